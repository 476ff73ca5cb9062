//! Reads the tables of a scene file that concern light, and makes checked render settings of them.

mod integrator;
mod lights;
mod sky;
mod studio;

pub(super) use integrator::IntegratorChoice;
pub use integrator::IntegratorKind;
pub(super) use lights::{DirectionalTable, LightTable};
pub(super) use sky::{GroundTable, SkyTable};
pub(crate) use studio::DepthCuePlan;

use super::document::Document;
use super::span::{KeyError, SceneFileError};
use crate::settings::layers::Joined;
use crate::style::OwnValues;
use pinhole::internals::exact::Table;
use pinhole::light::Light;
use pinhole::range::RangeError;
use studio::StudioPlan;

/// The contents of the tables, checked as far as that is possible without a scene.
#[derive(Debug)]
pub(super) struct SceneLighting {
    pub(super) studio: StudioPlan,
    /// The lights and the sun; `None` if the file names neither lights nor a sun nor a sky.
    pub(super) lights: Option<Vec<Light>>,
    /// What the file gives itself, so that a style does not choose it.
    pub(super) given: OwnValues,
}

/// The settings that the file or a flag gives, so that a style does not choose them.
fn given(layers: &Joined<'_>) -> OwnValues {
    OwnValues {
        occlusion_radius: layers.has("studio.occlusion.radius"),
        occlusion_samples: layers.has("studio.occlusion.samples"),
        smooth: layers.has("studio.smooth"),
        dense: layers.has("studio.dense"),
        denoise: layers.has("sampling.denoise"),
        outline: layers.in_file.has("studio.outline"),
        outline_by_flag: layers.in_flags.has("studio.outline"),
        outline_depth: layers.has("studio.outline.depth"),
        ground: layers.has("ground"),
        light: ["lights", "sky", "sun"].iter().any(|key| layers.has(key)),
    }
}

impl SceneLighting {
    pub(super) fn read(
        document: &Document,
        depth_cue: Option<DepthCuePlan>,
        layers: &Joined<'_>,
    ) -> Result<Self, SceneFileError> {
        let Document { studio, path, sampling, lights, sun, sky, ground, .. } = document;
        let at = |table: &'static str| move |error: KeyError| layers.places.refused(table, error);
        let unless = |table, checked: Result<(), RangeError>| checked.map_err(|e| at(table)(e.into()));
        path.iter().try_for_each(|Table(path)| unless("path", path.check()))?;
        sampling.iter().try_for_each(|Table(one)| unless("sampling", one.check()))?;
        sky.iter().try_for_each(|Table(sky)| sky.light().map(drop)).map_err(at("sky"))?;
        ground.iter().try_for_each(|Table(ground)| ground.check()).map_err(at("ground"))?;
        let names_light = lights.is_some() || sun.is_some() || sky.is_some();
        let listed = lights.iter().flatten().enumerate().map(|(index, Table(light))| {
            let refused = |error| layers.places.refused(&format!("lights.{index}"), error);
            light.light().map_err(refused)
        });
        let sun = sun.iter().map(|Table(sun)| sun.sun().map_err(at("sun")));
        let lights = listed.chain(sun).collect::<Result<Vec<_>, _>>()?;
        let studio = studio.clone().unwrap_or_default().0;
        Ok(Self {
            studio: StudioPlan::new(studio, depth_cue, layers)?,
            lights: names_light.then_some(lights),
            given: given(layers),
        })
    }
}
