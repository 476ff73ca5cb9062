//! Opens one file of spheres, as a whole or frame by frame, and chooses its format. The topology, a file that describes
//! the spheres of a trajectory, is opened in the same way.

use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use super::compressed::{Compression, decompressed};
use super::dataset::Dataset;
use super::error::{LoadError, LoadErrorKind, Place};
use super::file_rows::FileRows;
use super::format::{Format, FrameIndex, Frames, Options, ReadMethod, read_from_memory};
use super::source::{Source, start_of};
use super::topology::Topology;

/// Reads one file, or its first frame.
pub(super) fn open_file(path: &Path, options: &Options) -> Result<Dataset, LoadError> {
    let failed = |error: io::Error| LoadError::from(error).in_file(path);
    let mut source = Source::open(path).map_err(failed)?;
    let format = format_of(path, options, &mut source).map_err(|error| error.in_file(path))?;
    if format.has_frames() {
        return OpenFile::find(path, &options.clone().with_format(format), Some(0))?.into_frame(0);
    }
    if let Source::Plain(reader) = &source
        && let Some(rows) = FileRows::find(format, reader.get_ref(), options).map_err(|error| error.in_file(path))?
    {
        return rows.read().map_err(|error| error.in_file(path));
    }
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes).map_err(failed)?;
    format.read(&bytes, options)
}

/// The format of an open file. Compressed data that cannot be of it are refused before they are decompressed.
fn format_of(path: &Path, options: &Options, source: &mut Source) -> Result<&'static Format, LoadError> {
    let first = source.start()?;
    let format = options.format.map_or_else(|| Format::of_file(path, &first), Ok)?;
    format.check(options)?;
    if matches!(source, Source::Compressed(_)) {
        format.check_start(&first)?;
    }
    Ok(format)
}

/// Reads a file of spheres that is in memory. `name` is the name of the file, or empty. Only its extension is used, to
/// choose the format as [`open`](super::open) does. The topology in the options is the only file that is opened.
///
/// # Errors
/// Returns an error if the bytes cannot be read, their format is not known, or an option does not apply to it.
pub fn from_bytes(bytes: &[u8], name: impl AsRef<Path>, options: &Options) -> Result<Dataset, LoadError> {
    let format = match options.format {
        Some(format) => format,
        None => Format::of_file(name.as_ref(), &start_of(bytes)?)?,
    };
    format.read(bytes, options)
}

impl Format {
    /// Reads a file of this format, which may be compressed.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or an option does not apply to this format.
    pub fn read(&self, bytes: &[u8], options: &Options) -> Result<Dataset, LoadError> {
        self.check(options)?;
        if let Some(compression) = Compression::of(bytes) {
            self.check_start(&start_of(bytes)?)?;
            return self.read_plain(&decompressed(bytes, compression)?, options);
        }
        self.read_plain(bytes, options)
    }

    /// Refuses compressed data whose first bytes show that they are not of this format.
    fn check_start(&self, first: &[u8]) -> Result<(), LoadError> {
        let may_be = match self.is_text {
            true => !first.contains(&0),
            false => self.extensions.is_empty() || (self.starts)(first),
        };
        let message =
            || LoadError::new(format!("what is compressed here does not start as the format {} does", self.name));
        may_be.then_some(()).ok_or_else(message)
    }

    /// Reads a file that is not compressed.
    fn read_plain(&self, bytes: &[u8], options: &Options) -> Result<Dataset, LoadError> {
        match self.method {
            ReadMethod::Whole(read) => read(bytes, options),
            ReadMethod::Frames(frames) => read_from_memory(bytes, frames, options, open_topology(options)?),
        }
    }
}

/// Reads the first frame of the topology that the options name, if they name one.
fn open_topology(options: &Options) -> Result<Option<Topology>, LoadError> {
    let Some(path) = options.topology.as_deref() else { return Ok(None) };
    let loaded = open_file(path, &Options::default()).map_err(|error| {
        let place = match error.place {
            Place::File(_) => Place::Whole,
            place => place,
        };
        let error = LoadError { place, ..error };
        LoadError::new(format!("the topology {}: {error}", path.display()))
    })?;
    Ok(Some(Topology::new(path.to_path_buf(), loaded)))
}

/// A file whose frames were found.
#[derive(Debug)]
pub(super) struct OpenFile {
    path: PathBuf,
    source: Source,
    frames: Frames,
    index: FrameIndex,
    options: Options,
}

impl OpenFile {
    /// Finds the frames of a file, up to the last that is wanted.
    pub(super) fn find(path: &Path, options: &Options, last: Option<usize>) -> Result<Self, LoadError> {
        let of_file = |error: LoadError| error.in_file(path);
        let mut source = Source::open(path).map_err(|error| of_file(error.into()))?;
        let format = format_of(path, options, &mut source).map_err(of_file)?;
        let ReadMethod::Frames(frames) = format.method else {
            let name = format.name;
            let message = format!("a file of the format {name} has no frames; read it as a whole");
            return Err(LoadError::new(message).of_kind(LoadErrorKind::NoFrames));
        };
        if !matches!(frames, Frames::Lines { .. }) {
            source = source.in_small_pieces().map_err(|error| of_file(error.into()))?;
        }
        let topology = open_topology(options).map_err(of_file)?;
        let index = frames.find(&mut source, last, options, topology).map_err(of_file)?;
        let options = Options { format: Some(format), frame: None, ..options.clone() };
        Ok(Self { path: path.to_path_buf(), source, frames, index, options })
    }

    /// Number of complete frames.
    pub(super) fn len(&self) -> usize {
        self.index.frames.len()
    }

    /// The error after the last complete frame, if there is one.
    pub(super) fn problem(&self) -> Option<&LoadError> {
        self.index.problem.as_ref()
    }

    /// Number of bytes of a frame in the file; `None` if there is no such frame.
    pub(super) fn frame_bytes(&self, index: usize) -> Option<u64> {
        self.index.frames.get(index).map(|span| span.bytes.end - span.bytes.start)
    }

    /// Reads one frame, counted from 0.
    pub(super) fn frame(&mut self, index: usize) -> Result<Dataset, LoadError> {
        let Self { path, source, frames, index: found, options } = self;
        frames.read(source, found, index, options).map_err(|error| error.in_file(path))
    }

    /// Reads one frame, counted from 0, and checks that the frames are followed by the end of the file or by another
    /// frame, because a wrong number of atoms shows there. A fault after complete frames of binary data is only a note.
    pub(super) fn into_frame(mut self, index: usize) -> Result<Dataset, LoadError> {
        let loaded = self.frame(index)?;
        self.index.with_problem(loaded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_unknown_format_is_refused() {
        let refused = from_bytes(b"hello", "a.doc", &Options::default()).unwrap_err().to_string();
        assert!(refused.ends_with("raw-f32x4"), "{refused}");
        let missing = open_file("no/such/file.xyz".as_ref(), &Options::default()).unwrap_err().to_string();
        assert!(missing.starts_with("no/such/file.xyz: cannot be read: "), "{missing}");
    }

    #[test]
    fn the_content_decides_where_the_name_does_not() {
        let xyz = b"1\n\nO 0 0 0\n";
        for name in ["a.xyz", "a.XYZ", "a", "a.txt"] {
            let loaded = from_bytes(xyz, name, &Options::default()).unwrap();
            assert_eq!((loaded.spheres.len(), loaded.colors.map(|c| c.len())), (1, Some(1)), "{name}");
        }
    }
}
