//! What is drawn over a picture, and flags that an EXR file cannot follow.

use crate::flags::settings::Given;
use crate::input::Input;
use crate::output::picture::PictureFormat;
use crate::terminal::failure::Failure;
use pinhole_figure::annotate::{AnnotationError, Annotations};

/// Refuses flags that apply only to PNG pictures.
pub(crate) fn check(given: &Given, format: PictureFormat) -> Result<(), Failure> {
    if format == PictureFormat::Png {
        return Ok(());
    }
    if given.first_of(&["legend", "legend-title", "scale-bar", "label"]).is_some() {
        return Err(Failure::usage(
            "--legend, --scale-bar and --label are drawn on PNG pictures; an EXR file stores the light unchanged; \
             remove them or give -o a name that ends with .png",
        ));
    }
    if given.get("dpi").is_some() {
        return Err(Failure::usage("--dpi applies only to PNG; remove --dpi"));
    }
    match given.first_of(&["bits", "exposure", "tone"]) {
        Some(flag) => Err(Failure::usage(format!(
            "{flag} applies only to PNG; an EXR file stores the light unchanged in 32 bits; remove {flag}"
        ))),
        None => Ok(()),
    }
}

/// The annotations of a picture. Notes are given to `note`.
pub(crate) fn for_input(
    input: &Input,
    format: PictureFormat,
    note: impl Fn(&dyn std::fmt::Display),
) -> Result<Annotations, Failure> {
    let plan = &input.annotations;
    if plan.is_empty() {
        return Ok(Annotations::default());
    }
    if format == PictureFormat::Exr {
        note(&"an EXR picture stores the light unchanged, so annotations are not drawn; write a .png for them");
        return Ok(Annotations::default());
    }
    let middle = input.scene.bounds_to_frame();
    let middle = 0.5 * (middle.min() + middle.max());
    let made = plan.annotations(input.color_key.as_ref(), input.arrow_key.as_ref(), &input.view(), middle);
    let (annotations, notes) = made.map_err(|error| match error {
        AnnotationError::NoKey => Failure::usage(format!("{error}, with --color-by COLUMN, or draw --arrows VECTOR")),
        error => Failure::usage(error.to_string()),
    })?;
    notes.iter().for_each(|text| note(text));
    Ok(annotations)
}
