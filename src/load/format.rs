//! The formats of files of spheres: a row for each.

use super::error::{LoadError, OptionError};
use super::loaded::Loaded;
use super::raw;

/// A format of files of spheres.
#[derive(Debug)]
#[non_exhaustive]
pub struct Format {
    /// What it is called, such as `extxyz`.
    pub name: &'static str,
    /// What stands behind the last dot of such a file's name, in small letters.
    pub extensions: &'static [&'static str],
    /// What such a file holds, in a few words.
    pub about: &'static str,
    /// Whether a file may have several frames.
    pub has_frames: bool,
    /// Whether a file may lack radii, so that one is given for all.
    pub may_lack_radii: bool,
    /// Whether a file gives colours, by itself or by the elements of its atoms.
    pub has_colors: bool,
    /// Whether the first bytes of a file look like this format.
    starts: fn(&[u8]) -> bool,
    reader: fn(&[u8], &Options) -> Result<Loaded, LoadError>,
    extra_bytes: fn(&[u8]) -> Result<u64, LoadError>,
}

/// How a file of spheres is to be read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The format; if `None`, the file's name or content tells.
    pub format: Option<&'static Format>,
    /// Which frame of a trajectory, from 0; the first if `None`.
    pub frame: Option<usize>,
    /// The radius of all spheres, in the file's unit of length, if the file has none.
    pub radius: Option<f64>,
}

/// All formats that this build can read. A name or an extension belongs to one of them.
pub static FORMATS: &[Format] = &[
    #[cfg(feature = "xyz")]
    Format {
        name: "xyz",
        extensions: &["xyz"],
        about: "Atoms in text",
        has_frames: true,
        may_lack_radii: false,
        has_colors: true,
        starts: super::xyz::starts,
        reader: super::xyz::load,
        extra_bytes: none,
    },
    #[cfg(feature = "xyz")]
    Format {
        name: "extxyz",
        extensions: &["extxyz"],
        about: "Atoms in text, with named columns",
        has_frames: true,
        may_lack_radii: false,
        has_colors: true,
        starts: never,
        reader: super::xyz::load,
        extra_bytes: none,
    },
    #[cfg(feature = "pdb")]
    Format {
        name: "pdb",
        extensions: &["pdb", "ent"],
        about: "Atoms of a molecule in the fixed columns of the Protein Data Bank; a frame is a model",
        has_frames: true,
        may_lack_radii: false,
        has_colors: true,
        starts: super::pdb::starts,
        reader: |bytes, options| Ok(super::pdb::read(bytes, options.frame.unwrap_or_default())?),
        extra_bytes: none,
    },
    #[cfg(feature = "npy")]
    Format {
        name: "npy",
        extensions: &["npy"],
        about: "A NumPy array of shape (n, 4) or, with a radius, (n, 3)",
        has_frames: false,
        may_lack_radii: true,
        has_colors: false,
        starts: |bytes| bytes.starts_with(b"\x93NUMPY"),
        reader: |bytes, options| Ok(Loaded::new(super::npy::read_spheres(bytes, options.radius)?)),
        extra_bytes: none,
    },
    #[cfg(feature = "npy")]
    Format {
        name: "npz",
        extensions: &["npz"],
        about: "An archive with such an array",
        has_frames: false,
        may_lack_radii: true,
        has_colors: false,
        starts: |bytes| bytes.starts_with(b"PK\x03\x04"),
        reader: |bytes, options| Ok(Loaded::new(super::npz::read_spheres(bytes, options.radius)?)),
        extra_bytes: |bytes| Ok(super::npz::array_bytes(bytes)?),
    },
    Format {
        name: "raw-f32x4",
        extensions: &[],
        about: "Nothing but numbers: x, y, z, radius in little-endian f32",
        has_frames: false,
        may_lack_radii: false,
        has_colors: false,
        starts: never,
        reader: |bytes, _| Ok(Loaded::new(raw::read_spheres(bytes)?)),
        extra_bytes: none,
    },
];

fn never(_: &[u8]) -> bool {
    false
}

fn none(_: &[u8]) -> Result<u64, LoadError> {
    Ok(0)
}

impl Format {
    /// The format of a name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<&'static Self> {
        FORMATS.iter().find(|format| format.name == name)
    }

    /// The format that an extension stands for, in whatever case.
    #[must_use]
    pub fn of_extension(extension: &str) -> Option<&'static Self> {
        let extension = extension.to_ascii_lowercase();
        FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
    }

    /// The format that the first bytes of a file look like; a few hundred are enough.
    #[must_use]
    pub fn of_content(bytes: &[u8]) -> Option<&'static Self> {
        FORMATS.iter().find(|format| (format.starts)(bytes))
    }

    /// The extensions of all formats of which something is true, as in `.npy, .npz`.
    #[must_use]
    pub fn extensions_of(is_wanted: impl Fn(&Self) -> bool) -> String {
        let wanted = FORMATS.iter().filter(|format| is_wanted(format));
        let extensions = wanted.flat_map(|format| format.extensions);
        extensions.map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
    }

    /// Whether the format has a use for every option that is given.
    ///
    /// # Errors
    /// The first option for which it has none.
    pub fn check(&self, options: &Options) -> Result<(), OptionError> {
        if options.frame.is_some() && !self.has_frames {
            let what =
                format!("trajectories ({})", Self::extensions_of(|format| format.has_frames));
            return Err(OptionError { option: "frame", what });
        }
        if options.radius.is_some() && !self.may_lack_radii {
            let files = Self::extensions_of(|format| format.may_lack_radii);
            let what = format!("arrays of shape (n, 3) ({files})");
            return Err(OptionError { option: "radius", what });
        }
        Ok(())
    }

    /// How many bytes reading takes beside the file itself, as far as the file says; 0 if it does not.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn extra_bytes(&self, bytes: &[u8]) -> Result<u64, LoadError> {
        (self.extra_bytes)(bytes)
    }

    /// Reads a file of this format.
    ///
    /// # Errors
    /// If the file cannot be read, or an option is of no use to it.
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
    /// The same for a format that is known.
    #[must_use]
    pub fn with_format(self, format: &'static Format) -> Self {
        Self { format: Some(format), ..self }
    }

    /// The same for a frame of a trajectory, from 0.
    #[must_use]
    pub fn with_frame(self, frame: usize) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// The same with a radius of all spheres, for files that have none.
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
    fn options_without_use_are_refused() {
        let raw = Format::of_name("raw-f32x4").unwrap();
        let refused = raw.read(&[], &Options::default().with_frame(1)).unwrap_err().to_string();
        assert!(refused.starts_with("frame concerns trajectories ("), "{refused}");
        assert!(raw.read(&[], &Options::default().with_radius(1.0)).is_err());
        assert!(raw.read(&[], &Options::default()).unwrap().spheres.is_empty());
    }

    #[cfg(all(feature = "npy", feature = "pdb", feature = "xyz"))]
    #[test]
    fn content_tells_the_format() {
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
