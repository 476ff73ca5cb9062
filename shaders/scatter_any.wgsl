// A scene of all materials.

fn scatter_light(at: Surface, out: vec3f, lobe: f32, u: vec2u) -> Scattered {
    if (at.material.kind == DIELECTRIC) {
        return scatter_dielectric(at.material, !at.vertex.is_back, out, lobe, u);
    }
    return scatter_reflection(at.material, at.vertex.color, out, lobe, u);
}
