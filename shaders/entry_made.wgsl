// The ray of a pixel, made where it is used.

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    return enter_scene(camera_ray(relative_location(frame.tile_origin + pixel_in_tile)));
}
