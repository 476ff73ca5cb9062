//! Environment maps: equirectangular images of radiance from all directions, and how to sample them.
//!
//! Row 0 is up, +y, and all rows have the same height in latitude. The middle of the map is −z, the default direction
//! of view of a camera; to its right is +x. Radiance is constant within a texel, so that the density with which
//! directions are sampled can follow it exactly, and pictures do not depend on the texture filter of a device.
//!
//! Directions are sampled by luminance and solid angle, first the row and then the column, after M. Pharr, W. Jakob and
//! G. Humphreys, "Physically Based Rendering", 4th ed., 12.5, but uniformly in solid angle within a texel. The tables
//! are f32, and every random choice of a texel is exact in f32, so that a device chooses the same texel. The WGSL twin
//! is `shaders/scene/environment.wgsl`.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::camera::sampling::unit;

mod reduce;
mod shares;

use shares::solid_angle;

pub use reduce::MAX_SIZE;

/// The largest radiance, 2⁶⁴: sums and products on a device stay far from infinity.
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

/// Why texels do not make an environment map. Columns and rows count from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The map has no texels.
    #[error("a map of {width}×{height} texels is empty; width and height must be at least 1")]
    Empty {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
    },
    /// The number of texels differs from width times height.
    #[error("a map of {width}×{height} texels was given {found}; it needs width times height")]
    TexelCount {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// The number of texels given.
        found: usize,
    },
    /// A texel has a component that is NaN, negative or above [`MAX_RADIANCE`].
    #[error(
        "the texel in column {column} of row {row} is {value:?}; radiance is a number from 0 to {MAX_RADIANCE:e}"
    )]
    Texel {
        /// Column of the texel.
        column: usize,
        /// Row of the texel.
        row: usize,
        /// The texel as given.
        value: [f32; 3],
    },
}

impl std::fmt::Debug for Environment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Environment({}×{})", self.width, self.height)
    }
}

impl Environment {
    /// A map from its texels, row by row from the top. The ratio of width to height is free.
    ///
    /// A map larger than [`MAX_SIZE`] is reduced: its size is divided by the smallest whole number that makes it fit,
    /// rounded up, and each new texel is the mean, by solid angle, of the texels that it covers.
    ///
    /// # Errors
    /// Returns an error if the map is empty, the number of texels is wrong, or a component is NaN, negative or above
    /// [`MAX_RADIANCE`].
    pub fn new(width: u32, height: u32, texels: Vec<[f32; 3]>) -> Result<Self, EnvironmentError> {
        if width == 0 || height == 0 {
            return Err(EnvironmentError::Empty { width, height });
        }
        if u64::from(width) * u64::from(height) != texels.len() as u64 {
            return Err(EnvironmentError::TexelCount { width, height, found: texels.len() });
        }
        let is_radiance = |texel: &[f32; 3]| texel.iter().all(|c| (0.0..=MAX_RADIANCE).contains(c));
        if let Some(index) = texels.iter().position(|texel| !is_radiance(texel)) {
            let (row, column) = (index / width as usize, index % width as usize);
            return Err(EnvironmentError::Texel { column, row, value: texels[index] });
        }
        let ([width, height], texels) = reduce::reduced([width, height], texels);
        let (rows, columns) = shares::tables([width, height], &texels);
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

    /// The cumulative distribution of rows, `height` + 1 numbers: for each row the probability that a sample lies above
    /// it, and 1 at the end. Multiples of 2⁻²⁴; all zero if the map is black.
    #[must_use]
    pub fn rows(&self) -> &[f32] {
        &self.rows
    }

    /// The cumulative distributions of columns, `width` + 1 numbers for each row, for samples in that row. All zero if
    /// the row is black.
    #[must_use]
    pub fn columns(&self) -> &[f32] {
        &self.columns
    }

    /// Whether some texel is not black.
    #[must_use]
    pub fn has_light(&self) -> bool {
        self.rows[self.height as usize] > 0.0
    }

    /// Cosine and sine, in f32 as a device has them, of the angle by which the map is turned about +y, from +z to +x.
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

    /// A direction of unit length for two uniform random numbers (fractions of 2³²), and its density per steradian,
    /// which is zero only if the map is black.
    #[must_use]
    pub fn sample(&self, u: [u32; 2], rotation: [f32; 2]) -> (DVec3, f64) {
        let (row, down) = choose(&self.rows, u[1]);
        let (column, along) = choose(self.columns_of(row), u[0]);
        let longitude = TAU * ((column as f64 + along) / f64::from(self.width) - 0.5);
        // Measured from the nearer pole by sin²(θ/2) = (1 − cos θ)/2, which is proportional to area and does not
        // cancel.
        let height = self.height as usize;
        let is_upper = 2 * row < height;
        let (from_pole, along, sign) =
            if is_upper { (row, down, 1.0) } else { (height - 1 - row, 1.0 - down, -1.0) };
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

/// The interval of a cumulative table into which a fraction of 2³² falls, and the position in that interval, in [0, 1].
///
/// The upper 24 bits choose the interval; the lower 8 bits refine the position, each at the middle of its step.
fn choose(table: &[f32], u: u32) -> (usize, f64) {
    let chance = unit(u);
    let index = table.partition_point(|sum| f64::from(*sum) <= chance).min(table.len() - 1) - 1;
    let [low, high] = [table[index], table[index + 1]].map(f64::from);
    let rest = (f64::from(u & 0xff) + 0.5) / f64::from(1 << 24) / 256.0;
    // A black map has only empty intervals; no other interval is smaller than this.
    let share = (high - low).max(1.0 / f64::from(1 << 24));
    (index, ((chance - low + rest) / share).min(1.0))
}
