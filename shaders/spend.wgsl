// How long an invocation has looped, and what it reports.

// Not 0 if an invocation ran into the limit of iterations; not 0 if there is a path that goes on.
@group(0) @binding(2) var<storage, read_write> status: array<atomic<u32>, 2>;

// Iterations of all loops of this invocation.
var<private> spent: u32;

// Counts iterations. False once there are more than may be: then the loop is to be left at once. Kernels
// are built without wgpu's own bound on loops, and old software devices have a silent one.
fn spend(iterations: u32) -> bool {
    spent += iterations;
    return spent <= frame.iteration_limit;
}

fn report_spent() {
    if (spent > frame.iteration_limit) {
        atomicOr(&status[0], 1u);
    }
}
