//! A file format, and reading a file with it.

use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use super::error::LoadError;
use super::formats::FORMATS;
#[cfg(feature = "gzip")]
use super::gzip;
use super::loaded::Loaded;
use super::source::{Source, without_gz};
use super::trajectory::Frames;

/// A file format for spheres.
#[derive(Debug)]
#[non_exhaustive]
pub struct Format {
    /// Name of the format, such as `extxyz`.
    pub name: &'static str,
    /// File name extensions of the format, in lower case and without the dot.
    pub extensions: &'static [&'static str],
    /// Contents of such a file, in a few words for users.
    pub about: &'static str,
    /// How the frames of a file are found and read, if a file can have several.
    pub(super) frames: Option<Frames>,
    /// Whether a file has positions alone, so that [`Options::topology`] names a file that says what the spheres are.
    pub needs_topology: bool,
    /// Whether a file can lack names for its columns, so that [`Options::columns`] gives them.
    pub may_lack_names: bool,
    /// Whether a file can lack radii, so that [`Options::radius`] gives one for all spheres.
    pub may_lack_radii: bool,
    /// Whether a file gives colours, either directly or through the elements of its atoms.
    pub has_colors: bool,
    /// Whether z is the height in most files of this format, as in simulations and surveys. Of molecules and models of
    /// surfaces, y is up on the screen.
    pub z_is_up: bool,
    /// Whether the first bytes of a file look like this format.
    pub(super) starts: fn(&[u8]) -> bool,
    pub(super) reader: fn(&[u8], &Options) -> Result<Loaded, LoadError>,
    pub(super) extra_bytes: fn(&[u8]) -> Result<u64, LoadError>,
}

/// Options for reading a file of spheres.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The format; `None` chooses it by the name or the content of the file.
    pub format: Option<&'static Format>,
    /// The frame of a trajectory to read, counted from 0; `None` reads the first.
    pub frame: Option<usize>,
    /// The radius of all spheres, in the file's unit of length, for files without radii.
    pub radius: Option<f64>,
    /// The file that says what the spheres of a trajectory are, for formats that have positions alone.
    pub topology: Option<PathBuf>,
    /// The names of the columns, in the order of the file, for tables without a header; empty if there is one.
    pub columns: Vec<String>,
}

impl Format {
    /// Returns the format with this name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<&'static Self> {
        FORMATS.iter().find(|format| format.name == name)
    }

    /// Returns the format with this extension, which may be in upper or lower case.
    #[must_use]
    pub fn of_extension(extension: &str) -> Option<&'static Self> {
        let extension = extension.to_ascii_lowercase();
        FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
    }

    /// Returns the format that the first bytes of a file look like; a few hundred bytes are enough.
    #[must_use]
    pub fn of_content(bytes: &[u8]) -> Option<&'static Self> {
        FORMATS.iter().find(|format| (format.starts)(bytes))
    }

    /// Whether a file can have several frames, which [`Trajectory`](super::Trajectory) reads one by one.
    #[must_use]
    pub const fn has_frames(&self) -> bool {
        self.frames.is_some()
    }

    /// Returns the format of a file by its extension or else, of a regular file, by its first bytes, which may be
    /// compressed with gzip. Nothing else is opened: a pipe can be read only once.
    ///
    /// # Errors
    /// If the first bytes are needed and cannot be read.
    pub fn of_path(path: &Path) -> io::Result<Option<&'static Self>> {
        const FIRST_BYTES: u64 = 1 << 12;
        let format = Self::of_file_name(path);
        if format.is_some() || !path.is_file() {
            return Ok(format);
        }
        let mut first = Vec::new();
        Source::open(path)?.take(FIRST_BYTES).read_to_end(&mut first)?;
        Ok(Self::of_content(&first))
    }

    /// Returns the format with the extension of a file's name, before which `.gz` is taken away.
    fn of_file_name(path: &Path) -> Option<&'static Self> {
        without_gz(path).extension()?.to_str().and_then(Self::of_extension)
    }

    /// Returns the format of a file by its extension or else by its first bytes.
    pub(super) fn of_file(path: &Path, first: &[u8]) -> Result<&'static Self, LoadError> {
        let format = Self::of_file_name(path).or_else(|| Self::of_content(first));
        format.ok_or_else(Self::unknown)
    }

    /// The error of a file of which neither the name nor the content shows the format.
    #[must_use]
    pub fn unknown() -> LoadError {
        let names: Vec<&str> = FORMATS.iter().map(|format| format.name).collect();
        LoadError::new(format!(
            "neither the name nor the content of this file shows its format; choose one of {}",
            names.join(", ")
        ))
    }

    /// Lists the extensions of all formats for which `is_wanted` returns true, such as `.npy, .npz`.
    #[must_use]
    pub fn extensions_of(is_wanted: impl Fn(&Self) -> bool) -> String {
        let wanted = FORMATS.iter().filter(|format| is_wanted(format));
        let extensions = wanted.flat_map(|format| format.extensions);
        extensions.map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
    }

    /// Checks that every given option applies to this format.
    ///
    /// # Errors
    /// Returns the first option that does not apply.
    pub fn check(&self, options: &Options) -> Result<(), LoadError> {
        let refused = |option, what: String| {
            Err(LoadError::new(format!("{option} applies only to {what}; remove it")))
        };
        if options.frame.is_some() && !self.has_frames() {
            let what =
                format!("trajectories ({})", Self::extensions_of(|format| format.has_frames()));
            return refused("frame", what);
        }
        if options.radius.is_some() && !self.may_lack_radii {
            let files = Self::extensions_of(|format| format.may_lack_radii);
            let what = format!("data that can lack radii ({files})");
            return refused("radius", what);
        }
        if options.topology.is_some() && !self.needs_topology {
            let what = format!(
                "trajectories of positions alone ({})",
                Self::extensions_of(|format| format.needs_topology)
            );
            return refused("topology", what);
        }
        if !options.columns.is_empty() && !self.may_lack_names {
            let files = Self::extensions_of(|format| format.may_lack_names);
            return refused("columns", format!("tables ({files})"));
        }
        Ok(())
    }

    /// Returns how many bytes of memory reading takes in addition to the file itself, or 0 if the file does not say.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn extra_bytes(&self, bytes: &[u8]) -> Result<u64, LoadError> {
        #[cfg(feature = "gzip")]
        if gzip::starts(bytes) {
            return Ok(gzip::size_hint(bytes));
        }
        (self.extra_bytes)(bytes)
    }

    /// Reads a file of this format, which may be compressed with gzip.
    ///
    /// # Errors
    /// If the file cannot be read, or an option does not apply to this format.
    pub fn read(&self, bytes: &[u8], options: &Options) -> Result<Loaded, LoadError> {
        self.check(options)?;
        #[cfg(feature = "gzip")]
        if gzip::starts(bytes) {
            return (self.reader)(&gzip::decompressed(bytes)?, options);
        }
        (self.reader)(bytes, options)
    }
}

impl Eq for Format {}

impl PartialEq for Format {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Options {
    /// Returns these options with a format.
    #[must_use]
    pub fn with_format(self, format: &'static Format) -> Self {
        Self { format: Some(format), ..self }
    }

    /// Returns these options with a frame of a trajectory, counted from 0.
    #[must_use]
    pub fn with_frame(self, frame: usize) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Returns these options with the file that says what the spheres of a trajectory are.
    #[must_use]
    pub fn with_topology(self, path: impl Into<PathBuf>) -> Self {
        Self { topology: Some(path.into()), ..self }
    }

    /// Returns these options with the names of the columns of a table without a header.
    #[must_use]
    pub fn with_columns(self, columns: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { columns: columns.into_iter().map(Into::into).collect(), ..self }
    }

    /// Returns these options with one radius for all spheres, for files without radii.
    #[must_use]
    pub fn with_radius(self, radius: f64) -> Self {
        Self { radius: Some(radius), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_and_extension_belongs_to_one_format() {
        let mut seen = std::collections::HashSet::new();
        for format in FORMATS {
            assert_eq!(Format::of_name(format.name), Some(format));
            for extension in format.extensions {
                assert!(seen.insert(extension), "{extension} belongs to several formats");
                assert_eq!(Format::of_extension(&extension.to_uppercase()), Some(format));
            }
        }
    }

    #[test]
    fn options_that_do_not_apply_are_refused() {
        let raw = Format::of_name("raw-f32x4").unwrap();
        let refused = raw.read(&[], &Options::default().with_frame(1)).unwrap_err().to_string();
        assert!(refused.starts_with("frame applies only to trajectories ("), "{refused}");
        assert!(raw.read(&[], &Options::default().with_radius(1.0)).is_err());
        assert!(raw.read(&[], &Options::default()).unwrap().spheres.is_empty());
    }

    #[cfg(all(
        feature = "lammps",
        feature = "mmcif",
        feature = "npy",
        feature = "pdb",
        feature = "ply",
        feature = "xyz"
    ))]
    #[test]
    fn content_shows_the_format() {
        for (bytes, name) in [
            (&b"\x93NUMPY\x01"[..], "npy"),
            (b"PK\x03\x04", "npz"),
            (b"ply\r\nformat ascii 1.0", "ply"),
            (b"12\n\nH 0 0 0", "xyz"),
            (b"HEADER    OXYGEN TRANSPORT", "pdb"),
            (b"ITEM: TIMESTEP\n0\n", "lammps-dump"),
            (b"id,X,y,z,q\n1,2", "csv"),
            (b"made by me\n\n 20 atoms\n", "lammps-data"),
            (b"# comment\n\nData_4HHB\n", "mmcif"),
        ] {
            assert_eq!(Format::of_content(bytes).map(|format| format.name), Some(name));
        }
        assert_eq!(Format::of_content(b""), None);
    }
}
