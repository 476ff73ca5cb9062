// One node of the two-child tree. Twin: `BinaryNode` in src/accel/binary_tree.rs.
// provides: BINARY_INNER, BinaryChild, NO_ENTRY, binary_child
// needs: SlabRay

// Two vectors for each child of a node.
@group(1) @binding(3) var<storage, read> nodes: array<vec4u>;

// Two a child: its box's low corner and its link; its high corner and its count.
const BINARY_NODE_VECTORS: u32 = 4u;
const BINARY_CHILD_VECTORS: u32 = 2u;

// The count of a child that is a node.
const BINARY_INNER: u32 = 0xffffffffu;
// The entry of a box that is not entered; greater than any distance.
const NO_ENTRY: f32 = 2e30;

struct BinaryChild {
    // Index of the node, or of the leaf's first sphere.
    link: u32,
    count: u32,
    // Where the ray enters the box, or NO_ENTRY.
    entry: f32,
}

fn binary_child(ray: SlabRay, node: u32, side: u32) -> BinaryChild {
    let first = BINARY_NODE_VECTORS * node + BINARY_CHILD_VECTORS * side;
    let low = nodes[first];
    let high = nodes[first + 1u];
    let a = (bitcast<vec3f>(low.xyz) - ray.origin) * ray.inverse;
    let b = (bitcast<vec3f>(high.xyz) - ray.origin) * ray.inverse;
    let near = min(a, b);
    let far = max(a, b);
    let entry = max(max(near.x, near.y), max(near.z, 0.0));
    let exit = min(min(far.x, far.y), far.z);
    return BinaryChild(low.w, high.w, select(NO_ENTRY, entry, entry <= exit));
}
