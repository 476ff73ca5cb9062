// The point where a ray hits a sphere, and how far it is from a point of the sphere to its far side.
// provides: exit_distance_of, place_on
// needs: Hit, Place, Ray, Shape, Vertex, fence3, intersect, sphere_normal

fn place_on(shape: Shape, entered: Ray, hit: Hit, is_far_side: bool) -> Place {
    let sphere = vec4f(shape.xyz, abs(shape.w));
    var found = intersect(entered, sphere);
    let middle = dot(sphere.xyz - entered.origin, entered.direction);
    // The search has decided which side of the sphere is hit.
    let half_chord = select(abs(found.from_foot), abs(middle), is_far_side);
    let is_back = is_far_side || hit.t > middle;
    found.from_foot = select(-half_chord, half_chord, is_back);
    let outward = sphere_normal(entered, found);
    // The point is moved onto the sphere, unless the sphere is so large that its rounding errors exceed those of the
    // ray.
    let on_sphere = sphere.xyz + sphere.w * outward;
    let on_ray = entered.origin + hit.t * entered.direction;
    let position = fence3(select(on_sphere, on_ray, sphere.w > 64.0 * (hit.t + hit.distance)));
    return Place(position, outward, is_back, sphere);
}

// The distance from a point of a sphere through its inside to the far side; 0 if the direction points outwards.
fn exit_distance_of(vertex: Vertex, direction: vec3f) -> f32 {
    return max(2.0 * dot(vertex.sphere.xyz - vertex.position, direction), 0.0);
}
