// Which children of a node of the 8-wide tree are still to be visited, and in which order. Twin:
// src/accel/wide_group.rs.
// provides: WIDE_ROOT, first_of_group, octant_of, octant_order, rest_of_group
// needs: SlabRay

// Bit i says whether the direction is negative along axis i. Twin: `SlabRay::octant`.
fn octant_of(ray: SlabRay) -> u32 {
    return dot(select(vec3u(0u), vec3u(1u, 2u, 4u), ray.inverse < vec3f(0.0)), vec3u(1u));
}

// Moves bit s to bit `s ^ octant`: the first bit is then the child that a ray of this octant meets first.
fn octant_order(mask: u32, octant: u32) -> u32 {
    let x = select(mask, ((mask & 0x55u) << 1u) | ((mask >> 1u) & 0x55u), (octant & 1u) != 0u);
    let y = select(x, ((x & 0x33u) << 2u) | ((x >> 2u) & 0x33u), (octant & 2u) != 0u);
    return select(y, ((y & 0x0fu) << 4u) | (y >> 4u), (octant & 4u) != 0u);
}

// Children of one node that are still to be visited: x the first child; y, in bits 24 to 31, those hit, in
// the order of visits, and in bits 0 to 7 the inner mask. This one is the root alone.
const WIDE_ROOT: vec2u = vec2u(0u, 0x1000000u);

// The node that comes first in a group.
fn first_of_group(group: vec2u, octant: u32) -> u32 {
    let slot = (firstTrailingBit(group.y >> 24u)) ^ octant;
    return group.x + countOneBits(group.y & ((1u << slot) - 1u));
}

// The group without its first.
fn rest_of_group(group: vec2u) -> vec2u {
    let hits = group.y >> 24u;
    return vec2u(group.x, (group.y & 0xffu) | ((hits & (hits - 1u)) << 24u));
}
