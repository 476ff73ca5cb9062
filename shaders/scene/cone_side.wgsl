// A cone as a ray sees it, and where the ray crosses its side, which goes on without end. Twin: src/verify/cone.rs.
//
// Distances are counted from the point of the ray that is nearest to the middle of the axis, as for spheres
// (scene/sphere.wgsl). The discriminant is half_b^2 - a c in another form: by Lagrange's identity, the terms that cancel
// are the square of (side), the distance of the ray from the axis times the sine of the angle between both, which is a
// triple product and the same from all points of the ray. For a cylinder this is the foot-point form of spheres.
// provides: ConeSeen, LEAST_LENGTH, Shape, see_cone, side_crossing
// needs: Ray, fence, fence3

// A cone in the scene's frame. A radius with a minus sign belongs to an open end.
struct Shape {
    start: vec3f,
    first_radius: f32,
    end: vec3f,
    second_radius: f32,
}

// A distance that no ray reaches.
const FAR: f32 = 1e30;

// The least coefficient of a square, 2^-34. Below it, the ray is along the side, and one root is at infinity: devices compute
// axes to within about 2^-19.
const LEAST_SQUARE: f32 = 5.820766e-11;

// The least square of a length that is divided by.
const LEAST_LENGTH: f32 = 1e-37;

struct ConeSeen {
    // Distance of the foot from the ray's origin, and the vector to it from the middle of the axis.
    b: f32,
    foot: vec3f,
    axis: vec3f,
    half: f32,
    // The foot's height above the middle, and how much the ray rises.
    height: f32,
    rise: f32,
    // The vector from the axis to the foot, and that part of the ray's direction.
    away: vec3f,
    aside: vec3f,
    // The growth of the radius along the axis and along the ray, and the radius at the foot.
    slope: f32,
    growth: f32,
    radius: f32,
}

fn see_cone(ray: Ray, cone: Shape) -> ConeSeen {
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
    return ConeSeen(b, foot, axis, half, height, rise, away, aside, slope, growth, radius);
}

struct SideCrossing {
    enters: f32,
    leaves: f32,
    is_met: bool,
}

fn side_crossing(ray: Ray, seen: ConeSeen) -> SideCrossing {
    let growth = seen.growth;
    let radius = seen.radius;
    // The infinite cone: a s^2 + 2 half_b s + c = 0.
    let across = fence3(cross(ray.direction, seen.axis));
    let sine = fence(dot(across, across));
    let side = fence(dot(seen.foot, across));
    let tilt = fence(dot(seen.away, seen.aside));
    let square = fence(dot(seen.away, seen.away));
    let a = fence(sine - growth * growth);
    let half_b = fence(tilt - radius * growth);
    let c = fence(square - radius * radius);
    let discriminant =
        fence(fence(sine * radius * radius - side * side) + growth * fence(growth * square - 2.0 * tilt * radius));
    let root = sqrt(max(discriminant, 0.0));
    let to_far = select(root, -root, half_b < 0.0);
    let sum = fence(half_b + to_far);
    let is_flat = abs(a) < LEAST_SQUARE;
    let divisor = select(a, 1.0, is_flat);
    let one = select(clamp(-sum / divisor, -FAR, FAR), select(-FAR, FAR, sum < 0.0), is_flat);
    // The other root is -c/sum, but near the foot c is rounding errors and the sum next to nothing, or both are nothing.
    let is_quotient = is_flat || sum * sum > abs(a) * max(square, radius * radius);
    let quotient = -c / select(1.0 / FAR, sum, sum != 0.0);
    let two = clamp(select(-fence(half_b - to_far) / divisor, quotient, is_quotient), -FAR, FAR);
    let low = min(one, two);
    let high = max(one, two);
    // A ray that is steeper than the side is inside before the first or after the second root, where radii are positive.
    let is_steep = a < 0.0 && !is_flat;
    let opens = growth > 0.0;
    let side_in = select(low, select(-FAR, high, opens), is_steep);
    let side_out = select(high, select(low, FAR, opens), is_steep);
    let is_met = discriminant >= 0.0 || is_steep || is_flat;
    return SideCrossing(side_in, side_out, is_met);
}
