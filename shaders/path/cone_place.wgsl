// The point where a ray hits a cone, and how far it is from a point of the cone to its far side. Twin:
// src/verify/lit/cone_place.rs.
// provides: exit_distance_of, place_on
// needs: Hit, NOT_ROUND, NO_ID, Place, Ray, Shape, Vertex, brick, cone_normal, cross_cone, fence, fence3,
//   searched_far_side, shapes

fn place_on(cone: Shape, entered: Ray, hit: Hit, is_far_side: bool) -> Place {
    let crossing = cross_cone(entered, cone);
    let seen = crossing.seen;
    let near = fence(seen.b + crossing.enters);
    let far = fence(seen.b + crossing.leaves);
    // The search has decided which side of the cone is hit.
    let is_back = is_far_side || crossing.is_open_in || abs(far - hit.t) < abs(near - hit.t);
    let from_foot = select(crossing.enters, crossing.leaves, is_back);
    let outward = cone_normal(crossing, !is_back);
    // The foot is known from the middle of the axis, so that the distance to the cone costs no digits, unless the cone is so
    // large that its rounding errors exceed those of the ray.
    let middle = fence3(cone.start + 0.5 * fence3(cone.end - cone.start));
    let on_cone = middle + fence3(seen.foot + from_foot * entered.direction);
    let on_ray = entered.origin + hit.t * entered.direction;
    let size = seen.half + max(abs(cone.first_radius), abs(cone.second_radius));
    let position = fence3(select(on_cone, on_ray, size > 64.0 * (hit.t + hit.distance)));
    return Place(position, outward, is_back, vec4f(0.0, 0.0, 0.0, NOT_ROUND));
}

// The distance from a point of a cone through its inside to the far side, or NO_HIT through an open end.
fn exit_distance_of(vertex: Vertex, direction: vec3f) -> f32 {
    let is_ground = vertex.id == NO_ID;
    let shape_index = select(vertex.shape_index - brick.first_shape, 0u, is_ground);
    // Of the ground, as in the kernels of spheres, where it means nothing either.
    let of_ground = max(2.0 * dot(-vertex.position, direction), 0.0);
    return select(searched_far_side(Ray(vertex.position, direction), shapes[shape_index]), of_ground, is_ground);
}
