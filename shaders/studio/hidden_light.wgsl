// Testing whether a light is hidden from a surface, in a studio.
// provides: is_hidden
// needs: CameraRay, Excluded, PATH_BACK, PATH_ON_GROUND, Ray, Search, Start, enter_scene, find_any, ground_distance,
//   has

// Searches the brick for an occluder. `own` must be the shape on which the ray starts, and `to_center` the vector to its
// centre.
fn is_hidden(start: Start, own: Excluded, to_center: vec3f, direction: vec3f, distance: f32) -> bool {
    let ray = Ray(start.position, direction);
    let to_far_side = max(2.0 * dot(to_center, direction), 0.0);
    let is_in_own = has(start.flags, PATH_BACK) && to_far_side < distance;
    let is_below = !has(start.flags, PATH_ON_GROUND) && ground_distance(ray, 0.0) < distance;
    let entry = enter_scene(CameraRay(ray, 0.0, true));
    let rest = distance - entry.distance;
    var excluded = own;
    excluded.goes_inside = has(start.flags, PATH_BACK);
    var is_hidden = is_in_own || is_below;
    if (!is_hidden && rest > 0.0 && entry.is_inside) {
        is_hidden = find_any(Search(entry.ray, entry.inverse, excluded), rest);
    }
    return is_hidden;
}
