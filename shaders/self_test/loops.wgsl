// Executes long loops, which some devices leave silently.
// dispatched: by the self-test, three times with one workgroup.
// provides: loops
// needs: self_test

struct Loop {
    count: u32,
    // Element of a sequence that no compiler can shorten, which shows whether the count is true.
    state: u32,
}

// Number of iterations of each invocation.
@group(0) @binding(2) var<storage, read_write> answers: array<Loop>;

// The linear congruential generator of Numerical Recipes.
fn step(now: Loop) -> Loop {
    return Loop(now.count + 1u, now.state * 1664525u + 1013904223u);
}

@compute @workgroup_size(64)
fn loops(@builtin(local_invocation_index) index: u32) {
    var now = Loop(0u, index);
    for (var i = 0u; i < self_test.single; i++) {
        now = step(now);
    }
    // Each invocation loops in a different outer iteration, so that a device that runs invocations together executes
    // the loops of all of them.
    for (var i = 0u; i < self_test.outer; i++) {
        let inner = select(0u, self_test.inner, i == index);
        for (var j = 0u; j < inner; j++) {
            now = step(now);
        }
    }
    answers[index] = now;
}
