// A point that scatters light.
// provides: Reflection, Scattered, Surface
// needs: Axes, Material, Vertex

struct Surface {
    vertex: Vertex,
    material: Material,
    // Around the normal.
    axes: Axes,
}

struct Reflection {
    // The BSDF times the cosine.
    value: vec3f,
    // Of scattering light there, for each unit of solid angle.
    density: f32,
}

struct Scattered {
    // In the frame of the normal.
    direction: vec3f,
    // What light from there counts; 0 if there is none.
    weight: vec3f,
    density: f32,
}
