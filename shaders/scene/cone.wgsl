// Intersection of a ray with a cone between two discs, and the normal there. A cylinder has two equal radii. Twin:
// src/verify/cone.rs.
//
// The cone, its discs and what they enclose are convex. So a ray enters once and leaves once: between the later one of
// the entries of the infinite cone and of the slab between the planes of the discs, and the earlier one of the exits. A
// ray cannot pass between a disc and the side, because one comparison decides for both.
// provides: cone_normal, discriminant_of, intersect, shape_normal
// needs: ConeSeen, LEAST_LENGTH, NO_HIT, Ray, Shape, fence, fence3, see_cone, side_crossing

// The least part of a direction along the axis: 2^-40.
const LEAST_RISE: f32 = 9.094947e-13;

fn no_shape() -> Shape {
    return Shape(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
}

fn is_same(a: Shape, b: Shape) -> bool {
    return all(a.start == b.start) && all(a.end == b.end) && a.first_radius == b.first_radius
        && a.second_radius == b.second_radius;
}

// Not negative if the ray's line comes near a ball around the cone, whose radius is larger by more than rounding.
fn discriminant_of(ray: Ray, cone: Shape) -> f32 {
    let span = cone.end - cone.start;
    let radius = max(abs(cone.first_radius), abs(cone.second_radius));
    let to_center = cone.start - ray.origin + 0.5 * span;
    let b = dot(to_center, ray.direction);
    let foot = to_center - b * ray.direction;
    let reach = 1.001 * sqrt(0.25 * dot(span, span) + radius * radius) + 0x1p-18 * abs(b);
    return reach * reach - dot(foot, foot);
}

struct ConeHit {
    // Distance to the first point in front of the origin, or NO_HIT.
    t: f32,
    // Distance of that point from the foot.
    from_foot: f32,
    // 0 on the side, -1 on the disc of the start, 1 on that of the end.
    disc: f32,
    seen: ConeSeen,
}

// Intersects a ray with a cone, without branches, because software devices execute both sides of a branch.
fn intersect(ray: Ray, cone: Shape) -> ConeHit {
    let seen = see_cone(ray, cone);
    let side = side_crossing(ray, seen);
    // The slab. A ray that hardly rises is taken to rise a little.
    let risen = select(seen.rise, select(LEAST_RISE, -LEAST_RISE, seen.rise < 0.0), abs(seen.rise) < LEAST_RISE);
    let at_start = (-seen.half - seen.height) / risen;
    let at_end = (seen.half - seen.height) / risen;
    let slab_in = min(at_start, at_end);
    let slab_out = max(at_start, at_end);
    let enters_disc = slab_in > side.enters;
    let leaves_disc = slab_out < side.leaves;
    let enters = select(side.enters, slab_in, enters_disc);
    let leaves = select(side.leaves, slab_out, leaves_disc);
    let is_crossed = side.is_met && enters <= leaves;
    let is_up = risen > 0.0;
    // The signs of the radii of the discs at which the ray crosses the planes.
    let radius_in = select(cone.second_radius, cone.first_radius, is_up);
    let radius_out = select(cone.first_radius, cone.second_radius, is_up);
    let is_open_in = enters_disc && (bitcast<u32>(radius_in) >> 31u) != 0u;
    let is_open_out = leaves_disc && (bitcast<u32>(radius_out) >> 31u) != 0u;
    let near = seen.b + enters;
    let far = seen.b + leaves;
    let is_near = is_crossed && !is_open_in && near > 0.0;
    let is_far = is_crossed && !is_open_out && far > 0.0;
    let t = select(select(NO_HIT, far, is_far), near, is_near);
    let from_foot = select(leaves, enters, is_near);
    let is_disc = select(leaves_disc, enters_disc, is_near);
    // A ray that rises enters at the start and leaves at the end.
    let disc = select(0.0, select(-1.0, 1.0, is_near != is_up), is_disc);
    return ConeHit(t, from_foot, disc, seen);
}

// The normal at the point where a ray hits a cone.
fn shape_normal(ray: Ray, cone: Shape) -> vec3f {
    return cone_normal(intersect(ray, cone));
}

// The unit normal, which points away from the axis, or from the other end. At a tip it is along the axis.
fn cone_normal(hit: ConeHit) -> vec3f {
    let seen = hit.seen;
    let outward = fence3(seen.away + hit.from_foot * seen.aside);
    let radius = fence(seen.radius + hit.from_foot * seen.growth);
    let normal = fence3(outward - seen.slope * radius * seen.axis);
    let square = fence(dot(normal, normal));
    let at_tip = select(1.0, -1.0, seen.slope > 0.0) * seen.axis;
    let on_side = select(normal / sqrt(max(square, LEAST_LENGTH)), at_tip, square < LEAST_LENGTH);
    return fence3(select(on_side, hit.disc * seen.axis, hit.disc != 0.0));
}
