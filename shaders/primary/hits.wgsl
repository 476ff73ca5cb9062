// Buffer of the nearest hits of all pixels so far.
// provides: hit_index, load_hit, store_hit
// needs: Hit, frame

// Hits of the tile, row by row: the bits of t, id, shape index and distance. Each is one vector, because a software
// device reads and writes a struct word by word.
@group(0) @binding(1) var<storage, read_write> hits: array<vec4u>;

fn hit_index(pixel_in_tile: vec2u) -> u32 {
    return pixel_in_tile.y * frame.tile_size.x + pixel_in_tile.x;
}

fn load_hit(index: u32) -> Hit {
    let bits = hits[index];
    return Hit(bitcast<f32>(bits.x), bits.y, bits.z, bitcast<f32>(bits.w));
}

fn store_hit(index: u32, hit: Hit) {
    hits[index] = vec4u(bitcast<u32>(hit.t), hit.id, hit.shape_index, bitcast<u32>(hit.distance));
}
