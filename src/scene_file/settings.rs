//! The render settings that a scene file asks for.

use super::SceneFile;
use super::lighting::IntegratorKind;
use super::span::{SceneFileError, Span};
use super::value::scaled;
use crate::camera::{Camera, View};
use crate::image::color::LinearRgb;
use crate::light::environment::Environment;
use crate::light::{Sky, SkyLight};
use crate::render::{Integrator, RenderSettings, SettingsError};
use crate::scene::Scene;
use crate::scene::material::Material;
use crate::style::fit;

impl SceneFile {
    /// Returns the integrator that the file asks for: with the key `integrator`, or with a table, material or opacity
    /// that needs a lit picture. `None` means that the file asks for nothing, so that primary rays are enough.
    #[must_use]
    pub fn integrator(&self) -> Option<IntegratorKind> {
        self.lighting.integrator
    }

    /// Returns the path of the sky image, relative to the scene file. Only the integrator `path` needs the image.
    #[must_use]
    pub fn sky_image(&self) -> Option<&str> {
        self.lighting.sky.as_ref()?.image()
    }

    /// Returns the render settings for an integrator, which need not be the one that the file asks for; tables that it
    /// does not use are ignored. If the file names lights, a sun or a sky, there are no other lights; otherwise there
    /// are the default lights. Missing values follow from the scene and, for the depth cue, from the camera. `image` is
    /// the image at [`SceneFile::sky_image`]. The settings are not transparent; the caller can change that.
    ///
    /// # Errors
    /// For a lit picture: if a colour would create light, if the integrator does not support shadow catchers, or if the
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
        // Only path tracing is lit by a sky and needs its image.
        let sky = match &says.sky {
            _ if kind == IntegratorKind::Studio => defaults.sky,
            Some(sky) => sky.sky(image)?,
            None if says.lights.is_none() || !says.given.light => defaults.sky,
            None => Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: false },
        };
        let mut settings = RenderSettings {
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
        if let Some(style) = self.style {
            fit(&mut settings, style, says.given, scene, &View::new(camera, self.film));
        }
        settings.check(scene).map(|()| settings).map_err(|error| self.span_of(&error).error(error))
    }

    /// Refuses spheres of this file that would reflect more light than they receive, or emit too much.
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

    /// Returns the position in the file that an error is about. All tables and the spheres of this file have been
    /// checked before, so only a few errors are left.
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
