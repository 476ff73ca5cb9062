//! Checks of render settings: numbers out of range, and settings that contradict each other.

use std::f64::consts::FRAC_PI_2;

use super::{Integrator, RenderSettings};
use crate::geometry::math::{MAX_LENGTH, MIN_LENGTH, unit};
use crate::image::color::LinearRgb;
use crate::light::{LightKind, Sky, SkyLight};
use crate::range::RangeError;
use crate::scene::material::Material;
use crate::scene::{Scene, SceneAppearance};

/// The reason why settings, or the materials of a scene, are not valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// A parameter is out of range.
    #[error(transparent)]
    Range(#[from] RangeError),
    /// A surface would reflect more light than arrives.
    #[error(
        "{what} has the color {rgb:?}, which creates light; each component of a color that scatters must be at most 1"
    )]
    Albedo {
        /// The sphere or the ground that has the colour.
        what: String,
        /// Its linear colour.
        rgb: [f32; 3],
    },
    /// A light is so strong that sums of squares would exceed the range of f32.
    #[error("{what} shines with {rgb:?}, which is too strong; each component must be at most 1e18")]
    TooBright {
        /// The light, sphere or other source that is too bright.
        what: String,
        /// Its linear radiance or strength.
        rgb: [f32; 3],
    },
    /// The ground's normal is zero or not finite, or its point is out of range.
    #[error("the ground's normal must be finite and not zero, and its point finite and at most {MAX_LENGTH:e} in size")]
    Ground,
    /// The path integrator does not support shadow catchers.
    #[error("a shadow catcher needs the integrator `studio`; the integrator `path` does not support it")]
    Catcher,
    /// A light is not valid, or the integrator does not use a setting.
    #[error("{0}")]
    Invalid(String),
}

impl RenderSettings {
    /// Checks that all numbers are in range, that no two settings contradict each other, and, if the picture has
    /// lighting, that the materials of the scene do not reflect more light than arrives.
    ///
    /// # Errors
    /// Returns an error if a check fails. The error describes the first problem.
    pub fn check(&self, scene: &Scene) -> Result<(), SettingsError> {
        self.check_with(scene.checked_appearance())
    }

    /// The checks of [`RenderSettings::check`] for the appearance of a scene.
    pub(crate) fn check_with(&self, appearance: &SceneAppearance) -> Result<(), SettingsError> {
        self.check_is_used()?;
        if self.integrator.is_primary() {
            return Ok(());
        }
        let within = RangeError::unless_within;
        self.sampling.check()?;
        match &self.integrator {
            Integrator::Primary(_) => {}
            Integrator::Path(path) => {
                path.check()?;
                if self.ground.is_some_and(|ground| ground.is_shadow_catcher) {
                    return Err(SettingsError::Catcher);
                }
            }
            Integrator::Studio(studio) => studio.check()?,
        }
        for (index, light) in self.lights.iter().enumerate() {
            check_light(index, &light.kind)?;
        }
        if let SkyLight::Image { strength, rotation, .. } = &self.sky.light {
            within("strength", (*strength).into(), [0.0, 1e6], "from 0 to 1e6")?;
            within("rotation", *rotation, [-1e3, 1e3], "from -1000 to 1000 radians")?;
        }
        self.check_brightness()?;
        if let Some(ground) = &self.ground {
            let is_near = ground.point.abs().cmple(glam::DVec3::splat(MAX_LENGTH)).all();
            if unit(ground.normal).is_none() || !is_near {
                return Err(SettingsError::Ground);
            }
            check_albedo(ground.color, || "the ground".to_owned())?;
        }
        check_materials(appearance)
    }

    /// Returns an error for a setting that the integrator would ignore.
    fn check_is_used(&self) -> Result<(), SettingsError> {
        let integrator = self.integrator.name();
        let unused = |what: &str, instead: &str| {
            Err(SettingsError::Invalid(format!(
                "the integrator `{integrator}` does not use {what}; leave out {what}, or choose the integrator {instead}"
            )))
        };
        let is_primary = self.integrator.is_primary();
        if is_primary && self.sampling.samples != 1 {
            return Err(SettingsError::Invalid(format!(
                "the integrator `primary` traces one ray through the center of each pixel, but {} samples are asked \
                 for; ask for 1, or choose the integrator `studio` or `path`",
                self.sampling.samples
            )));
        }
        if !matches!(self.integrator, Integrator::Path(_)) && self.sky != Sky::default() {
            return unused("the sky", "`path`");
        }
        let for_light = [
            ("the lights", !self.lights.is_empty()),
            ("the ground", self.ground.is_some()),
            ("denoising", self.sampling.denoise),
        ];
        match for_light.into_iter().find(|(_, is_set)| is_primary && *is_set) {
            Some((what, _)) => unused(what, "`studio` or `path`"),
            None => Ok(()),
        }
    }

    /// Checks the strength of all light sources except spheres.
    fn check_brightness(&self) -> Result<(), SettingsError> {
        for (index, light) in self.lights.iter().enumerate() {
            check_brightness(light.kind.color().to_array(), 1.0, || format!("light {index}"))?;
        }
        let ambient = self.studio_parameters().map(|studio| studio.ambient);
        let others = ambient.into_iter().chain([self.background]);
        match &self.sky.light {
            SkyLight::Constant(color) => {
                check_brightness(color.to_array(), 1.0, || "the sky".to_owned())?;
            }
            SkyLight::Gradient { zenith, horizon, nadir } => {
                for color in [zenith, horizon, nadir] {
                    check_brightness(color.to_array(), 1.0, || "the sky".to_owned())?;
                }
            }
            SkyLight::Image { environment, strength, .. } => {
                for texel in environment.texels() {
                    check_brightness(*texel, *strength, || "the sky".to_owned())?;
                }
            }
        }
        for color in others {
            let what = || "the ambient light, or the background,".to_owned();
            check_brightness(color.to_array(), 1.0, what)?;
        }
        Ok(())
    }
}

/// The largest radiance. Its square, and the sum of many squares, stay below 2¹²⁸.
pub const BRIGHTEST: f32 = 1e18;

fn check_brightness(rgb: [f32; 3], by: f32, what: impl Fn() -> String) -> Result<(), SettingsError> {
    let rgb = rgb.map(|c| c * by);
    if rgb.iter().all(|c| *c <= BRIGHTEST) { Ok(()) } else { Err(SettingsError::TooBright { what: what(), rgb }) }
}

fn check_light(index: usize, light: &LightKind) -> Result<(), SettingsError> {
    let within = |parameter, value, bounds, range| {
        RangeError::unless_within(parameter, value, bounds, range)
            .map_err(|error| SettingsError::Invalid(format!("light {index}: {error}")))
    };
    match *light {
        LightKind::Head { .. } => {}
        LightKind::Directional { toward, angular_radius, .. } => {
            if unit(toward).is_none() {
                let message = "its direction must be finite and not zero";
                return Err(SettingsError::Invalid(format!("light {index}: {message}")));
            }
            if angular_radius != 0.0 {
                let range = "0, or from 0.06 to 90 degrees";
                within("angular_radius", angular_radius, [0.001, FRAC_PI_2], range)?;
            }
        }
        LightKind::Point { position, .. } => {
            for x in position.to_array() {
                within("position", x, [-MAX_LENGTH, MAX_LENGTH], "finite")?;
            }
        }
        LightKind::Sphere { center, radius, .. } => {
            for x in center.to_array() {
                within("center", x, [-MAX_LENGTH, MAX_LENGTH], "finite")?;
            }
            let range = "a length greater than 0, from 2^-56 to 2^56";
            within("radius", radius, [MIN_LENGTH, MAX_LENGTH], range)?;
        }
    }
    Ok(())
}

fn check_materials(appearance: &SceneAppearance) -> Result<(), SettingsError> {
    appearance.surfaces().iter().try_for_each(|surface| surface.check().map(drop))?;
    // Colours up to 1 cannot make a sphere too bright, because strengths have an upper limit.
    if !appearance.may_exceed_one() {
        return Ok(());
    }
    (0..appearance.sphere_count() as u32).try_for_each(|id| {
        let (color, what) = (appearance.color_of(id), || format!("sphere {id}"));
        match appearance.surface_of(id).material {
            Material::Emissive { strength } => check_brightness(color.to_array(), strength, what),
            _ => check_albedo(color, what),
        }
    })
}

fn check_albedo(color: LinearRgb, what: impl Fn() -> String) -> Result<(), SettingsError> {
    let rgb = color.to_array();
    if rgb.iter().all(|c| *c <= 1.0) { Ok(()) } else { Err(SettingsError::Albedo { what: what(), rgb }) }
}
