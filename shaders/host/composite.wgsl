// Draws a picture into a host's render pass, with the host's depth. Misses, and hits behind the far plane, are not
// drawn.
// dispatched: for all pixels of the host's viewport, in the host's render pass.
// provides: composite
// needs: HostView, clip_depth, color_for_host, is_behind

// The host's camera.
@group(0) @binding(0) var<uniform> view: HostView;
// Colour layer of the picture.
@group(0) @binding(1) var color_layer: texture_2d<f32>;
// Depth layer of the picture: distances along the rays, 1e30 for a miss.
@group(0) @binding(2) var depth_layer: texture_2d<f32>;

struct Fragment {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn composite(@builtin(position) place: vec4f) -> Fragment {
    // The subtraction wraps around, so pixels before the first one have large numbers.
    let pixel = vec2u(place.xy) - view.first_pixel;
    if (any(pixel >= view.size)) {
        discard;
    }
    let distance = textureLoad(depth_layer, pixel, 0).r;
    let depth = clip_depth(view, pixel, distance);
    if (distance >= 1e30 || is_behind(view, depth, view.far)) {
        discard;
    }
    let color = textureLoad(color_layer, pixel, 0);
    return Fragment(vec4f(color_for_host(color.rgb), color.a), clamp(depth, 0.0, 1.0));
}
