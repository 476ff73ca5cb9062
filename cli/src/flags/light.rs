//! The light flags of the command line. They take precedence over the keys of a scene file.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use crate::terminal::failure::Failure;
use crate::terminal::text::one_of;
use pinhole::LinearRgb;
use pinhole::camera::filter::PixelFilter;
use pinhole::range::RangeError;
use pinhole::render::{Integrator, Occlusion, Outline, RenderSettings, Sampling, Studio};
use pinhole_data::css;
use pinhole_figure::scene_file::IntegratorKind;
use pinhole_figure::style::Style;

/// Heading of these flags in the help. It is set on each flag, because clap would put later flags under a heading that
/// is set once.
pub(crate) const HEADING: &str = "Light and style";

const INTEGRATORS: &[(&str, &str, IntegratorKind)] = &[
    (
        "primary",
        "No light: the color of the first sphere that the ray through the center of a pixel hits",
        IntegratorKind::Primary,
    ),
    (
        "studio",
        "Direct light from lights to surfaces: shadows, ambient occlusion, opacity, outlines",
        IntegratorKind::Studio,
    ),
    ("path", "Path tracing: light is followed as surfaces scatter it", IntegratorKind::Path),
];

const FILTERS: &[(&str, &str, PixelFilter)] = &[
    ("box", "", PixelFilter::Box),
    ("gaussian", "", PixelFilter::Gaussian),
    ("blackman-harris", "", PixelFilter::BlackmanHarris),
];

#[derive(Clone, Debug, Default, Args)]
pub(crate) struct LightArgs {
    /// Look of the picture: light, lines and background. It takes the place of the scene's [default: the scene's; for
    /// data files: default, or the one that suits --integrator]
    #[arg(long, help_heading = HEADING, value_name = "STYLE", value_parser = styles())]
    style: Option<Style>,
    /// CSS color of the background [default: the scene's, or the style's]
    #[arg(long, help_heading = HEADING, value_name = "CSS")]
    background: Option<String>,
    /// How the light is computed [default: the scene's, or the style's]
    #[arg(long, help_heading = HEADING, value_parser = one_of(INTEGRATORS))]
    integrator: Option<IntegratorKind>,
    /// Samples per pixel, from 1 to 16777216: how smooth the picture is [default: the scene's, or the style's]
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    samples: Option<u32>,
    /// Seed of the random numbers; another seed gives other noise [default: the scene's, or 0]
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    seed: Option<u32>,
    /// Pixel filter, which weights the samples around the center of a pixel [default: the scene's, or blackman-harris]
    #[arg(long, help_heading = HEADING, value_parser = one_of(FILTERS))]
    filter: Option<PixelFilter>,
    /// Ambient occlusion with this number of rays per sample, from 1 to 1024 (studio) [without a number: 4]
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "RAYS",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "4"
    )]
    ao: Option<u32>,
    /// Outlines around shapes with this width in pixels, from 0.5 to 64 (studio)
    #[arg(long, help_heading = HEADING, value_name = "PIXELS", allow_hyphen_values = true)]
    outline: Option<f32>,
    /// Remove noise with a filter that is guided by shapes and colors [default: the scene's, or the style's]
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "BOOL",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "true"
    )]
    denoise: Option<bool>,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct LightFlags {
    args: LightArgs,
    background: Option<LinearRgb>,
    /// The flag (`--time` or `--noise`) that leaves the number of samples open, unless `samples` limits it.
    open_ended_by: Option<&'static str>,
}

impl LightFlags {
    /// `open_ended_by` is the flag that leaves the number of samples open, if there is one.
    pub(crate) fn new(
        args: &LightArgs,
        open_ended_by: Option<&'static str>,
    ) -> Result<Self, Failure> {
        let LightArgs { samples, ao, outline, .. } = *args;
        let refused = |flag: &str, given: String, error: &RangeError| {
            Failure::usage(format!("--{flag} {given}: it must be {}", error.range))
        };
        let background = args.background.as_deref().map(css::color).transpose();
        let background =
            background.map_err(|error| Failure::usage(format!("--background: {error}")))?;
        if let Some(samples) = samples {
            let sampling = Sampling { samples, ..Sampling::default() };
            sampling.check().map_err(|error| refused("samples", samples.to_string(), &error))?;
        }
        let mut studio = Studio::default();
        if let Some(rays) = ao {
            add_to_studio(&mut studio, ao, None);
            studio.check().map_err(|error| refused("ao", rays.to_string(), &error))?;
        }
        if let Some(width) = outline {
            add_to_studio(&mut studio, None, outline);
            studio.check().map_err(|error| refused("outline", width.to_string(), &error))?;
        }
        Ok(Self { args: args.clone(), background, open_ended_by })
    }

    /// Returns the style that takes the place of the scene's.
    pub(crate) fn style(&self) -> Option<Style> {
        self.args.style
    }

    /// Returns the style of data that no scene file describes.
    pub(crate) fn style_of_data(&self) -> Style {
        self.args.style.unwrap_or(match self.args.integrator {
            Some(IntegratorKind::Primary) => Style::Fast,
            Some(IntegratorKind::Path) => Style::Path,
            Some(IntegratorKind::Studio) | None => Style::Default,
        })
    }

    /// Returns the style of bricks, which have one ray for each pixel unless a flag asks for light.
    pub(crate) fn style_of_bricks(&self) -> Style {
        match self.args.integrator {
            None => self.args.style.unwrap_or(Style::Fast),
            Some(_) => self.style_of_data(),
        }
    }

    /// Returns the background that takes the place of the scene's.
    pub(crate) fn background(&self) -> Option<LinearRgb> {
        self.background
    }

    /// Returns the integrator of the picture; `scene` is the one that the scene asks for. If neither says, occlusion
    /// needs a studio, and other flags do not change the light.
    pub(crate) fn integrator(&self, scene: Option<IntegratorKind>) -> IntegratorKind {
        let by_flags = self.args.ao.map(|_| IntegratorKind::Studio);
        self.args.integrator.or(scene).or(by_flags).unwrap_or_default()
    }

    /// Returns the flags that were given and ask for light.
    fn for_light(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("--samples", self.args.samples.is_some()),
            ("--seed", self.args.seed.is_some()),
            ("--filter", self.args.filter.is_some()),
            ("--ao", self.args.ao.is_some()),
            ("--outline", self.args.outline.is_some()),
            ("--denoise", self.args.denoise == Some(true)),
        ];
        let given = given.into_iter().filter(|(_, is_given)| *is_given).map(|(flag, _)| flag);
        given.chain(self.open_ended_by)
    }

    /// Applies the flags to the settings of a scene. Flags take precedence. `scene` is the integrator that the scene
    /// asks for; if neither it nor a flag asks for one, samples smooth the edges and do not change the light.
    pub(crate) fn apply_to(
        &self,
        mut settings: RenderSettings,
        scene: Option<IntegratorKind>,
    ) -> Result<RenderSettings, Failure> {
        if let (Integrator::Primary(_), Some(flag)) =
            (&settings.integrator, self.for_light().next())
        {
            if self.args.integrator.or(scene).is_some() {
                return Err(Failure::usage(format!(
                    "{flag} applies only to the integrators `studio` and `path`, but this picture is made by \
                     `primary`; remove {flag} or choose another --integrator or --style"
                )));
            }
            settings = settings.with_smooth_edges();
        }
        let sampling = &mut settings.sampling;
        let most =
            if self.open_ended_by.is_some() { Sampling::MAX_SAMPLES } else { sampling.samples };
        sampling.samples = self.args.samples.unwrap_or(most);
        sampling.seed = self.args.seed.unwrap_or(sampling.seed);
        sampling.filter = self.args.filter.unwrap_or(sampling.filter);
        settings.is_denoised = self.args.denoise.unwrap_or(settings.is_denoised);
        let flag = if self.args.ao.is_some() { "--ao" } else { "--outline" };
        match &mut settings.integrator {
            Integrator::Studio(studio) => add_to_studio(studio, self.args.ao, self.args.outline),
            Integrator::Path(_) if self.args.ao.is_some() || self.args.outline.is_some() => {
                return Err(Failure::usage(format!(
                    "{flag} applies only to the integrator `studio`, but this picture is made by `path`; \
                     remove {flag} or choose --integrator studio"
                )));
            }
            _ => {}
        }
        Ok(settings)
    }
}

fn add_to_studio(studio: &mut Studio, ao: Option<u32>, outline: Option<f32>) {
    if let Some(samples) = ao {
        studio.occlusion = Some(Occlusion { samples, ..studio.occlusion.unwrap_or_default() });
    }
    if let Some(width) = outline {
        studio.outline = Some(Outline { width, ..studio.outline.unwrap_or(Outline::thin()) });
    }
}

fn styles() -> impl TypedValueParser<Value = Style> {
    PossibleValuesParser::new(Style::ALL.iter().map(|style| style.name()))
        .try_map(|name| Style::of_name(&name).ok_or("this is not a style"))
}
