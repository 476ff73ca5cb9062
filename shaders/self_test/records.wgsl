// What the kernels of this folder have in common: they compute, and src/gpu/self_test judges, whether a device
// keeps what the error bounds of src/verify count on.
// provides: runtime_zero, self_test

// Twin: the record of the same name in src/gpu/self_test/records.rs, as of all structs of these kernels.
struct SelfTest {
    // Zero; see fence.wgsl.
    zero: u32,
    // Iterations, for loops.wgsl.
    single: u32,
    outer: u32,
    inner: u32,
}

// Zero, and how long loops are.
@group(0) @binding(0) var<uniform> self_test: SelfTest;

fn runtime_zero() -> u32 {
    return self_test.zero;
}
