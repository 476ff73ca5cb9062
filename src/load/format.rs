//! The table of file formats, and reading a file with one of them.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use super::error::{LoadError, OptionError};
use super::loaded::Loaded;
use super::raw;
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
    /// Whether a file can lack radii, so that [`Options::radius`] gives one for all spheres.
    pub may_lack_radii: bool,
    /// Whether a file gives colours, either directly or through the elements of its atoms.
    pub has_colors: bool,
    /// Whether the first bytes of a file look like this format.
    starts: fn(&[u8]) -> bool,
    reader: fn(&[u8], &Options) -> Result<Loaded, LoadError>,
    extra_bytes: fn(&[u8]) -> Result<u64, LoadError>,
}

/// Options for reading a file of spheres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The format; `None` chooses it by the name or the content of the file.
    pub format: Option<&'static Format>,
    /// The frame of a trajectory to read, counted from 0; `None` reads the first.
    pub frame: Option<usize>,
    /// The radius of all spheres, in the file's unit of length, for files without radii.
    pub radius: Option<f64>,
}

/// All formats that this build can read. No two of them share a name or an extension.
pub static FORMATS: &[Format] = &[
    #[cfg(feature = "xyz")]
    Format {
        name: "xyz",
        extensions: &["xyz"],
        about: "Text with one atom on each line (XYZ)",
        frames: Some(super::xyz::FRAMES),
        may_lack_radii: false,
        has_colors: true,
        starts: super::xyz::starts,
        reader: super::xyz::load,
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "xyz")]
    Format {
        name: "extxyz",
        extensions: &["extxyz"],
        about: "Text with one atom on each line and named columns (extended XYZ)",
        frames: Some(super::xyz::FRAMES),
        may_lack_radii: false,
        has_colors: true,
        starts: never,
        reader: super::xyz::load,
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "pdb")]
    Format {
        name: "pdb",
        extensions: &["pdb", "ent"],
        about: "Text in the fixed columns of the Protein Data Bank; a frame is a model",
        frames: Some(super::pdb::FRAMES),
        may_lack_radii: false,
        has_colors: true,
        starts: super::pdb::starts,
        reader: |bytes, options| Ok(super::pdb::read(bytes, options.frame.unwrap_or_default())?),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "npy")]
    Format {
        name: "npy",
        extensions: &["npy"],
        about: "A NumPy array of shape (n, 4) or, with a radius, (n, 3)",
        frames: None,
        may_lack_radii: true,
        has_colors: false,
        starts: |bytes| bytes.starts_with(b"\x93NUMPY"),
        reader: |bytes, options| Ok(Loaded::new(super::npy::read_spheres(bytes, options.radius)?)),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "npy")]
    Format {
        name: "npz",
        extensions: &["npz"],
        about: "A NumPy archive with an array of shape (n, 4) or, with a radius, (n, 3)",
        frames: None,
        may_lack_radii: true,
        has_colors: false,
        starts: |bytes| bytes.starts_with(b"PK\x03\x04"),
        reader: |bytes, options| Ok(Loaded::new(super::npz::read_spheres(bytes, options.radius)?)),
        extra_bytes: |bytes| Ok(super::npz::array_bytes(bytes)?),
    },
    Format {
        name: "raw-f32x4",
        extensions: &[],
        about: "Raw numbers without a header: x, y, z, radius in little-endian f32",
        frames: None,
        may_lack_radii: false,
        has_colors: false,
        starts: never,
        reader: |bytes, _| Ok(Loaded::new(raw::read_spheres(bytes)?)),
        extra_bytes: no_extra_bytes,
    },
];

fn never(_: &[u8]) -> bool {
    false
}

fn no_extra_bytes(_: &[u8]) -> Result<u64, LoadError> {
    Ok(0)
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

    /// Returns the format of a file by its extension or else, of a regular file, by its first bytes. Nothing else is
    /// opened: a pipe can be read only once.
    ///
    /// # Errors
    /// If the first bytes are needed and cannot be read.
    pub fn of_path(path: &Path) -> io::Result<Option<&'static Self>> {
        const FIRST_BYTES: u64 = 1 << 12;
        let extension = path.extension().and_then(|extension| extension.to_str());
        let format = extension.and_then(Self::of_extension);
        if format.is_some() || !path.is_file() {
            return Ok(format);
        }
        let mut first = Vec::new();
        File::open(path)?.take(FIRST_BYTES).read_to_end(&mut first)?;
        Ok(Self::of_content(&first))
    }

    /// Returns the format of a file by its extension or else by its first bytes.
    pub(super) fn of_file(path: &Path, first: &[u8]) -> Result<&'static Self, LoadError> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        let format = extension.and_then(Self::of_extension).or_else(|| Self::of_content(first));
        format.ok_or_else(|| {
            let names = FORMATS.iter().map(|format| format.name);
            LoadError::UnknownFormat { formats: names.collect::<Vec<_>>().join(", ") }
        })
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
    pub fn check(&self, options: &Options) -> Result<(), OptionError> {
        if options.frame.is_some() && !self.has_frames() {
            let what =
                format!("trajectories ({})", Self::extensions_of(|format| format.has_frames()));
            return Err(OptionError { option: "frame", what });
        }
        if options.radius.is_some() && !self.may_lack_radii {
            let files = Self::extensions_of(|format| format.may_lack_radii);
            let what = format!("arrays of shape (n, 3) ({files})");
            return Err(OptionError { option: "radius", what });
        }
        Ok(())
    }

    /// Returns how many bytes of memory reading takes in addition to the file itself, or 0 if the file does not say.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn extra_bytes(&self, bytes: &[u8]) -> Result<u64, LoadError> {
        (self.extra_bytes)(bytes)
    }

    /// Reads a file of this format.
    ///
    /// # Errors
    /// If the file cannot be read, or an option does not apply to this format.
    pub fn read(&self, bytes: &[u8], options: &Options) -> Result<Loaded, LoadError> {
        self.check(options)?;
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

    #[cfg(all(feature = "npy", feature = "pdb", feature = "xyz"))]
    #[test]
    fn content_shows_the_format() {
        for (bytes, name) in [
            (&b"\x93NUMPY\x01"[..], "npy"),
            (b"PK\x03\x04", "npz"),
            (b"12\n\nH 0 0 0", "xyz"),
            (b"HEADER    OXYGEN TRANSPORT", "pdb"),
        ] {
            assert_eq!(Format::of_content(bytes).map(|format| format.name), Some(name));
        }
        assert_eq!(Format::of_content(b""), None);
    }
}
