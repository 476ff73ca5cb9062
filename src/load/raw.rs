//! Reads spheres from raw numbers without a header: x, y, z and radius of each sphere in little-endian f32.

use super::numbers::{Layout, rows};
use crate::scene::sphere_array::SphereArray;

/// Bytes per sphere.
const SPHERE_BYTES: usize = 16;

/// An error of reading raw spheres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RawError {
    /// The number of bytes is not a multiple of the size of a sphere.
    #[error(
        "the file has {bytes} bytes, which are {} × {SPHERE_BYTES} + {}, but each sphere takes {SPHERE_BYTES} bytes \
         (x, y, z, radius in little-endian f32); the file is cut off or has another format",
        bytes / SPHERE_BYTES, bytes % SPHERE_BYTES
    )]
    LeftOver {
        /// Number of bytes in the file.
        bytes: usize,
    },
    /// There is not enough memory for the spheres.
    #[error("there is not enough memory for {count} spheres")]
    Memory {
        /// Number of spheres.
        count: usize,
    },
}

/// Reads spheres of 16 bytes each: x, y, z and radius in little-endian f32.
///
/// # Errors
/// If the number of bytes is not a multiple of 16, or there is not enough memory.
pub fn read_spheres(bytes: &[u8]) -> Result<SphereArray, RawError> {
    if !bytes.len().is_multiple_of(SPHERE_BYTES) {
        return Err(RawError::LeftOver { bytes: bytes.len() });
    }
    let count = bytes.len() / SPHERE_BYTES;
    let layout = Layout { rows: count, columns: 4, by_column: false };
    let spheres = rows(bytes, layout, f32::from_le_bytes, 0.0);
    spheres.map(SphereArray::F32).map_err(|_| RawError::Memory { count })
}
