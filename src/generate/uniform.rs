//! Random numbers that are computed from an index and a slot, so that any thread can generate any sphere.

/// The step of `SplitMix64`: 2⁶⁴ divided by the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// The number of slots of each index.
const SLOTS: u64 = 32;

/// The random numbers of `SplitMix64`, accessed by slot rather than in sequence: its n-th state is the seed plus n
/// steps.
///
/// G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014; the constants are
/// those of S. Vigna's splitmix64.c. The seed is mixed once first, so that neighbouring seeds give unrelated numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Uniform {
    seed: u64,
}

impl Uniform {
    pub(crate) fn new(seed: u64) -> Self {
        Self { seed: mix(seed.wrapping_add(STEP)) }
    }

    /// 64 random bits; `slot` must be less than [`SLOTS`].
    pub(crate) fn bits(&self, index: u64, slot: u64) -> u64 {
        let n = index.wrapping_mul(SLOTS).wrapping_add(slot).wrapping_add(1);
        mix(self.seed.wrapping_add(n.wrapping_mul(STEP)))
    }

    /// A uniform random number: a multiple of 2⁻⁵³ in [0, 1).
    pub(crate) fn number(&self, index: u64, slot: u64) -> f64 {
        (self.bits(index, slot) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The sum of twelve uniform 16-bit numbers minus its mean: mean 0, standard deviation 1 (except for 2⁻³²), and
    /// never beyond ±6 (Irwin–Hall). It uses three slots from `slot` on.
    pub(super) fn nearly_normal(&self, index: u64, slot: u64) -> f64 {
        let quarters = |bits: u64| (0..4).map(move |k| (bits >> (16 * k)) & 0xffff);
        let sum: u64 = (0..3).flat_map(|k| quarters(self.bits(index, slot + k))).sum();
        // Twelve half steps move the mean to zero.
        (sum as f64 + 6.0) / f64::from(1 << 16) - 6.0
    }
}

/// The output function of `SplitMix64`.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 2ˣ for 0 ≤ x < 60, by the exponential series of the fraction: the error after 20 terms is below the resolution of
/// f64. `f64::exp2` differs between platforms.
pub(super) fn power_of_two(x: f64) -> f64 {
    let whole = x.floor();
    let y = (x - whole) * std::f64::consts::LN_2;
    let series = (1..=20).rev().fold(1.0, |sum, n| 1.0 + sum * y / f64::from(n));
    series * (1_u64 << whole as u64) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of the published generator with the seed 0.
    #[test]
    fn the_stream_is_that_of_splitmix64() {
        let uniform = Uniform { seed: 0 };
        assert_eq!(
            [0, 1, 2].map(|slot| uniform.bits(0, slot)),
            [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]
        );
    }

    #[test]
    fn powers_of_two() {
        for i in 0..=1300 {
            let x = f64::from(i) / 100.0;
            assert!((power_of_two(x) / x.exp2() - 1.0).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn moments() {
        let uniform = Uniform::new(7);
        let numbers = |f: fn(&Uniform, u64) -> f64| (0..100_000).map(move |i| f(&uniform, i));
        let mean = |numbers: &mut dyn Iterator<Item = f64>| numbers.sum::<f64>() / 1e5;
        assert!((mean(&mut numbers(|u, i| u.number(i, 0))) - 0.5).abs() < 0.01);
        assert!(mean(&mut numbers(|u, i| u.nearly_normal(i, 0))).abs() < 0.02);
        assert!((mean(&mut numbers(|u, i| u.nearly_normal(i, 0).powi(2))) - 1.0).abs() < 0.02);
    }
}
