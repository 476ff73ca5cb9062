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
    let slab = SlabRay(search.ray.origin, search.inverse, 0.0);
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
    var top = 0u;
    let slab = SlabRay(search.ray.origin, search.inverse, 0.0);
    var node = 0u;
    loop {
        if (!spend(11u)) {
            break;
        }
        let left = binary_child(slab, node, 0u);
        let right = binary_child(slab, node, 1u);
        if (any_in_child(search, left, t_max) || any_in_child(search, right, t_max)) {
            return true;
        }
        let goes_left = left.count == BINARY_INNER && left.entry <= t_max;
        let goes_right = right.count == BINARY_INNER && right.entry <= t_max;
        if (goes_left && goes_right) {
            stack[top] = left.link;
            top++;
        }
        node = select(left.link, right.link, goes_right);
        if (!goes_left && !goes_right) {
            if (top == 0u) {
                break;
            }
            top--;
            node = stack[top];
        }
    }
    return false;
}

fn any_in_child(search: Search, child: BinaryChild, t_max: f32) -> bool {
    let is_leaf = child.count != BINARY_INNER && child.entry <= t_max;
    return is_leaf && any_in_leaf(search, child.link, child.count, t_max);
}
