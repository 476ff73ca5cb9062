// The state of all paths between two dispatches.
// provides: ALBEDO, DEPARTURE, DIRECTION, FIRST, LOBE, MEDIUM, NORMAL, PATH_ALIVE, PATH_BACK, PATH_FULL, PATH_INSIDE,
//   PATH_ON_GROUND, PATH_SCATTERED, PENDING, RADIANCE, SHADOW, Start, THROUGHPUT, dispatch, has, load, load_hit,
//   load_start, paths, slot, store, store_hit, store_start
// needs: DispatchParameters, Hit

// State of the paths, slot by slot, and in each slot by sample and by row of the tile. It is stored as bits, because
// some of it are integers.
@group(0) @binding(3) var<storage, read_write> paths: array<vec4u>;
// Sample, surface, light and list that a dispatch processes.
@group(0) @binding(4) var<uniform> dispatch: DispatchParameters;

// Slot of the origin of the ray and the sum of its PATH_ flags.
const ORIGIN: u32 = 0u;
// Slot of the direction of the ray, and of the density with which the last surface scattered it.
const DIRECTION: u32 = 1u;
// Slot of the surface that the ray departs from, as `Departure`.
const DEPARTURE: u32 = 2u;
// Slot of the throughput. In a studio: the weight that remains for surfaces behind, and the weight of the surface.
const THROUGHPUT: u32 = 3u;
// Slot of the radiance of the sample so far, and of its opacity.
const RADIANCE: u32 = 4u;
// Slot of the albedo of the first surface, and of the length of the ray so far.
const FIRST: u32 = 5u;
// Slot of the hit of the ray: the bits of t, id, shape index and distance.
const HIT: u32 = 6u;
// Slot of the direction towards the sampled light from the origin, and of its distance; 0 for no light.
const SHADOW: u32 = 7u;
// Slot of the pending contribution of that light, and of its visibility, which is 0 once it is occluded.
const PENDING: u32 = 8u;
// Slot of the absorption of the glass that the ray is in.
const MEDIUM: u32 = 9u;
// In a studio, slot of the normal of the surface, and of a bit for each of 32 hidden lights.
const NORMAL: u32 = 7u;
// In a studio, slot of the colour of the surface times its weight. For a ground that catches shadows, the last
// component is the weight that remains for the background.
const ALBEDO: u32 = 8u;
// In a studio, slot of the specular lobe of the surface: its share, the square of its roughness, and the index of its
// energies.
const LOBE: u32 = 9u;

// Flag of a path with a ray that must be traced.
const PATH_ALIVE: u32 = 1u;
// Flag of a ray that starts on a sphere and goes inside.
const PATH_INSIDE: u32 = 2u;
// Flag of a ray that starts on the ground.
const PATH_ON_GROUND: u32 = 4u;
// Flag of a surface that is the inside of an opaque sphere.
const PATH_BACK: u32 = 16u;
// Flag of a ray whose hits on lights have the full weight, because light sampling could not have chosen them.
const PATH_FULL: u32 = 32u;
// Flag of a path that has been scattered since the camera.
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
