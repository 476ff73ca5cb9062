//! Reads the tables of a scene file that concern light, and makes checked render settings of them.

mod lights;
mod sky;
mod studio;

pub(super) use lights::{LightTable, SunTable};
pub(super) use sky::{GroundTable, SkyTable};
pub(super) use studio::{PathTable, SamplingTable, StudioTable};

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::span::{Lines, SceneFileError, WithSpan, range_of};
use crate::style::OwnValues;
use pinhole::internals::exact::Table;
use pinhole::light::Light;
use pinhole::render::{PathTracing, Sampling};
use sky::{GroundPlan, SkyPlan};
use studio::{StudioPlan, either};

/// The integrators that a scene file can name. The integrator computes the colour of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// Primary rays: a pixel shows what its ray meets first, without lights.
    #[default]
    Primary,
    /// Studio light: light goes directly from the lights to the surfaces.
    Studio,
    /// Path tracing: light is followed as surfaces scatter it.
    Path,
}

/// The keys and tables at the top of the file that concern light.
pub(super) struct LightingTables {
    /// Offset in bytes of the key `shading`, which applies to pictures without light.
    pub(super) shading: Option<usize>,
    pub(super) integrator: Option<IntegratorKind>,
    pub(super) studio: Option<Spanned<Table<StudioTable>>>,
    pub(super) path: Option<Spanned<Table<PathTable>>>,
    pub(super) sampling: Option<Spanned<Table<SamplingTable>>>,
    pub(super) lights: Option<Vec<Spanned<Table<LightTable>>>>,
    pub(super) sky: Option<Spanned<Table<SkyTable>>>,
    pub(super) sun: Option<Spanned<Table<SunTable>>>,
    pub(super) ground: Option<Spanned<Table<GroundTable>>>,
    /// Whether any surface is not matt and opaque.
    pub(super) has_materials: bool,
}

/// The contents of the tables, checked as far as that is possible without a scene.
#[derive(Debug)]
pub(super) struct SceneLighting {
    pub(super) integrator: Option<IntegratorKind>,
    pub(super) studio: StudioPlan,
    pub(super) path: PathTracing,
    pub(super) is_denoised: bool,
    pub(super) sampling: Sampling,
    /// The lights and the sun; `None` if the file names neither lights nor a sun nor a sky.
    pub(super) lights: Option<Vec<Light>>,
    pub(super) sky: Option<SkyPlan>,
    pub(super) ground: Option<WithSpan<GroundPlan>>,
    /// What the file gives itself, so that a style does not choose it.
    pub(super) given: OwnValues,
}

impl LightingTables {
    /// Reads the tables of a file, and those of its style where the file has none.
    pub(super) fn read(
        self,
        style: Self,
        lines: &Lines<'_>,
    ) -> Result<SceneLighting, SceneFileError> {
        let integrator = self.integrator(lines)?.or(style.integrator);
        let given = self.given();
        self.over(style).plans(integrator, given, lines)
    }

    /// Returns which values the file gives that a style would choose otherwise.
    fn given(&self) -> OwnValues {
        let [occlusion_radius, outline, outline_depth] =
            self.studio.as_ref().map_or([false; 3], |studio| studio.get_ref().0.given());
        let light = self.names_light();
        OwnValues { occlusion_radius, outline, outline_depth, ground: self.ground.is_some(), light }
    }

    fn names_light(&self) -> bool {
        self.lights.is_some() || self.sun.is_some() || self.sky.is_some()
    }

    /// Takes the keys of these tables, and those of a style where there are none. A file that names lights, a sun or a
    /// sky gets none of the style's.
    fn over(self, style: Self) -> Self {
        let names_light = self.names_light();
        Self {
            shading: self.shading,
            integrator: self.integrator.or(style.integrator),
            studio: either(self.studio, style.studio, StudioTable::over),
            path: either(self.path, style.path, PathTable::over),
            sampling: either(self.sampling, style.sampling, SamplingTable::over),
            lights: self.lights.or(style.lights.filter(|_| !names_light)),
            sky: self.sky.or(style.sky.filter(|_| !names_light)),
            sun: self.sun.or(style.sun.filter(|_| !names_light)),
            ground: self.ground.or(style.ground),
            has_materials: self.has_materials,
        }
    }

    fn plans(
        self,
        integrator: Option<IntegratorKind>,
        given: OwnValues,
        lines: &Lines<'_>,
    ) -> Result<SceneLighting, SceneFileError> {
        let names_light = self.names_light();
        let sun = self.sun.map(|sun| lights::read_sun(sun, lines)).transpose()?;
        let lights = self.lights.into_iter().flatten().map(|light| lights::read(light, lines));
        let lights = lights.chain(sun.map(Ok)).collect::<Result<Vec<_>, _>>()?;
        Ok(SceneLighting {
            integrator,
            studio: StudioPlan::read(self.studio, lines)?,
            path: studio::read_path(self.path, lines)?,
            is_denoised: studio::is_denoised(&self.sampling),
            sampling: studio::read_sampling(self.sampling, lines)?,
            lights: names_light.then_some(lights),
            sky: self.sky.map(|sky| SkyPlan::read(sky, lines)).transpose()?,
            ground: self.ground.map(|ground| GroundPlan::read(ground, lines)).transpose()?,
            given,
        })
    }

    /// Returns the integrator that the file names, or else the one that its tables and materials need.
    fn integrator(&self, lines: &Lines<'_>) -> Result<Option<IntegratorKind>, SceneFileError> {
        let of_paths = [("[path]", range_of(&self.path)), ("[sky]", range_of(&self.sky))];
        let of_studio = [("[studio]", range_of(&self.studio))];
        let lights = self.lights.as_ref();
        let of_both = [
            ("[sampling]", range_of(&self.sampling)),
            ("[[lights]]", lights.map(|lights| lights.first().map_or(0..0, Spanned::span))),
            ("[sun]", range_of(&self.sun)),
            ("[ground]", range_of(&self.ground)),
        ];
        let first = |tables: &[(&'static str, Option<Range<usize>>)]| {
            tables.iter().find_map(|(name, span)| Some((*name, span.as_ref()?.start)))
        };
        let of_any = || first(&of_paths).or(first(&of_studio)).or(first(&of_both));
        if let (Some(IntegratorKind::Primary), Some((table, start))) = (self.integrator, of_any()) {
            return Err(lines.span(start).error(format!(
                "`{table}` applies only to pictures with light, but `integrator = \"primary\"` makes a picture without \
                 light; remove one of them"
            )));
        }
        let kind = match (self.integrator, first(&of_paths), first(&of_studio)) {
            (Some(kind), ..) => Some(kind),
            (None, Some((table, start)), Some(_)) => {
                return Err(lines.span(start).error(format!(
                    "`{table}` applies to the integrator `path` and `[studio]` to the integrator `studio`; choose one \
                     with `integrator = \"path\"` or `integrator = \"studio\"`"
                )));
            }
            (None, Some(_), None) => Some(IntegratorKind::Path),
            (None, None, Some(_)) => Some(IntegratorKind::Studio),
            (None, None, None) => {
                (self.has_materials || first(&of_both).is_some()).then_some(IntegratorKind::Studio)
            }
        };
        match (kind, self.shading) {
            (Some(IntegratorKind::Studio | IntegratorKind::Path), Some(start)) => Err(lines.span(start).error(
                "`shading` applies only to pictures without light, but this file asks for light; remove `shading`",
            )),
            _ => Ok(kind),
        }
    }
}
