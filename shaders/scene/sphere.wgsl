// Spheres: one ray against one of them, and its normal.
//
// Haines, Guenther and Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray
// Tracing Gems, chapter 7 (2019): the discriminant from the foot point (after Hearn and Baker), so
// that it does not drown in the squared distance, and the roots as q and c/q, so that neither is a
// difference of nearly equal numbers. Changed here: the direction must have unit length, and only the
// root that counts is computed. A tangent ray hits.
// provides: Shape, bare, intersect, is_same, no_shape, shape_normal, sphere_normal
// needs: NO_HIT, Ray, fence, fence3

// Centre in the scene's frame, and radius.
alias Shape = vec4f;

fn no_shape() -> Shape {
    return vec4f(0.0);
}

// What a structure needs no more than to find a shape.
fn bare(shape: Shape) -> Shape {
    return vec4f(shape.xyz, abs(shape.w));
}

// The second must be bare.
fn is_same(a: Shape, b: Shape) -> bool {
    return all(a.xyz == b.xyz) && abs(a.w) == b.w;
}

struct SphereHit {
    // Distance to the first point in front of the origin (from inside: the far side), or NO_HIT.
    t: f32,
    // Signed distance from the centre's foot point on the ray to the hit point.
    from_foot: f32,
    foot_to_center: vec3f,
}

// Without branches: software devices run both sides of one and pay for the masks.
fn intersect(ray: Ray, sphere: Shape) -> SphereHit {
    let radius = sphere.w;
    let to_center = fence3(sphere.xyz - ray.origin);
    let b = fence(dot(to_center, ray.direction));
    let foot_to_center = fence3(to_center - b * ray.direction);
    let discriminant = fence(radius * radius - dot(foot_to_center, foot_to_center));
    // The product of the distances to both walls: positive outside, zero on the wall.
    let c = dot(to_center, to_center) - radius * radius;
    let half_chord = sqrt(max(discriminant, 0.0));
    let from_foot = select(half_chord, -half_chord, c > 0.0);
    // b + from_foot; where the two would cancel, from (b + from_foot)(b - from_foot) = c.
    let is_sum = b * from_foot >= 0.0;
    let t = select(c / select(b - from_foot, 1.0, is_sum), b + from_foot, is_sum);
    // Behind the origin t is negative; on the wall and leaving it is zero.
    let is_hit = discriminant >= 0.0 && t > 0.0;
    return SphereHit(select(NO_HIT, t, is_hit), from_foot, foot_to_center);
}

// The normal where a ray meets a sphere.
fn shape_normal(ray: Ray, sphere: Shape) -> vec3f {
    return sphere_normal(ray, intersect(ray, sphere));
}

// Unit normal, pointing away from the centre. From the right triangle of the intersection, not from
// the hit point, which far away from a small sphere is nothing but rounding. There the triangle is not
// quite right-angled either, so its hypotenuse is measured instead of taken to be the radius; it is
// never zero, because its two legs were made from the radius.
fn sphere_normal(ray: Ray, hit: SphereHit) -> vec3f {
    let outward = fence3(hit.from_foot * ray.direction - hit.foot_to_center);
    return fence3(outward / sqrt(dot(outward, outward)));
}
