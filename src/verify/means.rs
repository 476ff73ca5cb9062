//! Tests whether two pictures estimate the same light, by their means in each region, with a stated error probability.
//!
//! A picture with light is an estimate by random samples. An independent picture of the same scene says which light is
//! right: the reference makes it with another seed, as many samples and the same encoding. If a device is correct, its
//! result for a pixel and the reference's result are two draws from the same distribution, whatever it is. So their
//! difference d has either sign with the same probability, given its magnitude, and the differences of pixels are
//! independent. The sum of n such differences with random signs is bounded by Hoeffding's inequality ("Probability
//! inequalities for sums of bounded random variables", 1963, theorem 2):
//!
//! P(|Σ d| ≥ √(2 ln(2/p) Σ d²)) ≤ p
//!
//! The denoiser mixes pixels, but two pixels farther apart than twice its reach are independent. So the pixels are
//! divided into classes whose members are that far apart. The bound holds for each class, and the bound of all pixels
//! is the sum of the bounds of the classes. This sum is so much wider that only the whole picture is tested then.
//!
//! No variance is estimated and no tails are assumed, so the bound also holds for a picture with fireflies. With m
//! regions and channels, each is tested with p/m. A correct device is accused with a probability of at most p in all.
//!
//! Rounding may move a mean as well: a device adds up to as many roundings as a pixel has samples, and some hundred in
//! shading. Therefore the bound is wider by (samples + 256) 2⁻²⁴ of white, or of the brightest light.
//!
//! Where surfaces of several spheres coincide, rounding decides which one is seen, and no average helps. Regions with
//! more than a hundredth of such pixels stay undecided. So do regions with so much noise that the bound is above a
//! twentieth of the picture's mean.

use std::fmt;

use super::certificate::channel_name;
use crate::verify::certificate::Outcome;

/// The probability with which a correct device is accused.
pub const ERROR_PROBABILITY: f64 = 1e-9;

/// The largest number of regions along each side of a picture.
const MOST_REGIONS: u32 = 8;

/// The least number of pixels along each side of a region.
const LEAST_SIDE: u32 = 8;

/// The largest share of a region's pixels where surfaces coincide.
const MOST_TIES: f64 = 0.01;

/// The widest bound with which a region is decided, relative to the mean of the picture.
const WIDEST: f64 = 0.05;

/// The number of roundings in shading that may move a mean, apart from one for each sample.
const OF_SHADING: f64 = 256.0;

/// The comparison of one channel of a region.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RegionMean {
    /// Column and row of the region, from the top left; `None` for the whole picture.
    pub region: Option<[u32; 2]>,
    /// Index of the channel, from 0: red, green or blue.
    pub channel: usize,
    /// The mean of the picture.
    pub found: f64,
    /// The mean of the reference.
    pub expected: f64,
    /// The largest difference that is legal.
    pub bound: f64,
    /// The outcome of the comparison.
    pub outcome: Outcome,
}

/// The result of comparing means.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Means {
    /// The number of regions along each side.
    pub regions: [u32; 2],
    /// The means of each channel of each region, and then of the whole picture.
    pub means: Vec<RegionMean>,
}

/// Two pictures that are compared, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub struct Estimates<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The number of samples of each pixel.
    pub samples: u32,
    /// The picture.
    pub found: &'a [[f64; 3]],
    /// The reference's picture with other random numbers.
    pub expected: &'a [[f64; 3]],
    /// Maximum distance in pixels, along each axis, over which noise was mixed into a pixel; 0 without a
    /// [denoiser](crate::image::denoise::REACH).
    pub reach: u32,
    /// For each pixel, whether rounding decides which sphere it shows. It may be empty.
    pub ties: &'a [bool],
}

/// Sums over a region.
#[derive(Clone, Default)]
struct Sums {
    pixels: f64,
    ties: f64,
    found: [f64; 3],
    expected: [f64; 3],
    /// The sum of squared differences of each class of independent pixels.
    squares: Vec<[f64; 3]>,
}

impl Sums {
    /// The sum of the roots of the sums of all classes.
    fn deviation(&self, channel: usize) -> f64 {
        self.squares.iter().map(|of_class| of_class[channel].sqrt()).sum()
    }
}

impl Estimates<'_> {
    /// Compares the means of all regions.
    #[must_use]
    pub fn compare(&self) -> Means {
        let most = if self.reach == 0 { MOST_REGIONS } else { 1 };
        let regions = self.size.map(|side| (side / LEAST_SIDE).clamp(1, most));
        let mut sums = self.sums(regions);
        sums.extend(self.sums([1, 1]));
        let classes = f64::from(2 * self.reach + 1).powi(2);
        let tests = (3 * sums.len()) as f64 * classes;
        let factor = (2.0 * (2.0 * tests / ERROR_PROBABILITY).ln()).sqrt();
        let overall =
            sums.last().map_or(0.0, |whole| whole.expected.iter().sum::<f64>() / (3.0 * whole.pixels).max(1.0));
        let brightest = self.expected.iter().flatten().copied().fold(1.0, f64::max);
        let rounding = (f64::from(self.samples) + OF_SHADING) * brightest / f64::from(1_u32 << 24);
        let mut means = Vec::with_capacity(3 * sums.len());
        for (index, sums) in (0..).zip(&sums) {
            let row = index / regions[0];
            let region = (row < regions[1]).then_some([index % regions[0], row]);
            for channel in 0..3 {
                let [found, expected] = [sums.found, sums.expected].map(|sum| sum[channel] / sums.pixels.max(1.0));
                let bound = factor * sums.deviation(channel) / sums.pixels.max(1.0) + rounding;
                let is_vague = sums.ties > MOST_TIES * sums.pixels || bound > WIDEST * overall;
                // NaN is not within a bound.
                let is_within = (found - expected).abs() <= bound;
                let outcome = match (is_vague && found.is_finite(), is_within) {
                    (true, _) => Outcome::Undecided,
                    (false, true) => Outcome::Proved,
                    (false, false) => Outcome::Violated,
                };
                means.push(RegionMean { region, channel, found, expected, bound, outcome });
            }
        }
        Means { regions, means }
    }

    fn sums(&self, regions: [u32; 2]) -> Vec<Sums> {
        let apart = 2 * self.reach as usize + 1;
        let empty = Sums { squares: vec![[0.0; 3]; apart * apart], ..Sums::default() };
        let mut all = vec![empty; (regions[0] * regions[1]) as usize];
        let width = self.size[0].max(1) as usize;
        for (index, (found, expected)) in self.found.iter().zip(self.expected).enumerate() {
            let at = [index % width, index / width];
            let [column, row] = [0, 1].map(|axis| at[axis] * regions[axis] as usize / self.size[axis].max(1) as usize);
            let Some(sums) = all.get_mut(row * regions[0] as usize + column) else { continue };
            let class = &mut sums.squares[at[1] % apart * apart + at[0] % apart];
            sums.pixels += 1.0;
            sums.ties += f64::from(u8::from(self.ties.get(index) == Some(&true)));
            for channel in 0..3 {
                sums.found[channel] += found[channel];
                sums.expected[channel] += expected[channel];
                class[channel] += (found[channel] - expected[channel]).powi(2);
            }
        }
        all
    }
}

impl Means {
    /// The number of means with an outcome.
    #[must_use]
    pub fn count(&self, outcome: Outcome) -> usize {
        self.means.iter().filter(|mean| mean.outcome == outcome).count()
    }

    /// The outcome of the picture. It is undecided if more than half of the means are.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let undecided = self.count(Outcome::Undecided);
        match (self.count(Outcome::Violated), 2 * undecided <= self.means.len()) {
            (0, true) if !self.means.is_empty() => Outcome::Proved,
            (0, _) => Outcome::Undecided,
            _ => Outcome::Violated,
        }
    }

    /// The mean that is the farthest from the mean of the reference, relative to its bound.
    #[must_use]
    pub fn worst(&self) -> Option<&RegionMean> {
        let decided = self.means.iter().filter(|mean| mean.outcome != Outcome::Undecided);
        decided.max_by(|a, b| a.fraction().total_cmp(&b.fraction()))
    }

    /// The largest bound of a decided region. A difference of this size would be found in every such region.
    #[must_use]
    pub fn widest(&self) -> f64 {
        let decided = self.means.iter().filter(|mean| mean.outcome != Outcome::Undecided);
        decided.map(|mean| mean.bound).fold(0.0, f64::max)
    }
}

impl RegionMean {
    /// The difference relative to its bound: at most 1 if legal.
    #[must_use]
    pub fn fraction(&self) -> f64 {
        (self.found - self.expected).abs() / self.bound
    }
}

impl fmt::Display for RegionMean {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { region, channel, found, expected, bound, .. } = self;
        let name = channel_name(*channel);
        match region {
            Some([i, j]) => write!(f, "region ({i}, {j}): ")?,
            None => f.write_str("the whole picture: ")?,
        }
        write!(
            f,
            "the mean {name} is {found:.6}, the reference's is {expected:.6}, and a difference of {bound:.6} is legal"
        )
    }
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;

    const SIZE: [u32; 2] = [64, 48];

    /// An estimate of light by a few samples, some of which are fireflies.
    fn picture(seed: u64, scale: f64) -> Vec<[f64; 3]> {
        let mut random = Rng::with_seed(seed);
        let mut channel = |i: usize| {
            let sky = 0.2 + 0.6 * (i % 64) as f64 / 64.0;
            let firefly = if random.u32(0..500) == 0 { 5.0 } else { 0.0 };
            scale * (sky * 2.0 * random.f64() + firefly)
        };
        (0..SIZE[0] as usize * SIZE[1] as usize).map(|i| [channel(i), channel(i), channel(i)]).collect()
    }

    fn compare(found: &[[f64; 3]], expected: &[[f64; 3]]) -> Means {
        compare_mixed(found, expected, 0)
    }

    fn compare_mixed(found: &[[f64; 3]], expected: &[[f64; 3]], reach: u32) -> Means {
        Estimates { size: SIZE, samples: 4, reach, found, expected, ties: &[] }.compare()
    }

    fn noisy(random: &mut Rng, mean: f64) -> Vec<[f64; 3]> {
        (0..64 * 48).map(|_| [mean + 0.02 * (random.f64() - 0.5); 3]).collect()
    }

    #[test]
    fn estimates_of_the_same_light_are_never_accused() {
        for seed in 0..300 {
            let means = compare(&picture(2 * seed, 1.0), &picture(2 * seed + 1, 1.0));
            assert_eq!(means.count(Outcome::Violated), 0, "{:?}", means.worst());
        }
    }

    /// A picture in which each pixel is the mean of the pixels around it.
    fn mixed(picture: &[[f64; 3]], reach: i64) -> Vec<[f64; 3]> {
        let [width, height] = SIZE.map(i64::from);
        (0..width * height)
            .map(|index| {
                let (mut sum, mut count) = ([0.0; 3], 0.0);
                for y in (index / width - reach).max(0)..=(index / width + reach).min(height - 1) {
                    for x in (index % width - reach).max(0)..=(index % width + reach).min(width - 1) {
                        let other = picture[(y * width + x) as usize];
                        sum = std::array::from_fn(|i| sum[i] + other[i]);
                        count += 1.0;
                    }
                }
                sum.map(|c| c / count)
            })
            .collect()
    }

    #[test]
    fn mixed_pixels_are_not_taken_for_independent_ones() {
        let mut accused = 0;
        for seed in 0..40 {
            let [found, expected] = [2 * seed, 2 * seed + 1].map(|seed| mixed(&picture(seed, 1.0), 3));
            let means = compare_mixed(&found, &expected, 3);
            assert_eq!(means.count(Outcome::Violated), 0, "{:?}", means.worst());
            assert_eq!(means.means.len(), 6);
            // A comparison that ignores the mixing accuses a correct device.
            let means = compare(&found, &expected);
            accused += usize::from(means.outcome() == Outcome::Violated);
        }
        assert!(accused > 0);
        let mut random = Rng::with_seed(1);
        let [found, expected] = [0.52, 0.5].map(|mean| mixed(&noisy(&mut random, mean), 3));
        let means = compare_mixed(&found, &expected, 3);
        assert_eq!(means.outcome(), Outcome::Violated, "{means:?}");
    }

    #[test]
    fn another_light_is_found_and_so_is_a_region_with_none() {
        let exact: Vec<[f64; 3]> = vec![[0.5; 3]; 64 * 48];
        assert_eq!(compare(&exact, &exact).outcome(), Outcome::Proved);
        let brighter: Vec<[f64; 3]> = vec![[0.501; 3]; 64 * 48];
        assert_eq!(compare(&brighter, &exact).outcome(), Outcome::Violated);
        let mut random = Rng::with_seed(1);
        let mut noisy = |mean| noisy(&mut random, mean);
        let (right, wrong) = (noisy(0.5), noisy(0.52));
        assert_eq!(compare(&right, &noisy(0.5)).outcome(), Outcome::Proved);
        assert_eq!(compare(&wrong, &noisy(0.5)).outcome(), Outcome::Violated);
        let mut broken = right.clone();
        broken[100] = [f64::NAN; 3];
        assert_eq!(compare(&broken, &noisy(0.5)).outcome(), Outcome::Violated);
    }
}
