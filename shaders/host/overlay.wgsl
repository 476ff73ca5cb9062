// Draws a picture into a host's render pass that has no depth. Every pixel of the picture is drawn.
// dispatched: for all pixels of the host's viewport, in the host's render pass.
// provides: overlay
// needs: Cover, color_for_host, host_view_of

// Colour layer of the picture.
@group(0) @binding(1) var color_layer: texture_2d<f32>;

@fragment
fn overlay(covered: Cover) -> @location(0) vec4f {
    let view = host_view_of(covered);
    // Pixels before the first one have negative numbers.
    let pixel = floor(covered.place.xy) - view.first_pixel;
    if (any(pixel < vec2f(0.0)) | any(pixel >= view.size)) {
        discard;
    }
    let color = textureLoad(color_layer, vec2i(pixel), 0);
    return vec4f(color_for_host(color.rgb), color.a);
}
