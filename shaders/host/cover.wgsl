// The corners of a triangle that covers the whole viewport.
// dispatched: three vertices, when a picture is drawn into a host's render pass.
// provides: cover

@vertex
fn cover(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let x = select(-1.0, 3.0, vertex == 1u);
    let y = select(-1.0, 3.0, vertex == 2u);
    return vec4f(x, y, 0.0, 1.0);
}
