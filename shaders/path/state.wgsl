// What is known of every pixel's path between two dispatches.
// provides: ALBEDO, DEPARTURE, DIRECTION, FIRST, LOBE, MEDIUM, NORMAL, PATH_ALIVE, PATH_BACK, PATH_FULL, PATH_INSIDE,
//   PATH_ON_GROUND, PATH_SCATTERED, PENDING, RADIANCE, SHADOW, Start, THROUGHPUT, dispatch, has, load, load_hit,
//   load_start, paths, slot, store, store_hit, store_start
// needs: DispatchParameters, Hit

// Slot by slot, and in each sample by sample and row by row of the tile. Bits, because there are whole numbers among
// them.
@group(0) @binding(3) var<storage, read_write> paths: array<vec4u>;
// Which sample, surface, light and list a dispatch works on.
@group(0) @binding(4) var<uniform> dispatch: DispatchParameters;

// Where the ray starts, and the sum of its PATH_ flags.
const ORIGIN: u32 = 0u;
// Where it goes, and the density with which the last surface scattered it there.
const DIRECTION: u32 = 1u;
// What it starts on: `Departure`.
const DEPARTURE: u32 = 2u;
// What its light counts in the picture. In a studio: what is left for what is behind, and what the surface counts.
const THROUGHPUT: u32 = 3u;
// The sample's colour so far, and its opacity.
const RADIANCE: u32 = 4u;
// The colour of the first surface, and how long the ray is so far.
const FIRST: u32 = 5u;
// What the ray has hit: the bits of t, id, place and distance.
const HIT: u32 = 6u;
// Of a path that looks for light: the direction in which, from the origin, and how far; 0 for no light.
const SHADOW: u32 = 7u;
// What that light adds, and 1 unless something has been found in between.
const PENDING: u32 = 8u;
// Of a path where there is glass: what absorbs light on the way.
const MEDIUM: u32 = 9u;
// In a studio: the normal of the surface, and a bit for each of 32 lights that are hidden.
const NORMAL: u32 = 7u;
// The surface's colour by what it counts, and what is left for what is behind a ground that catches shadows.
const ALBEDO: u32 = 8u;
// The surface's lobe: its share, the square of its roughness, and where its energies are.
const LOBE: u32 = 9u;

// There is a ray to be traced.
const PATH_ALIVE: u32 = 1u;
// It starts on a sphere and goes inside.
const PATH_INSIDE: u32 = 2u;
// It starts on the ground.
const PATH_ON_GROUND: u32 = 4u;
// The surface is seen from inside of its sphere, which is opaque.
const PATH_BACK: u32 = 16u;
// No light that the ray meets has been looked for directly.
const PATH_FULL: u32 = 32u;
// Something has scattered it since the camera.
const PATH_SCATTERED: u32 = 64u;

fn slot(index: u32, which: u32) -> u32 {
    return which * dispatch.paths + index;
}

fn load(index: u32, which: u32) -> vec4f {
    return bitcast<vec4f>(paths[slot(index, which)]);
}

fn store(index: u32, which: u32, value: vec4f) {
    paths[slot(index, which)] = bitcast<vec4u>(value);
}

fn load_hit(index: u32) -> Hit {
    let bits = paths[slot(index, HIT)];
    return Hit(bitcast<f32>(bits.x), bits.y, bits.z, bitcast<f32>(bits.w));
}

fn store_hit(index: u32, hit: Hit) {
    paths[slot(index, HIT)] = vec4u(bitcast<u32>(hit.t), hit.id, hit.shape_index, bitcast<u32>(hit.distance));
}

struct Start {
    position: vec3f,
    flags: u32,
}

fn load_start(index: u32) -> Start {
    let bits = paths[slot(index, ORIGIN)];
    return Start(bitcast<vec3f>(bits.xyz), bits.w);
}

fn store_start(index: u32, position: vec3f, flags: u32) {
    paths[slot(index, ORIGIN)] = vec4u(bitcast<vec3u>(position), flags);
}

fn has(flags: u32, flag: u32) -> bool {
    return (flags & flag) != 0u;
}
