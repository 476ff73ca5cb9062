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
use super::progress;
use super::speak::answer;
use crate::image::{Image, Layer};
use crate::io::{npy, png, raw};

/// Where the results go, checked before any work is done.
#[derive(Debug)]
pub(super) struct Outputs {
    /// `None` is standard output.
    picture: Option<PathBuf>,
    layers: Vec<(Layer, PathBuf)>,
}

impl Outputs {
    /// Checks what the user typed: extensions, folders, layers, and that no file is named twice.
    pub(super) fn new(picture: &Path, layers: &[String]) -> Result<Self, Failure> {
        let picture = if picture == Path::new("-") {
            None
        } else {
            check_file(picture, "png")?;
            Some(picture.to_path_buf())
        };
        let layers = layers.iter().map(|text| parse_layer(text)).collect::<Result<Vec<_>, _>>()?;
        let outputs = Self { picture, layers };
        check_distinct(outputs.paths())?;
        Ok(outputs)
    }

    fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.picture.iter().chain(self.layers.iter().map(|(_, path)| path))
    }

    /// Refuses to overwrite what was read.
    pub(super) fn spare(&self, inputs: &[PathBuf]) -> Result<(), Failure> {
        spare(self.paths(), inputs)
    }

    /// The layers to render.
    pub(super) fn layers(&self) -> impl Iterator<Item = Layer> {
        self.layers.iter().map(|(layer, _)| *layer)
    }

    /// Encodes and writes everything, and `text` to a file if there is one; files get their names once
    /// all of them are complete.
    pub(super) fn write(&self, image: &Image, text: Option<(&PathBuf, &str)>) -> Result<()> {
        progress::stage("writing");
        let picture = png::encode(image)?;
        let mut files = Vec::new();
        if let Some((path, text)) = text {
            files.push((path, unnamed(path, text.as_bytes())?));
        }
        files.extend(self.files(image, &picture)?);
        name_all(files)?;
        if self.picture.is_none() {
            interrupt::words(
                "stopped; what was written to standard output is not the whole picture",
            );
            answer(&picture).context("standard output: cannot be written")?;
        }
        Ok(())
    }
}

impl Outputs {
    /// Files that have no names yet.
    fn files(&self, image: &Image, picture: &[u8]) -> Result<Vec<(&PathBuf, NamedTempFile)>> {
        let mut files = Vec::new();
        if let Some(path) = &self.picture {
            files.push((path, unnamed(path, picture)?));
        }
        for (layer, path) in &self.layers {
            files.push((path, unnamed(path, &npy::encode(image, *layer)?)?));
        }
        Ok(files)
    }

    /// Outputs for the left and for the right eye, beside those that were named.
    pub(super) fn of_eyes(&self) -> Result<[Self; 2], Failure> {
        let Some(picture) = &self.picture else {
            return Err(Failure::usage(
                "--stereo two-files: standard output takes one picture; name a file",
            ));
        };
        let outputs = ["left", "right"].map(|eye| Self {
            picture: Some(with_eye(picture, eye)),
            layers: self.layers.iter().map(|(layer, path)| (*layer, with_eye(path, eye))).collect(),
        });
        let paths = || outputs.iter().flat_map(Self::paths);
        paths().try_for_each(|path| check_place(path))?;
        check_distinct(paths())?;
        Ok(outputs)
    }

    /// As [`Outputs::write`], for both eyes.
    pub(super) fn write_both(outputs: &[Self; 2], images: &[Image]) -> Result<()> {
        progress::stage("writing");
        let mut files = Vec::new();
        for (outputs, image) in outputs.iter().zip(images) {
            files.extend(outputs.files(image, &png::encode(image)?)?);
        }
        name_all(files)
    }
}

/// NAME-left.png of NAME.png.
fn with_eye(path: &Path, eye: &str) -> PathBuf {
    let [stem, extension] = [path.file_stem(), path.extension()].map(Option::unwrap_or_default);
    let mut name = stem.to_os_string();
    name.push(format!("-{eye}."));
    name.push(extension);
    path.with_file_name(name)
}

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

/// `LAYER=FILE.npy`
fn parse_layer(text: &str) -> Result<(Layer, PathBuf), Failure> {
    let (name, path) = text.split_once('=').ok_or_else(|| {
        Failure::usage(format!("--layer {text}: write LAYER=FILE.npy, such as depth=depth.npy"))
    })?;
    if path.is_empty() {
        return Err(Failure::usage(format!("--layer {text}: name a file behind the =")));
    }
    let layer = name.parse().map_err(|error| Failure::usage(format!("--layer {text}: {error}")))?;
    check_file(Path::new(path), "npy")?;
    Ok((layer, PathBuf::from(path)))
}

fn check_file(path: &Path, wanted: &str) -> Result<(), Failure> {
    if extension(path).as_deref() != Some(wanted) {
        return Err(Failure::usage(format!(
            "{}: this output is written as .{wanted}; change its extension",
            path.display()
        )));
    }
    check_place(path)
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
