// Scattering by the materials of a scene.

//// matt
// Scattering in scenes in which every material is matt or emissive.
// provides: reflect_toward, scatter_light
// needs: Material, PI, Reflection, Scattered, Surface, cosine_direction

fn scatter_light(at: Surface, out: vec3f, lobe: f32, u: vec2u) -> Scattered {
    let toward = cosine_direction(u);
    return Scattered(toward, at.vertex.color, toward.z / PI);
}

fn reflect_toward(material: Material, color: vec3f, out: vec3f, toward: vec3f) -> Reflection {
    let matt = select(0.0, toward.z / PI, toward.z > 0.0 && out.z > 0.0);
    return Reflection(color * matt, matt);
}

//// any
// Scattering in scenes with any materials.
// provides: scatter_light
// needs: DIELECTRIC, Scattered, Surface, scatter_dielectric, scatter_reflection

fn scatter_light(at: Surface, out: vec3f, lobe: f32, u: vec2u) -> Scattered {
    if (at.material.kind == DIELECTRIC) {
        return scatter_dielectric(at.material, !at.vertex.is_back, out, lobe, u);
    }
    return scatter_reflection(at.material, at.vertex.color, out, lobe, u);
}
