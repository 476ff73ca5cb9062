// How long an invocation has looped, and what it reports.
// provides: count_iterations, report_spent, spend
// needs: frame, give_up

// Iterations of all loops of this invocation.
var<private> spent: u32;

fn count_iterations(iterations: u32) {
    spent += iterations;
}

// Counts iterations. False once there are more than the limit: then the loop is to be left at once. Kernels
// are built without wgpu's own bound on loops, and old software devices have a silent one.
fn spend(iterations: u32) -> bool {
    count_iterations(iterations);
    return spent <= frame.iteration_limit;
}

fn report_spent() {
    if (spent > frame.iteration_limit) {
        give_up();
    }
}
