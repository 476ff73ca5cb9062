// Scattering by the materials of a scene.
// provides: reflect_toward, scatter_light
// needs: ANY_MATERIALS, BsdfSample, DIELECTRIC, Material, PI, Reflection, Surface, cosine_direction, reflect_by_any,
//   scatter_dielectric, scatter_reflection

fn scatter_light(at: Surface, out: vec3f, lobe: f32, u: vec2u) -> BsdfSample {
    if (!ANY_MATERIALS) {
        let toward = cosine_direction(u);
        return BsdfSample(toward, at.vertex.color, toward.z / PI);
    }
    if (at.material.kind == DIELECTRIC) {
        return scatter_dielectric(at.material, !at.vertex.is_back, out, lobe, u);
    }
    return scatter_reflection(at.material, at.vertex.color, out, lobe, u);
}

// The BSDF times the cosine, and the density of scattering. Both directions point away from the surface, in the tangent
// frame.
fn reflect_toward(material: Material, color: vec3f, out: vec3f, toward: vec3f) -> Reflection {
    if (!ANY_MATERIALS) {
        let matt = select(0.0, toward.z / PI, toward.z > 0.0 && out.z > 0.0);
        return Reflection(color * matt, matt);
    }
    return reflect_by_any(material, color, out, toward);
}
