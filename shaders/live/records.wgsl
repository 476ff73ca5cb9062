// Surfaces and visibilities of a live picture, as they are kept between its passes. Twin: src/cpu/light/live.rs.
// provides: Shades, Visibility, pack_normal, pack_visibility, unpack_normal, visibility_of

// What is known of the light at a pixel: the visible shares of lamps and of ambient light, and the numbers of frames
// over which the two are averaged.
struct Visibility {
    shares: vec2f,
    counts: vec2u,
}

// Colours, premultiplied by opacity, and opacities. What is seen is `steady`, plus `lamps` times the share of lamps, plus
// `ambient` times the share of ambient light.
struct Shades {
    steady: vec4f,
    lamps: vec4f,
    ambient: vec4f,
}

// The octahedral map of a unit vector (Meyer and others, On Floating-Point Normal Vectors, 2010), in [-1, 1]^2.
fn pack_normal(normal: vec3f) -> vec2f {
    let size = abs(normal.x) + abs(normal.y) + abs(normal.z);
    let flat = normal.xy / max(size, 1e-20);
    let folded = (1.0 - abs(flat.yx)) * select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return select(flat, folded, normal.z < 0.0);
}

fn unpack_normal(packed: vec2f) -> vec3f {
    let height = 1.0 - abs(packed.x) - abs(packed.y);
    let folded = (1.0 - abs(packed.yx)) * select(vec2f(-1.0), vec2f(1.0), packed >= vec2f(0.0));
    return normalize(vec3f(select(packed, folded, height < 0.0), height));
}

// A word with the counts, and one with the shares.
fn pack_visibility(found: Visibility) -> vec2u {
    return vec2u(pack2x16unorm(found.shares), found.counts.x | (found.counts.y << 8u));
}

fn visibility_of(words: vec2u) -> Visibility {
    return Visibility(unpack2x16unorm(words.x), vec2u(words.y, words.y >> 8u) & vec2u(255u));
}
