// A surface in a studio, while its light is computed in one pass.
// provides: Seen
// needs: Excluded, Material, Start, Vertex

// A surface that the camera sees.
struct Seen {
    vertex: Vertex,
    material: Material,
    start: Start,
    excluded: Excluded,
    // Unit vector towards the camera.
    out: vec3f,
    // The colour times the weight.
    albedo: vec3f,
    // How much of the surface is seen behind depth cueing.
    weight: f32,
    // Whether only shadows are seen of it, and the luminance of all lights on it then.
    is_caught: bool,
    light: f32,
}
