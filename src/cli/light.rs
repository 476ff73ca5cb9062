//! Light on the command line: flags that take the place of a scene file's keys, and what to say of a lighting.

use clap::{Args, ValueEnum};

use super::failure::Failure;
use crate::filter::PixelFilter;
use crate::lighting::{
    Integrator, LightKind, Lighting, Occlusion, Outline, PathTracing, Sampling, SkyLight, Studio,
};
use crate::material::Material;
use crate::range::RangeError;
use crate::scene::Scene;
use crate::scene_file::IntegratorKind;

/// Of each flag, because clap puts whatever follows below a heading that is set once.
const HEADING: &str =
    "Light (any of these, as any table of a scene's that is about light, gives a lit picture)";

#[derive(Debug, Args)]
pub(super) struct LightArgs {
    /// How light is followed [default: the scene's, or studio]
    #[arg(long, help_heading = HEADING, value_enum)]
    integrator: Option<IntegratorArg>,
    /// Samples of each pixel, up to 16777216 [default: the scene's, or 16]
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    samples: Option<u32>,
    /// Another seed gives other noise [default: the scene's, or 0]
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    seed: Option<u32>,
    /// How samples around the centre of a pixel are weighted [default: the scene's, or blackman-harris]
    #[arg(long, help_heading = HEADING, value_enum)]
    filter: Option<FilterArg>,
    /// Ambient occlusion, with so many rays for each sample (studio) [without a number: 4]
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "RAYS",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "4"
    )]
    ao: Option<u32>,
    /// Lines of so many pixels around shapes (studio)
    #[arg(long, help_heading = HEADING, value_name = "PIXELS", allow_hyphen_values = true)]
    outline: Option<f32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum IntegratorArg {
    /// Directly from lights to surfaces: shadows, ambient occlusion, opacity, outlines
    Studio,
    /// As it is scattered: path tracing
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

/// What was given, checked.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LightFlags {
    integrator: Option<IntegratorKind>,
    samples: Option<u32>,
    seed: Option<u32>,
    filter: Option<PixelFilter>,
    ao: Option<u32>,
    outline: Option<f32>,
    /// As many samples as it takes, unless there are `samples`.
    is_open_ended: bool,
}

impl LightFlags {
    pub(super) fn new(args: &LightArgs) -> Result<Self, Failure> {
        let LightArgs { samples, seed, ao, outline, .. } = *args;
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
            IntegratorArg::Studio => IntegratorKind::Studio,
            IntegratorArg::Path => IntegratorKind::Path,
        });
        let filter = args.filter.map(Into::into);
        Ok(Self { integrator, samples, seed, filter, ao, outline, is_open_ended: false })
    }

    /// The same, for a picture that takes as many samples as it takes.
    pub(super) fn open_ended(self) -> Self {
        Self { is_open_ended: true, ..self }
    }

    /// How light is followed, if there is to be any.
    pub(super) fn integrator(&self, scene: Option<IntegratorKind>) -> Option<IntegratorKind> {
        let given = [
            self.samples.is_some(),
            self.seed.is_some(),
            self.filter.is_some(),
            self.ao.is_some(),
            self.outline.is_some(),
            self.is_open_ended,
        ];
        let by_flags = given.contains(&true).then_some(IntegratorKind::Studio);
        self.integrator.or(scene).or(by_flags)
    }

    /// Flags come before what a scene says.
    pub(super) fn over(&self, mut lighting: Lighting) -> Result<Lighting, Failure> {
        let sampling = &mut lighting.sampling;
        let most = if self.is_open_ended { Sampling::MAX_SAMPLES } else { sampling.samples };
        sampling.samples = self.samples.unwrap_or(most);
        sampling.seed = self.seed.unwrap_or(sampling.seed);
        sampling.filter = self.filter.unwrap_or(sampling.filter);
        let flag = if self.ao.is_some() { "--ao" } else { "--outline" };
        match &mut lighting.integrator {
            Integrator::Studio(studio) => add_to_studio(studio, self.ao, self.outline),
            Integrator::Path(_) if self.ao.is_some() || self.outline.is_some() => {
                return Err(Failure::usage(format!(
                    "{flag} concerns the integrator `studio`, and this picture is made by `path`; drop one"
                )));
            }
            Integrator::Path(_) => {}
        }
        Ok(lighting)
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

/// The lighting of a scene that says nothing of it.
pub(super) fn plain(kind: IntegratorKind) -> Lighting {
    let integrator = match kind {
        IntegratorKind::Studio => Integrator::Studio(Studio::default()),
        IntegratorKind::Path => Integrator::Path(PathTracing::default()),
    };
    Lighting { integrator, ..Lighting::default() }
}

/// What the user should know of a lighting although it is no error.
pub(super) fn notes(lighting: &Lighting, scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    if is_dark(lighting, scene) {
        notes.push(
            "no light: nothing shines on this scene, and its spheres will be black; add \
             [[lights]], or give something that is there a color and a strength"
                .to_owned(),
        );
    }
    let needs_paths = |material: &Material| {
        matches!(material, Material::Conductor { .. } | Material::Dielectric { .. })
    };
    if lighting.studio().is_some()
        && scene.finishes().iter().any(|finish| needs_paths(&finish.material))
    {
        notes.push(
            "metal and glass are matt in a studio; the integrator `path` shows what they are"
                .to_owned(),
        );
    }
    notes
}

/// Whether nothing shines at all.
fn is_dark(lighting: &Lighting, scene: &Scene) -> bool {
    let is_black = |color: &crate::LinearRgb| *color == crate::LinearRgb::BLACK;
    let is_lit = lighting.lights.iter().any(|light| {
        !is_black(match &light.kind {
            LightKind::Head { strength } | LightKind::Directional { strength, .. } => strength,
            LightKind::Point { intensity, .. } => intensity,
            LightKind::Sphere { radiance, .. } => radiance,
        })
    });
    let from_around = match (&lighting.integrator, &lighting.sky.light) {
        (Integrator::Studio(studio), _) => !is_black(&studio.ambient),
        (Integrator::Path(_), SkyLight::Constant(color)) => !is_black(color),
        (Integrator::Path(_), SkyLight::Gradient { zenith, horizon, nadir }) => {
            [zenith, horizon, nadir].into_iter().any(|color| !is_black(color))
        }
        (Integrator::Path(_), SkyLight::Image { environment, strength, .. }) => {
            environment.has_light() && *strength > 0.0
        }
    };
    let shines = |(color, finish): (&crate::LinearRgb, &crate::Finish)| match finish.material {
        Material::Emissive { strength } => strength > 0.0 && !is_black(color),
        _ => false,
    };
    !is_lit && !from_around && !scene.palette().iter().zip(scene.finishes()).any(shines)
}
