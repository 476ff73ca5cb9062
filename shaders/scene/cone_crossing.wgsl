// Where the line of a ray enters a cone between two discs and leaves it, and the normals there. Twin: src/verify/cone.rs.
//
// The cone, its discs and what they enclose are convex. So a ray enters once and leaves once: between the later one of
// the entries of the infinite cone and of the slab between the planes of the discs, and the earlier one of the exits. A
// ray cannot pass between a disc and the side, because one comparison decides for both.
// provides: ConeCrossing, cone_normal, cross_cone
// needs: ConeSeen, LEAST_LENGTH, Ray, Shape, fence, fence3, see_cone, side_crossing

// The least part of a direction along the axis: 2^-40.
const LEAST_RISE: f32 = 9.094947e-13;

// Where the line of a ray crosses a cone.
struct ConeCrossing {
    // Distances from the foot at which it enters and leaves.
    enters: f32,
    leaves: f32,
    enters_disc: bool,
    leaves_disc: bool,
    is_open_in: bool,
    is_open_out: bool,
    is_crossed: bool,
    // Whether the line rises from the start to the end.
    is_up: bool,
    seen: ConeSeen,
}

fn cross_cone(ray: Ray, cone: Shape) -> ConeCrossing {
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
    return ConeCrossing(enters, leaves, enters_disc, leaves_disc, is_open_in, is_open_out, is_crossed, is_up, seen);
}

// The unit normal where a ray enters a cone or leaves it, which points away from the axis, or from the other end. At a tip
// it is along the axis.
fn cone_normal(crossing: ConeCrossing, is_near: bool) -> vec3f {
    let seen = crossing.seen;
    let from_foot = select(crossing.leaves, crossing.enters, is_near);
    let is_disc = select(crossing.leaves_disc, crossing.enters_disc, is_near);
    // A ray that rises enters at the start and leaves at the end.
    let disc = select(-1.0, 1.0, is_near != crossing.is_up);
    let outward = fence3(seen.away + from_foot * seen.aside);
    let radius = fence(seen.radius + from_foot * seen.growth);
    let normal = fence3(outward - seen.slope * radius * seen.axis);
    let square = fence(dot(normal, normal));
    let at_tip = select(1.0, -1.0, seen.slope > 0.0) * seen.axis;
    let on_side = select(normal / sqrt(max(square, LEAST_LENGTH)), at_tip, square < LEAST_LENGTH);
    return fence3(select(on_side, disc * seen.axis, is_disc));
}
