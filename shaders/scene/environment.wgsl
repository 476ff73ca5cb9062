// Radiance, density and sampling of an environment map. Twin: src/light/environment.rs. It reads
// `lighting.environment_size`, in texels, and `lighting.environment_rotation`, which is cosine and sine.
// provides: environment_density, environment_radiance, sample_environment
// needs: atan2_turns, lighting, sin_cos_turns

// Texels of the map, row by row. The fourth component is not used.
@group(3) @binding(0) var<storage, read> environment_texels: array<vec4f>;
// Cumulative tables for sampling: height + 1 numbers for the rows, and width + 1 numbers for the columns of each row.
// All are multiples of 2^-24, so that f32 subtracts them exactly.
@group(3) @binding(1) var<storage, read> environment_shares: array<f32>;

struct EnvironmentSample {
    direction: vec3f,
    // Density per steradian; zero if the map is black.
    density: f32,
}

fn environment_radiance(direction: vec3f) -> vec3f {
    let texel = environment_texel(direction);
    return environment_texels[texel.y * lighting.environment_size.x + texel.x].xyz;
}

fn environment_density(direction: vec3f) -> f32 {
    return environment_density_of(environment_texel(direction));
}

fn sample_environment(u: vec2u) -> EnvironmentSample {
    let size = lighting.environment_size;
    let chance = vec2f(u >> vec2u(8u)) * 0x1p-24;
    let row = environment_row(chance.y);
    let columns = environment_columns(row);
    let column = environment_column(chance.x, columns);
    let low = vec2f(environment_shares[columns + column], environment_shares[row]);
    let high = vec2f(environment_shares[columns + column + 1u], environment_shares[row + 1u]);
    let rest = (vec2f(u & vec2u(0xffu)) + 0.5) * 0x1p-32;
    let share = max(high - low, vec2f(0x1p-24));
    let along = min((chance.x - low.x + rest.x) / share.x, 1.0);
    let longitude = sin_cos_turns((f32(column) + along) / f32(size.x) - 0.5);
    // Latitudes are computed from the nearer pole, as sin^2 of half the colatitude.
    let is_upper = 2u * row < size.y;
    let from_pole = f32(select(size.y - 1u - row, row, is_upper));
    let into = select(high.y - chance.y - rest.y, chance.y - low.y + rest.y, is_upper);
    let down = clamp(into / share.y, 0.0, 1.0);
    let sines = vec2f(sin_cos_turns(from_pole / f32(4u * size.y)).x,
        sin_cos_turns((from_pole + 1.0) / f32(4u * size.y)).x);
    let edges = sines * sines;
    let square = edges.x + down * (edges.y - edges.x);
    let radius = 2.0 * sqrt(square * (1.0 - square));
    let y = select(-1.0, 1.0, is_upper) * (1.0 - 2.0 * square);
    let flat = environment_turned(radius * vec2f(longitude.x, -longitude.y), 1.0);
    return EnvironmentSample(vec3f(flat.x, y, flat.y), environment_density_of(vec2u(column, row)));
}

// Rotates x and z about the y axis.
fn environment_turned(flat: vec2f, sign: f32) -> vec2f {
    let rotation = vec2f(lighting.environment_rotation.x, sign * lighting.environment_rotation.y);
    return rotation.x * flat + rotation.y * vec2f(flat.y, -flat.x);
}

// The index of the first number of a row's columns in the cumulative tables.
fn environment_columns(row: u32) -> u32 {
    return lighting.environment_size.y + 1u + row * (lighting.environment_size.x + 1u);
}

// The column and row of the texel in a direction.
fn environment_texel(direction: vec3f) -> vec2u {
    let flat = environment_turned(direction.xz, -1.0);
    let across = atan2_turns(flat.x, 0.0 - flat.y) + 0.5;
    let down = 2.0 * atan2_turns(sqrt(dot(flat, flat)), direction.y);
    let size = lighting.environment_size;
    return min(vec2u(vec2f(across, down) * vec2f(size)), size - vec2u(1u));
}

fn environment_density_of(texel: vec2u) -> f32 {
    let size = vec2f(lighting.environment_size);
    let entry = environment_columns(texel.y) + texel.x;
    let share = vec2f(environment_shares[entry + 1u] - environment_shares[entry],
        environment_shares[texel.y + 1u] - environment_shares[texel.y]);
    let sines = sin_cos_turns(f32(2u * texel.y + 1u) / (4.0 * size.y)).x
        * sin_cos_turns(0.25 / size.y).x;
    // The constant is 4 pi.
    return share.x * (share.y / (12.566371 / size.x * sines));
}

// The last entry of a table, except its end, that is not greater than the random number. Tables have at most 2^12 + 1
// entries.
fn environment_row(chance: f32) -> u32 {
    var range = vec2u(0u, lighting.environment_size.y);
    for (var i = 0u; i < 12u; i++) {
        let middle = (range.x + range.y) >> 1u;
        range = select(vec2u(range.x, middle), vec2u(middle, range.y), environment_shares[middle] <= chance);
    }
    return range.x;
}

fn environment_column(chance: f32, first: u32) -> u32 {
    var range = vec2u(0u, lighting.environment_size.x);
    for (var i = 0u; i < 12u; i++) {
        let middle = (range.x + range.y) >> 1u;
        range = select(vec2u(range.x, middle), vec2u(middle, range.y),
            environment_shares[first + middle] <= chance);
    }
    return range.x;
}
