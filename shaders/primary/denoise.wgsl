// One pass of an edge-avoiding denoising filter, which averages 25 pixels with weights for their similarity. The pixels
// are `step` pixels apart. Twin: src/cpu/denoise.rs.
//
// Dammertz, Sewtz, Hanika and Lensch, "Edge-Avoiding A-Trous Wavelet Transform for Fast Global Illumination
// Filtering", HPG 2010; with the variance of the noise as in Schied et al., "Spatiotemporal Variance-Guided Filtering",
// HPG 2017.
// dispatched: five times for each strip of a finished picture, with 8x8 pixels for each workgroup.
// provides: denoise
// needs: luminance

struct Denoise {
    size: vec2u,
    step: u32,
    // Zero; see fence.wgsl.
    zero: u32,
}

// Parameters of one of the five passes.
@group(0) @binding(0) var<uniform> denoise_pass: Denoise;
// Light of each pixel, which is colour divided by albedo, and the variance of its luminance.
@group(0) @binding(1) var<storage, read> lights: array<vec4f>;
// Normal of each pixel, zero for a miss, and its depth.
@group(0) @binding(2) var<storage, read> shapes: array<vec4f>;
// Albedo of each pixel.
@group(0) @binding(3) var<storage, read> albedos: array<vec4f>;
// Filtered light of each pixel, and the variance of its luminance.
@group(0) @binding(4) var<storage, read_write> filtered: array<vec4f>;

// A variance of light that is no noise. The filter adds as much to every variance.
const NO_NOISE: f32 = 1e-8;

// Weight of a B3 spline at a distance from its centre.
fn spline(distance: i32) -> f32 {
    return select(select(0.0625, 0.25, distance == 1), 0.375, distance == 0);
}

// Similarity of two pixels in shape and albedo, regardless of their light.
fn likeness(a: u32, b: u32, distance: f32) -> f32 {
    let shape = shapes[a];
    let other = shapes[b];
    let cosine = dot(shape.xyz, other.xyz);
    // Misses have no normal. Two misses count as similar.
    let are_misses = dot(shape.xyz, shape.xyz) == 0.0 && dot(other.xyz, other.xyz) == 0.0;
    let c2 = max(cosine, 0.0) * max(cosine, 0.0);
    let c4 = c2 * c2;
    let c16 = c4 * c4 * c4 * c4;
    let depth = abs(shape.w - other.w) / (0.005 * distance * max(min(shape.w, other.w), 1e-30));
    let tint = albedos[a].rgb - albedos[b].rgb;
    let alike = c16 * c16 / (1.0 + depth * depth);
    return select(alike, 1.0, are_misses) / (1.0 + 400.0 * dot(tint, tint));
}

@compute @workgroup_size(8, 8)
fn denoise(@builtin(global_invocation_id) pixel: vec3u) {
    if (any(pixel.xy >= denoise_pass.size)) {
        return;
    }
    let middle = pixel.y * denoise_pass.size.x + pixel.x;
    let light = lights[middle];
    // A miss without noise is background, and stays as it is. The loops end at once there: software devices compute both
    // sides of a branch, but leave a loop that no lane is in.
    let is_quiet = dot(shapes[middle].xyz, shapes[middle].xyz) == 0.0 && light.w <= NO_NOISE;
    let last = select(2, -3, is_quiet);
    var sum = vec3f(0.0);
    var variance = 0.0;
    var weights = 0.0;
    for (var dy = -2; dy <= last; dy++) {
        for (var dx = -2; dx <= last; dx++) {
            let at = vec2i(pixel.xy) + vec2i(dx, dy) * i32(denoise_pass.step);
            let is_in = all(at >= vec2i(0)) && all(at < vec2i(denoise_pass.size));
            let index = select(middle, u32(at.y) * denoise_pass.size.x + u32(at.x), is_in);
            let other = lights[index];
            let distance = f32(denoise_pass.step) * length(vec2f(f32(dx), f32(dy)));
            let change = luminance(other.rgb - light.rgb);
            let noise = 4.0 * (light.w + other.w) + NO_NOISE;
            let same = likeness(middle, index, max(distance, 1.0)) * exp(-change * change / noise);
            let weight = select(spline(abs(dx)) * spline(abs(dy)) * same, 0.0, !is_in);
            sum += weight * other.rgb;
            variance += weight * weight * other.w;
            weights += weight;
        }
    }
    let mean = vec4f(sum / weights, variance / (weights * weights));
    filtered[middle] = select(mean, light, is_quiet);
}
