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
    // The near root is at most b, and the far root of a ray that leaves at most the half chord. Where
    // the origin is almost on the wall, rounding can make c and the discriminant disagree; then the
    // quotient would be larger, or without bound.
    var t: f32;
    if (outside) {
        let q = b + half_chord;
        t = b;
        if (c < b * q) { t = c / q; }
    } else if (b >= 0.0) {
        t = b + half_chord;
    } else {
        let q = b - half_chord;
        t = half_chord;
        if (c > half_chord * q) { t = c / q; }
    }
    // On the wall and leaving, t is zero.
    if (t > 0.0) {
        hit.t = t;
    }
    return hit;
}

// Unit normal, pointing away from the centre. From the right triangle of the intersection, not from
// the hit point, which far away from a small sphere is nothing but rounding. There the triangle is not
// quite right-angled either, so its hypotenuse is measured instead of taken to be the radius; it is
// never zero, because its two legs were made from the radius.
fn sphere_normal(ray: Ray, hit: SphereHit) -> vec3f {
    let outward = hit.from_foot * ray.direction - hit.foot_to_center;
    return outward / sqrt(dot(outward, outward));
}
