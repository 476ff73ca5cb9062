// Whether the part of a ray in a cell meets the balls of the cell's list. Twin: src/accel/ball.rs, which explains why no
// sphere is lost.
// provides: IN_VECTOR, LAST_BALL, PartInCell, balls, met, part_in_cell

// The balls of the lists, four in each vector.
@group(1) @binding(3) var<storage, read> balls: array<vec4u>;

const BALLS_PER_VECTOR: u32 = 4u;
// The number of either in a list's vectors.
const IN_VECTOR: u32 = BALLS_PER_VECTOR;
// Marks the last ball of a list.
const LAST_BALL: u32 = 1u << 31u;
// The number of quanta along a side of a cell.
const QUANTA: f32 = 85.0;
const COORDINATE: u32 = 255u;
const COORDINATE_BITS: u32 = 8u;
// The bits of a radius after it is shifted to the lowest bits of an f32's exponent and the highest of its mantissa.
const RADIUS: u32 = 127u << 20u;
const RADIUS_TO_FLOAT: u32 = 4u;
const ONE: u32 = 0x3f800000u;

// The part of a ray in a cell, in quanta. The origin is counted from one side before the corner of the cell.
struct PartInCell {
    origin: vec3f,
    direction: vec3f,
    length: f32,
}

// The part of a ray that starts at a point, in units of the cell's side from its corner, and has a length in the same
// units.
fn part_in_cell(start: vec3f, direction: vec3f, length: f32) -> PartInCell {
    return PartInCell((start + 1.0) * QUANTA, direction, length * QUANTA);
}

// A bit for each of four balls that the part of the ray meets.
fn met(four: vec4u, part: PartInCell) -> u32 {
    let coordinate = vec4u(COORDINATE);
    let x = vec4f(vec4i(four & coordinate)) - part.origin.x;
    let y = vec4f(vec4i((four >> vec4u(COORDINATE_BITS)) & coordinate)) - part.origin.y;
    let z = vec4f(vec4i((four >> vec4u(2u * COORDINATE_BITS)) & coordinate)) - part.origin.z;
    let along = x * part.direction.x + y * part.direction.y + z * part.direction.z;
    let beyond = max(max(along - part.length, -along), vec4f(0.0));
    let squared = (x * x + y * y + z * z - along * along) + beyond * beyond;
    let radius = bitcast<vec4f>(((four >> vec4u(RADIUS_TO_FLOAT)) & vec4u(RADIUS)) + vec4u(ONE));
    let bits = select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), squared <= radius);
    return bits.x | bits.y | bits.z | bits.w;
}
