// A dispatch for every pixel of the tile, or of where the scene may be seen, and for every sample in flight.

fn path_of(group: vec3u, lane: u32) -> u32 {
    let pixel = pixel_in_tile(dispatch.first + group.xy, lane);
    let index = (group.z * frame.tile_size.y + pixel.y) * frame.tile_size.x + pixel.x;
    return select(index, NO_PATH, any(pixel >= frame.tile_size));
}
