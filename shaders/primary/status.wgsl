// Whether an invocation was given up.
// provides: give_up

// Not 0 if an invocation ran into the limit of iterations.
@group(0) @binding(2) var<storage, read_write> status: atomic<u32>;

fn give_up() {
    atomicOr(&status, 1u);
}
