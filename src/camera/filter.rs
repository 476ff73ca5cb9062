//! Pixel filters, and how samples are placed by them.
//!
//! Samples are not weighted but placed as densely as the filter is high, and count for one pixel alone: filter
//! importance sampling (M. Ernst, M. Stamminger, G. Greiner, "Filter Importance Sampling", IEEE Symposium on
//! Interactive Ray Tracing, 2006). All filters are products of one for each axis. Twin of [`offset`]:
//! `shaders/camera/filter.wgsl`.

use std::f64::consts::PI;

/// How far around a pixel's centre samples count for it, and how much. Distances are in pixels, along each axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "scene-file", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum PixelFilter {
    /// The pixel itself: the same for all within 0.5.
    Box,
    /// A normal distribution with a standard deviation of 0.5, less its value at the radius of 1.5, where it
    /// ends: the default of pbrt-v4.
    Gaussian,
    /// The Blackman-Harris window of four terms (F. J. Harris, "On the Use of Windows for Harmonic Analysis with
    /// the Discrete Fourier Transform", 1978) with a radius of 1.5: the default of Cycles.
    #[default]
    BlackmanHarris,
}

/// The parts into which a filter's half is cut for quadrature.
const CELLS: usize = 1024;

/// Entries of a table of offsets less one.
const STEPS: usize = 256;

impl PixelFilter {
    /// All of them.
    pub const ALL: &'static [Self] = &[Self::Box, Self::Gaussian, Self::BlackmanHarris];

    /// The name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Gaussian => "gaussian",
            Self::BlackmanHarris => "blackman-harris",
        }
    }

    /// The distance in pixels, along an axis, from which on nothing counts.
    #[must_use]
    pub const fn radius(self) -> f64 {
        match self {
            Self::Box => 0.5,
            Self::Gaussian | Self::BlackmanHarris => 1.5,
        }
    }

    /// How much a sample at a distance in pixels along an axis counts, relative to others.
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

    /// For [`offset`]: the distance in pixels from the centre, along an axis, to the left of which k/256 of the
    /// filter lies; from −radius to +radius, and symmetric to the bit.
    #[must_use]
    pub fn offset_table(&self) -> [f32; STEPS + 1] {
        let width = self.radius() / CELLS as f64;
        // Simpson's rule. A cell's error is of the order of 10⁻¹⁵ of the whole.
        let integral = |from: f64, to: f64| {
            let middle = self.weight(0.5 * (from + to));
            (to - from) / 6.0 * (self.weight(from) + 4.0 * middle + self.weight(to))
        };
        let edge = |cell: usize| cell as f64 * width;
        // Of the filter between the centre and the end of each cell.
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
            // Halved until f64 resolves no more.
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

/// A sample's distance in pixels from its pixel's centre, along an axis: the inverse of the filter's cumulative
/// distribution, for `u`/2³².
///
/// Between entries of the table it is interpolated, of `u` in steps of 2⁻²⁴. So the filter that samples follow is
/// piecewise constant: 256 pieces have 1/256 each, as those of the true one. Its cumulative distribution is off
/// by less than 1/512, and by as much only in the tails, where pieces are long.
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

    /// The part of a filter to the left of x, by the closed form, and of Gauss's by an alternating series of its
    /// own: ∫ exp(−2t²) = ∑ (−2)ⁿ x²ⁿ⁺¹/(n! (2n + 1)).
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
                // Odd cosines have changed sign, because angles count from the centre.
                let sines = 0.48829 * angle.sin()
                    + 0.14128 / 2.0 * (2.0 * angle).sin()
                    + 0.01168 / 3.0 * (3.0 * angle).sin();
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

    /// Entries are as exact as f32: what the distribution gains over half of an entry's last place.
    #[test]
    fn tables_invert_the_distribution() {
        for &filter in PixelFilter::ALL {
            for (k, &x) in filter.offset_table().iter().enumerate() {
                let found = cumulative(filter, f64::from(x));
                let bound =
                    density(filter, f64::from(x)) * f64::from(x).abs() * 2_f64.powi(-24) + 1e-13;
                let wanted = k as f64 / STEPS as f64;
                assert!((found - wanted).abs() <= bound, "{filter:?}, {k}: {found}");
            }
        }
    }

    /// The slope of that, from its difference around the centre.
    fn density(filter: PixelFilter, x: f64) -> f64 {
        let highest = (cumulative(filter, 1e-4) - cumulative(filter, -1e-4)) / 2e-4;
        filter.weight(x) / filter.weight(0.0) * highest
    }

    #[test]
    fn a_box_is_the_pixel_itself() {
        let table = PixelFilter::Box.offset_table();
        for u in [0, 1 << 8, 0x1234_5678, 1 << 31, u32::MAX] {
            let found = offset(&table, u);
            assert!(
                found.to_bits() == (crate::camera::sampling::unit(u) - 0.5).to_bits(),
                "{u}: {found}"
            );
        }
    }

    /// Where a piece has h in length and a filter's density rises or falls from a to b, the distribution is off by
    /// h |a − b|/4 at most: as if it jumped half-way.
    #[test]
    fn samples_follow_the_filter() {
        for &filter in PixelFilter::ALL {
            let table = filter.offset_table();
            let mut largest = 0.0_f64;
            for i in 0..1 << 16 {
                // In the middle of its share.
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
