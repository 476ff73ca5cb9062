// Intersection of a ray with a sphere, and the sphere's normal.
//
// Haines, Guenther and Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, chapter
// 7 (2019): the discriminant is computed from the foot point (after Hearn and Baker), so that it is not lost in the
// squared distance, and the roots as q and c/q, so that neither is a difference of nearly equal numbers. Changes: the
// direction must have unit length, and only the relevant root is computed. A tangent ray hits.
// provides: Shape, discriminant_of, intersect, is_same, no_shape, searched_far_side, shape_normal, sphere_normal
// needs: NO_HIT, Ray, fence, fence3

// A sphere: its centre in the scene's frame, and its radius.
alias Shape = vec4f;

fn no_shape() -> Shape {
    return vec4f(0.0);
}

fn is_same(a: Shape, b: Shape) -> bool {
    return all(a == b);
}

struct SphereHit {
    // Distance to the first point in front of the origin (from inside: the far side), or NO_HIT.
    t: f32,
    // Signed distance from the centre's foot point on the ray to the hit point.
    from_foot: f32,
    foot_to_center: vec3f,
}

// Not negative if the ray's line meets the sphere, with the operations and the fences of `intersect`.
fn discriminant_of(ray: Ray, sphere: Shape) -> f32 {
    let to_center = fence3(sphere.xyz - ray.origin);
    let b = fence(dot(to_center, ray.direction));
    let foot_to_center = fence3(to_center - b * ray.direction);
    return fence(sphere.w * sphere.w - dot(foot_to_center, foot_to_center));
}

// Intersects a ray with a sphere, without branches, because software devices execute both sides of a branch.
fn intersect(ray: Ray, sphere: Shape) -> SphereHit {
    let radius = sphere.w;
    let to_center = fence3(sphere.xyz - ray.origin);
    let b = fence(dot(to_center, ray.direction));
    let foot_to_center = fence3(to_center - b * ray.direction);
    let discriminant = fence(radius * radius - dot(foot_to_center, foot_to_center));
    // The product of the distances to both sides: positive outside, zero on the sphere.
    let c = dot(to_center, to_center) - radius * radius;
    let half_chord = sqrt(max(discriminant, 0.0));
    let from_foot = select(half_chord, -half_chord, c > 0.0);
    // The result is b + from_foot. Where the two would cancel, it follows from (b + from_foot)(b - from_foot) = c.
    let is_sum = b * from_foot >= 0.0;
    let t = select(c / select(b - from_foot, 1.0, is_sum), b + from_foot, is_sum);
    // t is negative behind the origin, and zero for a ray that leaves the sphere.
    let is_hit = discriminant >= 0.0 && t > 0.0;
    return SphereHit(select(NO_HIT, t, is_hit), from_foot, foot_to_center);
}

// What a search finds of a sphere on which a ray starts inwards: nothing, because its far side is known before.
fn searched_far_side(ray: Ray, sphere: Shape) -> f32 {
    return NO_HIT;
}

// The normal at the point where a ray hits a sphere.
fn shape_normal(ray: Ray, sphere: Shape) -> vec3f {
    return sphere_normal(ray, intersect(ray, sphere));
}

// The unit normal, which points away from the centre. It is computed from the right triangle of the intersection and
// not from the hit point, whose rounding errors may exceed the radius of a small and distant sphere. The triangle is
// not exactly right-angled there either, so its hypotenuse is computed instead of taken to be the radius. It is never
// zero, because its legs were computed from the radius.
fn sphere_normal(ray: Ray, hit: SphereHit) -> vec3f {
    let outward = fence3(hit.from_foot * ray.direction - hit.foot_to_center);
    return fence3(outward / sqrt(dot(outward, outward)));
}
