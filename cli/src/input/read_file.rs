//! Reads input files, and tells their formats from their names.

use std::fs::File;
use std::io::{Cursor, Read, Seek};
use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::bricks::EXTENSION;
use crate::terminal::failure::Failure;
use crate::terminal::memory;
use pinhole_data::load::{self, FileSet};

pub(crate) fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// Returns true if a file starts as one that is compressed.
pub(crate) fn is_compressed(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = load::open_regular(path).and_then(|file| file.take(16).read_to_end(&mut start));
    read.is_ok() && load::is_compressed(&start)
}

/// Bytes that are read first from standard input, whose size is not known.
const FIRST_PIECE: u64 = 1 << 20;

/// A file of which any part can be read.
pub(crate) trait ReadSeek: Read + Seek {}

impl<S: Read + Seek> ReadSeek for S {}

/// Opens a file of which parts are read. Standard input is read into memory.
pub(crate) fn open_seekable(path: &Path) -> Result<Box<dyn ReadSeek>> {
    if is_standard_input(path) {
        return Ok(Box::new(Cursor::new(read(path)?)));
    }
    Ok(Box::new(open(path)?))
}

/// Refuses a path at which something else than a regular file is, such as a pipe or a device.
pub(crate) fn check_regular(path: &Path) -> Result<()> {
    match path.metadata() {
        Ok(found) if found.is_dir() => bail!("{}: this is a folder; name a file", path.display()),
        Ok(found) if !found.is_file() && !is_standard_input(path) => bail!(
            "{}: this is not a regular file; copy it to a file, or give data on standard input, with - and --format",
            path.display()
        ),
        _ => Ok(()),
    }
}

/// Opens a regular file.
pub(crate) fn open(path: &Path) -> Result<File> {
    check_regular(path)?;
    load::open_regular(path).with_context(|| format!("{}: cannot be read", path.display()))
}

/// Reads a whole regular file, or standard input.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    if is_standard_input(path) {
        return read_all(path, std::io::stdin().lock(), 0);
    }
    read_open(path, open(path)?)
}

/// Reads a whole regular file that is open into memory of exactly its size.
pub(crate) fn read_open(path: &Path, file: File) -> Result<Vec<u8>> {
    let size = file.metadata().map_or(0, |metadata| metadata.len());
    read_all(path, file, size)
}

fn read_all(path: &Path, mut file: impl Read, size: u64) -> Result<Vec<u8>> {
    let cannot_read = || format!("{}: cannot be read", path.display());
    let what = format!("{}: reading {size} bytes needs", path.display());
    memory::check_reading(&what, size)?;
    let mut bytes = Vec::new();
    usize::try_from(size)
        .ok()
        .and_then(|size| bytes.try_reserve_exact(size).ok())
        .with_context(|| format!("{}: there is not enough memory for {size} bytes", path.display()))?;
    // The size of standard input is not known, so memory is checked again for each piece that is read.
    let mut piece = size.saturating_add(1).max(FIRST_PIECE);
    while file.by_ref().take(piece).read_to_end(&mut bytes).with_context(cannot_read)? as u64 == piece {
        piece = bytes.len() as u64;
        let what = format!("{}: reading more than {piece} bytes needs", path.display());
        memory::check_reading(&what, 2 * piece)?;
    }
    Ok(bytes)
}

/// The kind of an input file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Scene,
    Data(&'static load::Format),
    /// Spheres that `sort` divided among bricks.
    Bricks,
}

impl Format {
    /// Returns the format for the extension of a path, or the failure of a file that is missing or of another kind.
    pub(crate) fn of(path: &Path) -> Result<Self, Failure> {
        if let Some(set) = FileSet::of(path).with_context(|| path.display().to_string())? {
            let data = set.files().iter().map(|file| match Self::of(file)? {
                Self::Data(format) => Ok(format),
                _ => Err(Failure::usage(format!(
                    "{}: several files are seen together only if they are data; name one file",
                    file.display()
                ))),
            });
            // Frames are looked at when it is their turn.
            let looked_at = if set.are_frames() { 1 } else { set.files().len() };
            let formats = data.take(looked_at).collect::<Result<Vec<_>, Failure>>()?;
            if let Some(first) = formats.first() {
                return Ok(Self::Data(first));
            }
        }
        Self::of_name(path).map_err(|wrong| match is_standard_input(path) {
            true => Failure::Usage(wrong),
            false => open(path).map_or_else(Failure::Job, |_| Failure::Usage(wrong)),
        })
    }

    fn of_name(path: &Path) -> Result<Self> {
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
            _ => match load::Format::refused(path) {
                Some(refused) => bail!("{}: {refused}", path.display()),
                None => bail!(
                    "{}: this is not the extension of a format that can be read; use .toml (scene), \
                     {} (data), or .bin with --format raw-f32x4, or name the format of a data file with --format",
                    path.display(),
                    load::Format::extensions_of(|_| true)
                ),
            },
        }
    }
}

/// Returns the extension of a file name in lower case, without the dot.
pub(crate) fn extension(path: &Path) -> Option<String> {
    path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase)
}

/// Returns the format of a data file. What cannot be read is an error later, when it is.
pub(crate) fn data_format(path: &Path) -> Option<&'static load::Format> {
    let is_scene = extension(path).as_deref() == Some("toml");
    load::Format::of_path(path).ok().flatten().filter(|_| !is_scene)
}
