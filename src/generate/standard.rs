//! The standard scenes of the benchmarks.

use super::{GenerateError, Kind};
use crate::camera::film::{Film, FilmError};
use crate::camera::{CameraError, PinholeCamera, Pose};

/// A standard scene of the benchmarks, with its view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Standard {
    /// A million random spheres.
    R1M,
    /// Ten million random spheres.
    R10M,
    /// A lattice of 63³ cells, seen from outside along a corner.
    L1M,
    /// 200,000 spheres in clusters.
    C200k,
}

impl Standard {
    /// All standard scenes.
    pub const ALL: &'static [Self] = &[Self::R1M, Self::R10M, Self::L1M, Self::C200k];

    /// The seed of all standard scenes.
    pub const SEED: u64 = 1;

    /// The name of the scene.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::R1M => "R1M",
            Self::R10M => "R10M",
            Self::L1M => "L1M",
            Self::C200k => "C200k",
        }
    }

    /// The number of spheres.
    #[must_use]
    pub const fn count(self) -> u64 {
        match self {
            Self::R1M => 1_000_000,
            Self::R10M => 10_000_000,
            Self::L1M => 4 * 63 * 63 * 63,
            Self::C200k => 200_000,
        }
    }

    /// The arrangement of the spheres.
    #[must_use]
    pub const fn kind(self) -> Kind {
        match self {
            Self::R1M | Self::R10M => Kind::Random,
            Self::L1M => Kind::Lattice,
            Self::C200k => Kind::Clusters,
        }
    }

    /// The spheres (x, y, z, radius).
    ///
    /// # Errors
    /// Returns an error if there is not enough memory.
    pub fn spheres(self) -> Result<Vec<[f32; 4]>, GenerateError> {
        self.kind().spheres(self.count(), Self::SEED)
    }

    /// The camera: its view plane is at distance 1.5 and has the half extent (1, 1).
    ///
    /// # Errors
    /// This never fails, because the values are in range.
    pub fn camera(self) -> Result<PinholeCamera, CameraError> {
        let (eye, look_at) = match self {
            Self::R1M | Self::R10M | Self::C200k => ([0.5, 0.6, -1.2], [0.5, 0.5, 0.5]),
            Self::L1M => ([-0.25, 1.10, -0.15], [0.6, 0.98, 0.55]),
        };
        PinholeCamera::new(Pose::looking_at(eye, look_at, [0.0, 1.0, 0.0])?, 1.5, [1.0, 1.0])
    }

    /// The film: 1024×1024.
    ///
    /// # Errors
    /// This never fails, because the size is in range.
    pub fn film(self) -> Result<Film, FilmError> {
        Film::new(1024, 1024)
    }
}
