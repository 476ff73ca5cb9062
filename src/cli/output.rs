//! Files that appear whole or not at all.

use std::fs::Permissions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use tempfile::NamedTempFile;

use super::failure::Failure;
use crate::image::{Image, Layer};
use crate::io::{npy, png};

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
        let mut paths: Vec<&PathBuf> =
            picture.iter().chain(layers.iter().map(|(_, path)| path)).collect();
        paths.sort();
        if let Some(twice) = paths.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(Failure::usage(format!(
                "{}: two outputs have this name",
                twice[0].display()
            )));
        }
        Ok(Self { picture, layers })
    }

    /// The layers to render.
    pub(super) fn layers(&self) -> impl Iterator<Item = Layer> {
        self.layers.iter().map(|(layer, _)| *layer)
    }

    /// Encodes and writes everything; files get their names once all of them are complete.
    pub(super) fn write(&self, image: &Image) -> Result<()> {
        let picture = png::encode(image)?;
        let mut files = Vec::new();
        if let Some(path) = &self.picture {
            files.push((path, unnamed(path, &picture)?));
        }
        for (layer, path) in &self.layers {
            files.push((path, unnamed(path, &npy::encode(image, *layer)?)?));
        }
        if self.picture.is_none() {
            write_to_stdout(&picture)?;
        }
        for (path, file) in files {
            name(path, file)?;
        }
        Ok(())
    }
}

/// Writes one file, whole or not at all.
pub(super) fn write_file(path: &Path, contents: &[u8]) -> Result<()> {
    name(path, unnamed(path, contents)?)
}

fn unnamed(path: &Path, contents: &[u8]) -> Result<NamedTempFile> {
    let cannot_write = || format!("{}: cannot be written", path.display());
    let mut builder = tempfile::Builder::new();
    builder.prefix(".pinhole-");
    // As any new file: what the umask leaves of this.
    #[cfg(unix)]
    builder.permissions(<Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666));
    let mut file = builder.tempfile_in(folder(path)).with_context(cannot_write)?;
    file.write_all(contents).with_context(cannot_write)?;
    file.as_file().sync_all().with_context(cannot_write)?;
    Ok(file)
}

fn name(path: &Path, file: NamedTempFile) -> Result<()> {
    file.persist(path)
        .map_err(|error| error.error)
        .with_context(|| format!("{}: cannot be written", path.display()))?;
    Ok(())
}

fn write_to_stdout(bytes: &[u8]) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        // The reader has seen enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.context("standard output: cannot be written"),
    }
}

/// `LAYER=FILE.npy`
fn parse_layer(text: &str) -> Result<(Layer, PathBuf), Failure> {
    let (name, path) = text.split_once('=').ok_or_else(|| {
        Failure::usage(format!("--layer {text}: write LAYER=FILE.npy, such as depth=depth.npy"))
    })?;
    let layer = name.parse().map_err(|error| Failure::usage(format!("--layer {text}: {error}")))?;
    check_file(Path::new(path), "npy")?;
    Ok((layer, PathBuf::from(path)))
}

fn check_file(path: &Path, extension: &str) -> Result<(), Failure> {
    let found = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    if found.as_deref() != Some(extension) {
        return Err(Failure::usage(format!(
            "{}: this output is written as .{extension}; change its extension",
            path.display()
        )));
    }
    if path.is_dir() {
        return Err(Failure::usage(format!("{}: this is a folder; name a file", path.display())));
    }
    let folder = folder(path);
    if !folder.is_dir() {
        return Err(Failure::usage(format!(
            "{}: the folder {} does not exist; create it first",
            path.display(),
            folder.display()
        )));
    }
    Ok(())
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}
