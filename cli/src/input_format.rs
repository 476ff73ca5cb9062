//! The kinds of input files, told by their names.

use std::path::Path;

use anyhow::{Result, bail};

use super::bricks::EXTENSION;
use super::failure::Failure;
use super::read_file::is_standard_input;
use pinhole::load;

/// The kind of an input file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Scene,
    Data(&'static load::Format),
    /// Spheres that `sort` divided among bricks.
    Bricks,
}

impl Format {
    /// Returns the format for the extension of a path.
    pub(super) fn of(path: &Path) -> Result<Self> {
        let extension = extension(path);
        match (data_format(path), extension.as_deref()) {
            (_, Some(EXTENSION)) => Ok(Self::Bricks),
            (Some(format), _) => Ok(Self::Data(format)),
            (None, Some("toml")) => Ok(Self::Scene),
            _ if is_standard_input(path) => {
                bail!("-: name the format of the data on standard input with --format")
            }
            (None, Some("bin")) => bail!(
                "{}: the extension .bin does not show the format; if the file has x, y, z, radius in \
                 little-endian f32, add --format raw-f32x4",
                path.display()
            ),
            _ => bail!(
                "{}: this is not the extension of a format that can be read; use .toml (scene), \
                 {} (data), or .bin with --format raw-f32x4, or name the format of a data file with --format",
                path.display(),
                load::Format::extensions_of(|_| true)
            ),
        }
    }
}

/// Returns the extension of a file name in lower case, without the dot.
pub(super) fn extension(path: &Path) -> Option<String> {
    path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase)
}

/// Returns the format of a data file. What cannot be read is an error later, when it is.
pub(super) fn data_format(path: &Path) -> Option<&'static load::Format> {
    let is_scene = extension(path).as_deref() == Some("toml");
    load::Format::of_path(path).ok().flatten().filter(|_| !is_scene)
}

/// Parses a size, such as `800x600`.
pub(super) fn parse_size(text: &str) -> Result<(u32, u32), Failure> {
    let sides = text.split_once(['x', 'X']);
    sides.and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?))).ok_or_else(
        || Failure::usage(format!("--size {text}: write WIDTHxHEIGHT in pixels, such as 800x600")),
    )
}
