// What belongs to one frame: its settings, and what each ray has hit so far.

// A miss. Never inf: WGSL lets an implementation assume that infinities do not exist.
const NO_HIT: f32 = 1e30;
const NO_ID: u32 = 0xffffffffu;

struct Hit {
    t: f32,
    id: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
// Row by row, of the tile.
@group(0) @binding(1) var<storage, read_write> hits: array<Hit>;

fn hit_index(pixel_in_tile: vec2u) -> u32 {
    return pixel_in_tile.y * frame.tile_size.x + pixel_in_tile.x;
}
