// Draws a picture into a host's render pass, with the host's depth. Hits behind the far plane are not drawn.
// dispatched: for all pixels of the host's viewport, in the host's render pass.
// provides: composite
// needs: Cover, center_of, color_for_host, depth_of_picture, host_view_of, is_behind

// Colour layer of the picture, with alpha multiplied in.
@group(0) @binding(1) var color_layer: texture_2d<f32>;

struct Fragment {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn composite(covered: Cover) -> Fragment {
    let view = host_view_of(covered);
    // Pixels before the first one have negative numbers.
    let pixel = floor(covered.place.xy) - view.first_pixel;
    let is_outside = any(abs(center_of(view, pixel)) >= view.size);
    let color = textureLoad(color_layer, vec2i(pixel), 0);
    let drawn = depth_of_picture(view, pixel, color.a);
    // Without `||`, whose branches take a software device longer than what they avoid.
    if (is_outside | !drawn.is_drawn | is_behind(view, drawn.depth, view.far)) {
        discard;
    }
    return Fragment(vec4f(color_for_host(color.rgb), color.a), clamp(drawn.depth, 0.0, 1.0));
}
