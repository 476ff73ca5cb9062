// The GGX microfacet distribution in the tangent frame of a normal. Twin: src/cpu/light/bsdf.rs.
//
// Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (2007); Heitz, "Sampling the GGX
// Distribution of Visible Normals", JCGT 7(4), 2018.
// provides: ggx_lambda, mirrors_brdf, reflected_density, visible_mirror
// needs: PI, concentric_disk, unit2

// Smith's function lambda, which measures the masking of microfacets seen from a direction.
fn ggx_lambda(alpha: f32, cosine: f32) -> f32 {
    let c2 = max(cosine * cosine, 1e-12);
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - c2) / c2) - 1.0);
}

fn ggx_density(alpha: f32, half: vec3f) -> f32 {
    let scaled = vec3f(half.xy / alpha, half.z);
    let q = dot(scaled, scaled);
    return 1.0 / (PI * alpha * alpha * q * q);
}

// A random normal among the microfacets that are visible from `out`.
fn visible_mirror(alpha: f32, out: vec3f, u: vec2u) -> vec3f {
    let stretched = normalize(vec3f(alpha * out.xy, out.z));
    let across = dot(stretched.xy, stretched.xy);
    let is_aside = across > 1e-12;
    let side = vec2f(-stretched.y, stretched.x) / sqrt(select(1.0, across, is_aside));
    let x = vec3f(select(vec2f(1.0, 0.0), side, is_aside), 0.0);
    let y = cross(stretched, x);
    let p = concentric_disk(unit2(u));
    let s = 0.5 * (1.0 + stretched.z);
    let q = (1.0 - s) * sqrt(max(1.0 - p.x * p.x, 0.0)) + s * p.y;
    let z = sqrt(max(1.0 - p.x * p.x - q * q, 0.0));
    let seen = p.x * x + q * y + z * stretched;
    return normalize(vec3f(alpha * seen.xy, max(seen.z, 1e-6)));
}

// The density with which a visible microfacet reflects the direction.
fn reflected_density(alpha: f32, out: vec3f, half: vec3f) -> f32 {
    let seen = 1.0 / (1.0 + ggx_lambda(alpha, out.z));
    return seen * ggx_density(alpha, half) / (4.0 * out.z);
}

// The BRDF of perfectly reflecting microfacets, times the cosine.
fn mirrors_brdf(alpha: f32, out: vec3f, toward: vec3f, half: vec3f) -> f32 {
    let both = 1.0 / (1.0 + ggx_lambda(alpha, out.z) + ggx_lambda(alpha, toward.z));
    return both * ggx_density(alpha, half) / (4.0 * out.z);
}
