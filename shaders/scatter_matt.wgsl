// A scene in which everything is matt or sends out light.

fn scatter_light(at: Surface, out: vec3f, lobe: f32, u: vec2u) -> Scattered {
    let toward = cosine_direction(u);
    return Scattered(toward, at.vertex.color, toward.z / PI);
}

fn reflect_toward(material: Material, color: vec3f, out: vec3f, toward: vec3f) -> Reflection {
    let matt = select(0.0, toward.z / PI, toward.z > 0.0 && out.z > 0.0);
    return Reflection(color * matt, matt);
}
