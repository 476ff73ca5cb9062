//! The flags about how a picture is written: what is drawn over it, and its encoding.

use clap::Args;

use crate::input::Input;
use crate::output::picture::PictureFormat;
use crate::terminal::failure::Failure;
use crate::terminal::text::one_of;
use pinhole::LinearRgb;
use pinhole::camera::film::Film;
use pinhole::image::encoding::{Bits, Encoding};
use pinhole::image::tone::ToneCurve;
use pinhole_data::css;
use pinhole_figure::annotate::{
    AnnotationError, AnnotationPlan, Annotations, Label, LegendPlan, Panel, Position, ScaleBarPlan,
};
use pinhole_figure::color_by::ColorKey;

pub(crate) const HEADING: &str = "Annotations (drawn on a PNG, after exposure and tone)";

const PANELS: &[(&str, &str, Panel)] = &[
    ("auto", "Where the picture behind is mixed", Panel::Auto),
    ("always", "Everywhere", Panel::Always),
    ("never", "Nowhere", Panel::Never),
];

const TONES: &[(&str, &str, ToneCurve)] = &[
    ("none", "No curve: brighter light is clipped", ToneCurve::None),
    ("filmic", "A curve like that of film, for red, green and blue separately", ToneCurve::Filmic),
    ("agx", "AgX: strong colors turn white", ToneCurve::Agx),
];

#[derive(Debug, Args)]
pub(crate) struct AnnotationArgs {
    /// Show what the colors of --color-by mean, at a position: top-left, top, top-right, left, right, bottom-left,
    /// bottom, bottom-right, or fractions of the width and height such as 0.9,0.5 [without a position: right]
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "POSITION",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "right"
    )]
    legend: Option<String>,
    /// Title of the legend, which is shown if this is given [default: the name of the column]
    #[arg(long, help_heading = HEADING, value_name = "TEXT")]
    legend_title: Option<String>,
    /// Show how long a length is; write the length, the unit, or both, such as --scale-bar="20 Å", and a position after
    /// an @ [without a length: a round one] [without a position: bottom-left]
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "LENGTH UNIT[@POSITION]",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = ""
    )]
    scale_bar: Option<String>,
    /// Write a text at a position, such as "a@top-right"; may be repeated [without a position: top-left]
    #[arg(long = "label", help_heading = HEADING, value_name = "TEXT[@POSITION]")]
    labels: Vec<String>,
    /// Size of the text, as a factor of 1/36 of the picture's height
    #[arg(long, help_heading = HEADING, value_name = "F")]
    text_scale: Option<f32>,
    /// CSS color of text and lines [default: black or white, whichever can be read]
    #[arg(long, help_heading = HEADING, value_name = "CSS")]
    text_color: Option<String>,
    /// Whether a translucent panel lies behind annotations [default: auto]
    #[arg(long, help_heading = HEADING, value_parser = one_of(PANELS))]
    panel: Option<Panel>,
    /// Pixels per inch at which a PNG is to be printed; changes no pixel [default: the scene's, or none]
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    pub(crate) dpi: Option<f32>,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct AnnotationFlags {
    plan: AnnotationPlan,
    format: Option<PictureFormat>,
    /// Whether a flag names the column, so that the title in a scene file is that of another one.
    has_new_column: bool,
}

impl AnnotationFlags {
    pub(crate) fn new(
        args: &AnnotationArgs,
        format: PictureFormat,
        has_new_column: bool,
    ) -> Result<Self, Failure> {
        let refused = |flag: &str, error: &dyn std::fmt::Display| {
            Failure::usage(format!("--{flag}: {error}"))
        };
        let position = |flag: &'static str, text: &str| {
            text.parse::<Position>().map_err(|error| refused(flag, &error))
        };
        let legend = match (&args.legend, &args.legend_title) {
            (None, None) => None,
            (at, title) => {
                let position = at.as_deref().map(|text| position("legend", text)).transpose()?;
                Some(LegendPlan { title: title.clone(), position })
            }
        };
        let [low, high] = Annotations::TEXT_SCALES;
        if let Some(scale) = args.text_scale.filter(|scale| !(low..=high).contains(scale)) {
            return Err(Failure::usage(format!(
                "--text-scale {scale}: it must be from {low} to {high}"
            )));
        }
        let color = args.text_color.as_deref().map(css::color).transpose();
        let color = color.map_err(|error| refused("text-color", &error))?;
        let plan = AnnotationPlan {
            legend,
            scale_bar: args.scale_bar.as_deref().map(scale_bar),
            labels: args.labels.iter().map(|text| label(text)).collect(),
            text_scale: args.text_scale,
            color: color.map(LinearRgb::to_srgb8),
            panel: args.panel,
        };
        if format == PictureFormat::Exr && !plan.is_empty() {
            return Err(Failure::usage(
                "--legend, --scale-bar and --label are drawn on PNG pictures; an EXR file stores the light unchanged; \
                 remove them or give -o a name that ends with .png",
            ));
        }
        Ok(Self { plan, format: Some(format), has_new_column })
    }

    /// The parts of the film that a camera must leave free for the legend. `file` is what a scene file draws.
    pub(crate) fn free_sides(
        &self,
        file: &AnnotationPlan,
        key: Option<&ColorKey>,
        film: Film,
    ) -> [f64; 4] {
        match self.format {
            Some(PictureFormat::Exr) => [0.0; 4],
            _ => self.plan_over(file).free_sides(key, film),
        }
    }

    /// What is to be drawn: what a scene file says, over which flags take precedence.
    pub(crate) fn plan_over(&self, file: &AnnotationPlan) -> AnnotationPlan {
        let (mut file, flags) = (file.clone(), self.plan.clone());
        if let Some(legend) = file.legend.as_mut().filter(|_| self.has_new_column) {
            legend.title = None;
        }
        let legend = match (flags.legend, file.legend) {
            (Some(flag), Some(key)) => Some(LegendPlan {
                title: flag.title.or(key.title),
                position: flag.position.or(key.position),
            }),
            (flag, key) => flag.or(key),
        };
        AnnotationPlan {
            legend,
            scale_bar: flags.scale_bar.or(file.scale_bar),
            labels: file.labels.into_iter().chain(flags.labels).collect(),
            text_scale: flags.text_scale.or(file.text_scale),
            color: flags.color.or(file.color),
            panel: flags.panel.or(file.panel),
        }
    }

    /// The annotations of a picture. Notes are given to `note`.
    pub(crate) fn for_input(
        &self,
        input: &Input,
        note: impl Fn(&dyn std::fmt::Display),
    ) -> Result<Annotations, Failure> {
        let plan = self.plan_over(&input.annotations);
        if plan.is_empty() {
            return Ok(Annotations::default());
        }
        if self.format == Some(PictureFormat::Exr) {
            note(
                &"an EXR picture stores the light unchanged, so annotations are not drawn; write a .png for them",
            );
            return Ok(Annotations::default());
        }
        let middle = input.scene.bounds_to_frame();
        let middle = 0.5 * (middle.min() + middle.max());
        let made = plan.annotations(input.color_key.as_ref(), &input.view(), middle);
        let (annotations, notes) = made.map_err(|error| match error {
            AnnotationError::NoKey => Failure::usage(format!("{error}, with --color-by COLUMN")),
            error => Failure::usage(error.to_string()),
        })?;
        notes.iter().for_each(|text| note(text));
        Ok(annotations)
    }
}

/// Splits `TEXT@POSITION`. What follows the last @ belongs to the text unless it is a position.
fn at_position(text: &str) -> (&str, Option<Position>) {
    let split = text
        .rsplit_once('@')
        .and_then(|(text, position)| Some((text, Some(position.parse::<Position>().ok()?))));
    split.unwrap_or((text, None))
}

fn label(text: &str) -> Label {
    let (text, position) = at_position(text);
    Label { text: text.to_owned(), position: position.unwrap_or(Position::TOP_LEFT) }
}

/// Reads a length, a unit, or both.
fn scale_bar(text: &str) -> ScaleBarPlan {
    let (text, position) = at_position(text);
    let text = text.trim();
    // The longest beginning that is a number.
    let ends = text.char_indices().map(|(start, c)| start + c.len_utf8()).rev();
    let number = ends.filter_map(|end| Some((text[..end].trim_end().parse::<f64>().ok()?, end)));
    let number = number.into_iter().find(|(length, _)| length.is_finite());
    let (length, unit) = match number {
        Some((length, end)) => (Some(length), &text[end..]),
        None => (None, text),
    };
    ScaleBarPlan { length, unit: unit.trim().to_owned(), position }
}

/// Flags for writing the picture. [`EncodingFlags`] checks them.
#[derive(Debug, Args)]
pub(crate) struct EncodingArgs {
    /// Bits per channel of a PNG, 8 or 16 [default: the scene's, or 8]
    #[arg(long, value_name = "N")]
    bits: Option<u32>,
    /// Make the background transparent: write RGBA, with alpha from the spheres [default: the scene's, or false]
    #[arg(
        long,
        value_name = "BOOL",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "true"
    )]
    transparent: Option<bool>,
    /// Exposure of a PNG in stops from -32 to 32; each stop doubles the brightness [default: the scene's, or 0]
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    exposure: Option<f32>,
    /// Tone curve of a PNG, which brings light that is brighter than white into range [default: the scene's, or none]
    #[arg(long, value_parser = one_of(TONES))]
    tone: Option<ToneCurve>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct EncodingFlags {
    bits: Option<Bits>,
    transparent: Option<bool>,
    exposure: Option<f32>,
    tone: Option<ToneCurve>,
    dots_per_inch: Option<f32>,
}

impl EncodingFlags {
    pub(crate) fn new(
        args: &EncodingArgs,
        dots_per_inch: Option<f32>,
        format: PictureFormat,
    ) -> Result<Self, Failure> {
        let EncodingArgs { bits, transparent, exposure, tone } = *args;
        let checked = Encoding::default().with_dots_per_inch(dots_per_inch);
        checked.map_err(|error| Failure::usage(format!("--dpi: {error}")))?;
        if format == PictureFormat::Exr && dots_per_inch.is_some() {
            return Err(Failure::usage("--dpi applies only to PNG; remove --dpi"));
        }
        let given = [
            ("--bits", bits.is_some()),
            ("--exposure", exposure.is_some()),
            ("--tone", tone.is_some()),
        ];
        let given = given.into_iter().find(|(_, is_given)| *is_given);
        if let (PictureFormat::Exr, Some((flag, _))) = (format, given) {
            return Err(Failure::usage(format!(
                "{flag} applies only to PNG; an EXR file stores the light unchanged in 32 bits; remove {flag}"
            )));
        }
        if let Some(stops) = exposure {
            let checked = Encoding::default().with_exposure(stops);
            checked.map_err(|error| Failure::usage(format!("--exposure: {error}")))?;
        }
        let bits = bits.map(Bits::new).transpose();
        Ok(Self {
            bits: bits.map_err(|error| Failure::usage(format!("--bits: {error}")))?,
            transparent,
            exposure,
            tone,
            dots_per_inch,
        })
    }

    /// Applies the flags to the encoding of a scene. Flags take precedence.
    pub(crate) fn apply_to(self, scene: Encoding) -> Encoding {
        let mut encoding = scene;
        encoding.bits = self.bits.unwrap_or(scene.bits);
        encoding.transparent = self.transparent.unwrap_or(scene.transparent);
        encoding.tone = self.tone.unwrap_or(scene.tone);
        // What the setters refuse was refused before, so neither fails.
        let exposure = self.exposure.unwrap_or(scene.exposure());
        encoding = encoding.with_exposure(exposure).unwrap_or(encoding);
        let dots_per_inch = self.dots_per_inch.or(scene.dots_per_inch());
        encoding.with_dots_per_inch(dots_per_inch).unwrap_or(encoding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pinhole_figure::annotate::Anchor;

    #[test]
    fn a_scale_bar_has_a_length_and_a_unit() {
        let bar = |text: &str| {
            let ScaleBarPlan { length, unit, position } = scale_bar(text);
            (length, unit, position)
        };
        assert_eq!(bar(""), (None, String::new(), None));
        assert_eq!(bar("20 Å"), (Some(20.0), "Å".to_owned(), None));
        assert_eq!(bar("2.5e3"), (Some(2500.0), String::new(), None));
        assert_eq!(bar("5eV"), (Some(5.0), "eV".to_owned(), None));
        let right = Position::Anchor(Anchor::BottomRight);
        assert_eq!(bar("µm@bottom-right"), (None, "µm".to_owned(), Some(right)));
        assert_eq!(bar("inf"), (None, "inf".to_owned(), None));
    }

    #[test]
    fn a_label_ends_before_its_position() {
        assert_eq!(label("me@home").text, "me@home");
        let label = label("a@b@0.5,1");
        assert_eq!((label.text.as_str(), label.position), ("a@b", Position::At([0.5, 1.0])));
    }
}
