// What is known of a path's ray before the first brick is traced: one that starts on a sphere and goes inside meets
// its far wall at the latest, at twice the distance to the middle of the chord. Which sphere that is, the hit
// before this still says.

fn hit_before(index: u32) -> Hit {
    let middle = dot(left.xyz - path_ray.origin, path_ray.direction);
    let before = load_hit(index);
    let is_known = has(path_flags, PATH_INSIDE) && has(path_flags, PATH_ALIVE);
    let t = select(NO_HIT, max(2.0 * middle, 0.0), is_known);
    return Hit(t, select(NO_ID, before.id, is_known), select(0u, before.place, is_known), 0.0);
}
