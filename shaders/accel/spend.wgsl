// Counting the loop iterations of an invocation, and reporting when they reach the limit.
// provides: count_iterations, report_spent, spend
// needs: give_up, iteration_limit

// Number of iterations of all loops of this invocation.
var<private> spent: u32;

fn count_iterations(iterations: u32) {
    spent += iterations;
}

// Counts iterations, and returns whether their number is within the limit. If not, the loop must be left at once.
// Kernels are built without wgpu's own loop bound, and old software devices leave long loops silently.
fn spend(iterations: u32) -> bool {
    count_iterations(iterations);
    return spent <= iteration_limit();
}

fn report_spent() {
    if (spent > iteration_limit()) {
        give_up();
    }
}
