// Coordinates of a ray in a grid, and the searches that all traversals of grids share.
// provides: EMPTY, Found, GRID, GridRay, INNER_START, INNER_UNIT, KIND, LEVEL, LEVEL_SHIFT, LIST, NO_SHAPE, REACH,
//   REACH_BITS, find_any, find_nearest, first_cell, grid_ray, least
// needs: Nearest, Ray, Search, brick, offer, walk

// Kind of a cell, in the two highest bits of its word. The other bits depend on the kind.
const KIND: u32 = 3u << 30u;
const EMPTY: u32 = 0u;
const LIST: u32 = 1u << 30u;
const GRID: u32 = 2u << 30u;

// In the word of an empty cell: the number of empty cells ahead, in REACH_BITS bits for each octant.
const REACH: u32 = 7u;
const REACH_BITS: u32 = 3u;
// In the word of a cell with an inner grid: the binary logarithm of the number of inner cells along an axis, and the
// index of the first inner word in units of INNER_UNIT.
const LEVEL: u32 = 7u;
const LEVEL_SHIFT: u32 = 27u;
const INNER_START: u32 = 0x7ffffffu;
const INNER_UNIT: u32 = 8u;

struct GridRay {
    // 1 for each axis along which the ray ascends, otherwise 0.
    ahead: vec3f,
    // 1 for each axis along which the ray ascends, otherwise -1.
    step: vec3f,
    // The distance along the ray to plane p of an axis, counted from the corner of the grid, is base + p * delta.
    base: vec3f,
    delta: vec3f,
    // The position on the ray at distance t, in units of cells, is start + t * speed.
    start: vec3f,
    speed: vec3f,
    // Cells for each unit of distance along the ray.
    per_cell: f32,
    // Distances at which the ray enters and leaves the grid.
    t_enter: f32,
    t_leave: f32,
}

// The nearest hit in this brick so far.
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
    return GridRay(ahead, step, base, delta, start, ray.direction * per_cell, per_cell, t_enter, t_leave);
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
    // A list also accepts a sphere at exactly the distance of `found`, so this starts with the largest number below
    // `t_max`, which is positive.
    var found = Found(bitcast<f32>(bitcast<u32>(t_max) - 1u), NO_SHAPE);
    walk(search, &found, true);
    return found.shape_index != NO_SHAPE;
}
