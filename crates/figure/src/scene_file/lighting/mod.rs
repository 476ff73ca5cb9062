//! Reads the tables of a scene file that concern light, and makes checked render settings of them.

mod integrator;
mod lights;
mod sky;
mod studio;

pub(super) use integrator::AskedIntegrator;
pub use integrator::IntegratorKind;
pub(super) use lights::{LightTable, SunTable};
pub(super) use sky::{GroundTable, SkyTable};
pub(super) use studio::DepthCuePlan;

use toml::Spanned;

use super::span::{SceneFileError, WithSpan};
use crate::settings::layers::Joined;
use crate::style::OwnValues;
use pinhole::internals::exact::Table;
use pinhole::light::Light;
use pinhole::render::{PathTracing, Sampling, Studio};
use sky::{GroundPlan, SkyPlan};
use studio::StudioPlan;

/// The keys and tables that concern light.
pub(super) struct LightingTables {
    pub(super) studio: Studio,
    pub(super) depth_cue: Option<DepthCuePlan>,
    pub(super) path: PathTracing,
    pub(super) sampling: Sampling,
    pub(super) denoise: bool,
    pub(super) lights: Option<Vec<Spanned<Table<LightTable>>>>,
    pub(super) sky: Option<Spanned<Table<SkyTable>>>,
    pub(super) sun: Option<Spanned<Table<SunTable>>>,
    pub(super) ground: Option<Spanned<Table<GroundTable>>>,
}

/// The contents of the tables, checked as far as that is possible without a scene.
#[derive(Debug)]
pub(super) struct SceneLighting {
    pub(super) studio: StudioPlan,
    pub(super) path: PathTracing,
    pub(super) denoise: bool,
    pub(super) sampling: Sampling,
    /// The lights and the sun; `None` if the file names neither lights nor a sun nor a sky.
    pub(super) lights: Option<Vec<Light>>,
    pub(super) sky: Option<SkyPlan>,
    pub(super) ground: Option<WithSpan<GroundPlan>>,
    /// What the file gives itself, so that a style does not choose it.
    pub(super) given: OwnValues,
}

/// The settings that the file or a flag gives, so that a style does not choose them.
fn given(layers: &Joined<'_>) -> OwnValues {
    OwnValues {
        occlusion_radius: layers.has("studio.occlusion.radius"),
        outline: layers.in_file.has("studio.outline"),
        outline_by_flag: layers.in_flags.has("studio.outline"),
        outline_depth: layers.has("studio.outline.depth"),
        ground: layers.has("ground"),
        light: ["lights", "sky", "sun"].iter().any(|key| layers.has(key)),
    }
}

impl LightingTables {
    pub(super) fn read(self, layers: &Joined<'_>) -> Result<SceneLighting, SceneFileError> {
        let lines = &layers.lines;
        let refused = |table| move |error| layers.refused(table, &error);
        self.path.check().map_err(refused("path"))?;
        self.sampling.check().map_err(refused("sampling"))?;
        let names_light = self.lights.is_some() || self.sun.is_some() || self.sky.is_some();
        let sun = self.sun.map(|sun| lights::read_sun(sun, lines)).transpose()?;
        let lights = self.lights.into_iter().flatten().map(|light| lights::read(light, lines));
        let lights = lights.chain(sun.map(Ok)).collect::<Result<Vec<_>, _>>()?;
        Ok(SceneLighting {
            studio: StudioPlan::new(self.studio, self.depth_cue, layers)?,
            path: self.path,
            denoise: self.denoise,
            sampling: self.sampling,
            lights: names_light.then_some(lights),
            sky: self.sky.map(|sky| SkyPlan::read(sky, lines)).transpose()?,
            ground: self.ground.map(|ground| GroundPlan::read(ground, lines)).transpose()?,
            given: given(layers),
        })
    }
}
