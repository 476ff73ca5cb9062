//! Pixel filters, and the placement of samples by them.
//!
//! Samples are not weighted. They are placed with the density of the filter, and each counts for one pixel only. This
//! is filter importance sampling (M. Ernst, M. Stamminger, G. Greiner, "Filter Importance Sampling", IEEE Symposium on
//! Interactive Ray Tracing, 2006). Every filter is separable: a product of the same function of x and of y. [`offset`]
//! has a WGSL twin in `shaders/camera/filter.wgsl`.

use std::f64::consts::PI;

/// A pixel filter: the density of samples around a pixel's centre. Distances are in pixels, along each axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum PixelFilter {
    /// One weight everywhere within 0.5, which is the pixel itself.
    Box,
    /// A normal distribution with a standard deviation of 0.5, cut off at a radius of 1.5 and lowered by its value
    /// there, so that it ends at zero. This is the default of pbrt-v4.
    Gaussian,
    /// The Blackman-Harris window of four terms (F. J. Harris, "On the Use of Windows for Harmonic Analysis with the
    /// Discrete Fourier Transform", 1978) with a radius of 1.5. This is the default of Cycles.
    #[default]
    BlackmanHarris,
}

/// The number of parts into which half of a filter is cut for quadrature.
const CELLS: usize = 1024;

/// One less than the number of entries of an offset table.
const STEPS: usize = 256;

impl PixelFilter {
    /// All filters.
    pub const ALL: &'static [Self] = &[Self::Box, Self::Gaussian, Self::BlackmanHarris];

    /// The distance in pixels, along an axis, beyond which samples do not count.
    #[must_use]
    pub const fn radius(self) -> f64 {
        match self {
            Self::Box => 0.5,
            Self::Gaussian | Self::BlackmanHarris => 1.5,
        }
    }

    /// The relative weight of a sample at a distance in pixels along an axis. It is not normalized.
    #[must_use]
    pub fn weight(self, distance: f64) -> f64 {
        let radius = self.radius();
        if distance.abs() > radius {
            return 0.0;
        }
        match self {
            Self::Box => 1.0,
            Self::Gaussian => {
                let normal = |x: f64| (-2.0 * x * x).exp();
                normal(distance) - normal(radius)
            }
            Self::BlackmanHarris => {
                let angle = PI * (distance / radius + 1.0);
                let [a, b, c] = [1.0, 2.0, 3.0].map(|k| (k * angle).cos());
                0.35875 - 0.48829 * a + 0.14128 * b - 0.01168 * c
            }
        }
    }

    /// The table that [`offset`] interpolates. Entry k is the distance in pixels from the centre, along an axis, with
    /// k/256 of the filter to its left. Entries go from −radius to +radius and are symmetric to the bit.
    #[must_use]
    pub fn offset_table(&self) -> [f32; STEPS + 1] {
        let width = self.radius() / CELLS as f64;
        // Simpson's rule. The error of a cell is of the order of 10⁻¹⁵ of the whole integral.
        let integral = |from: f64, to: f64| {
            let middle = self.weight(0.5 * (from + to));
            (to - from) / 6.0 * (self.weight(from) + 4.0 * middle + self.weight(to))
        };
        let edge = |cell: usize| cell as f64 * width;
        // The integral of the filter from the centre to the end of each cell.
        let mut total = 0.0;
        let sums: Vec<f64> = (0..CELLS)
            .map(|cell| {
                total += integral(edge(cell), edge(cell + 1));
                total
            })
            .collect();
        let mut table = [0.0; STEPS + 1];
        for k in 1..=STEPS / 2 {
            let wanted = total * k as f64 / (STEPS / 2) as f64;
            let cell = sums.partition_point(|sum| *sum < wanted).min(CELLS - 1);
            let before = if cell == 0 { 0.0 } else { sums[cell - 1] };
            // Bisection until f64 resolves no more.
            let (mut low, mut high) = (edge(cell), edge(cell + 1));
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if before + integral(edge(cell), middle) < wanted {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let offset = if k == STEPS / 2 { self.radius() } else { high } as f32;
            table[STEPS / 2 + k] = offset;
            table[STEPS / 2 - k] = -offset;
        }
        table
    }
}

/// The distance in pixels of a sample from a pixel's centre, along an axis. It is the inverse of the filter's
/// cumulative distribution at `u`/2³².
///
/// Between entries, the table is interpolated linearly, with `u` in steps of 2⁻²⁴. So samples follow a piecewise
/// constant filter. Each of its 256 pieces has 1/256 of the weight, as with the exact filter. The cumulative
/// distribution is off by less than 1/512, and by that much only in the tails, where pieces are long.
#[must_use]
pub fn offset(table: &[f32; STEPS + 1], u: u32) -> f64 {
    let index = (u >> 24) as usize;
    let fraction = f64::from((u >> 8) & 0xffff) / f64::from(1 << 16);
    let [low, high] = [table[index], table[index + 1]].map(f64::from);
    low + fraction * (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The fraction of a filter to the left of x. The Gaussian uses an alternating series, ∫ exp(−2t²) = ∑ (−2)ⁿ
    /// x²ⁿ⁺¹/(n! (2n + 1)), and the others use the closed form.
    fn cumulative(filter: PixelFilter, x: f64) -> f64 {
        let radius = filter.radius();
        let from_center = |x: f64| match filter {
            PixelFilter::Box => x,
            PixelFilter::Gaussian => {
                let mut power = x;
                let mut sum = -x * (-4.5_f64).exp();
                for n in 0..60 {
                    let n = f64::from(n);
                    sum += power / (2.0 * n + 1.0);
                    power *= -2.0 * x * x / (n + 1.0);
                }
                sum
            }
            PixelFilter::BlackmanHarris => {
                let angle = PI * x / radius;
                // Cosines of odd multiples have the opposite sign, because angles are measured from the centre here.
                let sines =
                    0.48829 * angle.sin() + 0.14128 / 2.0 * (2.0 * angle).sin() + 0.01168 / 3.0 * (3.0 * angle).sin();
                0.35875 * x + sines * radius / PI
            }
        };
        0.5 + 0.5 * from_center(x) / from_center(radius)
    }

    #[test]
    fn tables_are_symmetric_and_end_at_the_radius() {
        for &filter in PixelFilter::ALL {
            let table = filter.offset_table();
            let radius = filter.radius() as f32;
            for k in 0..=STEPS {
                assert_eq!(table[k].to_bits() << 1, table[STEPS - k].to_bits() << 1);
                assert!((table[k] + table[STEPS - k]).to_bits() == 0, "{filter:?}, {k}");
            }
            assert_eq!(
                [table[0], table[STEPS / 2], table[STEPS]].map(f32::to_bits),
                [(-radius).to_bits(), 0, radius.to_bits()]
            );
            assert!(table.is_sorted_by(|a, b| a < b), "{filter:?}");
        }
    }

    /// Entries are as exact as f32 allows. The bound is the change of the distribution over half a unit in the last
    /// place.
    #[test]
    fn tables_invert_the_distribution() {
        for &filter in PixelFilter::ALL {
            for (k, &x) in filter.offset_table().iter().enumerate() {
                let found = cumulative(filter, f64::from(x));
                let bound = density(filter, f64::from(x)) * f64::from(x).abs() * 2_f64.powi(-24) + 1e-13;
                let wanted = k as f64 / STEPS as f64;
                assert!((found - wanted).abs() <= bound, "{filter:?}, {k}: {found}");
            }
        }
    }

    /// The density of the filter at x: its weight, scaled by the slope of [`cumulative`] at the centre.
    fn density(filter: PixelFilter, x: f64) -> f64 {
        let highest = (cumulative(filter, 1e-4) - cumulative(filter, -1e-4)) / 2e-4;
        filter.weight(x) / filter.weight(0.0) * highest
    }

    #[test]
    fn a_box_is_the_pixel_itself() {
        let table = PixelFilter::Box.offset_table();
        for u in [0, 1 << 8, 0x1234_5678, 1 << 31, u32::MAX] {
            let found = offset(&table, u);
            assert!(found.to_bits() == (crate::camera::sampling::unit(u) - 0.5).to_bits(), "{u}: {found}");
        }
    }

    /// If the density of a filter rises or falls from a to b over a piece of length h, the distribution is off by at
    /// most h |a − b|/4, which is the error if the density jumps half-way.
    #[test]
    fn samples_follow_the_filter() {
        for &filter in PixelFilter::ALL {
            let table = filter.offset_table();
            let mut largest = 0.0_f64;
            for i in 0..1 << 16 {
                // The middle of the i-th of 2¹⁶ equal parts.
                let u = (i << 16) + (1 << 15);
                let piece = (u >> 24) as usize;
                let [a, b] = [table[piece], table[piece + 1]].map(f64::from);
                let bound = 0.25 * (b - a) * (density(filter, a) - density(filter, b)).abs();
                let x = offset(&table, u);
                let error = (cumulative(filter, x) - crate::camera::sampling::unit(u)).abs();
                assert!(error < bound + 1e-7, "{filter:?}, {u:x}: {error}");
                largest = largest.max(error);
            }
            assert!(largest < 1.0 / 512.0, "{filter:?}: {largest}");
        }
    }
}
