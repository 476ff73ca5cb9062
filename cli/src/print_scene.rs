//! `pinhole render --print-scene`: writes the scene file that a command means.

use std::path::Path;

use anyhow::{Context, Result, anyhow};

use super::input::Input;
use super::speak::answer;
use pinhole::annotate::AnnotationPlan;
use pinhole::image::encoding::Encoding;
use pinhole::internals::text::one_line;
use pinhole::scene_file::{Contents, write};

/// Writes the scene file to standard output. `encoding` and `annotations` have the flags about the picture's file and
/// about what is drawn on it.
pub(super) fn print(input: &Input, encoding: Encoding, annotations: AnnotationPlan) -> Result<()> {
    let contents = Contents {
        film: input.film,
        encoding,
        annotations,
        camera: input.parameters,
        settings: &input.settings,
        sky_image: input.sky_image.as_deref().map(named).transpose()?,
        data: input.data.clone(),
        spheres: input.own_spheres.clone(),
    };
    input.files.iter().try_for_each(|path| named(path).map(drop))?;
    let title = one_line(&input.report.path);
    let text = format!(
        "# The scene that `pinhole render` made of {title}, with every value that it chose.\n\
         # Paths are relative to the folder in which it was written: keep it there.\n\n{}",
        write(&contents)
    );
    answer(text.as_bytes()).context("standard output: cannot be written")
}

/// Returns a path as text, which is all that a scene file can name.
fn named(path: &Path) -> Result<String> {
    let text = path.to_str().ok_or_else(|| {
        anyhow!(
            "{}: a scene file cannot name this path, because it is not UTF-8; rename it",
            path.display()
        )
    })?;
    Ok(text.to_owned())
}
