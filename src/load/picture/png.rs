//! Reads pictures from PNG files.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

use super::file::{FileSamples, PictureFile, damaged, no_memory};
use crate::image::encoding::Bits;
use crate::load::error::LoadError;
use crate::write::png::CERTIFICATE;

const FORMAT: &str = "PNG";

pub(super) fn read(bytes: &[u8]) -> Result<PictureFile, LoadError> {
    let failed = |error: png::DecodingError| damaged(FORMAT, &error);
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: usize::MAX });
    decoder.set_transformations(Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(failed)?;
    let info = reader.info();
    let (width, height) = (info.width, info.height);
    let bits = match info.bit_depth {
        BitDepth::Eight => Bits::Eight,
        BitDepth::Sixteen => Bits::Sixteen,
        other => return Err(kind(&format!("samples of {} bits", other as u8))),
    };
    let has_alpha = match info.color_type {
        ColorType::Rgb => false,
        ColorType::Rgba => true,
        other => return Err(kind(&format!("samples of the kind {other:?}"))),
    };
    let memory = || no_memory(width as usize, height as usize);
    let size = reader.output_buffer_size().ok_or_else(memory)?;
    // Deflate shrinks by less than 1032, so that a short file cannot ask for much memory.
    if size as u64 > 1032 * bytes.len() as u64 + 1032 {
        return Err(damaged(FORMAT, &"it is cut off"));
    }
    let mut samples = Vec::new();
    samples.try_reserve_exact(size).map_err(|_| memory())?;
    samples.resize(size, 0);
    reader.next_frame(&mut samples).map_err(failed)?;
    reader.finish().map_err(failed)?;
    let texts = &reader.info().uncompressed_latin1_text;
    let certificate = texts.iter().find(|text| text.keyword == CERTIFICATE);
    Ok(PictureFile {
        size: [width, height],
        samples: FileSamples::Encoded { bits, has_alpha, bytes: samples },
        certificate: certificate.map(|text| text.text.clone()),
    })
}

fn kind(found: &str) -> LoadError {
    let written = "RGB and RGBA with 8 or 16 bits";
    LoadError::new(format!("the {FORMAT} file has {found}; this crate writes {written}"))
}
