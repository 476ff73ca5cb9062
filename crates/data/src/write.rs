//! Writes spheres to a sink: as an array of NumPy, and as raw numbers.

use std::io::{self, BufWriter, Write};

use npyz::WriterBuilder;

/// Writes spheres as an `.npy` file of shape (n, 4): x, y, z, radius in float32 and C order.
///
/// # Errors
/// Returns an error if the sink fails.
pub fn npy(spheres: &[[f32; 4]], sink: impl Write) -> io::Result<()> {
    let mut sink = BufWriter::new(sink);
    let shape = [spheres.len() as u64, 4];
    let options = npyz::WriteOptions::new().default_dtype().shape(&shape);
    let mut writer = options.writer(&mut sink).begin_nd()?;
    writer.extend(spheres.as_flattened().iter().copied())?;
    writer.finish()?;
    sink.flush()
}

/// Writes spheres without a header, as 16 bytes each: x, y, z and radius in little-endian f32.
///
/// # Errors
/// Returns an error if the sink fails.
pub fn raw(spheres: &[[f32; 4]], mut sink: impl Write) -> io::Result<()> {
    let mut bytes = Vec::new();
    for chunk in spheres.chunks(1 << 12) {
        bytes.clear();
        bytes.extend(chunk.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        sink.write_all(&bytes)?;
    }
    sink.flush()
}
