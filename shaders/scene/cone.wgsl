// Intersection of a ray with a cone between two discs, and the normal there. A cylinder has two equal radii. Twin:
// src/verify/cone.rs.
//
// The cone, its discs and what they enclose are convex. So a ray enters once and leaves once: between the later one of
// the entries of the infinite cone and of the slab between the planes of the discs, and the earlier one of the exits. A
// ray cannot pass between a disc and the side, because one comparison decides for both.
//
// Distances are counted from the point of the ray that is nearest to the middle of the axis, as for spheres
// (scene/sphere.wgsl). The discriminant is half_b^2 - a c in another form: by Lagrange's identity, the terms that cancel
// are the square of (side), the distance of the ray from the axis times the sine of the angle between both, which is a
// triple product and the same from all points of the ray. For a cylinder this is the foot-point form of spheres.
// provides: Shape, cone_normal, intersect
// needs: NO_HIT, Ray, fence, fence3

// A cone in the scene's frame. A radius with a minus sign belongs to an open end.
struct Shape {
    start: vec3f,
    first_radius: f32,
    end: vec3f,
    second_radius: f32,
}

// A distance that no ray reaches.
const FAR: f32 = 1e30;

// The least part of a direction along the axis: 2^-40.
const LEAST_RISE: f32 = 9.094947e-13;

// The least coefficient of a square, 2^-34. Below it, the ray is along the side, and one root is at infinity: devices compute
// axes to within about 2^-19.
const LEAST_SQUARE: f32 = 5.820766e-11;

// The least square of a length that is divided by.
const LEAST_LENGTH: f32 = 1e-37;

fn no_shape() -> Shape {
    return Shape(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
}

fn is_same(a: Shape, b: Shape) -> bool {
    return all(a.start == b.start) && all(a.end == b.end) && a.first_radius == b.first_radius
        && a.second_radius == b.second_radius;
}

struct ConeHit {
    // Distance to the first point in front of the origin, or NO_HIT.
    t: f32,
    // Distance of that point from the foot.
    from_foot: f32,
    // 0 on the side, -1 on the disc of the start, 1 on that of the end.
    disc: f32,
    axis: vec3f,
    // The vector from the axis to the foot, and that part of the ray's direction.
    away: vec3f,
    aside: vec3f,
    // The growth of the radius along the axis, and along the ray; and the radius at the foot.
    slope: f32,
    growth: f32,
    radius: f32,
}

// Intersects a ray with a cone, without branches, because software devices execute both sides of a branch.
fn intersect(ray: Ray, cone: Shape) -> ConeHit {
    let span = fence3(cone.end - cone.start);
    let length = fence(sqrt(max(fence(dot(span, span)), LEAST_LENGTH)));
    let axis = fence3(span / length);
    let half = 0.5 * length;
    let first = abs(cone.first_radius);
    let second = abs(cone.second_radius);
    let slope = fence((second - first) / length);
    let to_middle = fence3(fence3(cone.start - ray.origin) + 0.5 * span);
    let b = fence(dot(to_middle, ray.direction));
    let foot = fence3(b * ray.direction - to_middle);
    let height = fence(dot(foot, axis));
    let rise = fence(dot(ray.direction, axis));
    let away = fence3(foot - height * axis);
    let aside = fence3(ray.direction - rise * axis);
    let radius = fence(0.5 * (first + second) + slope * height);
    let growth = fence(slope * rise);

    // The slab. A ray that hardly rises is taken to rise a little.
    let risen = select(rise, select(LEAST_RISE, -LEAST_RISE, rise < 0.0), abs(rise) < LEAST_RISE);
    let at_start = (-half - height) / risen;
    let at_end = (half - height) / risen;
    let slab_in = min(at_start, at_end);
    let slab_out = max(at_start, at_end);

    // The infinite cone: a s^2 + 2 half_b s + c = 0.
    let across = fence3(cross(ray.direction, axis));
    let sine = fence(dot(across, across));
    let side = fence(dot(foot, across));
    let tilt = fence(dot(away, aside));
    let square = fence(dot(away, away));
    let a = fence(sine - growth * growth);
    let half_b = fence(tilt - radius * growth);
    let c = fence(square - radius * radius);
    let discriminant =
        fence(fence(sine * radius * radius - side * side) + growth * fence(growth * square - 2.0 * tilt * radius));
    let root = sqrt(max(discriminant, 0.0));
    let sum = fence(half_b + select(root, -root, half_b < 0.0));
    let is_flat = abs(a) < LEAST_SQUARE;
    // Neither root is a difference of nearly equal numbers. Without a sum, both are zero, or both at infinity.
    let one = select(clamp(-sum / select(a, 1.0, is_flat), -FAR, FAR), select(-FAR, FAR, sum < 0.0), is_flat);
    let has_sum = sum != 0.0;
    let two = select(clamp(-c / select(1.0 / FAR, sum, has_sum), -FAR, FAR), 0.0, !has_sum && !is_flat);
    let low = min(one, two);
    let high = max(one, two);
    // A ray that is steeper than the side is inside before the first or after the second root, on the side of the tip
    // where the radius is positive.
    let is_steep = a < 0.0 && !is_flat;
    let opens = growth > 0.0;
    let side_in = select(low, select(-FAR, high, opens), is_steep);
    let side_out = select(high, select(low, FAR, opens), is_steep);
    let is_met = discriminant >= 0.0 || is_steep || is_flat;

    let enters_disc = slab_in > side_in;
    let leaves_disc = slab_out < side_out;
    let enters = select(side_in, slab_in, enters_disc);
    let leaves = select(side_out, slab_out, leaves_disc);
    let is_crossed = is_met && enters <= leaves;
    let is_up = risen > 0.0;
    // The signs of the radii of the discs at which the ray crosses the planes.
    let radius_in = select(cone.second_radius, cone.first_radius, is_up);
    let radius_out = select(cone.first_radius, cone.second_radius, is_up);
    let is_open_in = enters_disc && (bitcast<u32>(radius_in) >> 31u) != 0u;
    let is_open_out = leaves_disc && (bitcast<u32>(radius_out) >> 31u) != 0u;
    let near = b + enters;
    let far = b + leaves;
    let is_near = is_crossed && !is_open_in && near > 0.0;
    let is_far = is_crossed && !is_open_out && far > 0.0;
    let t = select(select(NO_HIT, far, is_far), near, is_near);
    let from_foot = select(leaves, enters, is_near);
    let is_disc = select(leaves_disc, enters_disc, is_near);
    // A ray that rises enters at the start and leaves at the end.
    let disc = select(0.0, select(-1.0, 1.0, is_near != is_up), is_disc);
    return ConeHit(t, from_foot, disc, axis, away, aside, slope, growth, radius);
}

// The normal at the point where a ray hits a cone.
fn shape_normal(ray: Ray, cone: Shape) -> vec3f {
    return cone_normal(intersect(ray, cone));
}

// The unit normal, which points away from the axis, or from the other end. At a tip it is along the axis.
fn cone_normal(hit: ConeHit) -> vec3f {
    let outward = fence3(hit.away + hit.from_foot * hit.aside);
    let radius = fence(hit.radius + hit.from_foot * hit.growth);
    let normal = fence3(outward - hit.slope * radius * hit.axis);
    let square = fence(dot(normal, normal));
    let at_tip = select(1.0, -1.0, hit.slope > 0.0) * hit.axis;
    let on_side = select(normal / sqrt(max(square, LEAST_LENGTH)), at_tip, square < LEAST_LENGTH);
    return fence3(select(on_side, hit.disc * hit.axis, hit.disc != 0.0));
}
