// The ray of a path, from where it enters the scene's box if it starts outside.

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let index = hit_index(pixel_in_tile);
    let origin = load(index, ORIGIN);
    let direction = load(index, DIRECTION);
    left = load(index, LEFT);
    var entry = enter_scene(CameraRay(Ray(origin.xyz, direction.xyz), 0.0, true));
    let is_alive = has(bitcast<u32>(origin.w), PATH_ALIVE);
    entry.is_inside = entry.is_inside && is_alive;
    if (is_alive) {
        atomicStore(&status[1], 1u);
    }
    return entry;
}
