// Reading a node of the binary tree and testing its boxes. Twin: `BinaryNode` in src/accel/binary_tree.rs.
// provides: BINARY_INNER, BinaryChild, NO_ENTRY, binary_child
// needs: SlabRay

// Nodes of the tree, with two vectors for each child: the low corner of its box and its link, then the high corner and
// its count.
@group(1) @binding(3) var<storage, read> nodes: array<vec4u>;

const BINARY_NODE_VECTORS: u32 = 4u;
const BINARY_CHILD_VECTORS: u32 = 2u;

// The count of a child that is an inner node.
const BINARY_INNER: u32 = 0xffffffffu;
// The entry distance of a box that the ray misses. It is greater than any distance.
const NO_ENTRY: f32 = 2e30;

struct BinaryChild {
    // Index of the inner node, or of the first sphere of the leaf.
    link: u32,
    count: u32,
    // Distance at which the ray enters the box, or NO_ENTRY.
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
