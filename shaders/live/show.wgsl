// Averages the visible shares of light over neighbouring pixels of the same surface, the less the more frames know them,
// and writes the picture. Twin: src/cpu/light/live.rs.
// dispatched: once for each frame of a live picture, after `reproject`.
// provides: show
// needs: LiveView, unpack_normal, visibility_of, write_layers, write_with_alpha

// The cameras of this frame and of the one before.
@group(0) @binding(0) var<uniform> view: LiveView;
// The surfaces of this frame, as in trace.wgsl.
@group(0) @binding(1) var<storage, read> surfaces: array<vec4u>;
// Shares, counts, depth and id of every pixel.
@group(0) @binding(2) var<storage, read> known: array<vec4u>;

fn normal_at(index: u32) -> vec3f {
    return unpack_normal(unpack2x16snorm(surfaces[4u * index + 2u].w));
}

// How much a neighbour counts: not at all beyond an edge.
fn weight_of(depth: f32, other: f32, normal: vec3f, other_normal: vec3f) -> f32 {
    let pixel_size = view.footprint * select(depth, 1.0, view.is_parallel != 0u);
    let is_near = abs(depth - other) <= 12.0 * pixel_size + 1e-5 * depth;
    return select(0.0, clamp(4.0 * dot(normal, other_normal) - 3.0, 0.0, 1.0), is_near);
}

fn smoothed(pixel: vec2u, index: u32, center: vec4u, normal: vec3f) -> vec2f {
    let own = visibility_of(center.xy);
    let depth = bitcast<f32>(center.z);
    // Frames tell more than neighbours once there are many.
    let part = clamp(1.25 - vec2f(own.counts) / 16.0, vec2f(0.0), vec2f(1.0));
    var sum = own.shares;
    var total = vec2f(1.0);
    for (var i = 0; i < 9 && any(part > vec2f(0.0)); i++) {
        let at = vec2i(pixel) + 2 * vec2i(i % 3 - 1, i / 3 - 1);
        if (i != 4 && all(at >= vec2i(0)) && all(at < vec2i(view.size))) {
            let there = u32(at.y) * view.size.x + u32(at.x);
            let other = known[there];
            let found = visibility_of(other.xy);
            let weight = part * weight_of(depth, bitcast<f32>(other.z), normal, normal_at(there));
            sum += weight * found.shares;
            total += weight;
        }
    }
    return sum / total;
}

@compute @workgroup_size(8, 8)
fn show(@builtin(global_invocation_id) invocation: vec3u) {
    let pixel = invocation.xy;
    if (any(pixel >= view.size)) {
        return;
    }
    let index = pixel.y * view.size.x + pixel.x;
    let opacities = unpack2x16snorm(surfaces[4u * index + 3u].z);
    let steady = bitcast<vec4f>(surfaces[4u * index]);
    let lamps = vec4f(bitcast<vec3f>(surfaces[4u * index + 1u].xyz), opacities.x);
    let ambient = vec4f(bitcast<vec3f>(surfaces[4u * index + 2u].xyz), opacities.y);
    let center = known[index];
    let normal = normal_at(index);
    let shares = smoothed(pixel, index, center, normal);
    let color = steady + shares.x * lamps + shares.y * ambient;
    write_with_alpha(pixel, max(color.rgb, vec3f(0.0)), clamp(color.a, 0.0, 1.0));
    let is_miss = bitcast<f32>(center.z) >= 1e30;
    write_layers(pixel, bitcast<f32>(center.z), select(normal, vec3f(0.0), is_miss), center.w);
}
