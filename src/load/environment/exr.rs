//! Reads environment maps from OpenEXR files.

use std::cell::{Cell, RefCell};

use exr::error::Error;
use exr::image::read::layers::ReadChannels;
use exr::meta::MetaData;
use exr::meta::attribute::EnvironmentMap;
use exr::prelude::{Compression, ReadLayers, Vec2, read as reader};

use super::decoding::{Watched, black, damaged, refusal};
use crate::light::environment::Environment;
use crate::load::error::LoadError;

const FORMAT: &str = "OpenEXR";

/// Names of the channels that are read.
const CHANNELS: [&str; 3] = ["R", "G", "B"];

pub(super) fn read(bytes: &[u8]) -> Result<Environment, LoadError> {
    let at_end = Cell::new(false);
    let refused = |error: Error| refusal(FORMAT, bytes, &at_end, &error);
    let unreadable = |message: &str| Err(damaged(FORMAT, message));
    // The size is checked before the decoder allocates anything, because the decoder has no limit of its own.
    let meta =
        MetaData::read_from_buffered(Watched::new(bytes, &at_end), false).map_err(refused)?;
    let names = |channels: &[exr::meta::attribute::ChannelDescription]| -> Vec<String> {
        channels.iter().map(|channel| channel.name.to_string()).collect()
    };
    let has_color = |names: &[String]| CHANNELS.iter().all(|c| names.iter().any(|name| name == c));
    let with_color =
        meta.headers.iter().find(|header| has_color(&names(&header.channels.list)) && !header.deep);
    let Some(header) = with_color else {
        let first = meta.headers.first().map(|header| names(&header.channels.list).join(", "));
        let found = crate::text::one_line(&first.unwrap_or_default());
        let found = if found.is_empty() { "no channels".to_owned() } else { found };
        return Err(LoadError::new(format!(
            "no part of the OpenEXR file has the channels R, G and B, which are needed; the first part has {found}"
        )));
    };
    // The decoder of B44 overflows on damaged files (exr 1.74).
    let is_lossy = |compression| matches!(compression, Compression::B44 | Compression::B44A);
    if meta.headers.iter().any(|header| is_lossy(header.compression)) {
        return unreadable(
            "its compression is B44, which is not supported; save it with ZIP compression",
        );
    }
    if header.own_attributes.environment_map == Some(EnvironmentMap::Cube) {
        return unreadable("it is a cube map, but only equirectangular maps can be read");
    }
    let Vec2(width, height) = header.layer_size;
    let room = RefCell::new(black([width, height].map(|count| count as u64), FORMAT, bytes.len())?);
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
        // A file that the decoder does not expect makes its threads panic, which would end the process.
        .non_parallel()
        .from_buffered(Watched::new(bytes, &at_end))
        .map_err(refused)?;
    let size = image.layer_data.size;
    if size != header.layer_size {
        return unreadable("its first part with the channels R, G and B cannot be read");
    }
    let (_, texels) = image.layer_data.channel_data.pixels;
    let [width, height] = [size.width(), size.height()].map(|count| count as u32);
    Environment::new(width, height, texels).map_err(|error| LoadError::new(error.to_string()))
}
