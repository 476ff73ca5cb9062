//! Writes spheres as nothing but numbers: little-endian f32, x, y, z, radius, sphere after sphere.

use std::io::{self, Write};

/// Writes spheres, each of 16 bytes.
///
/// # Errors
/// Those of the sink.
pub fn write_spheres(spheres: &[[f32; 4]], mut sink: impl Write) -> io::Result<()> {
    let mut bytes = Vec::new();
    for chunk in spheres.chunks(1 << 12) {
        bytes.clear();
        bytes.extend(chunk.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        sink.write_all(&bytes)?;
    }
    sink.flush()
}
