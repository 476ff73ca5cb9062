// What belongs to one frame: its settings, and what each ray has hit so far.

// A miss. Never inf: WGSL lets an implementation assume that infinities do not exist.
const NO_HIT: f32 = 1e30;
const NO_ID: u32 = 0xffffffffu;

// The side of a workgroup, in pixels.
const WORKGROUP_SIDE: u32 = 8u;

struct Hit {
    // From where the ray enters the scene's box.
    t: f32,
    // Index in input order.
    id: u32,
    // Index into the spheres of all bricks.
    place: u32,
    // How far from the camera the ray starts.
    distance: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
// Row by row, of the tile: the bits of t, id, place, and of distance. One vector, because a software device reads
// and writes a structure word by word.
@group(0) @binding(1) var<storage, read_write> hits: array<vec4u>;

// Zero, and no compiler knows it, because every kernel first sets it from the frame: for `fence`. Reading the
// frame at each fence takes a software device 5 to 9 % of walking a tree.
var<private> zero_bits: u32;

fn runtime_zero() -> u32 {
    return zero_bits;
}

fn hit_index(pixel_in_tile: vec2u) -> u32 {
    return pixel_in_tile.y * frame.tile_size.x + pixel_in_tile.x;
}

fn load_hit(index: u32) -> Hit {
    let bits = hits[index];
    return Hit(bitcast<f32>(bits.x), bits.y, bits.z, bitcast<f32>(bits.w));
}

fn store_hit(index: u32, hit: Hit) {
    hits[index] = vec4u(bitcast<u32>(hit.t), hit.id, hit.place, bitcast<u32>(hit.distance));
}
