// Computes the numbers of workgroups of the next indirect dispatches, for a whole list of paths and for a slice of it.
// It also empties the lists that are filled next.
// dispatched: one workgroup, before each list of paths is used.
// provides: advance
// needs: LIST_OF_LIGHT, dispatch, next_list, queue, start_fences

// Arguments of two indirect dispatches, with three numbers of workgroups each.
@group(0) @binding(5) var<storage, read_write> groups_needed: array<u32, 6>;

@compute @workgroup_size(64)
fn advance(@builtin(local_invocation_index) lane: u32) {
    start_fences();
    if (lane != 0u) {
        return;
    }
    let groups = (atomicLoad(&queue.counts[dispatch.list]) + 63u) / 64u;
    let slice = min(groups - min(groups, dispatch.first.x), dispatch.count);
    groups_needed = array<u32, 6>(groups, 1u, 1u, slice, 1u, 1u);
    if (dispatch.is_new != 0u) {
        atomicStore(&queue.counts[next_list()], 0u);
        atomicStore(&queue.counts[LIST_OF_LIGHT], 0u);
    }
}
