//! The light that a spot reflects.

use glam::DVec3;

use super::spots::Spot;
use crate::camera::Camera;
use crate::geometry::math::wide;
use crate::light::LightKind;
use crate::render::{RenderSettings, Studio};
use crate::scene::SceneAppearance;
use crate::scene::material::Material;

/// The light of a studio whose lights have no width and no shadows.
pub(super) struct Lit<'a> {
    appearance: &'a SceneAppearance,
    studio: &'a Studio,
    /// Directions towards lights, or none for lights at the eye, and what they make a white surface reflect that faces
    /// them.
    lights: Vec<(Option<DVec3>, DVec3)>,
    /// The colour where there is no sphere.
    pub(super) background: DVec3,
}

impl<'a> Lit<'a> {
    pub(super) fn new(
        appearance: &'a SceneAppearance,
        camera: &dyn Camera,
        settings: &'a RenderSettings,
    ) -> Option<Self> {
        let vectors = camera.vectors();
        let lights = settings.lights.iter().filter_map(|light| match light.in_view(&vectors)? {
            LightKind::Head { strength } => Some((None, wide(strength.to_array()))),
            LightKind::Directional { toward, strength, .. } => Some((Some(toward), wide(strength.to_array()))),
            LightKind::Point { .. } | LightKind::Sphere { .. } => None,
        });
        let background = if settings.is_transparent { DVec3::ZERO } else { wide(settings.background.to_array()) };
        let studio = settings.studio_parameters()?;
        Some(Self { appearance, studio, lights: lights.collect(), background })
    }

    pub(super) fn albedo(&self, id: u32) -> DVec3 {
        wide(self.appearance.color_of(id).to_array())
    }

    /// The light that leaves a spot towards the camera. `openness` is asked for if ambient light counts.
    pub(super) fn color(&self, spot: &Spot, openness: impl FnOnce() -> f64) -> DVec3 {
        let albedo = self.albedo(spot.id);
        let color = match self.appearance.surface_of(spot.id).material {
            Material::Emissive { strength } => albedo * f64::from(strength),
            _ => {
                let ambient = wide(self.studio.ambient.to_array());
                let around = if ambient == DVec3::ZERO { DVec3::ZERO } else { ambient * openness() };
                let lamp = |(toward, strength): &(Option<DVec3>, DVec3)| {
                    strength * spot.normal.dot(toward.unwrap_or(spot.out)).max(0.0)
                };
                albedo * (around + self.lights.iter().map(lamp).sum::<DVec3>())
            }
        };
        let Some(cue) = self.studio.depth_cue else { return color };
        let faded = ((spot.distance - cue.near) / (cue.far - cue.near)).clamp(0.0, 1.0);
        color.lerp(wide(cue.color.to_array()), faded)
    }
}
