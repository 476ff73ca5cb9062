// The status word, which reports that an invocation abandoned its search.
// provides: give_up

// Nonzero if an invocation reached the iteration limit.
@group(0) @binding(2) var<storage, read_write> status: atomic<u32>;

fn give_up() {
    atomicOr(&status, 1u);
}
