//! Sample points, computed from their address, which is the pixel, the sample, and the pair of dimensions.
//!
//! Each pair of dimensions uses the first two dimensions of Sobol's sequence, a (0, 2)-sequence in base 2. In every
//! aligned block of 2ᵐ samples, each elementary interval of area 2⁻ᵐ contains exactly one sample. Each pair is shuffled
//! and scrambled on its own ("padded", as in `PaddedSobolSampler` of pbrt-v4), which keeps this property and makes
//! pairs and pixels independent of each other. The method is that of B. Burley, "Practical Hash-based Owen Scrambling",
//! JCGT 9(4), 2020, with N. Vegdahl's hash ("Building a Better LK Hash", psychopath.io, 2021) in place of that of Laine
//! and Karras.
//!
//! All arithmetic is on integers, so that every device gives the same bits. The WGSL twin is `shaders/math/sampling.wgsl`.

/// The seed of a pixel, given as column and row. It makes the pixel's sample points differ from those of other pixels.
///
/// Hashes are nested as in M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
#[must_use]
pub fn pixel_seed(pixel: [u32; 2], seed: u32) -> u32 {
    let [column, row] = pixel;
    pcg(column.wrapping_add(pcg(row.wrapping_add(pcg(seed)))))
}

/// One point of a pair of dimensions: two integers in units of 2⁻³².
///
/// A sample may use many pairs. Each purpose has its own number `pair`.
#[must_use]
pub fn pair(pixel_seed: u32, sample: u32, pair: u32) -> [u32; 2] {
    let order = pcg(pixel_seed ^ pcg(pair));
    let across = pcg(order);
    let down = pcg(across);
    // The index is scrambled as if it were a fraction, so that aligned blocks of 2ᵐ samples remain aligned blocks.
    let index = scramble_reversed(sample.reverse_bits(), order).reverse_bits();
    // Sobol's first dimension is the index with its bits reversed, and `scramble_reversed` takes reversed bits.
    [scramble_reversed(index, across), scramble_reversed(second_dimension(index), down)].map(u32::reverse_bits)
}

/// The number in [0, 1) given by the upper 24 bits. f32 represents it exactly.
#[must_use]
pub fn unit(bits: u32) -> f64 {
    f64::from(bits >> 8) / f64::from(1 << 24)
}

/// The bijective output function RXS-M-XS of the 32-bit PCG, after one step of its generator.
pub(crate) fn pcg(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// Owen scrambling of a fraction whose bits are reversed: flips each bit depending on a hash of the bits below it.
fn scramble_reversed(x: u32, seed: u32) -> u32 {
    let x = x ^ x.wrapping_mul(0x3d20_adea);
    let x = x.wrapping_add(seed).wrapping_mul((seed >> 16) | 1);
    let x = x ^ x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Sobol's second dimension, with its bits reversed.
///
/// Its direction numbers are the rows of Pascal's triangle modulo 2: bit i of the index stands for (1 + X)ⁱ, a
/// polynomial over GF(2) whose coefficients are the bits of the result. As i is a sum of powers 2ᵏ and (1 + X)^2ᵏ = 1 +
/// X^2ᵏ, multiplying by that matrix takes one step for each k.
fn second_dimension(index: u32) -> u32 {
    let x = index ^ ((index & 0xaaaa_aaaa) >> 1);
    let x = x ^ ((x & 0xcccc_cccc) >> 2);
    let x = x ^ ((x & 0xf0f0_f0f0) >> 4);
    let x = x ^ ((x & 0xff00_ff00) >> 8);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The second dimension by the recurrence of its direction numbers: the polynomial is X + 1, so v(i + 1) = v(i) ^
    /// (v(i) >> 1).
    fn second_dimension_by_definition(index: u32) -> u32 {
        let mut direction = 1_u32 << 31;
        let mut point = 0;
        for i in 0..32 {
            point ^= direction * ((index >> i) & 1);
            direction ^= direction >> 1;
        }
        point
    }

    #[test]
    fn the_second_dimension_is_that_of_the_direction_numbers() {
        let powers = (0..32).map(|i| 1 << i);
        let hashed = (0..10_000).map(pcg);
        for index in powers.chain(0..10_000).chain(hashed).chain([u32::MAX]) {
            let expected = second_dimension_by_definition(index);
            assert_eq!(second_dimension(index).reverse_bits(), expected, "{index}");
        }
        // The first points, from published tables of the sequence.
        let first = [0, 1, 2, 3, 4].map(|i| unit(second_dimension(i).reverse_bits()));
        assert!(first.iter().eq(&[0.0, 0.5, 0.75, 0.25, 0.625]), "{first:?}");
    }

    /// Each bit of the result depends only on the same bit of the input, which flips it, and on the bits below.
    #[test]
    fn scrambling_is_nested() {
        for i in 0..20_000 {
            let (x, seed, bit) = (pcg(3 * i), pcg(3 * i + 1), pcg(3 * i + 2) >> 27);
            let difference = scramble_reversed(x, seed) ^ scramble_reversed(x ^ (1 << bit), seed);
            assert_eq!(difference.trailing_zeros(), bit, "{x:#x}, {seed:#x}");
        }
    }

    /// Known values from a program in another language that follows the paper's formula.
    #[test]
    fn hashes_of_known_numbers() {
        assert_eq!(pcg(0), 129_708_002);
        assert_eq!(pcg(1), 2_831_084_092);
    }
}
