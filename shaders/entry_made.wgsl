// The ray of a pixel, made where it is used.

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    return make_entry(pixel_in_tile);
}
