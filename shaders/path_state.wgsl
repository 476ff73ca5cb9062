// What is known of every pixel's path between two dispatches.

// Slot by slot, and in each row by row of the tile.
@group(0) @binding(3) var<storage, read_write> paths: array<vec4f>;
@group(0) @binding(4) var<uniform> stage: Stage;

// Where the ray starts, and the sum of its PATH_ flags.
const ORIGIN: u32 = 0u;
// Where it goes, and the density with which the last surface scattered it there.
const DIRECTION: u32 = 1u;
// The sphere on which it starts; radius 0 for none.
const LEFT: u32 = 2u;
// What its light counts in the picture, and the place of that sphere.
const THROUGHPUT: u32 = 3u;
// The sample's colour so far, and its opacity.
const RADIANCE: u32 = 4u;
// The direction in which a light is looked for from the origin, and how far; 0 for no light.
const SHADOW: u32 = 5u;
// What its light adds, and whether nothing has been found in between.
const PENDING: u32 = 6u;
// In a studio the normal of the surface, and what the pending light adds to opacity; of a path what absorbs light
// on the way.
const NORMAL: u32 = 7u;
const MEDIUM: u32 = 7u;
// In a studio the colour of the surface by what it counts; and the id of the sphere on which the ray starts.
const SURFACE: u32 = 8u;
// In a studio its lobe; of a path the sphere that is looked for, which hides itself from nobody.
const LOBE: u32 = 9u;
const TARGET: u32 = 9u;
// The colour of the first surface, and how long the path is so far.
const FIRST: u32 = 10u;

// There is a ray to be traced.
const PATH_ALIVE: u32 = 1u;
// It starts on a sphere and goes inside.
const PATH_INSIDE: u32 = 2u;
// It starts on the ground.
const PATH_ON_GROUND: u32 = 4u;
// In a studio: there is a surface to be lit.
const PATH_LIT: u32 = 8u;
// The surface is seen from inside of its sphere.
const PATH_BACK: u32 = 16u;
// No light that the ray meets has been looked for directly.
const PATH_FULL: u32 = 32u;
// Something has scattered it since the camera.
const PATH_SCATTERED: u32 = 64u;

fn slot(index: u32, which: u32) -> u32 {
    return which * frame.tile_size.x * frame.tile_size.y + index;
}

fn load(index: u32, which: u32) -> vec4f {
    return paths[slot(index, which)];
}

fn store(index: u32, which: u32, xyz: vec3f, w: f32) {
    paths[slot(index, which)] = vec4f(xyz, w);
}

fn has(flags: u32, flag: u32) -> bool {
    return (flags & flag) != 0u;
}
