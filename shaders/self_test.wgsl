// What the kernels self_test_*.wgsl have in common: they compute, and src/gpu/self_test judges, whether a device
// keeps what the error bounds of src/verify count on.

// Twin: the record of the same name in src/gpu/self_test/records.rs, as of all structs of these kernels.
struct SelfTest {
    // Zero; see fence.wgsl.
    zero: u32,
    // Of self_test_loops.wgsl, iterations.
    single: u32,
    outer: u32,
    inner: u32,
}

@group(0) @binding(0) var<uniform> self_test: SelfTest;

fn runtime_zero() -> u32 {
    return self_test.zero;
}
