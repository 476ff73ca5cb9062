// Which paths a dispatch works on: lists of them, how long each is, and whether an invocation gave up.
// provides: LIST_OF_LIGHT, NO_PATH, append, give_up, next_list, queue
// needs: dispatch

struct Queue {
    // Not 0 if an invocation ran into the limit of iterations.
    spent: atomic<u32>,
    // How many paths each list has.
    counts: array<atomic<u32>, 3>,
    // The lists, one behind the other, each with room for all paths.
    entries: array<u32>,
}

// Whether an invocation gave up; lists of paths, and how long they are.
@group(0) @binding(2) var<storage, read_write> queue: Queue;

// Lists 0 and 1 have, by turns, the paths that go on; this one has those that look for light.
const LIST_OF_LIGHT: u32 = 2u;

// No path.
const NO_PATH: u32 = 0xffffffffu;

// The list of the paths that go on after this surface.
fn next_list() -> u32 {
    return dispatch.surface & 1u;
}

// The order of a list is up to the device; nothing depends on it.
fn append(list: u32, index: u32) {
    let at = atomicAdd(&queue.counts[list], 1u);
    queue.entries[list * dispatch.paths + at] = index;
}

fn give_up() {
    atomicOr(&queue.spent, 1u);
}
