//! Environment maps: equirectangular images of radiance from all directions, and the sampling of directions.
//!
//! Row 0 is up, +y, and all rows have the same height in latitude. The middle of the map is −z, the default direction
//! of view of a camera. To its right is +x. Radiance is constant within a texel, so that the density with which
//! directions are sampled can follow it exactly, and pictures do not depend on the texture filter of a device.
//!
//! Directions are sampled by luminance and solid angle, first the row and then the column. This follows M. Pharr, W.
//! Jakob and G. Humphreys, "Physically Based Rendering", 4th ed., 12.5, but uniformly in solid angle within a texel.
//! The tables are f32, and every random choice of a texel is exact in f32, so that a device chooses the same texel. The
//! WGSL twin is `shaders/scene/environment.wgsl`.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::camera::sampling::unit;
use crate::image::color::luminance;
use crate::parallel::{for_each, map};

/// The largest radiance, 2⁶⁴. Up to it, sums and products on a device stay far from infinity.
pub const MAX_RADIANCE: f32 = 18_446_744_073_709_551_616.0;

/// An equirectangular map of linear radiance.
#[derive(Clone, PartialEq)]
pub struct Environment {
    width: u32,
    height: u32,
    texels: Vec<[f32; 3]>,
    rows: Vec<f32>,
    columns: Vec<f32>,
}

/// The reason why texels do not make an environment map. Columns and rows count from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct EnvironmentError(String);

impl std::fmt::Debug for Environment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Environment({}×{})", self.width, self.height)
    }
}

impl Environment {
    /// Makes a map from its texels, row by row from the top. The ratio of width to height is free.
    ///
    /// A map larger than [`MAX_SIZE`] is reduced. Its size is divided by the smallest whole number that makes it fit,
    /// and rounded up. Each new texel is the mean, by solid angle, of the texels that it covers.
    ///
    /// # Errors
    /// Returns an error if the map is empty, the number of texels is wrong, or a component is NaN, negative or above
    /// [`MAX_RADIANCE`].
    pub fn new(width: u32, height: u32, texels: Vec<[f32; 3]>) -> Result<Self, EnvironmentError> {
        if width == 0 || height == 0 {
            return Err(EnvironmentError(format!(
                "a map of {width}×{height} texels is empty; width and height must be at least 1"
            )));
        }
        if u64::from(width) * u64::from(height) != texels.len() as u64 {
            return Err(EnvironmentError(format!(
                "a map of {width}×{height} texels was given {}; it needs width times height",
                texels.len()
            )));
        }
        let is_radiance = |texel: &[f32; 3]| texel.iter().all(|c| (0.0..=MAX_RADIANCE).contains(c));
        if let Some(index) = texels.iter().position(|texel| !is_radiance(texel)) {
            let (row, column) = (index / width as usize, index % width as usize);
            return Err(EnvironmentError(format!(
                "the texel in column {column} of row {row} is {:?}; radiance is a number from 0 to {MAX_RADIANCE:e}",
                texels[index]
            )));
        }
        let ([width, height], texels) = reduced([width, height], texels);
        let (rows, columns) = tables([width, height], &texels);
        Ok(Self { width, height, texels, rows, columns })
    }

    /// Number of columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Radiance of all texels, row by row from the top.
    #[must_use]
    pub fn texels(&self) -> &[[f32; 3]] {
        &self.texels
    }

    /// The cumulative distribution of rows: `height` + 1 multiples of 2⁻²⁴. For each row it has the probability that a
    /// sample lies above the row, and 1 at the end. All are zero if the map is black.
    #[must_use]
    pub fn rows(&self) -> &[f32] {
        &self.rows
    }

    /// The cumulative distributions of columns: `width` + 1 numbers for each row, for samples in that row. All are zero
    /// if the row is black.
    #[must_use]
    pub fn columns(&self) -> &[f32] {
        &self.columns
    }

    /// Returns true if at least one texel is not black.
    #[must_use]
    pub fn has_light(&self) -> bool {
        self.rows[self.height as usize] > 0.0
    }

    /// Cosine and sine, in f32 as on a device, of the rotation of the map about +y, from +z to +x.
    #[must_use]
    pub fn rotation(radians: f64) -> [f32; 2] {
        [radians.cos() as f32, radians.sin() as f32]
    }

    /// The radiance of the map in a direction of unit length.
    #[must_use]
    pub fn radiance(&self, direction: DVec3, rotation: [f32; 2]) -> [f64; 3] {
        let [column, row] = self.texel(direction, rotation);
        self.texels[row * self.width as usize + column].map(f64::from)
    }

    /// The probability density per steradian with which [`Environment::sample`] chooses a direction of unit length.
    ///
    /// It is positive where there is light.
    #[must_use]
    pub fn density(&self, direction: DVec3, rotation: [f32; 2]) -> f64 {
        self.density_of(self.texel(direction, rotation))
    }

    /// A direction of unit length for two uniform random numbers (in units of 2⁻³²), and its density per steradian. The
    /// density is zero only if the map is black.
    #[must_use]
    pub fn sample(&self, u: [u32; 2], rotation: [f32; 2]) -> (DVec3, f64) {
        let (row, down) = choose(&self.rows, u[1]);
        let (column, along) = choose(self.columns_of(row), u[0]);
        let longitude = TAU * ((column as f64 + along) / f64::from(self.width) - 0.5);
        // Measured from the nearer pole by sin²(θ/2) = (1 − cos θ)/2, which is proportional to area and does not
        // cancel.
        let height = self.height as usize;
        let is_upper = 2 * row < height;
        let (from_pole, along, sign) = if is_upper { (row, down, 1.0) } else { (height - 1 - row, 1.0 - down, -1.0) };
        let edge = |row: usize| (0.5 * PI * row as f64 / f64::from(self.height)).sin().powi(2);
        let (low, high) = (edge(from_pole), edge(from_pole + 1));
        let square = low + along * (high - low);
        let radius = 2.0 * (square * (1.0 - square)).sqrt();
        let (sine, cosine) = longitude.sin_cos();
        let in_map = DVec3::new(radius * sine, sign * (1.0 - 2.0 * square), -radius * cosine);
        (turned(in_map, rotation), self.density_of([column, row]))
    }

    /// Column and row of the texel in a direction of unit length.
    fn texel(&self, direction: DVec3, [cosine, sine]: [f32; 2]) -> [usize; 2] {
        let d = turned(direction, [cosine, -sine]);
        // Adding zero turns −0 into +0, because atan2 depends on the sign of zero.
        let across = (d.x + 0.0).atan2(0.0 - d.z) / TAU + 0.5;
        let down = d.x.hypot(d.z).atan2(d.y) / PI;
        [(across, self.width), (down, self.height)]
            .map(|(part, count)| ((part * f64::from(count)) as usize).min(count as usize - 1))
    }

    fn density_of(&self, [column, row]: [usize; 2]) -> f64 {
        let share = |table: &[f32], i: usize| f64::from(table[i + 1]) - f64::from(table[i]);
        let probability = share(&self.rows, row) * share(self.columns_of(row), column);
        probability / solid_angle([self.width, self.height], row)
    }

    fn columns_of(&self, row: usize) -> &[f32] {
        let length = self.width as usize + 1;
        &self.columns[row * length..][..length]
    }
}

/// A vector rotated about +y.
fn turned(d: DVec3, rotation: [f32; 2]) -> DVec3 {
    let [cosine, sine] = rotation.map(f64::from);
    DVec3::new(cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x)
}

/// The interval of a cumulative table that contains `u`/2³², and the position in that interval, in [0, 1].
///
/// The upper 24 bits choose the interval. The lower 8 bits refine the position, each at the middle of its step.
fn choose(table: &[f32], u: u32) -> (usize, f64) {
    let chance = unit(u);
    let index = table.partition_point(|sum| f64::from(*sum) <= chance).min(table.len() - 1) - 1;
    let [low, high] = [table[index], table[index + 1]].map(f64::from);
    let rest = (f64::from(u & 0xff) + 0.5) / f64::from(1 << 24) / 256.0;
    // Only a black map has smaller intervals, which are empty.
    let share = (high - low).max(1.0 / f64::from(1 << 24));
    (index, ((chance - low + rest) / share).min(1.0))
}

/// The largest numbers of columns and rows. Larger maps are reduced.
pub const MAX_SIZE: [u32; 2] = [4096, 2048];

/// Reduces a map that is too large. The new texels are the means, by solid angle, of the texels that they cover, so the
/// total light stays the same.
fn reduced(size: [u32; 2], texels: Vec<[f32; 3]>) -> ([u32; 2], Vec<[f32; 3]>) {
    let factor = (0..2).map(|axis| size[axis].div_ceil(MAX_SIZE[axis])).max().unwrap_or(1);
    if factor == 1 {
        return (size, texels);
    }
    let reduced = size.map(|count| count.div_ceil(factor));
    let [columns, rows] = [0, 1].map(|axis| covers(size[axis], reduced[axis]));
    let width = size[0] as usize;
    let lines = map(reduced[1] as usize, |row| {
        columns
            .iter()
            .map(|columns| {
                let (mut sum, mut total) = ([0.0; 3], 0.0);
                for &(row, from, to) in &rows[row] {
                    let edge = |row: f64| (PI * row / f64::from(size[1])).cos();
                    let height = edge(from) - edge(to);
                    for &(column, from, to) in columns {
                        let weight = height * (to - from);
                        let texel = texels[row * width + column].map(f64::from);
                        sum = std::array::from_fn(|i| sum[i] + weight * texel[i]);
                        total += weight;
                    }
                }
                sum.map(|component| (component / total) as f32)
            })
            .collect::<Vec<[f32; 3]>>()
    });
    (reduced, lines.concat())
}

/// For each of `few` equal parts of an axis of `many` texels, the texels that it covers, with the covered intervals.
fn covers(many: u32, few: u32) -> Vec<Vec<(usize, f64, f64)>> {
    // Positions are compared as fractions with the denominator `few`, so that no texel is missed and none is covered by
    // an interval of length zero.
    let (many, few) = (u64::from(many), u64::from(few));
    let at = |numerator: u64| numerator as f64 / few as f64;
    (0..few)
        .map(|i| {
            let (from, to) = (i * many, (i + 1) * many);
            (from / few..to.div_ceil(few))
                .map(|k| (k as usize, at(from.max(k * few)), at(to.min((k + 1) * few))))
                .collect()
        })
        .collect()
}

/// The solid angle of a texel in a row: 2π/width times the difference of the cosines of its edges' colatitudes, written
/// as a product.
fn solid_angle([width, height]: [u32; 2], row: usize) -> f64 {
    let half = 0.5 * PI / f64::from(height);
    2.0 * TAU / f64::from(width) * ((2 * row + 1) as f64 * half).sin() * half.sin()
}

/// The number of equal shares into which a table divides probability. f32 holds every multiple of 2⁻²⁴ up to 1, and the
/// differences of these multiples.
const SHARES: f64 = (1 << 24) as f64;

/// Makes the cumulative table of rows, and the tables of the columns of each row.
fn tables([width, height]: [u32; 2], texels: &[[f32; 3]]) -> (Vec<f32>, Vec<f32>) {
    let (columns, rows) = (width as usize, height as usize);
    let mut sums = vec![0.0; rows];
    let mut tables = vec![0.0; rows * (columns + 1)];
    let parts: Vec<_> =
        sums.iter_mut().zip(tables.chunks_mut(columns + 1)).zip(texels.chunks(columns)).enumerate().collect();
    for_each(parts, |(row, ((sum, table), texels))| {
        let weights = texels.iter().map(|texel| luminance(texel.map(f64::from)));
        *sum = fill(table, weights) * solid_angle([width, height], row);
    });
    let mut table = vec![0.0; rows + 1];
    fill(&mut table, sums.into_iter());
    (table, tables)
}

/// Fills a table with the cumulative distribution of weights, and returns their sum.
///
/// Each weight that is not zero gets one share for certain, so that no light is too faint to be sampled. The other
/// shares are distributed in proportion.
fn fill(table: &mut [f32], weights: impl Iterator<Item = f64> + Clone) -> f64 {
    let total: f64 = weights.clone().sum();
    if total == 0.0 {
        table.fill(0.0);
        return total;
    }
    let certain = weights.clone().filter(|weight| *weight > 0.0).count() as f64;
    let (mut before, mut sum) = (0.0, 0.0);
    table[0] = 0.0;
    for (entry, weight) in table[1..].iter_mut().zip(weights) {
        sum += weight;
        before += if weight > 0.0 { 1.0 } else { 0.0 };
        // The weights are added in the same order as for the total, so the last sum equals it.
        let shares: f64 = before + ((SHARES - certain) * (sum / total)).round();
        *entry = (shares / SHARES) as f32;
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_the_axis_once() {
        for (many, few) in [(4, 2), (5, 3), (8193, 2731), (9001, 3001)] {
            let covers = covers(many, few);
            let pieces: Vec<_> = covers.concat();
            assert!(pieces.iter().all(|(k, from, to)| { from < to && *from >= *k as f64 && *to <= *k as f64 + 1.0 }));
            let total: f64 = pieces.iter().map(|(_, from, to)| to - from).sum();
            assert!((total / f64::from(many) - 1.0).abs() < 1e-12, "{many}, {few}: {total}");
            assert_eq!(covers.len(), few as usize);
        }
        assert_eq!(covers(4, 2)[1], [(2, 2.0, 3.0), (3, 3.0, 4.0)]);
    }

    fn filled(weights: &[f64]) -> Vec<f32> {
        let mut table = vec![f32::NAN; weights.len() + 1];
        fill(&mut table, weights.iter().copied());
        table
    }

    #[test]
    fn shares_are_in_proportion_and_end_at_one() {
        assert_eq!(filled(&[1.0, 2.0, 1.0]), [0.0, 0.25, 0.75, 1.0]);
        assert_eq!(filled(&[0.0, 3.0, 0.0]), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(filled(&[0.0, 0.0]), [0.0, 0.0, 0.0]);
        let faint = filled(&[1e-30, 1e30, 1e-30, 0.0]);
        let shares = faint.windows(2).map(|pair| f64::from(pair[1] - pair[0]) * SHARES);
        assert_eq!(shares.collect::<Vec<_>>(), [1.0, SHARES - 2.0, 1.0, 0.0]);
    }
}
