// The ray of a path, from where it enters the scene's box if it starts outside.

// What it starts on, and whether it goes inside of that.
var<private> leaves: Departure;
var<private> is_going_inside: bool;

fn entry_of_path(index: u32) -> Entry {
    let start = load_start(index);
    leaves = load_departure(index);
    leave(leaves);
    is_going_inside = has(start.flags, PATH_INSIDE) && has(start.flags, PATH_ALIVE);
    var entry = enter_scene(CameraRay(Ray(start.position, load(index, DIRECTION).xyz), 0.0, true));
    entry.is_inside = entry.is_inside && has(start.flags, PATH_ALIVE);
    return entry;
}
