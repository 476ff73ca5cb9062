// The ray of a path, from where it enters the scene's box if it starts outside.

var<private> path_ray: Ray;
var<private> path_flags: u32;

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let index = hit_index(pixel_in_tile);
    let start = load_start(index);
    path_ray = Ray(start.position, load(index, DIRECTION).xyz);
    path_flags = start.flags;
    left = load(index, LEFT);
    var entry = enter_scene(CameraRay(path_ray, 0.0, true));
    let is_alive = has(start.flags, PATH_ALIVE);
    entry.is_inside = entry.is_inside && is_alive;
    if (is_alive) {
        atomicStore(&status[1], 1u);
    }
    return entry;
}
