//! The light flags of the command line. They take precedence over the keys of a scene file.

use clap::{Args, ValueEnum};

use super::failure::Failure;
use pinhole::camera::filter::PixelFilter;
use pinhole::range::RangeError;
use pinhole::render::{Integrator, Occlusion, Outline, RenderSettings, Sampling, Studio};
use pinhole::scene_file::IntegratorKind;

/// Heading of these flags in the help. It is set on each flag, because clap would put later flags under a heading that
/// is set once.
pub(super) const HEADING: &str =
    "Light (any of these flags, or a table about light in the scene, makes a lit picture)";

#[derive(Debug, Args)]
pub(super) struct LightArgs {
    /// How the light is computed [default: the scene's; studio if another flag asks for light; otherwise primary]
    #[arg(long, help_heading = HEADING, value_enum)]
    integrator: Option<IntegratorArg>,
    /// Samples per pixel, from 1 to 16777216 [default: the scene's, or 16]
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    samples: Option<u32>,
    /// Seed of the random numbers; another seed gives other noise [default: the scene's, or 0]
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    seed: Option<u32>,
    /// Pixel filter, which weights the samples around the center of a pixel [default: the scene's, or blackman-harris]
    #[arg(long, help_heading = HEADING, value_enum)]
    filter: Option<FilterArg>,
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
    /// Remove noise with a filter that is guided by shapes and colors
    #[arg(long, help_heading = HEADING)]
    denoise: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum IntegratorArg {
    /// No light: the color of the first sphere that the ray through the center of a pixel hits
    Primary,
    /// Direct light from lights to surfaces: shadows, ambient occlusion, opacity, outlines
    Studio,
    /// Path tracing: light is followed as surfaces scatter it
    Path,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FilterArg {
    Box,
    Gaussian,
    BlackmanHarris,
}

impl From<FilterArg> for PixelFilter {
    fn from(filter: FilterArg) -> Self {
        match filter {
            FilterArg::Box => Self::Box,
            FilterArg::Gaussian => Self::Gaussian,
            FilterArg::BlackmanHarris => Self::BlackmanHarris,
        }
    }
}

/// The flags that were given, checked.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LightFlags {
    integrator: Option<IntegratorKind>,
    samples: Option<u32>,
    seed: Option<u32>,
    filter: Option<PixelFilter>,
    ao: Option<u32>,
    outline: Option<f32>,
    denoise: bool,
    /// The flag (`--time` or `--noise`) that leaves the number of samples open, unless `samples` limits it.
    open_ended_by: Option<&'static str>,
}

impl LightFlags {
    pub(super) fn new(args: &LightArgs) -> Result<Self, Failure> {
        let LightArgs { samples, seed, ao, outline, denoise, .. } = *args;
        let refused = |flag: &str, error: &RangeError| {
            Failure::usage(format!("--{flag} {}: it must be {}", error.value(), error.range))
        };
        if let Some(samples) = samples {
            let sampling = Sampling { samples, ..Sampling::default() };
            sampling.check().map_err(|error| refused("samples", &error))?;
        }
        let mut studio = Studio::default();
        add_to_studio(&mut studio, ao, None);
        studio.check().map_err(|error| refused("ao", &error))?;
        add_to_studio(&mut studio, None, outline);
        studio.check().map_err(|error| refused("outline", &error))?;
        let integrator = args.integrator.map(|integrator| match integrator {
            IntegratorArg::Primary => IntegratorKind::Primary,
            IntegratorArg::Studio => IntegratorKind::Studio,
            IntegratorArg::Path => IntegratorKind::Path,
        });
        let filter = args.filter.map(Into::into);
        Ok(Self { integrator, samples, seed, filter, ao, outline, denoise, open_ended_by: None })
    }

    /// Returns these flags with the flag that leaves the number of samples open, if there is one.
    pub(super) fn with_open_end(self, flag: Option<&'static str>) -> Self {
        Self { open_ended_by: flag, ..self }
    }

    /// Returns the integrator of the picture; `scene` is the one that the scene asks for.
    pub(super) fn integrator(&self, scene: Option<IntegratorKind>) -> IntegratorKind {
        let by_flags = self.for_light().next().map(|_| IntegratorKind::Studio);
        self.integrator.or(scene).or(by_flags).unwrap_or_default()
    }

    /// Returns the flags that were given and ask for light.
    fn for_light(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("--samples", self.samples.is_some()),
            ("--seed", self.seed.is_some()),
            ("--filter", self.filter.is_some()),
            ("--ao", self.ao.is_some()),
            ("--outline", self.outline.is_some()),
            ("--denoise", self.denoise),
        ];
        let given = given.into_iter().filter(|(_, is_given)| *is_given).map(|(flag, _)| flag);
        given.chain(self.open_ended_by)
    }

    /// Applies the flags to the settings of a scene. Flags take precedence.
    pub(super) fn apply_to(&self, mut settings: RenderSettings) -> Result<RenderSettings, Failure> {
        if let (Integrator::Primary(_), Some(flag)) =
            (&settings.integrator, self.for_light().next())
        {
            return Err(Failure::usage(format!(
                "{flag} applies only to the integrators `studio` and `path`, but this picture is made by `primary`; \
                 remove {flag} or choose another --integrator"
            )));
        }
        let sampling = &mut settings.sampling;
        let most =
            if self.open_ended_by.is_some() { Sampling::MAX_SAMPLES } else { sampling.samples };
        sampling.samples = self.samples.unwrap_or(most);
        sampling.seed = self.seed.unwrap_or(sampling.seed);
        sampling.filter = self.filter.unwrap_or(sampling.filter);
        settings.is_denoised |= self.denoise;
        let flag = if self.ao.is_some() { "--ao" } else { "--outline" };
        match &mut settings.integrator {
            Integrator::Studio(studio) => add_to_studio(studio, self.ao, self.outline),
            Integrator::Path(_) if self.ao.is_some() || self.outline.is_some() => {
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
        studio.outline = Some(Outline { width, ..studio.outline.unwrap_or_default() });
    }
}

/// Returns the default settings of an integrator, for data files.
pub(super) fn plain(kind: IntegratorKind) -> RenderSettings {
    match kind {
        IntegratorKind::Primary => RenderSettings::default(),
        IntegratorKind::Studio => RenderSettings::studio(),
        IntegratorKind::Path => RenderSettings::path(),
    }
}
