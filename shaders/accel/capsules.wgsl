// Whether a ray meets the capsules of a cell's list, which take the place of balls where the shapes are cones. A capsule
// is what is near the line between two places. Twin: src/accel/cone_cells.rs, which explains why no cone is lost.
// provides: IN_VECTOR, LAST_BALL, PartInCell, balls, met, part_in_cell

// The capsules of the lists, two in each vector: the first end with the radius, and the second end.
@group(1) @binding(3) var<storage, read> balls: array<vec4u>;

const CAPSULES_PER_VECTOR: u32 = 2u;
// The number of either in a list's vectors.
const IN_VECTOR: u32 = CAPSULES_PER_VECTOR;
// Marks the last capsule of a list.
const LAST_BALL: u32 = 1u << 31u;
// The number of quanta along a side of a cell.
const QUANTA: f32 = 85.0;
const COORDINATE: u32 = 255u;
const COORDINATE_BITS: u32 = 8u;
// The bits of a radius after it is shifted to the lowest bits of an f32's exponent and the highest of its mantissa.
const RADIUS: u32 = 127u << 20u;
const RADIUS_TO_FLOAT: u32 = 4u;
const ONE: u32 = 0x3f800000u;
// A squared length next to nothing, so that a capsule with one place for both ends is a ball.
const LEAST_SQUARE_SPAN: f32 = 1e-8;

// The ray in a cell, seen along it, in quanta: two directions across it, and its place along them. That is counted from one
// side before the corner of the cell.
struct PartInCell {
    right: vec3f,
    up: vec3f,
    origin: vec2f,
}

fn part_in_cell(start: vec3f, direction: vec3f, length: f32) -> PartInCell {
    let side = select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(direction.z) > 0.7);
    let right = normalize(cross(side, direction));
    let up = cross(direction, right);
    let origin = (start + 1.0) * QUANTA;
    return PartInCell(right, up, vec2f(dot(origin, right), dot(origin, up)));
}

// A bit for each of two capsules that the ray meets.
fn met(two: vec4u, part: PartInCell) -> u32 {
    return select(0u, 1u, is_met(two.xy, part)) | select(0u, 2u, is_met(two.zw, part));
}

// Whether the line of the ray comes near the line between the ends of a capsule. Both distances are multiplied by the square of
// the line, because software devices take long to divide.
fn is_met(capsule: vec2u, part: PartInCell) -> bool {
    let first = seen(capsule.x, part);
    let span = seen(capsule.y, part) - first;
    let square = dot(span, span) + LEAST_SQUARE_SPAN;
    let nearest = square * first + clamp(-dot(first, span), 0.0, square) * span;
    let radius = bitcast<f32>(((capsule.x >> RADIUS_TO_FLOAT) & RADIUS) + ONE);
    return dot(nearest, nearest) <= radius * square * square;
}

// An end of a capsule, seen along the ray and from it.
fn seen(end: u32, part: PartInCell) -> vec2f {
    let packed = vec3u(end, end >> COORDINATE_BITS, end >> (2u * COORDINATE_BITS)) & vec3u(COORDINATE);
    let place = vec3f(vec3i(packed));
    return vec2f(dot(place, part.right), dot(place, part.up)) - part.origin;
}
