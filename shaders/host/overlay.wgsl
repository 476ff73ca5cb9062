// Draws a picture into a host's render pass that has no depth. Every pixel of the picture is drawn.
// dispatched: for all pixels of the host's viewport, in the host's render pass.
// provides: overlay
// needs: HostView, color_for_host

// The host's camera.
@group(0) @binding(0) var<uniform> view: HostView;
// Colour layer of the picture.
@group(0) @binding(1) var color_layer: texture_2d<f32>;

@fragment
fn overlay(@builtin(position) place: vec4f) -> @location(0) vec4f {
    // The subtraction wraps around, so pixels before the first one have large numbers.
    let pixel = vec2u(place.xy) - view.first_pixel;
    if (any(pixel >= view.size)) {
        discard;
    }
    let color = textureLoad(color_layer, pixel, 0);
    return vec4f(color_for_host(color.rgb), color.a);
}
