//! Reads pictures that the writers of this crate made: the unchanged samples of a PNG or an OpenEXR file, and the
//! certificate in the file.
//!
//! Programs that show pictures look at more than the samples: at gamma, windows, frames. So a certified file must be what
//! the writer makes of its samples and its certificate. Of a PNG that holds for all chunks but those of samples, which
//! must be one whole stream; of an OpenEXR file for each byte, apart from the order of attributes.

use std::io::Read;

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
/// Returns an error if the file is neither a PNG nor an OpenEXR file, is damaged, is of a kind that this crate does not
/// write, or has a certificate and anything beside the picture that this crate does not write.
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

/// The number of bytes before the chunks of a PNG, which the decoder checks.
const SIGNATURE: usize = 8;

/// A chunk of a PNG or an attribute of an OpenEXR file: its name, and all its bytes.
type Part<'a> = (&'a [u8], &'a [u8]);

/// Refuses parts of a file that differ from those that the writer makes.
fn check_parts(kind: &str, found: &[Part<'_>], written: &[Part<'_>]) -> Result<(), LoadError> {
    let is_named = |parts: &[Part<'_>], name: &[u8]| parts.iter().any(|part| part.0 == name);
    let added = found.iter().find(|part| !written.contains(part)).map(|part| part.0);
    let absent = written.iter().find(|part| !is_named(found, part.0)).map(|part| part.0.escape_ascii());
    Err(not_as_written(&match (added, absent) {
        (Some(name), _) if is_named(written, name) => {
            format!("its {kind} {} is not the one that `pinhole render` writes", name.escape_ascii())
        }
        (Some(name), _) => format!("it has the {kind} {}, which `pinhole render` does not write", name.escape_ascii()),
        (None, Some(name)) => format!("it lacks the {kind} {name}, which `pinhole render` writes"),
        (None, None) if found == written => return Ok(()),
        (None, None) => format!("it has one {kind} of `pinhole render` twice or in another place"),
    }))
}

fn not_as_written(difference: &str) -> LoadError {
    let rest = "so that viewers may show another picture; verify the file that render wrote";
    LoadError::new(format!("{difference}, {rest}"))
}

/// Splits a PNG into its chunks.
fn chunks(bytes: &[u8]) -> Result<Vec<Part<'_>>, LoadError> {
    let mut parts = Vec::new();
    let (_, mut rest) = bytes.split_at(SIGNATURE.min(bytes.len()));
    while let Some((length, named)) = rest.split_first_chunk() {
        // A chunk has its length, its name, its data and a checksum.
        let size = (u32::from_be_bytes(*length) as usize).saturating_add(12);
        let (Some(name), Some((chunk, others))) = (named.get(..4), rest.split_at_checked(size)) else { break };
        parts.push((name, chunk));
        rest = others;
        if name == b"IEND" && !rest.is_empty() {
            return Err(not_as_written("data follow its end"));
        }
    }
    if rest.is_empty() { Ok(parts) } else { Err(damaged("PNG", &"it is cut off")) }
}

/// Checks that a certified PNG of `size` bytes of samples and filters has only what the writer makes.
fn check_png(bytes: &[u8], without_samples: &[u8], size: usize) -> Result<(), LoadError> {
    let is_samples = |part: &Part<'_>| part.0 == b"IDAT";
    let (mut found, mut written) = (chunks(bytes)?, chunks(without_samples)?);
    let data = |part: &Part<'_>| part.1[8..part.1.len() - 4].to_vec();
    let stream: Vec<u8> = found.iter().filter(|part| is_samples(part)).flat_map(data).collect();
    // All chunks of samples that follow each other count as one.
    found.iter_mut().filter(|part| is_samples(part)).for_each(|part| part.1 = &[]);
    found.dedup_by(|a, b| is_samples(a) && is_samples(b));
    written.insert(written.len() - 1, (b"IDAT", &[]));
    check_parts("chunk", &found, &written)?;
    let mut inflated = flate2::bufread::ZlibDecoder::new(&*stream).take(size as u64 + 1);
    let count = std::io::copy(&mut inflated, &mut std::io::sink()).map_err(|error| damaged("PNG", &error))?;
    match count == size as u64 && inflated.into_inner().into_inner().is_empty() {
        true => Ok(()),
        false => Err(not_as_written("its stream of samples is not as long as the picture")),
    }
}

/// Splits the header of an OpenEXR file into the version and the sorted attributes, and returns what follows.
fn attributes(bytes: &[u8]) -> Option<(Vec<Part<'_>>, &[u8])> {
    let (version, mut rest) = bytes.split_at_checked(8)?;
    let mut parts = vec![(&b"version"[..], version)];
    loop {
        // An attribute has a name, a kind, the size of its value, and its value. An empty name is the end.
        let mut texts = rest.splitn(3, |byte| *byte == 0);
        let (name, _, sized) = (texts.next()?, texts.next()?, texts.next()?);
        if name.is_empty() {
            parts.sort_unstable();
            return Some((parts, &rest[1..]));
        }
        let (size, value) = sized.split_first_chunk()?;
        let (_, others) = value.split_at_checked(u32::from_le_bytes(*size) as usize)?;
        parts.push((name, &rest[..rest.len() - others.len()]));
        rest = others;
    }
}

fn read_png(bytes: &[u8]) -> Result<PictureFile, LoadError> {
    use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

    use crate::write::png::{CERTIFICATE, begin};

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
    let texts = &info.uncompressed_latin1_text;
    let certificate = texts.iter().find(|text| text.keyword == CERTIFICATE).map(|text| text.text.clone());
    if certificate.is_some() {
        let kind = (info.color_type, info.bit_depth);
        let per_metre = info.pixel_dims.filter(|dims| dims.xppu == dims.yppu).map(|dims| dims.xppu);
        let mut written = Vec::new();
        let begun = begin(&mut written, [width, height], kind, per_metre, certificate.as_deref());
        drop(begun.map_err(|error| damaged("PNG", &error))?);
        // Each row begins with the number of its filter.
        check_png(bytes, &written, size + sides[1])?;
    }
    // Deflate shrinks data by a factor below 1032, so a short file cannot ask for much memory.
    if size as u64 > 1032 * bytes.len() as u64 + 1032 {
        return Err(damaged("PNG", &"it is cut off"));
    }
    let mut samples = room(size, 0, sides)?;
    reader.next_frame(&mut samples).map_err(failed)?;
    reader.finish().map_err(failed)?;
    Ok(PictureFile {
        size: [width, height],
        samples: FileSamples::Encoded { bits, has_alpha, bytes: samples },
        certificate,
    })
}

fn read_exr(bytes: &[u8]) -> Result<PictureFile, LoadError> {
    use std::cell::{Cell, RefCell};

    use exr::meta::MetaData;
    use exr::meta::attribute::{AttributeValue, SampleType};
    use exr::prelude::{Compression, ReadChannels, ReadLayers, Text, Vec2, read as reader};

    use super::environment::FileBytes;
    use crate::write::exr::{CERTIFICATE, encode_certified};

    let failed = |error: exr::error::Error| damaged("OpenEXR", &error);
    let written = "one part with R, G, B and A in f32 and ZIP compression, or with a certificate and no compression";
    let kind = |found: &str| of_other_kind("OpenEXR", found, written);
    // The size is checked before the decoder allocates anything, because the decoder has no limit of its own.
    // The reader for environments is used, so that the decoder is compiled only once.
    let at_end = Cell::new(false);
    let meta = MetaData::read_from_buffered(FileBytes::new(bytes, &at_end), false).map_err(failed)?;
    let [header] = &*meta.headers else {
        return Err(kind(&format!("{} parts", meta.headers.len())));
    };
    let name = Text::new_or_panic(CERTIFICATE);
    let certificate = match header.own_attributes.other.get(&name) {
        Some(AttributeValue::Text(text)) => Some(text.to_string()),
        _ => None,
    };
    let compression = if certificate.is_some() { Compression::Uncompressed } else { Compression::ZIP16 };
    if header.deep || header.compression != compression {
        return Err(kind(&format!("the compression {}", header.compression)));
    }
    let channels = &header.channels.list;
    let has = |name: &str| channels.iter().any(|c| c.name == *name && c.sample_type == SampleType::F32);
    if !["R", "G", "B", "A"].into_iter().all(has) {
        return Err(kind("other channels"));
    }
    let Vec2(width, height) = header.layer_size;
    let count = width.checked_mul(height).ok_or_else(|| no_memory(width, height))?;
    // Deflate shrinks data by a factor below 1032.
    let factor = if certificate.is_some() { 1 } else { 1032 };
    if (count as u64).saturating_mul(16) > factor * bytes.len() as u64 {
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
    let Vec2(width, height) = image.layer_data.size;
    let (_, pixels) = image.layer_data.channel_data.pixels;
    if let Some(certificate) = &certificate {
        let expected =
            encode_certified([width, height], &pixels, certificate).map_err(|error| damaged("OpenEXR", &error))?;
        let (Some((found, rest)), Some((written, samples))) = (attributes(bytes), attributes(&expected)) else {
            return Err(damaged("OpenEXR", &"its header is cut off"));
        };
        check_parts("attribute", &found, &written)?;
        if rest != samples {
            return Err(not_as_written("its rows are stored in another way, or data follow its end"));
        }
    }
    Ok(PictureFile { size: [width as u32, height as u32], samples: FileSamples::Linear(pixels), certificate })
}
