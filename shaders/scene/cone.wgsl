// Intersection of a ray with a cone between two discs. A cylinder has two equal radii. Twin: src/verify/cone.rs.
// provides: discriminant_of, intersect, is_same, no_shape, searched_far_side, shape_normal
// needs: ConeCrossing, NO_HIT, Ray, Shape, cone_normal, cross_cone, fence

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
    // Whether the ray enters the cone there.
    is_near: bool,
    crossing: ConeCrossing,
}

// Intersects a ray with a cone, without branches, because software devices execute both sides of a branch.
fn intersect(ray: Ray, cone: Shape) -> ConeHit {
    let crossing = cross_cone(ray, cone);
    let near = crossing.seen.b + crossing.enters;
    let far = crossing.seen.b + crossing.leaves;
    let is_near = crossing.is_crossed && !crossing.is_open_in && near > 0.0;
    let is_far = crossing.is_crossed && !crossing.is_open_out && far > 0.0;
    let t = select(select(NO_HIT, far, is_far), near, is_near);
    return ConeHit(t, is_near, crossing);
}

// The distance at which a ray that starts on a cone leaves it, or NO_HIT through an open end. It does not depend on which side
// of the surface rounding puts the start.
fn searched_far_side(ray: Ray, cone: Shape) -> f32 {
    let crossing = cross_cone(ray, cone);
    return select(max(fence(crossing.seen.b + crossing.leaves), 0.0), NO_HIT, crossing.is_open_out);
}

// The normal at the point where a ray hits a cone.
fn shape_normal(ray: Ray, cone: Shape) -> vec3f {
    let hit = intersect(ray, cone);
    return cone_normal(hit.crossing, hit.is_near);
}
