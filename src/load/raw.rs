//! Reads spheres from raw numbers without a header: x, y, z and radius of each sphere in little-endian f32.

use super::error::LoadError;
use super::numbers::{Layout, rows};
use crate::scene::sphere_array::SphereArray;

/// Bytes per sphere.
const SPHERE_BYTES: usize = 16;

/// Reads spheres of 16 bytes each: x, y, z and radius in little-endian f32.
///
/// # Errors
/// If the number of bytes is not a multiple of 16, or there is not enough memory.
pub fn read_spheres(bytes: &[u8]) -> Result<SphereArray, LoadError> {
    if !bytes.len().is_multiple_of(SPHERE_BYTES) {
        let (bytes, whole, left) =
            (bytes.len(), bytes.len() / SPHERE_BYTES, bytes.len() % SPHERE_BYTES);
        return Err(LoadError::new(format!(
            "the file has {bytes} bytes, which are {whole} × {SPHERE_BYTES} + {left}, but each sphere takes {SPHERE_BYTES} \
             bytes (x, y, z, radius in little-endian f32); the file is cut off or has another format"
        )));
    }
    let count = bytes.len() / SPHERE_BYTES;
    let layout = Layout { rows: count, columns: 4, by_column: false };
    let spheres = rows(bytes, layout, f32::from_le_bytes, 0.0);
    let memory = |_| LoadError::new(format!("there is not enough memory for {count} spheres"));
    spheres.map(SphereArray::F32).map_err(memory)
}
