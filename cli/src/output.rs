//! Files that appear whole or not at all.

use std::collections::HashSet;
use std::fs::Permissions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use tempfile::NamedTempFile;

use super::failure::Failure;
use super::input::extension;
use super::interrupt;
use pinhole::write::{npy, raw};

/// Refuses one file for two outputs.
pub(super) fn check_distinct<'a>(
    outputs: impl Iterator<Item = &'a PathBuf>,
) -> Result<(), Failure> {
    let mut seen = HashSet::new();
    for path in outputs {
        if !seen.insert(real(path)) {
            return Err(Failure::usage(format!("{}: two outputs are this file", path.display())));
        }
    }
    Ok(())
}

/// Refuses to overwrite what was read.
pub(super) fn spare<'a>(
    mut outputs: impl Iterator<Item = &'a PathBuf>,
    inputs: &[PathBuf],
) -> Result<(), Failure> {
    let inputs: Vec<PathBuf> = inputs.iter().map(|path| real(path)).collect();
    match outputs.find(|path| inputs.contains(&real(path))) {
        None => Ok(()),
        Some(path) => Err(Failure::usage(format!(
            "{}: this output is an input as well; give it another name",
            path.display()
        ))),
    }
}

/// A folder that will be made if it is not there.
#[derive(Debug)]
pub(super) struct NewFolder(PathBuf);

impl NewFolder {
    /// Refuses what is no folder and cannot become one, and one in which `file` cannot be written.
    pub(super) fn new(path: &Path, file: &str) -> Result<Self, Failure> {
        // Without a separator at the end.
        let path: PathBuf = path.components().collect();
        if path.is_dir() {
            check_place(&path.join(file))?;
        } else if path.exists() {
            return Err(Failure::usage(format!(
                "{}: this is a file; name a folder",
                path.display()
            )));
        } else {
            check_place(&path)?;
        }
        Ok(Self(path))
    }

    /// Makes it while files are written into it; if they are not, it is as it was.
    pub(super) fn with<T>(&self, write: impl FnOnce() -> Result<T>) -> Result<T> {
        let is_new = !self.0.is_dir();
        if is_new {
            std::fs::create_dir(&self.0)
                .with_context(|| format!("{}: cannot be created", self.0.display()))?;
        }
        write().inspect_err(|_| {
            if is_new {
                // What holds something stays.
                let _ = std::fs::remove_dir(&self.0);
            }
        })
    }
}

/// As what spheres are written.
#[derive(Clone, Copy, Debug)]
pub(super) enum SpheresFormat {
    Npy,
    RawF32x4,
}

impl SpheresFormat {
    /// The format that an extension stands for, if the file can be written.
    pub(super) fn of(path: &Path) -> Result<Self, Failure> {
        let format = match extension(path).as_deref() {
            Some("npy") => Self::Npy,
            Some("bin") => Self::RawF32x4,
            _ => {
                return Err(Failure::usage(format!(
                    "{}: spheres are written as .npy or .bin; change its extension",
                    path.display()
                )));
            }
        };
        check_place(path)?;
        Ok(format)
    }
}

/// Writes spheres to a file.
pub(super) fn write_spheres(
    path: &Path,
    format: SpheresFormat,
    spheres: &[[f32; 4]],
) -> Result<()> {
    let file = unnamed_with(path, |file| match format {
        SpheresFormat::Npy => npy::write_spheres(spheres, file),
        SpheresFormat::RawF32x4 => raw::write_spheres(spheres, file),
    })?;
    name_all(vec![(&path.to_path_buf(), file)])
}

/// A file beside the one that it will become. It is removed if the program is stopped.
fn temporary(path: &Path) -> Result<NamedTempFile> {
    interrupt::creating(|| temporary_in_folder(path), |file| file.path().to_path_buf())
}

fn temporary_in_folder(path: &Path) -> Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".pinhole-");
    // As any new file: what the umask leaves of this.
    #[cfg(unix)]
    builder.permissions(<Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666));
    builder
        .tempfile_in(folder(&real(path)))
        .map_err(|error| without_name(&error))
        .with_context(|| format!("{}: cannot be written", path.display()))
}

/// The reason without the temporary file's name, which means nothing to the user.
fn without_name(error: &io::Error) -> anyhow::Error {
    let text = error.to_string();
    let reason = text.split_once(" at path ").map_or(&*text, |(reason, _)| reason);
    anyhow!("{reason}")
}

pub(super) fn unnamed(path: &Path, contents: &[u8]) -> Result<NamedTempFile> {
    unnamed_with(path, |file| file.write_all(contents))
}

pub(super) fn unnamed_with(
    path: &Path,
    write: impl FnOnce(&mut NamedTempFile) -> io::Result<()>,
) -> Result<NamedTempFile> {
    let cannot_write = || format!("{}: cannot be written", path.display());
    let mut file = temporary(path)?;
    write(&mut file).map_err(|error| without_name(&error)).with_context(cannot_write)?;
    file.as_file().sync_all().with_context(cannot_write)?;
    if let Ok(old) = path.metadata() {
        file.as_file().set_permissions(old.permissions()).with_context(cannot_write)?;
    }
    Ok(file)
}

/// Gives complete files their names. If one cannot have its name, those that were new are removed again.
pub(super) fn name_all(files: Vec<(&PathBuf, NamedTempFile)>) -> Result<()> {
    let any = !files.is_empty();
    interrupt::all_or_nothing(any, || name_each(files))
}

fn name_each(files: Vec<(&PathBuf, NamedTempFile)>) -> Result<()> {
    let mut new = Vec::new();
    for (path, file) in files {
        let existed = path.exists();
        if let Err(error) = file.persist(real(path)) {
            for path in new {
                // What cannot be removed either is still a complete file.
                let _ = std::fs::remove_file(path);
            }
            return Err(error.error)
                .with_context(|| format!("{}: cannot be written", path.display()));
        }
        if !existed {
            new.push(path);
        }
    }
    Ok(())
}

/// One spelling for all that a file can be called, whether it is there or not. What a link points to is
/// replaced, not the link.
fn real(path: &Path) -> PathBuf {
    if let Ok(target) = path.canonicalize() {
        return target;
    }
    // A link to a file that is yet to be made.
    let linked = path.read_link().map(|link| folder(path).join(link));
    let path = linked.as_deref().unwrap_or(path);
    let folder = folder(path);
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    path.file_name().map_or_else(|| path.to_path_buf(), |name| folder.join(name))
}

/// Refuses folders, and files in folders that are not there or cannot be written.
pub(super) fn check_place(path: &Path) -> Result<(), Failure> {
    let ends_with_separator = path
        .as_os_str()
        .as_encoded_bytes()
        .last()
        .is_some_and(|b| std::path::is_separator(*b as char));
    if path.is_dir() || ends_with_separator {
        return Err(Failure::usage(format!("{}: this is a folder; name a file", path.display())));
    }
    if path.metadata().is_ok_and(|old| !old.is_file()) {
        return Err(Failure::usage(format!(
            "{}: this is no regular file, and would be replaced by one; choose another name",
            path.display()
        )));
    }
    let folder = folder(path);
    if !folder.is_dir() {
        return Err(Failure::usage(format!(
            "{}: the folder {} does not exist; create it first",
            path.display(),
            folder.display()
        )));
    }
    // Better now than after the work.
    temporary(path).map(drop)?;
    Ok(())
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}
