// Traversal of the compressed 8-wide tree in octant order.
// provides: find_any, find_nearest
// needs: LEAF_COUNT_SHIFT, LEAF_FIRST, Nearest, Search, SlabRay, WIDE_ROOT, WideNode, any_in_leaf, brick,
//   first_of_group, octant_of, octant_order, offer_leaf, rest_of_group, spend, wide_node

// Maximum depth of the tree and size of the stack. The remaining children of a node are one entry, and the root leaves
// none, so a tree of WIDE_LEVELS levels needs one entry less. The host builds no deeper tree.
const WIDE_LEVELS: u32 = 16u;

// By how much boxes are wider for a ray with this origin: errors grow with the distance to a sphere, and the spheres of a
// crowd have a margin for rays that start near it.
fn widening(origin: vec3f) -> f32 {
    let farthest = length(max(abs(origin - brick.crowd_min), abs(brick.crowd_max - origin)));
    return max(0x1p-17 * farthest - brick.crowd_margin, 0.0);
}

// Counts the iterations of a node: one for the node, and at most four for each leaf, including the loop over leaves.
fn spend_on_node(leaves: u32) -> bool {
    return spend(1u + 4u * countOneBits(leaves));
}

// The byte of the leaf in a slot.
fn leaf_byte(node: WideNode, slot: u32) -> u32 {
    return (select(node.leaves.x, node.leaves.y, slot >= 4u) >> (8u * (slot & 3u))) & 0xffu;
}

fn find_nearest(search: Search, nearest: ptr<function, Nearest>) {
    var stack: array<vec2u, WIDE_LEVELS>;
    var top = 0u;
    let slab = SlabRay(search.ray.origin, search.inverse, widening(search.ray.origin));
    let octant = octant_of(slab);
    var group = WIDE_ROOT;
    var leaves = 0u;
    loop {
        let index = first_of_group(group, octant);
        let rest = rest_of_group(group);
        if ((rest.y >> 24u) != 0u) {
            stack[top] = rest;
            top++;
        }
        let node = wide_node(slab, index, (*nearest).t);
        leaves = node.hits & ~node.inner_mask;
        if (!spend_on_node(leaves)) {
            return;
        }
        while (leaves != 0u) {
            let leaf = leaf_byte(node, firstTrailingBit(leaves));
            leaves &= leaves - 1u;
            offer_leaf(search, node.first_sphere + (leaf & LEAF_FIRST), leaf >> LEAF_COUNT_SHIFT, nearest);
        }
        let order = octant_order(node.hits & node.inner_mask, octant);
        group = vec2u(node.first_child, node.inner_mask | (order << 24u));
        if (order == 0u) {
            if (top == 0u) {
                return;
            }
            top--;
            group = stack[top];
        }
    }
}

fn find_any(search: Search, t_max: f32) -> bool {
    var stack: array<vec2u, WIDE_LEVELS>;
    var top = 0u;
    let slab = SlabRay(search.ray.origin, search.inverse, widening(search.ray.origin));
    var group = WIDE_ROOT;
    var leaves = 0u;
    loop {
        let index = first_of_group(group, 0u);
        let rest = rest_of_group(group);
        if ((rest.y >> 24u) != 0u) {
            stack[top] = rest;
            top++;
        }
        let node = wide_node(slab, index, t_max);
        leaves = node.hits & ~node.inner_mask;
        if (!spend_on_node(leaves)) {
            break;
        }
        while (leaves != 0u) {
            let leaf = leaf_byte(node, firstTrailingBit(leaves));
            leaves &= leaves - 1u;
            if (any_in_leaf(search, node.first_sphere + (leaf & LEAF_FIRST), leaf >> LEAF_COUNT_SHIFT, t_max)) {
                return true;
            }
        }
        let hits = node.hits & node.inner_mask;
        group = vec2u(node.first_child, node.inner_mask | (hits << 24u));
        if (hits == 0u) {
            if (top == 0u) {
                break;
            }
            top--;
            group = stack[top];
        }
    }
    return false;
}
