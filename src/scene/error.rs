//! Why spheres and an appearance do not make a scene.

use glam::DVec3;

use crate::geometry::math::MAX_LENGTH;
use crate::scene::sphere::SphereError;

/// Why spheres and an appearance do not make a scene.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A sphere is out of range.
    #[error("sphere {index}: {error}")]
    Sphere {
        /// Index in input order.
        index: usize,
        /// What is wrong with it.
        error: SphereError,
    },
    /// There is not enough memory for all spheres.
    #[error("there is not enough memory for {count} spheres, which need {} bytes", count * 16)]
    Memory {
        /// The number of spheres given.
        count: usize,
    },
    /// The frame's origin is NaN, infinite or too far away.
    #[error("its origin {:?} is out of range; every coordinate must be finite and at most {MAX_LENGTH:e} in size", origin.to_array())]
    Origin {
        /// The origin as given.
        origin: DVec3,
    },
    /// A sphere of a part is outside of the box of the whole scene.
    #[error("sphere {index} is outside of the scene that it should be a part of")]
    OutsideOfWhole {
        /// Index in the part.
        index: usize,
    },
    /// The palette index of a sphere is out of range.
    #[error(
        "sphere {index} has no color: its index is out of range; the palette has {colors} colors"
    )]
    Color {
        /// Index in input order.
        index: usize,
        /// The number of colours in the palette.
        colors: usize,
    },
    /// The index of a sphere's surface properties is out of range.
    #[error("the surface index of sphere {index} is out of range; there are {surfaces} surfaces")]
    SurfaceProperties {
        /// Index in input order.
        index: usize,
        /// The number of sets of surface properties.
        surfaces: usize,
    },
    /// A sphere has the number NaN, for which a colour map has no colour.
    #[error("sphere {index} has the number NaN, which has no color")]
    Scalar {
        /// Index in input order.
        index: usize,
    },
    /// A list with one entry for each sphere has the wrong length.
    #[error(
        "{}: there are {found} for {spheres} spheres",
        if found < spheres { format!("sphere {found} has no {what}") } else { format!("{what} {spheres} has no sphere") }
    )]
    Count {
        /// What the list contains.
        what: &'static str,
        /// The length of the list.
        found: usize,
        /// The number of spheres, which the length should be.
        spheres: usize,
    },
    /// There are more spheres than ids.
    #[error("{count} spheres are too many; ids are u32 and {} means a miss", u32::MAX)]
    TooMany {
        /// The number of spheres given.
        count: usize,
    },
}
