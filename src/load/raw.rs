//! Reads spheres from nothing but numbers: little-endian f32, x, y, z, radius, sphere after sphere.

use super::numbers::{Layout, rows};
use crate::scene::sphere_array::SphereArray;

/// Bytes of a sphere.
const SPHERE: usize = 16;

/// Why bytes are no list of spheres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RawError {
    /// Part of a sphere is left over.
    #[error(
        "{bytes} bytes are {} spheres of {SPHERE} bytes (x, y, z, radius in little-endian f32), and {} bytes are left over",
        bytes / SPHERE, bytes % SPHERE
    )]
    LeftOver {
        /// How many bytes there are.
        bytes: usize,
    },
    /// There is no memory for so many.
    #[error("there is no memory for {count} spheres")]
    Memory {
        /// How many there are.
        count: usize,
    },
}

/// Reads spheres.
///
/// # Errors
/// If part of a sphere is left over.
pub fn read_spheres(bytes: &[u8]) -> Result<SphereArray, RawError> {
    if !bytes.len().is_multiple_of(SPHERE) {
        return Err(RawError::LeftOver { bytes: bytes.len() });
    }
    let count = bytes.len() / SPHERE;
    let layout = Layout { rows: count, columns: 4, by_column: false };
    let spheres = rows(bytes, layout, f32::from_le_bytes, 0.0);
    spheres.map(SphereArray::F32).map_err(|_| RawError::Memory { count })
}
