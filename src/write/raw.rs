//! Writes spheres as raw numbers without a header: x, y, z and radius of each sphere in little-endian f32.

use std::io::{self, Write};

/// Writes spheres as 16 bytes each: x, y, z and radius in little-endian f32.
///
/// # Errors
/// If the sink fails.
pub fn write_spheres(spheres: &[[f32; 4]], mut sink: impl Write) -> io::Result<()> {
    let mut bytes = Vec::new();
    for chunk in spheres.chunks(1 << 12) {
        bytes.clear();
        bytes.extend(chunk.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        sink.write_all(&bytes)?;
    }
    sink.flush()
}
