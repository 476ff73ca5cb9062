// Traversal of the binary tree, the nearer child first. Twin: src/accel/binary_tree_trace.rs.
// provides: find_any, find_nearest
// needs: BINARY_INNER, BinaryChild, NO_ENTRY, Nearest, Search, SlabRay, any_in_leaf, binary_child, offer_leaf, spend

// Maximum depth of the tree, which is also the size of the stack: each level leaves at most one entry on it. The host
// builds no deeper tree.
const BINARY_LEVELS: u32 = 30u;

// Stack entry of a child: its link and entry distance. The distance of a leaf is NO_ENTRY, so leaves are never pushed.
fn stack_entry(child: BinaryChild) -> vec2u {
    return vec2u(child.link, bitcast<u32>(select(NO_ENTRY, child.entry, child.count == BINARY_INNER)));
}

fn offer_child(search: Search, child: BinaryChild, nearest: ptr<function, Nearest>) {
    if (child.count != BINARY_INNER && child.entry <= (*nearest).t) {
        offer_leaf(search, child.link, child.count, nearest);
    }
}

fn find_nearest(search: Search, nearest: ptr<function, Nearest>) {
    var stack: array<vec2u, BINARY_LEVELS>;
    var top = 0u;
    let slab = SlabRay(search.ray.origin, search.inverse);
    var next = vec2u(0u, 0u);
    var near = BinaryChild();
    var far = BinaryChild();
    // An iteration costs one node, its pops, and two leaves of four spheres. Each pop belongs to a push by another
    // node.
    while (spend(12u)) {
        let left = binary_child(slab, next.x, 0u);
        let right = binary_child(slab, next.x, 1u);
        near = left;
        far = right;
        if (right.entry < left.entry) {
            near = right;
            far = left;
        }
        offer_child(search, near, nearest);
        offer_child(search, far, nearest);
        let far_entry = stack_entry(far);
        next = stack_entry(near);
        if (bitcast<f32>(next.y) > (*nearest).t) {
            next = far_entry;
        } else if (bitcast<f32>(far_entry.y) <= (*nearest).t) {
            stack[top] = far_entry;
            top++;
        }
        while (bitcast<f32>(next.y) > (*nearest).t) {
            if (top == 0u) {
                return;
            }
            top--;
            next = stack[top];
        }
    }
}

fn find_any(search: Search, t_max: f32) -> bool {
    var stack: array<u32, BINARY_LEVELS>;
    // The root, which is node 0, is on the stack.
    var top = 1u;
    let slab = SlabRay(search.ray.origin, search.inverse);
    while (top > 0u && spend(11u)) {
        top--;
        let node = stack[top];
        for (var side = 0u; side < 2u; side++) {
            let child = binary_child(slab, node, side);
            if (child.entry > t_max) {
                continue;
            }
            if (child.count == BINARY_INNER) {
                stack[top] = child.link;
                top++;
            } else if (any_in_leaf(search, child.link, child.count, t_max)) {
                return true;
            }
        }
    }
    return false;
}
