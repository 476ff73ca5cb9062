//! Records of the self-test that kernels read and write. Twins: the structs of the same names in the files in
//! `shaders/self_test`. A test in `gpu/shader/records.rs` compares them.

use bytemuck::{Pod, Zeroable};

use crate::generate::Uniform;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SelfTest {
    pub(crate) limit: u32,
    pub(crate) limit_again: u32,
    pub(crate) single: u32,
    pub(crate) outer: u32,
    pub(crate) inner: u32,
}

impl Default for SelfTest {
    /// No loops, and the numbers for fences that a frame has.
    fn default() -> Self {
        let limit = 64_000;
        Self { limit, limit_again: limit, single: 0, outer: 0, inner: 0 }
    }
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Operands {
    pub(crate) a: f32,
    pub(crate) b: f32,
    pub(crate) p: f32,
    pub(crate) q: f32,
    pub(crate) factor: f32,
    pub(crate) dividend: f32,
    pub(crate) divisor: f32,
    pub(crate) radicand: f32,
    pub(crate) u: [f32; 3],
    pub(crate) _pad1: u32,
    pub(crate) v: [f32; 3],
    pub(crate) _pad2: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Arithmetic {
    pub(crate) sum: f32,
    pub(crate) back: f32,
    pub(crate) error: f32,
    pub(crate) unfenced_error: f32,
    pub(crate) scaled: f32,
    pub(crate) difference: f32,
    pub(crate) product: f32,
    pub(crate) quotient: f32,
    pub(crate) root: f32,
    pub(crate) inverse_root: f32,
    pub(crate) dot: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Values {
    pub(crate) f: f32,
    pub(crate) g: f32,
    pub(crate) whole: u32,
    pub(crate) i: u32,
    pub(crate) j: u32,
    pub(crate) small: f32,
    pub(crate) other: f32,
    pub(crate) scale: f32,
    pub(crate) tiny: f32,
    pub(crate) speck: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Exact {
    pub(crate) from_whole: f32,
    pub(crate) truncated: i32,
    pub(crate) unsigned: u32,
    pub(crate) floored: f32,
    pub(crate) smaller: f32,
    pub(crate) larger: f32,
    pub(crate) selected: f32,
    pub(crate) comparisons: u32,
    pub(crate) bits: u32,
    pub(crate) from_bits: f32,
    pub(crate) added: u32,
    pub(crate) subtracted: u32,
    pub(crate) multiplied: u32,
    pub(crate) divided: u32,
    pub(crate) remainder: u32,
    pub(crate) shifted_left: u32,
    pub(crate) shifted_right: u32,
    pub(crate) ones: u32,
    pub(crate) lowest: u32,
    pub(crate) tiny_difference: f32,
    pub(crate) tiny_product: f32,
    pub(crate) tiny_sum: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Loop {
    pub(crate) count: u32,
    pub(crate) state: u32,
}

/// The random numbers of an invocation, indexed by slot.
struct Numbers<'a> {
    uniform: &'a Uniform,
    index: u64,
}

impl Numbers<'_> {
    fn bits(&self, slot: u64) -> u32 {
        // Only the low bits are used.
        self.uniform.bits(self.index, slot) as u32
    }

    /// An integer from `first` to `last`, inclusive.
    fn integer(&self, slot: u64, first: i32, last: i32) -> i32 {
        let count = f64::from(last - first + 1);
        first + (self.uniform.number(self.index, slot) * count) as i32
    }

    /// A number with the given exponent and random sign and mantissa. It uses one slot.
    fn float(&self, slot: u64, exponent: i32) -> f32 {
        let bits = self.bits(slot);
        f32::from_bits(((exponent + 127) as u32) << 23 | bits & 0x807f_ffff)
    }

    /// A number with random sign and mantissa, and an exponent from `first` to `last`. It uses two slots.
    fn float_between(&self, slot: u64, first: i32, last: i32) -> f32 {
        self.float(slot, self.integer(slot + 1, first, last))
    }
}

fn all<T>(seed: u64, count: usize, make: impl Fn(&Numbers<'_>) -> T) -> Vec<T> {
    let uniform = Uniform::new(seed);
    (0..count as u64).map(|index| make(&Numbers { uniform: &uniform, index })).collect()
}

/// Inputs of operations whose results may be rounded. The exponents have three properties: no result
/// overflows or is subnormal, f64 represents sums and products exactly, and f32 represents the rounding error
/// of a sum in either direction of rounding.
pub(super) fn operands(count: usize) -> Vec<Operands> {
    let mut operands = all(1, count, |numbers| {
        let exponent = numbers.integer(0, -50, 59);
        let a = numbers.float(1, exponent);
        let b = numbers.float_between(2, exponent - 20, exponent - 1);
        let p = numbers.float_between(4, -20, 20);
        let quotient = numbers.integer(8, -100, 100);
        // WGSL bounds the error of division for divisors from 2^-126 to 2^126.
        let divisor = numbers.integer(9, (-126).max(-126 - quotient), 125.min(125 - quotient));
        let vector = |slot: u64| [0, 2, 4].map(|axis| numbers.float_between(slot + axis, -10, 10));
        Operands {
            a,
            b,
            p,
            // q equals -p except for the lowest bits of the mantissa.
            q: f32::from_bits((-p).to_bits() ^ numbers.bits(6) & 0xfff),
            factor: numbers.float_between(7, -20, 20),
            dividend: numbers.float(10, divisor + quotient),
            divisor: numbers.float(11, divisor),
            radicand: numbers.float_between(12, -126, 127).abs(),
            u: vector(14),
            v: vector(20),
            ..Operands::zeroed()
        }
    });
    if let Some(first) = operands.first_mut() {
        first.radicand = 0.0;
    }
    operands
}

pub(super) fn values(count: usize) -> Vec<Values> {
    const MANTISSA: u32 = 0x007f_ffff;
    all(2, count, |numbers| {
        let f = numbers.float_between(0, -3, 30);
        let small = numbers.float(2, -126);
        let tiny = |slot| f32::from_bits(numbers.bits(slot) & (MANTISSA >> 1));
        Values {
            f,
            g: match numbers.integer(3, 0, 7) {
                0 => f,
                1 => -f,
                2 => f.trunc(),
                _ => numbers.float_between(4, -3, 30),
            },
            whole: (numbers.bits(6) >> 8) << numbers.integer(7, 0, 8),
            i: numbers.bits(8) << numbers.integer(9, 0, 31),
            // The divisor is not zero.
            j: (numbers.bits(10) >> numbers.integer(11, 0, 31)).max(1),
            small,
            other: f32::from_bits(small.to_bits() ^ numbers.bits(12) & MANTISSA),
            scale: numbers.float_between(13, -13, -2),
            tiny: tiny(15),
            speck: tiny(16),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_promised() {
        for o in operands(4096) {
            assert!(o.a.abs() >= o.b.abs(), "{o:?}");
            let numbers = [o.a * o.b, o.p, o.q, o.p * o.factor, o.dividend, o.divisor];
            let quotient = o.dividend / o.divisor;
            assert!(numbers.iter().chain([&quotient]).all(|v| v.is_normal()), "{o:?}");
            assert!((o.q / o.p + 1.0).abs() < 0.001, "{o:?}");
            assert!((2_f32.powi(-126)..2_f32.powi(126)).contains(&o.divisor.abs()), "{o:?}");
            assert!(o.radicand == 0.0 || o.radicand.is_normal(), "{o:?}");
        }
        for v in values(4096) {
            assert!(v.f.abs() < 2_f32.powi(31) && v.g.abs() < 2_f32.powi(31), "{v:?}");
            assert_eq!(f64::from(v.whole as f32), f64::from(v.whole));
            assert!(v.small.is_normal() && v.other.is_normal() && v.j > 0, "{v:?}");
            for tiny in [v.tiny, v.speck, v.tiny + v.speck, v.small - v.other] {
                assert!(!tiny.is_normal(), "{v:?}");
            }
            assert!((v.small * v.scale).is_subnormal(), "{v:?}");
        }
    }
}
