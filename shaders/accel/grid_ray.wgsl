// A ray among a grid's cells, and the nearest sphere so far. Used by grid.wgsl and nested_grid.wgsl.
// provides: EMPTY, Found, GRID, GridRay, INNER_START, INNER_UNIT, KIND, LEVEL, LEVEL_SHIFT, LIST, NO_SHAPE, REACH,
//   REACH_BITS, cells, find_any, find_nearest, first_cell, grid_ray, least
// needs: Nearest, Ray, Search, brick, offer, walk

// One word for each cell of the grid, and of the grids inside its cells.
@group(1) @binding(3) var<storage, read> cells: array<u32>;

// What a cell's word is, in its two highest bits; the others are a number.
const KIND: u32 = 3u << 30u;
const EMPTY: u32 = 0u;
const LIST: u32 = 1u << 30u;
const GRID: u32 = 2u << 30u;

// Of an empty cell, in so many bits for each octant: how many cells ahead are empty.
const REACH: u32 = 7u;
const REACH_BITS: u32 = 3u;
// Of a cell with a grid inside: the logarithm of its cells along an axis, and where its words start, in units.
const LEVEL: u32 = 7u;
const LEVEL_SHIFT: u32 = 27u;
const INNER_START: u32 = 0x7ffffffu;
const INNER_UNIT: u32 = 8u;

struct GridRay {
    // Per axis: 1 for a ray that ascends, or 0.
    ahead: vec3f,
    // Per axis: 1 or -1.
    step: vec3f,
    // The plane p of an axis, counted in cells from the grid's corner, is base + p * delta away.
    base: vec3f,
    delta: vec3f,
    // Where the ray is, counted in cells: start + t * speed.
    start: vec3f,
    speed: vec3f,
    // Where it enters and leaves the grid.
    t_enter: f32,
    t_leave: f32,
}

// The nearest sphere of this brick.
struct Found {
    t: f32,
    shape_index: u32,
}

const NO_SHAPE: u32 = 0xffffffffu;

fn least(v: vec3f) -> f32 {
    return min(v.x, min(v.y, v.z));
}

fn grid_ray(ray: Ray, inverse: vec3f) -> GridRay {
    let forward = ray.direction >= vec3f(0.0);
    let ahead = select(vec3f(0.0), vec3f(1.0), forward);
    let step = select(vec3f(-1.0), vec3f(1.0), forward);
    let base = (brick.min - ray.origin) * inverse;
    let delta = brick.cell_size * inverse;
    let counts = vec3f(brick.cell_counts);
    let near = base + (1.0 - ahead) * counts * delta;
    let t_enter = max(max(near.x, max(near.y, near.z)), 0.0);
    let t_leave = least(base + ahead * counts * delta);
    let per_cell = 1.0 / brick.cell_size;
    let start = (ray.origin - brick.min) * per_cell;
    return GridRay(ahead, step, base, delta, start, ray.direction * per_cell, t_enter, t_leave);
}

// The cell in which the ray enters the grid.
fn first_cell(along: GridRay) -> vec3f {
    let cell = floor(along.start + along.t_enter * along.speed);
    return clamp(cell, vec3f(0.0), vec3f(brick.cell_counts) - 1.0);
}

fn find_nearest(search: Search, nearest: ptr<function, Nearest>) {
    var found = Found((*nearest).t, NO_SHAPE);
    walk(search, &found, false);
    if (found.shape_index != NO_SHAPE) {
        offer(nearest, found.t, found.shape_index);
    }
}

fn find_any(search: Search, t_max: f32) -> bool {
    // A list takes what is as near as the nearest so far; `t_max` is positive, so this is the number below it.
    var found = Found(bitcast<f32>(bitcast<u32>(t_max) - 1u), NO_SHAPE);
    walk(search, &found, true);
    return found.shape_index != NO_SHAPE;
}
