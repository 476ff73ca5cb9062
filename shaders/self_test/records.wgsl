// The record that the kernels of the self-test share. These kernels compute numbers by which src/gpu/self_test judges
// whether a device has the properties that the error bounds of src/verify assume.
// provides: runtime_zero, self_test

// Twin: the struct of the same name in src/gpu/self_test/records.rs. All structs of these kernels have twins there.
struct SelfTest {
    // Two equal numbers that are not 0, as in scene/frame.wgsl.
    limit: u32,
    limit_again: u32,
    // Numbers of iterations for loops.wgsl.
    single: u32,
    outer: u32,
    inner: u32,
}

// A zero for fences, and the numbers of iterations of loops.
@group(0) @binding(0) var<uniform> self_test: SelfTest;

fn runtime_zero() -> u32 {
    return self_test.limit ^ self_test.limit_again;
}
