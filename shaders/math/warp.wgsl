// Maps from the unit square to directions, and tangent frames. Twin: src/cpu/light/maps.rs.
// provides: Axes, axes_around, cone_direction, cone_of_sphere, cosine_direction, to_local, to_world
// needs: concentric_disk, fence3, unit2

// A tangent frame: an orthonormal basis whose third vector is given.
//
// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
struct Axes {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

fn axes_around(n: vec3f) -> Axes {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    let x = vec3f(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    return Axes(x, vec3f(b, s + n.y * n.y * a, -n.y), n);
}

fn to_world(axes: Axes, v: vec3f) -> vec3f {
    return fence3(normalize(v.x * axes.x + v.y * axes.y + v.z * axes.z));
}

fn to_local(axes: Axes, v: vec3f) -> vec3f {
    return vec3f(dot(axes.x, v), dot(axes.y, v), dot(axes.z, v));
}

// A direction around z, with the density cosine / pi.
fn cosine_direction(u: vec2u) -> vec3f {
    let p = concentric_disk(unit2(u));
    return vec3f(p, sqrt(max(1.0 - dot(p, p), 0.0)));
}

// A uniformly distributed direction in a cone around z, with the density 1 / (2 pi k); k is 1 minus the cosine of the
// cone's half angle.
fn cone_direction(u: vec2u, k: f32) -> vec3f {
    let p = concentric_disk(unit2(u));
    let q = dot(p, p) * k;
    return vec3f(p * sqrt(max(k * (2.0 - q), 0.0)), 1.0 - q);
}

// The cone that a sphere fills, seen from a distance greater than its radius: 1 minus the cosine of the half angle.
fn cone_of_sphere(radius: f32, distance: f32) -> f32 {
    let s = radius / distance;
    return s * s / (1.0 + sqrt(max(1.0 - s * s, 0.0)));
}
