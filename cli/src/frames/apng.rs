//! Movies as animated PNG.

use std::io::{self, BufWriter, Write};

use png::{BitDepth, ColorType, Compression, EncodingError, Filter, SrgbRenderingIntent};

use super::sink::{Samples, Sink};
use pinhole::image::encoding::Bits;

/// Writes pictures that repeat without end.
pub(super) fn write(sink: &Sink<'_>, samples: &Samples<'_>, file: impl Write) -> io::Result<()> {
    let failed = |error: EncodingError| match error {
        EncodingError::IoError(error) => error,
        error => io::Error::other(error),
    };
    let [width, height] = sink.size;
    let mut encoder = png::Encoder::new(BufWriter::new(file), width, height);
    let is_transparent = sink.encoding.transparent();
    encoder.set_color(if is_transparent { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(match sink.encoding.bits() {
        Bits::Sixteen => BitDepth::Sixteen,
        _ => BitDepth::Eight,
    });
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    let count = u32::try_from(sink.count).map_err(io::Error::other)?;
    encoder.set_animated(count, 0).map_err(failed)?;
    // At most 240, as the flag allows.
    let per_second = u16::try_from(sink.frames_per_second).unwrap_or(u16::MAX);
    encoder.set_frame_delay(1, per_second).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    while let Some(picture) = samples.next()? {
        writer.write_image_data(&picture).map_err(failed)?;
    }
    writer.finish().map_err(failed)
}
