//! The light that a spot reflects.

use std::sync::atomic::Ordering;

use glam::DVec3;

use super::lamps::Lamp;
use super::levels::Places;
use super::lists::Needed;
use super::openness::Openness;
use super::spots::{Row, Spot};
use super::tables::Tables;
use crate::camera::Camera;
use crate::geometry::math::wide;
use crate::light::LightKind;
use crate::render::{RenderSettings, Studio};
use crate::scene::material::Material;
use crate::scene::{SceneAppearance, SharedShapes};

/// The light of a studio whose lights are at the eye or infinitely far away.
pub(super) struct Lit<'a> {
    appearance: &'a SceneAppearance,
    studio: &'a Studio,
    /// Lamps, or none for lights at the eye, and what they make a white surface reflect that faces them.
    lamps: Vec<(Option<Lamp>, DVec3)>,
    openness: Option<&'a mut Openness>,
    places: Places<'a>,
    /// The colour where there is no sphere.
    pub(super) background: DVec3,
}

impl<'a> Lit<'a> {
    pub(super) fn new(
        appearance: &'a SceneAppearance,
        camera: &dyn Camera,
        settings: &'a RenderSettings,
        tables: &'a mut Tables,
        shapes: &'a SharedShapes,
    ) -> Option<Self> {
        let (places, openness) = tables.parts(shapes);
        let studio = settings.studio_parameters()?;
        let vectors = camera.vectors();
        let lamps = settings.lights.iter().filter_map(|light| match light.in_view(&vectors)? {
            LightKind::Head { strength } => Some((None, wide(strength.to_array()))),
            LightKind::Directional { toward, strength, angular_radius } => {
                Some((Some(Lamp::new(toward, angular_radius, &places)), wide(strength.to_array())))
            }
            LightKind::Point { .. } | LightKind::Sphere { .. } => None,
        });
        let lamps = lamps.collect();
        let background = if settings.is_transparent { DVec3::ZERO } else { wide(settings.background.to_array()) };
        Some(Self { appearance, studio, lamps, openness, places, background })
    }

    /// Prepares for the light of some spots.
    pub(super) fn see(&mut self, rows: &[Row]) {
        let cubes = Needed::cubes(&self.places, rows);
        if let Some(openness) = &mut self.openness {
            openness.see(&self.places, rows, &cubes);
        }
        if self.studio.shadows {
            self.lamps.iter_mut().flat_map(|(lamp, _)| lamp).for_each(|lamp| lamp.see(&self.places, &cubes));
        }
    }

    /// The number of places around which spheres were left out, so that these dim no light there.
    pub(super) fn crowded(&self) -> usize {
        let of_lamps = self.lamps.iter().flat_map(|(lamp, _)| lamp).map(|lamp| &lamp.crowded);
        let all = of_lamps.chain(self.openness.as_ref().map(|openness| &openness.crowded));
        all.map(|count| count.load(Ordering::Relaxed)).sum()
    }

    pub(super) fn albedo(&self, id: u32) -> DVec3 {
        wide(self.appearance.color_of(id).to_array())
    }

    /// The light that leaves a spot towards the camera.
    pub(super) fn color(&self, spot: &Spot) -> DVec3 {
        let albedo = self.albedo(spot.id);
        let color = match self.appearance.surface_of(spot.id).material {
            Material::Emissive { strength } => albedo * f64::from(strength),
            _ => {
                let mut light = wide(self.studio.ambient.to_array());
                if let (Some(openness), true) = (&self.openness, light != DVec3::ZERO) {
                    light *= f64::from(openness.at(self.places.cells, spot.position, spot.normal));
                }
                for (lamp, strength) in &self.lamps {
                    light += strength
                        * match lamp {
                            Some(lamp) => lamp.light(spot, self.studio.shadows.then_some(&self.places)),
                            None => spot.normal.dot(spot.out).max(0.0),
                        };
                }
                albedo * light
            }
        };
        let Some(cue) = self.studio.depth_cue else { return color };
        let faded = ((spot.distance - cue.near) / (cue.far - cue.near)).clamp(0.0, 1.0);
        color.lerp(wide(cue.color.to_array()), faded)
    }
}
