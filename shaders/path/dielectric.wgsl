// Scattering by smooth and rough glass. Twin: src/cpu/light/bsdf.rs.
// provides: scatter_dielectric
// needs: BsdfSample, ENERGIES, Material, energy, ggx_lambda, visible_mirror

// The fraction of unpolarised light that is reflected. `relative` is the index of refraction behind the surface,
// divided by that in front of it.
fn fresnel(relative: f32, cosine: f32) -> f32 {
    let sine2 = (1.0 - cosine * cosine) / (relative * relative);
    let beyond = sqrt(max(1.0 - sine2, 0.0));
    let across = (cosine - relative * beyond) / (cosine + relative * beyond);
    let along = (relative * cosine - beyond) / (relative * cosine + beyond);
    return select(0.5 * (across * across + along * along), 1.0, sine2 >= 1.0);
}

fn scatter_dielectric(material: Material, is_entering: bool, out: vec3f, lobe: f32, u: vec2u) -> BsdfSample {
    let relative = select(1.0 / material.parameter, material.parameter, is_entering);
    var half = vec3f(0.0, 0.0, 1.0);
    if (material.alpha > 0.0) {
        half = visible_mirror(material.alpha, out, u);
    }
    let cosine = clamp(dot(out, half), 0.0, 1.0);
    let is_reflected = lobe < fresnel(relative, cosine);
    let beyond = sqrt(max(1.0 - (1.0 - cosine * cosine) / (relative * relative), 0.0));
    let refracted = (cosine / relative - beyond) * half - out / relative;
    let toward = select(refracted, 2.0 * cosine * half - out, is_reflected);
    if ((toward.z > 0.0) != is_reflected) {
        return BsdfSample(toward, vec3f(0.0), 0.0);
    }
    var weight = 1.0;
    if (material.alpha > 0.0) {
        // The table of energies for light from inside follows the table for light from outside.
        let first = material.energies + select(ENERGIES / 4u, 0u, is_entering);
        weight = 1.0 / ((1.0 + ggx_lambda(material.alpha, abs(toward.z))) * energy(first, out.z));
    }
    return BsdfSample(toward, vec3f(weight), 0.0);
}
