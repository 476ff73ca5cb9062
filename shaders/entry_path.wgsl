// The ray of a path, from where it enters the scene's box if it starts outside.

var<private> path_ray: Ray;
var<private> path_flags: u32;

fn entry_of_path(index: u32) -> Entry {
    let start = load_start(index);
    path_ray = Ray(start.position, load(index, DIRECTION).xyz);
    path_flags = start.flags;
    left = load(index, LEFT);
    var entry = enter_scene(CameraRay(path_ray, 0.0, true));
    entry.is_inside = entry.is_inside && has(start.flags, PATH_ALIVE);
    return entry;
}
