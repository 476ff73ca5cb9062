//! Sample points: they are as evenly spread as Owen-scrambled Sobol points must be, and pairs and pixels are
//! independent.
//!
//! The expected statistics are derived for Owen's scrambling with ideal random bits. Seeds are fixed.

use pinhole::camera::sampling::{pair, pixel_seed, unit};

const SEED: u32 = 11;

fn point(pixel: [u32; 2], sample: u32, number: u32) -> [f64; 2] {
    pair(pixel_seed(pixel, SEED), sample, number).map(unit)
}

/// In every aligned block of 2ᵐ samples, every box of 2⁻ᵃ by 2ᵃ⁻ᵐ contains one sample.
#[test]
fn every_aligned_block_is_a_net() {
    let addresses = [([0, 0], 0), ([1, 0], 0), ([0, 1], 1), ([1919, 1079], 7), ([u32::MAX; 2], 999)];
    for (pixel, number) in addresses {
        let seed = pixel_seed(pixel, SEED);
        for m in 0..=10_u32 {
            let last = u32::MAX >> m;
            for block in [0, 1, 2, 5, 1000, last / 2, last - 1, last].map(|b: u32| b.min(last)) {
                let samples = 0..1 << m;
                let points: Vec<_> = samples.map(|i| pair(seed, (block << m) + i, number)).collect();
                for a in 0..=m {
                    let mut is_taken = vec![false; 1 << m];
                    for [x, y] in points.iter().map(|point| point.map(u64::from)) {
                        let place = ((x << a) >> 32 << (m - a)) | ((y << (m - a)) >> 32);
                        assert!(!is_taken[place as usize], "{pixel:?}, {number}, {m}, {block}, {a}");
                        is_taken[place as usize] = true;
                    }
                }
            }
        }
    }
}

/// N times the expected square of the mean of (u − ½)(v − ½) over the first N samples, where u and v are
/// coordinates of two pairs, or of two pixels.
///
/// Let C(i, j) be the covariance of a coordinate of samples i and j; the expectation is ∑ C²(i, j)/N. Bits of
/// a coordinate, as signs, are uncorrelated with each other. If d is the highest bit in which i and j differ,
/// they still do after shuffling, those above are still equal, and those below become independent of each
/// other. So the first d bits of the coordinate agree with probability 2⁻ᵈ, and then the next one differs:
/// it contributes −2⁻ᵈ 4⁻ᵈ⁻²; all other bits cancel. With N 2ᵈ such pairs and C(i, i) = 1/12 it is
/// 1/144 + ∑ 2ᵈ 2^(−6d−8) = 1/144 + 2⁻⁸/(1 − 2⁻⁵).
const EXPECTED: f64 = 1.0 / 144.0 + 1.0 / (256.0 - 8.0);

/// The mean of N times that square over many tries, relative to the expectation.
fn relative_dependence(tries: u32, samples: u32, product: impl Fn(u32, u32) -> f64) -> f64 {
    let total: f64 = (0..tries)
        .map(|n| {
            let sum: f64 = (0..samples).map(|i| product(n, i)).sum();
            sum * sum / f64::from(samples)
        })
        .sum();
    total / f64::from(tries) / EXPECTED
}

/// Five standard deviations. The square of a nearly normal number varies by twice its squared expectation.
fn bound(tries: u32) -> f64 {
    5.0 * (2.0 / f64::from(tries)).sqrt()
}

#[test]
fn pairs_are_independent() {
    const TRIES: u32 = 4096;
    for samples in [16, 64, 256] {
        for (a, b) in [(0, 1), (1, 2), (0, 2), (6, 7), (3, 1 << 20)] {
            for (c, d) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let found = relative_dependence(TRIES, samples, |n, i| {
                    let pixel = [n % 64, n / 64];
                    (point(pixel, i, a)[c] - 0.5) * (point(pixel, i, b)[d] - 0.5)
                });
                assert!((found - 1.0).abs() < bound(TRIES), "{samples}, {a}.{c} and {b}.{d}: {found}");
            }
        }
    }
}

#[test]
fn pixels_are_independent() {
    const TRIES: u32 = 4096;
    for samples in [16, 64, 256] {
        for [x, y] in [[1, 0], [0, 1], [1, 1], [2, 0], [0, 4096]] {
            for c in [0, 1] {
                let found = relative_dependence(TRIES, samples, |n, i| {
                    // The pixels are far apart, so that no pixel is in two tries.
                    let pixel = [4 * (n % 64), 2 * (n / 64)];
                    let other = [pixel[0] + x, pixel[1] + y];
                    (point(pixel, i, 0)[c] - 0.5) * (point(other, i, 0)[c] - 0.5)
                });
                assert!((found - 1.0).abs() < bound(TRIES), "{samples}, {x}, {y}, {c}: {found}");
            }
        }
    }
}

/// One sample of each pixel. Its mean, and the mean products of neighbours, are those of independent uniform numbers.
#[test]
fn a_picture_of_one_sample_is_white_noise() {
    const SIDE: u32 = 256;
    let count = f64::from(SIDE * SIDE);
    for sample in [0, 1, 17] {
        for c in [0, 1] {
            let at = |x, y| point([x, y], sample, 0)[c] - 0.5;
            let mean = |f: &dyn Fn(u32, u32) -> f64| {
                let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
                pixels.map(|(x, y)| f(x, y)).sum::<f64>() / count
            };
            // Variances of a number and of a product of two independent ones: 1/12 and 1/144.
            let (once, twice) = (5.0 * (1.0 / 12.0 / count).sqrt(), 5.0 / 12.0 / count.sqrt());
            assert!(mean(&at).abs() < once);
            for [dx, dy] in [[1, 0], [0, 1], [1, 1], [2, 0], [0, 2]] {
                let product = mean(&|x, y| at(x, y) * at(x + dx, y + dy));
                assert!(product.abs() < twice, "{sample}, {c}, {dx}, {dy}: {product}");
            }
        }
    }
}

/// The slope of log(error) over log(samples) of the root mean square error of many pixels.
fn slope(error: impl Fn(u32) -> f64) -> f64 {
    let (few, many) = (16_u32, 4096_u32);
    (error(many) / error(few)).ln() / (f64::from(many) / f64::from(few)).ln()
}

/// For smooth functions, Owen's scrambling gives N^(−3/2), up to logarithms (Owen, "Scrambled net variance for
/// integrals of smooth functions", 1997); independent numbers give N^(−1/2).
#[test]
fn smooth_functions_are_integrated_well() {
    let smooth = |[x, y]: [f64; 2]| (x + 0.5 * y).exp() * (3.0 * x * y).cos();
    // Uses the midpoint rule, whose error is far below that of the samples.
    let n = 2000;
    let middle = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| [middle(i), middle(j)]));
    let exact = cells.map(smooth).sum::<f64>() / f64::from(n * n);
    let error = |numbers: &dyn Fn([u32; 2], u32) -> [f64; 2], samples: u32| {
        let pixels = (0..256).map(|n| [n % 16, n / 16]);
        let square = |pixel| {
            let sum: f64 = (0..samples).map(|i| smooth(numbers(pixel, i))).sum();
            (sum / f64::from(samples) - exact).powi(2)
        };
        (pixels.map(square).sum::<f64>() / 256.0).sqrt()
    };
    let found = slope(|samples| error(&|pixel, i| point(pixel, i, 3), samples));
    assert!(found < -1.2, "{found}");
    // The other half of the test. Points without nets fail it, such as one sample from each of many pairs.
    let independent = slope(|samples| error(&|pixel, i| point(pixel, 0, i), samples));
    assert!((independent + 0.5).abs() < 0.1, "{independent}");
}
