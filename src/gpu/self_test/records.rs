//! Records of the self-test that kernels read and write. Twins: the structs of the same names in
//! the files in `shaders/self_test`. The test of `gpu/shader/records.rs` compares them.

use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct SelfTest {
    pub(in crate::gpu) limit: u32,
    pub(in crate::gpu) limit_again: u32,
    pub(in crate::gpu) single: u32,
    pub(in crate::gpu) outer: u32,
    pub(in crate::gpu) inner: u32,
}

impl Default for SelfTest {
    /// No loops, and numbers for fences like those of a frame.
    fn default() -> Self {
        let limit = 64_000;
        Self { limit, limit_again: limit, single: 0, outer: 0, inner: 0 }
    }
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct Operands {
    pub(in crate::gpu) a: f32,
    pub(in crate::gpu) b: f32,
    pub(in crate::gpu) p: f32,
    pub(in crate::gpu) q: f32,
    pub(in crate::gpu) factor: f32,
    pub(in crate::gpu) dividend: f32,
    pub(in crate::gpu) divisor: f32,
    pub(in crate::gpu) radicand: f32,
    pub(in crate::gpu) u: [f32; 3],
    pub(in crate::gpu) _pad1: u32,
    pub(in crate::gpu) v: [f32; 3],
    pub(in crate::gpu) _pad2: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct Arithmetic {
    pub(in crate::gpu) sum: f32,
    pub(in crate::gpu) back: f32,
    pub(in crate::gpu) error: f32,
    pub(in crate::gpu) unfenced_error: f32,
    pub(in crate::gpu) scaled: f32,
    pub(in crate::gpu) difference: f32,
    pub(in crate::gpu) product: f32,
    pub(in crate::gpu) quotient: f32,
    pub(in crate::gpu) root: f32,
    pub(in crate::gpu) inverse_root: f32,
    pub(in crate::gpu) dot: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct Values {
    pub(in crate::gpu) f: f32,
    pub(in crate::gpu) g: f32,
    pub(in crate::gpu) whole: u32,
    pub(in crate::gpu) i: u32,
    pub(in crate::gpu) j: u32,
    pub(in crate::gpu) small: f32,
    pub(in crate::gpu) other: f32,
    pub(in crate::gpu) scale: f32,
    pub(in crate::gpu) tiny: f32,
    pub(in crate::gpu) speck: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct Exact {
    pub(in crate::gpu) from_whole: f32,
    pub(in crate::gpu) truncated: i32,
    pub(in crate::gpu) unsigned: u32,
    pub(in crate::gpu) floored: f32,
    pub(in crate::gpu) smaller: f32,
    pub(in crate::gpu) larger: f32,
    pub(in crate::gpu) selected: f32,
    pub(in crate::gpu) comparisons: u32,
    pub(in crate::gpu) bits: u32,
    pub(in crate::gpu) from_bits: f32,
    pub(in crate::gpu) added: u32,
    pub(in crate::gpu) subtracted: u32,
    pub(in crate::gpu) multiplied: u32,
    pub(in crate::gpu) divided: u32,
    pub(in crate::gpu) remainder: u32,
    pub(in crate::gpu) shifted_left: u32,
    pub(in crate::gpu) shifted_right: u32,
    pub(in crate::gpu) ones: u32,
    pub(in crate::gpu) lowest: u32,
    pub(in crate::gpu) tiny_difference: f32,
    pub(in crate::gpu) tiny_product: f32,
    pub(in crate::gpu) tiny_sum: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub(in crate::gpu) struct Looped {
    pub(in crate::gpu) count: u32,
    pub(in crate::gpu) state: u32,
}
