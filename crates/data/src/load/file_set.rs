//! Several files under one name: frames of one trajectory, such as `dump.0` and `dump.100` under `dump.*`, or files that
//! are seen together, under `{protein.pdb,ligand.sdf}`.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::error::LoadError;

/// Several files for which one name stands, in the order of the numbers in their names.
///
/// A `*` in the name stands for a number: `dump.*` for all files such as `dump.0` and `dump.100`. Words in braces stand for
/// files that are listed: `dump.{0,100}`. If all of them are numbers, the files are frames. Others are put together. A file
/// that has such a name itself is no set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileSet {
    files: Vec<PathBuf>,
    are_frames: bool,
}

/// A folder, and a name in it in three parts: what stands before, in the place of, and after a number.
type Parts<'a> = (&'a Path, [&'a str; 3]);

impl FileSet {
    /// The files for which the name at the end of a path stands; `None` if it is the name of one file.
    ///
    /// # Errors
    /// Returns an error if there are no such files, or their folder cannot be read.
    pub fn of(path: &Path) -> Result<Option<Self>, LoadError> {
        let Some((folder, [before, middle, after])) = parts(path) else { return Ok(None) };
        if let Some(set) = Self::listed((folder, [before, middle, after])) {
            return Ok(Some(set));
        }
        let mut found = Vec::new();
        let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        for entry in listed.read_dir().map_err(|error| LoadError::from(error).in_file(folder))? {
            let name = entry.map_err(|error| LoadError::from(error).in_file(folder))?.file_name();
            let number = name.to_str().and_then(|name| name.strip_prefix(before)?.strip_suffix(after));
            found.extend(number.filter(|number| is_number(number)).map(str::to_owned));
        }
        if found.is_empty() {
            return Err(LoadError::new("there is no file whose name has a number in the place of the *"));
        }
        found.sort_unstable_by(|a, b| key(a).cmp(&key(b)));
        let files = found.iter().map(|number| folder.join(format!("{before}{number}{after}"))).collect();
        Ok(Some(Self { files, are_frames: true }))
    }

    /// The files for which a path stands if they are seen together, and are no frames.
    #[must_use]
    pub fn together(path: &Path) -> Option<Self> {
        Self::listed(parts(path)?).filter(|set| !set.are_frames)
    }

    /// The files whose names stand in braces, which no folder is searched for.
    fn listed((folder, [before, middle, after]): Parts<'_>) -> Option<Self> {
        let names = middle.strip_prefix('{')?.strip_suffix('}')?.split(',');
        let are_frames = names.clone().all(is_number);
        let files = names.map(|name| folder.join(format!("{before}{name}{after}"))).collect();
        Some(Self { files, are_frames })
    }

    /// Returns true if the name at the end of a path stands for several files.
    #[must_use]
    pub fn is_one(path: &Path) -> bool {
        parts(path).is_some()
    }

    /// The name for files in one folder whose names differ in a number alone; `None` if they do not.
    #[must_use]
    pub fn name_of(paths: &[PathBuf]) -> Option<PathBuf> {
        let (first, folder) = (paths.first()?, paths.first()?.parent()?);
        let names: Option<Vec<&str>> = paths
            .iter()
            .map(|path| path.file_name().and_then(OsStr::to_str).filter(|_| path.parent() == Some(folder)))
            .collect();
        let names = names.filter(|names| names.len() > 1)?;
        let first_name = first.file_name().and_then(OsStr::to_str)?;
        let same = |from_end: bool| {
            let alike = |name: &&str| match from_end {
                false => first_name.bytes().zip(name.bytes()).take_while(|(a, b)| a == b).count(),
                true => first_name.bytes().rev().zip(name.bytes().rev()).take_while(|(a, b)| a == b).count(),
            };
            names.iter().map(alike).min().unwrap_or_default()
        };
        // Digits that all numbers share belong to them.
        let before = first_name.get(..same(false))?.trim_end_matches(|c: char| c.is_ascii_digit());
        let after = first_name.get(first_name.len() - same(true)..)?.trim_start_matches(|c: char| c.is_ascii_digit());
        let numbers = names.iter().map(|name| name.get(before.len()..name.len().checked_sub(after.len())?));
        let mut numbers: Vec<&str> = numbers.collect::<Option<_>>()?;
        numbers.sort_unstable_by(|a, b| key(a).cmp(&key(b)));
        numbers.dedup();
        if numbers.len() < names.len() || !numbers.iter().all(|number| is_number(number)) {
            return None;
        }
        let all = folder.join(format!("{before}*{after}"));
        let listed = folder.join(format!("{before}{{{}}}{after}", numbers.join(",")));
        let files = Self::of(&listed).ok().flatten()?.files;
        Some(if Self::of(&all).ok().flatten().is_some_and(|all| all.files == files) { all } else { listed })
    }

    /// The name for files that are seen together; `None` if one of them has a comma or a brace in its name.
    #[must_use]
    pub fn name_together(paths: &[PathBuf]) -> Option<PathBuf> {
        let names: Option<Vec<&str>> = paths.iter().map(|path| path.to_str()).collect();
        let names =
            names.filter(|names| names.len() > 1 && !names.iter().any(|name| name.contains([',', '{', '}'])))?;
        Some(PathBuf::from(format!("{{{}}}", names.join(","))))
    }

    /// Returns true if the files are frames of one trajectory, and false if they are seen together.
    #[must_use]
    pub fn are_frames(&self) -> bool {
        self.are_frames
    }

    /// The files.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }
}

/// The parts of a path that stands for several files, and is not that of a file.
fn parts(path: &Path) -> Option<Parts<'_>> {
    // Files in several folders are listed with these.
    let whole = path.to_str().filter(|text| text.starts_with('{') && text.ends_with('}') && text.len() > 2);
    let (folder, name) = match whole {
        Some(whole) => (Path::new(""), whole),
        None => (path.parent().unwrap_or(Path::new("")), path.file_name()?.to_str()?),
    };
    let (first, last) = match name.find('{') {
        Some(first) => (first, name.find('}').filter(|last| *last > first + 1)?),
        None => (name.find('*')?, name.rfind('*')?),
    };
    let is_set = name[first..].starts_with('{') || first == last;
    (is_set && !path.exists()).then(|| (folder, [&name[..first], &name[first..=last], &name[last + 1..]]))
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Texts with this key are in the order of their numbers, however long those are.
fn key(number: &str) -> (usize, &str, usize) {
    let digits = number.trim_start_matches('0');
    (digits.len(), digits, number.len())
}
