//! Reads pictures that the writers of this crate made: the unchanged samples of a PNG or an OpenEXR file, and the
//! certificate in the file.

use pinhole::image::encoding::Bits;
use pinhole::internals::text::one_line;
use pinhole_data::load::LoadError;

/// A picture as a file stores it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PictureFile {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The samples, row by row from the top.
    pub samples: FileSamples,
    /// The text of the certificate, if the file has one.
    pub certificate: Option<String>,
}

/// The samples of a picture in a file.
#[derive(Clone, Debug, PartialEq)]
pub enum FileSamples {
    /// Samples of a PNG: RGB or RGBA, each of one byte, or of two with the high byte first.
    Encoded {
        /// The bits of each sample.
        bits: Bits,
        /// Whether there is an alpha channel.
        has_alpha: bool,
        /// The samples.
        bytes: Vec<u8>,
    },
    /// Samples of an OpenEXR file: red, green, blue and alpha.
    Linear(Vec<[f32; 4]>),
}

/// Reads a picture from the bytes of its file.
///
/// # Errors
/// Returns an error if the file is neither a PNG nor an OpenEXR file, is damaged, or is of a kind that this crate does
/// not write.
pub fn read(bytes: &[u8]) -> Result<PictureFile, LoadError> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => read_png(bytes),
        [0x76, 0x2f, 0x31, 0x01, ..] => read_exr(bytes),
        _ => Err(LoadError::new("this is neither a PNG nor an OpenEXR file; pictures of `pinhole render` are")),
    }
}

fn damaged(format: &str, error: &impl ToString) -> LoadError {
    let message = one_line(&error.to_string());
    LoadError::new(format!("the {format} file cannot be read: {message}"))
}

/// The error of a file that this crate could not have written.
fn of_other_kind(format: &str, found: &str, written: &str) -> LoadError {
    LoadError::new(format!("the {format} file has {found}; this crate writes {written}"))
}

/// Makes room for `count` samples. Callers have refused headers that declare more than the file can hold.
fn room<T: Clone>(count: usize, sample: T, [width, height]: [usize; 2]) -> Result<Vec<T>, LoadError> {
    let mut room = Vec::new();
    room.try_reserve_exact(count).map_err(|_| no_memory(width, height))?;
    room.resize(count, sample);
    Ok(room)
}

fn no_memory(width: usize, height: usize) -> LoadError {
    LoadError::new(format!("there is not enough memory for a picture of {width}x{height} pixels"))
}

fn read_png(bytes: &[u8]) -> Result<PictureFile, LoadError> {
    use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

    use crate::write::png::CERTIFICATE;

    let failed = |error: png::DecodingError| damaged("PNG", &error);
    let kind = |found: &str| of_other_kind("PNG", found, "RGB and RGBA with 8 or 16 bits");
    let mut decoder = Decoder::new_with_limits(std::io::Cursor::new(bytes), Limits { bytes: usize::MAX });
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
    let sides = [width, height].map(|side| side as usize);
    let size = reader.output_buffer_size().ok_or_else(|| no_memory(sides[0], sides[1]))?;
    // Deflate shrinks data by a factor below 1032, so a short file cannot ask for much memory.
    if size as u64 > 1032 * bytes.len() as u64 + 1032 {
        return Err(damaged("PNG", &"it is cut off"));
    }
    let mut samples = room(size, 0, sides)?;
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

fn read_exr(bytes: &[u8]) -> Result<PictureFile, LoadError> {
    use std::cell::{Cell, RefCell};

    use exr::meta::MetaData;
    use exr::meta::attribute::{AttributeValue, SampleType};
    use exr::prelude::{Compression, ReadChannels, ReadLayers, Text, Vec2, read as reader};

    use super::environment::FileBytes;
    use crate::write::exr::CERTIFICATE;

    let failed = |error: exr::error::Error| damaged("OpenEXR", &error);
    let written = "one part with R, G, B and A in f32 and ZIP compression";
    let kind = |found: &str| of_other_kind("OpenEXR", found, written);
    // The size is checked before the decoder allocates anything, because the decoder has no limit of its own.
    // The reader for environments is used, so that the decoder is compiled only once.
    let at_end = Cell::new(false);
    let meta = MetaData::read_from_buffered(FileBytes::new(bytes, &at_end), false).map_err(failed)?;
    let [header] = &*meta.headers else {
        return Err(kind(&format!("{} parts", meta.headers.len())));
    };
    if header.deep || header.compression != Compression::ZIP16 {
        return Err(kind(&format!("the compression {}", header.compression)));
    }
    let channels = &header.channels.list;
    if ["R", "G", "B", "A"]
        .iter()
        .any(|name| !channels.iter().any(|c| c.name == **name && c.sample_type == SampleType::F32))
    {
        return Err(kind("other channels"));
    }
    let Vec2(width, height) = header.layer_size;
    let count = width.checked_mul(height).ok_or_else(|| no_memory(width, height))?;
    // Deflate shrinks data by a factor below 1032.
    if (count as u64).saturating_mul(16) > 1032 * bytes.len() as u64 {
        return Err(damaged("OpenEXR", &"it is cut off"));
    }
    let room = RefCell::new(room(count, [0.0; 4], [width, height])?);
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.width(), room.take()),
            |(width, pixels), at, (r, g, b, a): (f32, f32, f32, f32)| {
                if let Some(pixel) = pixels.get_mut(at.y() * *width + at.x()) {
                    *pixel = [r, g, b, a];
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        // Unexpected files make the decoder's threads panic, which would end the process.
        .non_parallel()
        .from_buffered(FileBytes::new(bytes, &at_end))
        .map_err(failed)?;
    let certificate = match image.layer_data.attributes.other.get(&Text::new_or_panic(CERTIFICATE)) {
        Some(AttributeValue::Text(text)) => Some(text.to_string()),
        _ => None,
    };
    let Vec2(width, height) = image.layer_data.size;
    let (_, pixels) = image.layer_data.channel_data.pixels;
    Ok(PictureFile { size: [width as u32, height as u32], samples: FileSamples::Linear(pixels), certificate })
}
