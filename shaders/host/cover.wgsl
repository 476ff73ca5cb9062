// The corners of a triangle that covers the whole viewport.
// dispatched: three vertices, when a picture is drawn into a host's render pass.
// provides: cover
// needs: Cover, HostView

// The host's camera.
@group(0) @binding(0) var<uniform> view: HostView;

@vertex
fn cover(@builtin(vertex_index) vertex: u32) -> Cover {
    let x = select(-1.0, 3.0, vertex == 1u);
    let y = select(-1.0, 3.0, vertex == 2u);
    return Cover(
        vec4f(x, y, 0.0, 1.0),
        vec4f(view.column, view.is_parallel),
        vec4f(view.row, view.slope),
        vec4f(view.forward, view.far),
        vec4f(view.film_depth, view.zero),
        vec4f(view.size, view.first_pixel),
    );
}
