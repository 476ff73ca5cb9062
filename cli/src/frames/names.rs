//! Names of files with the number of a frame, from a pattern as `printf` has them.

use std::path::{Path, PathBuf};

/// A path whose file name contains `%d` or `%04d` once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pattern {
    folder: PathBuf,
    before: String,
    /// The least number of digits, filled up with zeros.
    digits: usize,
    after: String,
}

/// Whether a path contains the sign of patterns.
pub(crate) fn has_sign(path: &Path) -> bool {
    path.to_string_lossy().contains('%')
}

impl Pattern {
    /// Reads a pattern.
    pub(crate) fn new(path: &Path) -> Result<Self, String> {
        let wanted = |problem: &str| {
            format!(
                "{}: {problem}; write one %d or %04d into the name, such as f%04d.png",
                path.display()
            )
        };
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| wanted("this is not the name of a file in UTF-8"))?;
        if path.parent().is_some_and(has_sign) {
            return Err(wanted("the names of folders are the same for all frames"));
        }
        let Some((before, rest)) = name.split_once('%') else {
            return Err(wanted("every frame needs a name of its own"));
        };
        let Some((width, after)) = rest.split_once('d') else {
            return Err(wanted("the % in this name is not that of a number"));
        };
        let digits = match width.strip_prefix('0') {
            _ if width.is_empty() => Some(1),
            Some(digits) => digits.parse().ok().filter(|digits| (1..=20).contains(digits)),
            None => None,
        };
        let Some(digits) = digits else {
            return Err(wanted("the % in this name is not that of a number"));
        };
        if after.contains('%') {
            return Err(wanted("a name has the number of its frame once"));
        }
        let (before, after) = (before.to_owned(), after.to_owned());
        Ok(Self { folder: path.with_file_name(""), before, digits, after })
    }

    /// Returns the path for a number.
    pub(crate) fn path(&self, number: usize) -> PathBuf {
        let Self { folder, before, digits, after } = self;
        folder.join(format!("{before}{number:0digits$}{after}"))
    }
}

/// Returns a path with a number in place of its `%d`; a path without one is returned as it is.
pub(crate) fn numbered(path: &Path, number: usize) -> PathBuf {
    Pattern::new(path).map_or_else(|_| path.to_path_buf(), |pattern| pattern.path(number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_digits() {
        let name = |pattern: &str, number| {
            Pattern::new(Path::new(pattern)).unwrap().path(number).to_str().unwrap().to_owned()
        };
        assert_eq!(name("f%d.png", 7), "f7.png");
        assert_eq!(name("out/f%04d.png", 7), "out/f0007.png");
        assert_eq!(name("/a/%03d-b.exr", 12345), "/a/12345-b.exr");
    }

    #[test]
    fn other_patterns_are_refused() {
        for text in ["f.png", "f%.png", "f%4d.png", "f%0d.png", "f%s.png", "%d/f.png", "%d%d.png"] {
            assert!(Pattern::new(Path::new(text)).is_err(), "{text}");
        }
        assert!(Pattern::new(Path::new("f%021d.png")).is_err());
    }
}
