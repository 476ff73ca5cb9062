// The ray through the centre of a pixel and the centre of the lens.
// provides: make_entry
// needs: Entry, camera_ray, enter_scene, frame, relative_location

fn make_entry(pixel_in_tile: vec2u) -> Entry {
    return enter_scene(camera_ray(relative_location(frame.tile_origin + pixel_in_tile), vec2f(0.5)));
}
