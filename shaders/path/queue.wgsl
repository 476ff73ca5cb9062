// The lists of paths that dispatches process, their lengths, and the status word.
// provides: LIST_OF_LIGHT, NO_PATH, append, give_up, next_list, queue
// needs: dispatch

struct Queue {
    // Nonzero if an invocation reached the iteration limit.
    spent: atomic<u32>,
    // Number of paths in each list.
    counts: array<atomic<u32>, 3>,
    // The lists, one after another, each with room for all paths.
    entries: array<u32>,
}

// Status word, lengths of the lists of paths, and the lists themselves.
@group(0) @binding(2) var<storage, read_write> queue: Queue;

// The list of the paths whose sampled light must be tested for occlusion. Lists 0 and 1 alternately contain the paths
// that continue.
const LIST_OF_LIGHT: u32 = 2u;

// The value for an invocation without a path.
const NO_PATH: u32 = 0xffffffffu;

// The list of the paths that continue after this surface.
fn next_list() -> u32 {
    return dispatch.surface & 1u;
}

// Appends a path to a list. The order of a list depends on the device, and no result depends on the order.
fn append(list: u32, index: u32) {
    let at = atomicAdd(&queue.counts[list], 1u);
    queue.entries[list * dispatch.paths + at] = index;
}

fn give_up() {
    atomicOr(&queue.spent, 1u);
}
