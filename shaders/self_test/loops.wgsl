// Loops, which some devices leave silently.
// dispatched: by the self-test, one workgroup, three times.
// provides: loops
// needs: self_test

struct Looped {
    count: u32,
    // Of a sequence that no compiler shortens; it tells whether the count is true.
    state: u32,
}

// How often each loop ran.
@group(0) @binding(2) var<storage, read_write> answers: array<Looped>;

// Numerical Recipes' linear congruential generator.
fn step(looped: Looped) -> Looped {
    return Looped(looped.count + 1u, looped.state * 1664525u + 1013904223u);
}

@compute @workgroup_size(64)
fn loops(@builtin(local_invocation_index) index: u32) {
    var looped = Looped(0u, index);
    for (var i = 0u; i < self_test.single; i++) {
        looped = step(looped);
    }
    // Each invocation in a turn of its own, so that what runs them together loops for all of them.
    for (var i = 0u; i < self_test.outer; i++) {
        let inner = select(0u, self_test.inner, i == index);
        for (var j = 0u; j < inner; j++) {
            looped = step(looped);
        }
    }
    answers[index] = looped;
}
