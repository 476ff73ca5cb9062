// The BSDF of reflecting surfaces: Lambertian, with or without a specular lobe, and metal. Twin:
// src/cpu/light/bsdf.rs.
// provides: reflect_by_any, scatter_reflection
// needs: BsdfSample, CONDUCTOR, DIELECTRIC, Material, PI, Reflection, cosine_direction, energy, ggx_lambda,
//   mirrors_brdf, reflected_density, visible_mirror

fn schlick(color: vec3f, cosine: f32) -> vec3f {
    let m = clamp(1.0 - cosine, 0.0, 1.0);
    let m2 = m * m;
    return color + (vec3f(1.0) - color) * (m2 * m2 * m);
}

// The factor that compensates for the energy that single scattering loses (Turquin, "Practical multiple scattering
// compensation for microfacet models", 2019).
fn compensation(color: vec3f, kept: f32) -> vec3f {
    return vec3f(1.0) + color * ((1.0 - kept) / kept);
}

// The reflection of `reflect_toward` by any material.
fn reflect_by_any(material: Material, color: vec3f, out: vec3f, toward: vec3f) -> Reflection {
    if (toward.z <= 0.0 || out.z <= 0.0 || material.kind >= DIELECTRIC) {
        return Reflection(vec3f(0.0), 0.0);
    }
    let is_metal = material.kind == CONDUCTOR;
    let share = select(material.parameter, 1.0, is_metal);
    let matt = (1.0 - share) * toward.z / PI;
    if (share == 0.0) {
        return Reflection(color * matt, matt);
    }
    let half = normalize(out + toward);
    let kept = energy(material.energies, out.z);
    let mirrors = mirrors_brdf(material.alpha, out, toward, half);
    let metal = schlick(color, dot(half, out)) * compensation(color, kept);
    let lobe = select(vec3f(1.0 / kept), metal, is_metal);
    let density = matt + share * reflected_density(material.alpha, out, half);
    return Reflection(color * matt + share * mirrors * lobe, density);
}

fn scatter_reflection(material: Material, color: vec3f, out: vec3f, lobe: f32, u: vec2u) -> BsdfSample {
    let is_metal = material.kind == CONDUCTOR;
    if (is_metal || lobe < material.parameter) {
        let half = visible_mirror(material.alpha, out, u);
        let toward = 2.0 * dot(half, out) * half - out;
        let r = reflect_by_any(material, color, out, toward);
        if (is_metal) {
            // The quotient of value and density, with common factors cancelled.
            let kept = energy(material.energies, out.z);
            let seen = 1.0 + ggx_lambda(material.alpha, out.z);
            let ratio = seen / (seen + ggx_lambda(material.alpha, toward.z));
            let weight = schlick(color, dot(half, out)) * compensation(color, kept) * ratio;
            return BsdfSample(toward, select(vec3f(0.0), weight, toward.z > 0.0), r.density);
        }
        return BsdfSample(toward, r.value / max(r.density, 1e-30), r.density);
    }
    let toward = cosine_direction(u);
    let r = reflect_by_any(material, color, out, toward);
    let mixed = r.value / max(r.density, 1e-30);
    let weight = select(mixed, color, material.parameter == 0.0);
    return BsdfSample(toward, select(vec3f(0.0), weight, toward.z > 0.0), r.density);
}
