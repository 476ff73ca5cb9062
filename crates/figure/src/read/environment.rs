//! Reads environment maps from Radiance HDR and OpenEXR files. The maps are equirectangular, with the zenith at the
//! upper edge.
//!
//! Texels are taken as they are, as linear radiance with the primaries of Rec. 709. Exposures, colour corrections and
//! chromaticities that a file declares are not applied.

use std::cell::{Cell, RefCell};
use std::io::{Cursor, Read, Seek, SeekFrom};

use exr::error::Error;
use exr::image::read::layers::ReadChannels;
use exr::meta::MetaData;
use exr::meta::attribute::EnvironmentMap;
use exr::prelude::{Compression, ReadLayers, Vec2, read as reader};
use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;

use pinhole::light::environment::Environment;
use pinhole_data::load::{LoadError, LoadErrorKind};

/// Reads an environment map. The first bytes of the file show its format.
///
/// The first part of an OpenEXR file with the channels R, G and B is read.
///
/// # Errors
/// Returns an error if the file has neither format, is damaged or too large, or has an invalid radiance.
pub fn read(bytes: &[u8]) -> Result<Environment, LoadError> {
    if bytes.starts_with(b"#?") {
        return read_hdr(bytes);
    }
    if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        return read_exr(bytes);
    }
    Err(LoadError::new("this is neither a Radiance HDR nor an OpenEXR file; convert the image to one of them"))
}

/// The largest number of texels that a file may have: 16,384 × 8192.
pub const MAX_TEXELS: u64 = 1 << 27;

fn cut_off(format: &str, bytes: usize) -> LoadError {
    let message = format!("the {format} file is incomplete: it ends after {bytes} bytes, before its image does");
    LoadError::new(message).of_kind(LoadErrorKind::CutOff)
}

fn damaged(format: &str, message: &str) -> LoadError {
    LoadError::new(format!("the {format} file is damaged or of a kind that cannot be read: {message}"))
}

/// Limit on the number of texels that a file may declare for each of its bytes. Both formats stay below it: 172
/// with deflate, at three halves per texel, and about 1,400 with long runs in Radiance's oldest encoding.
const TEXELS_PER_BYTE: u64 = 2048;

/// Number of texels that a file of any length may declare.
const SMALL: u64 = 1 << 20;

/// Allocates a black image. Its size comes from a header that may be wrong, so the size is refused if a file of
/// `bytes` bytes cannot hold it.
fn black([width, height]: [u64; 2], format: &'static str, bytes: usize) -> Result<Vec<[f32; 3]>, LoadError> {
    let texels = width.saturating_mul(height);
    if texels > MAX_TEXELS {
        return Err(LoadError::new(format!(
            "the image has {width}×{height} texels, more than the limit of {MAX_TEXELS}; use a smaller image"
        )));
    }
    if texels > SMALL.max(TEXELS_PER_BYTE.saturating_mul(bytes as u64)) {
        return Err(cut_off(format, bytes));
    }
    let mut room = Vec::new();
    room.try_reserve_exact(texels as usize)
        .map_err(|_| LoadError::new(format!("there is not enough memory for {texels} texels; use a smaller image")))?;
    room.resize(texels as usize, [0.0; 3]);
    Ok(room)
}

/// A file in memory that records whether a decoder tried to read beyond its end. Decoders report that differently.
pub(super) struct FileBytes<'a> {
    bytes: Cursor<&'a [u8]>,
    at_end: &'a Cell<bool>,
}

impl<'a> FileBytes<'a> {
    pub(super) fn new(bytes: &'a [u8], at_end: &'a Cell<bool>) -> Self {
        Self { bytes: Cursor::new(bytes), at_end }
    }
}

impl Read for FileBytes<'_> {
    fn read(&mut self, target: &mut [u8]) -> std::io::Result<usize> {
        let count = self.bytes.read(target)?;
        if count < target.len() {
            self.at_end.set(true);
        }
        Ok(count)
    }
}

impl Seek for FileBytes<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.bytes.seek(to)
    }
}

/// Returns the error for a decoder that gave up, with its message.
fn refusal(format: &'static str, bytes: &[u8], at_end: &Cell<bool>, message: &impl ToString) -> LoadError {
    if at_end.get() {
        return cut_off(format, bytes.len());
    }
    damaged(format, &pinhole::internals::text::one_line(&message.to_string()))
}

const OPENEXR: &str = "OpenEXR";

const CHANNELS: [&str; 3] = ["R", "G", "B"];

fn read_exr(bytes: &[u8]) -> Result<Environment, LoadError> {
    let at_end = Cell::new(false);
    let refused = |error: Error| refusal(OPENEXR, bytes, &at_end, &error);
    let unreadable = |message: &str| Err(damaged(OPENEXR, message));
    // The size is checked before the decoder allocates anything, because the decoder has no limit of its own.
    let meta = MetaData::read_from_buffered(FileBytes::new(bytes, &at_end), false).map_err(refused)?;
    let names = |channels: &[exr::meta::attribute::ChannelDescription]| -> Vec<String> {
        channels.iter().map(|channel| channel.name.to_string()).collect()
    };
    let has_color = |names: &[String]| CHANNELS.iter().all(|c| names.iter().any(|name| name == c));
    let with_color = meta.headers.iter().find(|header| has_color(&names(&header.channels.list)) && !header.deep);
    let Some(header) = with_color else {
        let first = meta.headers.first().map(|header| names(&header.channels.list).join(", "));
        let found = pinhole::internals::text::one_line(&first.unwrap_or_default());
        let found = if found.is_empty() { "no channels".to_owned() } else { found };
        return Err(LoadError::new(format!(
            "no part of the OpenEXR file has the channels R, G and B, which are needed; the first part has {found}"
        )));
    };
    // The decoder of B44 overflows on damaged files (exr 1.74).
    let is_lossy = |compression| matches!(compression, Compression::B44 | Compression::B44A);
    if meta.headers.iter().any(|header| is_lossy(header.compression)) {
        return unreadable("its compression is B44, which is not supported; save it with ZIP compression");
    }
    if header.own_attributes.environment_map == Some(EnvironmentMap::Cube) {
        return unreadable("it is a cube map, but only equirectangular maps can be read");
    }
    let Vec2(width, height) = header.layer_size;
    let room = RefCell::new(black([width, height].map(|count| count as u64), OPENEXR, bytes.len())?);
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.width(), room.take()),
            |(width, texels), at, (red, green, blue): (f32, f32, f32)| {
                let index = at.y() * *width + at.x();
                if let Some(texel) = texels.get_mut(index) {
                    *texel = [red, green, blue];
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        // Unexpected files make the decoder's threads panic, which would end the process.
        .non_parallel()
        .from_buffered(FileBytes::new(bytes, &at_end))
        .map_err(refused)?;
    let size = image.layer_data.size;
    if size != header.layer_size {
        return unreadable("its first part with the channels R, G and B cannot be read");
    }
    let (_, texels) = image.layer_data.channel_data.pixels;
    let [width, height] = [size.width(), size.height()].map(|count| count as u32);
    Environment::new(width, height, texels).map_err(|error| LoadError::new(error.to_string()))
}

const RADIANCE: &str = "Radiance HDR";

fn read_hdr(bytes: &[u8]) -> Result<Environment, LoadError> {
    let at_end = Cell::new(false);
    let refused = |error| refusal(RADIANCE, bytes, &at_end, &error);
    if has_empty_runs(bytes) {
        return Err(damaged(RADIANCE, "it has several empty runs of pixels in a row"));
    }
    // The decoder must not be strict: the signature may also be `#?RGBE`, and headers have lines of all kinds.
    let decoder = HdrDecoder::with_strictness(FileBytes::new(bytes, &at_end), false).map_err(refused)?;
    let (width, height) = decoder.dimensions();
    let mut texels = black([width, height].map(u64::from), RADIANCE, bytes.len())?;
    decoder.read_image(bytemuck::cast_slice_mut(&mut texels)).map_err(refused)?;
    Environment::new(width, height, texels).map_err(|error| LoadError::new(error.to_string()))
}

/// Whether the file has eight run markers in a row, the last four of which are empty. No encoder writes that, and
/// the decoder's multiplier for such a run overflows (image 0.25.10).
fn has_empty_runs(bytes: &[u8]) -> bool {
    const MARKER: usize = 4;
    let is_marker = |marker: &[u8]| marker[..3] == [1, 1, 1];
    bytes.windows(8 * MARKER).any(|run| {
        // The rarest condition is tested first.
        run.ends_with(&[1, 1, 1, 0])
            && run.chunks(MARKER).all(is_marker)
            && run[4 * MARKER..].chunks(MARKER).all(|marker| marker[3] == 0)
    })
}
