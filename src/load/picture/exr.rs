//! Reads pictures from OpenEXR files.

use std::cell::RefCell;
use std::io::Cursor;

use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, SampleType};
use exr::prelude::{Compression, ReadChannels, ReadLayers, Text, Vec2, read as reader};

use super::file::{FileSamples, PictureFile, damaged, no_memory};
use crate::load::error::LoadError;
use crate::write::exr::CERTIFICATE;

const FORMAT: &str = "OpenEXR";

pub(super) fn read(bytes: &[u8]) -> Result<PictureFile, LoadError> {
    let failed = |error: exr::error::Error| damaged(FORMAT, &error);
    // The size is checked before the decoder allocates anything, because the decoder has no limit of its own.
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(failed)?;
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
    let memory = || no_memory(width, height);
    let count = width.checked_mul(height).ok_or_else(memory)?;
    // Deflate shrinks by less than 1032.
    if (count as u64).saturating_mul(16) > 1032 * bytes.len() as u64 {
        return Err(damaged(FORMAT, &"it is cut off"));
    }
    let mut room = Vec::new();
    room.try_reserve_exact(count).map_err(|_| memory())?;
    room.resize(count, [0.0; 4]);
    let room = RefCell::new(room);
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
        // A file that the decoder does not expect makes its threads panic, which would end the process.
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(failed)?;
    let certificate = match image.layer_data.attributes.other.get(&Text::new_or_panic(CERTIFICATE))
    {
        Some(AttributeValue::Text(text)) => Some(text.to_string()),
        _ => None,
    };
    let Vec2(width, height) = image.layer_data.size;
    let (_, pixels) = image.layer_data.channel_data.pixels;
    Ok(PictureFile {
        size: [width as u32, height as u32],
        samples: FileSamples::Linear(pixels),
        certificate,
    })
}

fn kind(found: &str) -> LoadError {
    let written = "one part with R, G, B and A in f32 and ZIP compression";
    LoadError::new(format!("the {FORMAT} file has {found}; this crate writes {written}"))
}
