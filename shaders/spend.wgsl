// How long an invocation has looped, and what it reports.

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
        give_up();
    }
}
