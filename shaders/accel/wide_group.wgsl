// The set of a wide-tree node's children that are still to be visited, and their order.
// provides: WIDE_ROOT, first_of_group, octant_of, octant_order, rest_of_group
// needs: SlabRay

// The octant of a ray's direction: bit i is set if the direction is negative along axis i.
fn octant_of(ray: SlabRay) -> u32 {
    return dot(select(vec3u(0u), vec3u(1u, 2u, 4u), ray.inverse < vec3f(0.0)), vec3u(1u));
}

// Moves bit s to bit `s ^ octant`, so that the lowest bit is the child that a ray of this octant reaches first.
fn octant_order(mask: u32, octant: u32) -> u32 {
    let x = select(mask, ((mask & 0x55u) << 1u) | ((mask >> 1u) & 0x55u), (octant & 1u) != 0u);
    let y = select(x, ((x & 0x33u) << 2u) | ((x >> 2u) & 0x33u), (octant & 2u) != 0u);
    return select(y, ((y & 0x0fu) << 4u) | (y >> 4u), (octant & 4u) != 0u);
}

// The group that contains the root only. A group holds the children of one node that are still to be visited: x is the
// index of the first child; bits 24 to 31 of y are the children that the ray hits, in the order of visits, and bits 0
// to 7 of y are the mask of inner nodes.
const WIDE_ROOT: vec2u = vec2u(0u, 0x1000000u);

// The index of the first node of a group.
fn first_of_group(group: vec2u, octant: u32) -> u32 {
    let slot = (firstTrailingBit(group.y >> 24u)) ^ octant;
    return group.x + countOneBits(group.y & ((1u << slot) - 1u));
}

// A group without its first node.
fn rest_of_group(group: vec2u) -> vec2u {
    let hits = group.y >> 24u;
    return vec2u(group.x, (group.y & 0xffu) | ((hits & (hits - 1u)) << 24u));
}
