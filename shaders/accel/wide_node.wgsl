// Reading a node of the compressed 8-wide tree and testing its boxes. Its words are described in
// src/accel/wide_tree.rs.
// provides: LEAF_COUNT_SHIFT, LEAF_FIRST, WideNode, wide_node
// needs: SlabRay

// Nodes of the tree, with five vectors each.
@group(1) @binding(3) var<storage, read> nodes: array<vec4u>;

const WIDE_NODE_VECTORS: u32 = 5u;
// The byte of a leaf: in its low bits the first sphere, relative to the first sphere of the node, and above the count.
const LEAF_FIRST: u32 = 31u;
const LEAF_COUNT_SHIFT: u32 = 5u;

struct WideNode {
    inner_mask: u32,
    first_child: u32,
    first_sphere: u32,
    // The leaf bytes, one for each slot.
    leaves: vec2u,
    // Bit s is set if the ray enters the box of slot s at a distance of at most `t_max`.
    hits: u32,
}

// The distances to the planes of four slots: byte s of the word, multiplied by `step`, plus `start`.
fn planes(cells: u32, step: f32, start: f32) -> vec4f {
    return vec4f((vec4u(cells) >> vec4u(0u, 8u, 16u, 24u)) & vec4u(0xffu)) * step + start;
}

struct QuantizedRay {
    step: vec3f,
    // Distances to the grid's origin, less and more by how much boxes are wider.
    near: vec3f,
    far: vec3f,
    t_max: f32,
}

// The hit bits of four slots, from the quantized near and far planes of each axis.
fn four_hits(ray: QuantizedRay, near: vec3u, far: vec3u) -> u32 {
    let entry = max(
        max(planes(near.x, ray.step.x, ray.near.x), planes(near.y, ray.step.y, ray.near.y)),
        max(planes(near.z, ray.step.z, ray.near.z), vec4f(0.0)),
    );
    let exit = min(
        min(planes(far.x, ray.step.x, ray.far.x), planes(far.y, ray.step.y, ray.far.y)),
        min(planes(far.z, ray.step.z, ray.far.z), vec4f(ray.t_max)),
    );
    return dot(select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), entry <= exit), vec4u(1u));
}

// Reads a node and tests all its boxes.
fn wide_node(ray: SlabRay, index: u32, t_max: f32) -> WideNode {
    let first = WIDE_NODE_VECTORS * index;
    let grid = nodes[first];
    let links = nodes[first + 1u];
    let a = nodes[first + 2u];
    let b = nodes[first + 3u];
    let c = nodes[first + 4u];

    let exponents = (vec3u(grid.w) >> vec3u(0u, 8u, 16u)) & vec3u(0xffu);
    let cell = bitcast<vec3f>(exponents << vec3u(23u));
    let start = (bitcast<vec3f>(grid.xyz) - ray.origin) * ray.inverse;
    let wider = ray.wider * abs(ray.inverse);
    let in_grid = QuantizedRay(cell * ray.inverse, start - wider, start + wider, t_max);

    let backward = ray.inverse < vec3f(0.0);
    let low_0 = vec3u(a.x, a.z, b.x);
    let low_4 = vec3u(a.y, a.w, b.y);
    let high_0 = vec3u(b.z, c.x, c.z);
    let high_4 = vec3u(b.w, c.y, c.w);
    let hits = four_hits(in_grid, select(low_0, high_0, backward), select(high_0, low_0, backward))
        | (four_hits(in_grid, select(low_4, high_4, backward), select(high_4, low_4, backward)) << 4u);
    return WideNode(grid.w >> 24u, links.x, links.y, links.zw, hits);
}
