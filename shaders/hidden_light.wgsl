// In a studio: whether something hides a light from a surface.

// Searches the brick; of 32 lights, each has a bit.
fn look_for(index: u32, start: Start, direction: vec3f, distance: f32, bit: u32) {
    left = load(index, LEFT);
    let ray = Ray(start.position, direction);
    let to_far_wall = max(2.0 * dot(left.xyz - start.position, direction), 0.0);
    let is_in_own = has(start.flags, PATH_BACK) && to_far_wall < distance;
    let is_below = !has(start.flags, PATH_ON_GROUND) && ground_distance(ray, 0.0) < distance;
    let entry = enter_scene(CameraRay(ray, 0.0, true));
    let rest = distance - entry.distance;
    var is_hidden = is_in_own || is_below;
    if (!is_hidden && rest > 0.0 && entry.is_inside) {
        is_hidden = find_any(entry.ray, entry.inverse, rest);
    }
    if (is_hidden) {
        paths[slot(index, NORMAL)].w |= 1u << (bit & 31u);
    }
    report_spent();
}
