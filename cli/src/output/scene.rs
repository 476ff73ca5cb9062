//! The scene file of a picture, with every value that the program chose.

use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result, anyhow};

use crate::input::{Input, extension};
use crate::output::files::{check_not_inputs, check_writable};
use crate::terminal::failure::Failure;
use pinhole::internals::text::whole_line;
use pinhole_figure::scene_file::Settled;

/// Returns the text of the scene file. Paths in it are relative to `folder`, or else to the current one.
pub(crate) fn text(input: &Input, folder: Option<&Path>) -> Result<String> {
    input.files.iter().try_for_each(|path| named(path).map(drop))?;
    let placed = |path: &Path| match folder {
        Some(folder) => named(&relative(path, folder)?),
        None => named(path),
    };
    let mut data = input.data.clone();
    if let Some(data) = &mut data {
        data.file = placed(Path::new(&data.file))?;
        data.topology = data.topology.as_deref().map(|file| placed(Path::new(file))).transpose()?;
    }
    let settled = Settled {
        camera: input.parameters,
        settings: &input.settings,
        sky_image: input.sky_image.as_deref().map(placed).transpose()?,
        data,
        cone_files: input.cone_files.iter().map(|path| placed(path)).collect::<Result<_>>()?,
    };
    let place = match folder {
        Some(_) => "of this file".to_owned(),
        None => "in which it was written: keep it there, or write it with --save-scene".to_owned(),
    };
    Ok(format!(
        "# The scene that `pinhole render` made of {}, with every value that it chose.\n\
         # Paths are relative to the folder {place}.\n\n{}\n",
        whole_line(&input.report.path),
        input.file.settled(settled).trim_end()
    ))
}

/// Checks that a scene file can be written to this path.
pub(crate) fn check(path: &PathBuf, inputs: &[PathBuf]) -> Result<(), Failure> {
    if extension(path).as_deref() != Some("toml") {
        return Err(Failure::usage(format!(
            "--save-scene: {}: the name of a scene file ends in .toml; change it",
            path.display()
        )));
    }
    check_not_inputs(std::iter::once(path), inputs)?;
    check_writable(path)
}

/// Returns a path as text, because a scene file can only name paths that are text.
fn named(path: &Path) -> Result<String> {
    if path.as_os_str() == "-" {
        return Err(anyhow!("-: a scene file cannot name standard input; save the data to a file"));
    }
    let text = path.to_str().ok_or_else(|| {
        anyhow!("{}: a scene file cannot name this path, because it is not UTF-8; rename it", path.display())
    })?;
    Ok(text.to_owned())
}

/// The path of a file seen from a folder. Both are relative to the current folder; an absolute path stays as it is.
fn relative(path: &Path, folder: &Path) -> Result<PathBuf> {
    if path.is_absolute() {
        return Ok(path.to_path_buf());
    }
    let whole = |folder: &Path| {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        folder.canonicalize().with_context(|| folder.display().to_string())
    };
    let from = whole(folder)?;
    let to = whole(path.parent().unwrap_or(Path::new("")))?.join(path.file_name().unwrap_or_default());
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let up = from.components().skip(shared).map(|_| Component::ParentDir);
    Ok(up.chain(to.components().skip(shared)).collect())
}
