//! Opens files of spheres, and chooses their format.

use std::path::Path;

use super::error::LoadError;
use super::format::{FORMATS, Format, Options};
use super::loaded::Loaded;

/// Reads a file of spheres. Its format is the one in the options, or else follows from the extension, or else from the
/// content.
///
/// # Errors
/// If the file cannot be read, its format is not known, or an option does not apply to it.
pub fn open(path: impl AsRef<Path>, options: &Options) -> Result<Loaded, LoadError> {
    let path = path.as_ref();
    let bytes =
        std::fs::read(path).map_err(|error| LoadError::File { path: path.to_path_buf(), error })?;
    from_bytes(&bytes, path, options)
}

/// Reads a file of spheres that is in memory. `name` is the name of the file, or empty; only its extension is used, to
/// choose the format as [`open`] does, and no file is opened.
///
/// # Errors
/// If the bytes cannot be read, their format is not known, or an option does not apply to it.
pub fn from_bytes(
    bytes: &[u8],
    name: impl AsRef<Path>,
    options: &Options,
) -> Result<Loaded, LoadError> {
    let extension = name.as_ref().extension().and_then(|extension| extension.to_str());
    let format = options
        .format
        .or_else(|| extension.and_then(Format::of_extension))
        .or_else(|| Format::of_content(bytes))
        .ok_or_else(|| {
            let names = FORMATS.iter().map(|format| format.name);
            LoadError::UnknownFormat { formats: names.collect::<Vec<_>>().join(", ") }
        })?;
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
