// The structs of a surface point, of a BSDF value and of a scattered direction.
// provides: BsdfSample, Reflection, Surface
// needs: Axes, Material, Vertex

struct Surface {
    vertex: Vertex,
    material: Material,
    // Tangent frame around the normal.
    axes: Axes,
    // How many surfaces the path has met before.
    number: u32,
}

struct Reflection {
    // The BSDF times the cosine.
    value: vec3f,
    // Density of scattering in this direction, per unit of solid angle.
    density: f32,
}

struct BsdfSample {
    // Direction in the tangent frame.
    direction: vec3f,
    // Factor of the throughput; 0 if the light is absorbed.
    weight: vec3f,
    density: f32,
}
