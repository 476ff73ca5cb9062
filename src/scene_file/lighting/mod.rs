//! What a scene file says of light: tables in, checked settings out.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

mod ground;
mod lights;
mod samples;
mod sky;
mod studio;

pub(super) use ground::GroundTable;
pub(super) use lights::{LightTable, SunTable};
pub(super) use samples::{PathTable, SamplingTable};
pub(super) use sky::SkyTable;
pub(super) use studio::StudioTable;

use ground::GroundPlan;
use sky::SkyPlan;
use studio::StudioPlan;

use super::SceneFile;
use super::span::{Lines, SceneFileError, Span, WithSpan, range_of};
use super::value::scaled;
use crate::camera::Camera;
use crate::exact::Table;
use crate::image::color::LinearRgb;
use crate::light::environment::Environment;
use crate::light::{Light, Sky, SkyLight};
use crate::render::{Integrator, PathTracing, RenderSettings, Sampling, SettingsError};
use crate::scene::Scene;
use crate::scene::material::Material;

/// How a picture is made, by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// By what a pixel's ray meets first, without lights.
    #[default]
    Primary,
    /// Directly from lights to surfaces.
    Studio,
    /// As it is scattered.
    Path,
}

/// The tables, as they stand at the top of the file.
pub(super) struct LightingTables {
    /// Where the key for pictures without light is.
    pub(super) shading: Option<usize>,
    pub(super) integrator: Option<IntegratorKind>,
    pub(super) studio: Option<Spanned<Table<StudioTable>>>,
    pub(super) path: Option<Spanned<Table<PathTable>>>,
    pub(super) sampling: Option<Spanned<Table<SamplingTable>>>,
    pub(super) lights: Option<Vec<Spanned<Table<LightTable>>>>,
    pub(super) sky: Option<Spanned<Table<SkyTable>>>,
    pub(super) sun: Option<Spanned<Table<SunTable>>>,
    pub(super) ground: Option<Spanned<Table<GroundTable>>>,
    /// Whether surfaces are to be more than matt and opaque.
    pub(super) has_materials: bool,
}

/// What the tables say, checked as far as it can be without a scene.
#[derive(Debug)]
pub(super) struct SceneLighting {
    integrator: Option<IntegratorKind>,
    studio: StudioPlan,
    path: PathTracing,
    is_denoised: bool,
    sampling: Sampling,
    /// `None` if the file says nothing of light that comes from elsewhere than spheres.
    lights: Option<Vec<Light>>,
    sky: Option<SkyPlan>,
    ground: Option<WithSpan<GroundPlan>>,
}

impl LightingTables {
    pub(super) fn read(self, lines: &Lines<'_>) -> Result<SceneLighting, SceneFileError> {
        let integrator = self.integrator(lines)?;
        let names_light = self.lights.is_some() || self.sun.is_some() || self.sky.is_some();
        let sun = self.sun.map(|sun| lights::read_sun(sun, lines)).transpose()?;
        let lights = self.lights.into_iter().flatten().map(|light| lights::read(light, lines));
        let lights = lights.chain(sun.map(Ok)).collect::<Result<Vec<_>, _>>()?;
        Ok(SceneLighting {
            integrator,
            studio: StudioPlan::read(self.studio, lines)?,
            path: samples::read_path(self.path, lines)?,
            is_denoised: samples::is_denoised(&self.sampling),
            sampling: samples::read_sampling(self.sampling, lines)?,
            lights: names_light.then_some(lights),
            sky: self.sky.map(|sky| SkyPlan::read(sky, lines)).transpose()?,
            ground: self.ground.map(|ground| GroundPlan::read(ground, lines)).transpose()?,
        })
    }

    /// What the file says, or what it says that only a lit picture has.
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
                "`{table}` is for pictures with light, and `integrator = \"primary\"` makes one without; drop one"
            )));
        }
        let kind = match (self.integrator, first(&of_paths), first(&of_studio)) {
            (Some(kind), ..) => Some(kind),
            (None, Some((table, start)), Some(_)) => {
                return Err(lines.span(start).error(format!(
                    "`{table}` is for paths and `[studio]` for a studio; say which with \
                     `integrator = \"path\"` or `integrator = \"studio\"`"
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
                "`shading` is for pictures without light, and this file asks for light; drop one",
            )),
            _ => Ok(kind),
        }
    }
}

impl SceneFile {
    /// How the picture is made, if the file says so: by the key `integrator`, or by a table, material or opacity that
    /// only a lit picture shows. A file that says nothing asks for primary rays.
    #[must_use]
    pub fn integrator(&self) -> Option<IntegratorKind> {
        self.lighting.integrator
    }

    /// The image of the sky that paths need, relative to the scene file.
    #[must_use]
    pub fn sky_image(&self) -> Option<&str> {
        self.lighting.sky.as_ref()?.image()
    }

    /// The settings, for an integrator that need not be the file's own; what it does not use is left out. A file that
    /// names lights, a sun or a sky gets no others; what is left open follows the scene and, for the depth cue, the
    /// camera. Transparency is for the caller to decide.
    ///
    /// # Errors
    /// Of a lit picture: if a colour would create light, if the integrator does not support shadow catchers, or if the
    /// image of the sky is needed and not given.
    pub fn settings(
        &self,
        kind: IntegratorKind,
        scene: &Scene,
        camera: &dyn Camera,
        image: Option<Environment>,
    ) -> Result<RenderSettings, SceneFileError> {
        let (says, defaults) = (&self.lighting, RenderSettings::studio());
        let background = self.background;
        let integrator = match kind {
            IntegratorKind::Primary => {
                let integrator = Integrator::Primary(self.shading);
                return Ok(RenderSettings { integrator, background, ..RenderSettings::default() });
            }
            IntegratorKind::Studio => {
                Integrator::Studio(says.studio.studio(scene, camera, background)?)
            }
            IntegratorKind::Path => Integrator::Path(says.path),
        };
        // Only paths are lit by a sky, and only they need its image.
        let sky = match &says.sky {
            _ if kind == IntegratorKind::Studio => defaults.sky,
            Some(sky) => sky.sky(image)?,
            None if says.lights.is_none() => defaults.sky,
            None => Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: false },
        };
        let settings = RenderSettings {
            integrator,
            sampling: says.sampling,
            lights: says.lights.clone().unwrap_or(defaults.lights),
            sky,
            ground: says.ground.as_ref().map(|ground| ground.value.ground(scene)),
            background,
            is_transparent: false,
            is_denoised: says.is_denoised,
        };
        self.check_colors()?;
        settings.check(scene).map(|()| settings).map_err(|error| self.span_of(&error).error(error))
    }

    /// Refuses spheres of this file that would create light.
    fn check_colors(&self) -> Result<(), SceneFileError> {
        for (index, sphere) in self.spheres.iter().enumerate() {
            let (color, surface) = (sphere.value.color, sphere.value.surface);
            let (rgb, what) = (color.to_array(), format!("sphere {index}"));
            match surface.material {
                Material::Emissive { strength } => {
                    scaled(color, strength.into(), &what)
                        .map_err(|error| sphere.span.error(error))?;
                }
                _ if rgb.iter().any(|c| *c > 1.0) => {
                    return Err(sphere.span.error(SettingsError::Albedo { what, rgb }));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Of what is left when all tables, and the spheres of this file, have been checked.
    fn span_of(&self, error: &SettingsError) -> Span {
        let ground = || self.lighting.ground.as_ref().map(|ground| ground.span);
        let data = || self.data.as_ref().map(|data| data.span);
        match error {
            SettingsError::Ground | SettingsError::Catcher => ground(),
            SettingsError::Albedo { what, .. } if what == "the ground" => ground(),
            SettingsError::Albedo { .. } | SettingsError::TooBright { .. } => data(),
            _ => None,
        }
        .unwrap_or(Span::START)
    }
}
