// One ray against one sphere.
//
// Haines, Guenther and Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray
// Tracing Gems, chapter 7 (2019): the discriminant from the foot point (after Hearn and Baker), so
// that it does not drown in the squared distance, and the roots as c/q and q, so that neither is a
// difference of nearly equal numbers. Changed here: the direction has unit length, and only the root
// that counts is computed. The direction must be unit; a tangent ray hits.

struct SphereHit {
    // Distance to the first point in front of the origin (from inside: the far wall), or NO_HIT.
    t: f32,
    // Signed distance from the centre's foot point on the ray to the hit point.
    from_foot: f32,
    foot_to_center: vec3f,
}

fn intersect_sphere(ray: Ray, sphere: vec4f) -> SphereHit {
    let radius = sphere.w;
    let to_center = sphere.xyz - ray.origin;
    let b = dot(to_center, ray.direction);
    let foot_to_center = to_center - b * ray.direction;
    let discriminant = radius * radius - dot(foot_to_center, foot_to_center);
    // The product of the two roots: negative if the origin is inside.
    let c = dot(to_center, to_center) - radius * radius;

    var hit = SphereHit(NO_HIT, 0.0, foot_to_center);
    if (discriminant < 0.0 || (c > 0.0 && b <= 0.0)) {
        return hit;
    }
    let half_chord = sqrt(discriminant);
    let outside = c > 0.0;
    hit.from_foot = select(half_chord, -half_chord, outside);
    var t: f32;
    if (b >= 0.0) {
        let q = b + half_chord;
        // Outside, b > 0, so q > 0.
        if (outside) { t = c / q; } else { t = q; }
    } else {
        t = c / (b - half_chord);
    }
    // On the wall and leaving, t is zero.
    if (t > 0.0) {
        hit.t = t;
    }
    return hit;
}

// Unit normal, pointing away from the centre. From the right triangle of the intersection, not from
// the hit point, which far away from a small sphere is nothing but rounding.
fn sphere_normal(ray: Ray, sphere: vec4f, hit: SphereHit) -> vec3f {
    return (hit.from_foot * ray.direction - hit.foot_to_center) / sphere.w;
}
