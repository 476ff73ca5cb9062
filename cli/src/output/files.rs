//! Writes files so that they appear complete or not at all.

use std::collections::HashSet;
use std::fs::Permissions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use tempfile::NamedTempFile;

use crate::terminal::failure::Failure;
use crate::terminal::{interrupt, profile};

/// Refuses to use one file for two outputs.
pub(crate) fn check_distinct<'a>(outputs: impl Iterator<Item = &'a PathBuf>) -> Result<(), Failure> {
    let mut seen = HashSet::new();
    for path in outputs {
        if !seen.insert(canonical(path)) {
            return Err(Failure::usage(format!(
                "{}: two outputs have this file; give each output a file of its own",
                path.display()
            )));
        }
    }
    Ok(())
}

/// Refuses to overwrite an input.
pub(crate) fn check_not_inputs<'a>(
    mut outputs: impl Iterator<Item = &'a PathBuf>,
    inputs: &[PathBuf],
) -> Result<(), Failure> {
    let inputs: Vec<PathBuf> = inputs.iter().map(|path| canonical(path)).collect();
    match outputs.find(|path| inputs.contains(&canonical(path))) {
        None => Ok(()),
        Some(path) => {
            Err(Failure::usage(format!("{}: this output is also an input; give it another name", path.display())))
        }
    }
}

/// A folder for output, which is created if it does not exist.
#[derive(Debug)]
pub(crate) struct NewFolder(PathBuf);

impl NewFolder {
    /// Refuses a path that is not a folder and cannot become one, and a folder in which `file` cannot be written.
    pub(crate) fn new(path: &Path, file: &str) -> Result<Self, Failure> {
        // Collecting the components removes a separator at the end.
        let path: PathBuf = path.components().collect();
        if path.is_dir() {
            check_writable(&path.join(file))?;
        } else if path.exists() {
            return Err(Failure::usage(format!("{}: this is a file; name a folder", path.display())));
        } else {
            check_writable(&path)?;
        }
        Ok(Self(path))
    }

    /// Creates the folder if needed and calls `write`. If `write` fails, a folder that was created is removed again.
    pub(crate) fn with<T>(&self, write: impl FnOnce() -> Result<T>) -> Result<T> {
        let is_new = !self.0.is_dir();
        if is_new {
            std::fs::create_dir(&self.0).with_context(|| format!("{}: cannot be created", self.0.display()))?;
        }
        write().inspect_err(|_| {
            if is_new {
                // This fails if the folder is not empty, and the folder then stays.
                let _ = std::fs::remove_dir(&self.0);
            }
        })
    }
}

/// Creates a temporary file in the folder of the final file. It is removed if the program is stopped.
fn temporary(path: &Path) -> Result<NamedTempFile> {
    temporary_in(folder(&canonical(path)), path)
}

fn temporary_in(folder: &Path, path: &Path) -> Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".pinhole-");
    // The umask applies to these permissions, as for any new file.
    #[cfg(unix)]
    builder.permissions(<Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666));
    interrupt::creating(|| builder.tempfile_in(folder), |file| file.path().to_path_buf())
        .map_err(|error| without_name(&error))
        .with_context(|| format!("{}: cannot be written", path.display()))
}

/// Returns the error without the name of the temporary file, which means nothing to the user.
fn without_name(error: &io::Error) -> anyhow::Error {
    let text = error.to_string();
    let reason = text.split_once(" at path ").map_or(&*text, |(reason, _)| reason);
    anyhow!("{reason}")
}

/// Writes contents to a temporary file, which [`name_all`] renames to `path`.
pub(crate) fn unnamed(path: &Path, contents: &[u8]) -> Result<NamedTempFile> {
    unnamed_with(path, |file| file.write_all(contents))
}

/// Writes a temporary file with a function. [`name_all`] renames the file to `path`.
pub(crate) fn unnamed_with(
    path: &Path,
    write: impl FnOnce(&mut NamedTempFile) -> io::Result<()>,
) -> Result<NamedTempFile> {
    let cannot_write = || format!("{}: cannot be written", path.display());
    let file = filled(path, temporary(path)?, write)?;
    if let Ok(old) = path.metadata() {
        file.as_file().set_permissions(old.permissions()).with_context(cannot_write)?;
    }
    Ok(file)
}

fn filled(
    path: &Path,
    mut file: NamedTempFile,
    write: impl FnOnce(&mut NamedTempFile) -> io::Result<()>,
) -> Result<NamedTempFile> {
    let _phase = profile::phase("write");
    let cannot_write = || format!("{}: cannot be written", path.display());
    write(&mut file).map_err(|error| without_name(&error)).with_context(cannot_write)?;
    file.as_file().sync_all().with_context(cannot_write)?;
    Ok(file)
}

/// Writes a file with a function, in a folder that strangers may have filled: a link with its name is replaced, and its
/// target is left alone.
pub(crate) fn replace(path: &Path, write: impl FnOnce(&mut NamedTempFile) -> io::Result<()>) -> Result<()> {
    let file = filled(path, temporary_in(folder(path), path)?, write)?;
    let named = interrupt::all_or_nothing(true, || file.persist(path).map(drop));
    named.map_err(|error| error.error).with_context(|| format!("{}: cannot be written", path.display()))
}

/// Gives complete files their final names. If one cannot be named, those that did not exist before are removed again.
pub(crate) fn name_all(files: Vec<(&PathBuf, NamedTempFile)>) -> Result<()> {
    let _phase = profile::phase("write");
    let any = !files.is_empty();
    interrupt::all_or_nothing(any, || name_each(files))
}

fn name_each(files: Vec<(&PathBuf, NamedTempFile)>) -> Result<()> {
    let mut new = Vec::new();
    for (path, file) in files {
        let existed = path.exists();
        if let Err(error) = file.persist(canonical(path)) {
            for path in new {
                // A file that cannot be removed is still a complete file.
                let _ = std::fs::remove_file(path);
            }
            return Err(error.error).with_context(|| format!("{}: cannot be written", path.display()));
        }
        if !existed {
            new.push(path);
        }
    }
    Ok(())
}

/// Returns the canonical path of a file, whether it exists or not. The path of a link is that of its target, because
/// the target is replaced and not the link.
fn canonical(path: &Path) -> PathBuf {
    if let Ok(target) = path.canonicalize() {
        return target;
    }
    // The path may be a link to a file that does not exist yet.
    let linked = path.read_link().map(|link| folder(path).join(link));
    let path = linked.as_deref().unwrap_or(path);
    let folder = folder(path);
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    path.file_name().map_or_else(|| path.to_path_buf(), |name| folder.join(name))
}

/// Refuses a path at which no file can be written: a folder, or a file in a folder that does not exist or is not
/// writable.
pub(crate) fn check_writable(path: &Path) -> Result<(), Failure> {
    let ends_with_separator =
        path.as_os_str().as_encoded_bytes().last().is_some_and(|b| std::path::is_separator(*b as char));
    if path.is_dir() || ends_with_separator {
        return Err(Failure::usage(format!("{}: this is a folder; name a file", path.display())));
    }
    if path.metadata().is_ok_and(|old| !old.is_file()) {
        return Err(Failure::usage(format!(
            "{}: this is not a regular file and would be replaced by one; choose another name",
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
    // A folder in which no file can be written should be noticed before the work, not after it.
    temporary(path).map(drop)?;
    Ok(())
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}
