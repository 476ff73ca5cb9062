// The part of a light that a surface reflects to the camera in a studio. Twin: src/cpu/light/studio.rs.
// provides: reflected
// needs: PI, energy, mirrors_brdf

// The light that a specular lobe reflects, for a surface of weight 1.
fn lobe_light(lobe: vec3f, normal: vec3f, out: vec3f, toward: vec3f) -> f32 {
    let half = normalize(out + toward);
    let o = vec3f(0.0, 0.0, max(dot(normal, out), 1e-6));
    let i = vec3f(0.0, 0.0, max(dot(normal, toward), 1e-6));
    let h = dot(half, normal);
    let across = cross(half, normal);
    let mirrors = mirrors_brdf(lobe.y, o, i, vec3f(sqrt(dot(across, across)), 0.0, h));
    return lobe.x * PI * mirrors / energy(bitcast<u32>(lobe.z), o.z);
}

// The light that a surface reflects, for a light of strength 1. `lobe` is its specular lobe, `weight` how much of the
// surface is seen, and `albedo` its colour times that.
fn reflected(lobe: vec3f, normal: vec3f, out: vec3f, toward: vec3f, albedo: vec3f, weight: f32) -> vec3f {
    let cosine = max(dot(normal, toward), 0.0);
    var seen = (1.0 - lobe.x) * cosine * albedo;
    if (lobe.x > 0.0) {
        let shine = weight * lobe_light(lobe, normal, out, toward);
        seen += vec3f(select(0.0, shine, cosine > 0.0));
    }
    return seen;
}
