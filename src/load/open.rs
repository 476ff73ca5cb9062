//! Opens files of spheres, and chooses their format.

use std::io::{self, Read as _};
use std::path::Path;

use super::error::LoadError;
use super::format::{Format, Options};
use super::loaded::Loaded;
use super::source::Source;
#[cfg(feature = "gzip")]
use super::source::without_gz;
use super::trajectory::Trajectory;

/// Reads a file of spheres. Its format is the one in the options, or else follows from the extension, or else from the
/// content. Of a file with several frames only the one that is asked for is in memory; [`Trajectory`] reads several.
///
/// # Errors
/// If the file cannot be read, its format is not known, or an option does not apply to it.
pub fn open(path: impl AsRef<Path>, options: &Options) -> Result<Loaded, LoadError> {
    let path = path.as_ref();
    let failed = |error: io::Error| LoadError::from(error).in_file(path);
    let format = match options.format {
        Some(format) => Some(format),
        None => Format::of_path(path).map_err(failed)?,
    };
    // Frames are found by seeking, which a pipe cannot do.
    if let Some(format) = format.filter(|format| format.has_frames() && path.is_file()) {
        let frames = Trajectory::open_up_to(path, &options.clone().with_format(format))?;
        return frames.into_frame(options.frame.unwrap_or_default());
    }
    let mut bytes = Vec::new();
    Source::open(path).and_then(|mut file| file.read_to_end(&mut bytes)).map_err(failed)?;
    from_bytes(&bytes, path, options)
}

/// Reads a file of spheres that is in memory. `name` is the name of the file, or empty; only its extension is used, to
/// choose the format as [`open`] does, and no file is opened but the topology in the options.
///
/// # Errors
/// If the bytes cannot be read, their format is not known, or an option does not apply to it.
pub fn from_bytes(
    bytes: &[u8],
    name: impl AsRef<Path>,
    options: &Options,
) -> Result<Loaded, LoadError> {
    let format = match options.format {
        Some(format) => format,
        #[cfg(feature = "gzip")]
        None if super::gzip::starts(bytes) => {
            let bytes = super::gzip::decompressed(bytes)?;
            return from_bytes(&bytes, without_gz(name.as_ref()), options);
        }
        None => Format::of_file(name.as_ref(), bytes)?,
    };
    format.read(bytes, options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_unknown_format_is_refused() {
        let refused = from_bytes(b"hello", "a.doc", &Options::default()).unwrap_err().to_string();
        assert!(refused.ends_with("raw-f32x4"), "{refused}");
        let missing = open("no/such/file.xyz", &Options::default()).unwrap_err().to_string();
        assert!(missing.starts_with("no/such/file.xyz: cannot be read: "), "{missing}");
    }

    #[cfg(feature = "xyz")]
    #[test]
    fn the_content_decides_where_the_name_does_not() {
        let xyz = b"1\n\nO 0 0 0\n";
        for name in ["a.xyz", "a.XYZ", "a", "a.txt"] {
            let loaded = from_bytes(xyz, name, &Options::default()).unwrap();
            assert_eq!(
                (loaded.spheres.len(), loaded.colors.map(|c| c.len())),
                (1, Some(1)),
                "{name}"
            );
        }
    }
}
