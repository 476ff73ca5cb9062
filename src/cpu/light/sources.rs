//! The light that arrives at a point from the lights of the settings, and the light sources that the path integrator
//! samples.

use glam::DVec3;

use super::maps::{TangentFrame, cone, cone_density, cone_of_sphere, rgb, versine};
use crate::light::LightKind;
use crate::render::LightSampling;

/// A light source that can be sampled. All have the same probability.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// A light that scattered rays cannot hit.
    Lamp(LightKind),
    /// A disk at infinity.
    Sun(Sun),
    /// All emissive spheres together.
    Emitters,
    /// The image of the sky.
    Sky,
}

/// A light at infinity that scattered rays can hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sun {
    pub(super) toward: DVec3,
    /// 1 minus the cosine of the sun's angular radius.
    pub(super) k: f64,
    pub(super) radiance: DVec3,
}

/// All light sources of a scene, for one method of light sampling.
#[derive(Debug, Default)]
pub(super) struct Sources {
    pub(super) sampled: Vec<Source>,
    suns: Vec<Sun>,
}

impl Sources {
    /// Collects the light sources. Their order is that in which random numbers choose them.
    pub(super) fn new(lights: &[LightKind], has_emitters: bool, has_sky: bool, sampling: LightSampling) -> Self {
        let samples_all = sampling != LightSampling::Chance;
        let mut sources = Self::default();
        for light in lights {
            match *light {
                LightKind::Head { .. } => {}
                LightKind::Directional { toward, strength, angular_radius } if angular_radius > 0.0 => {
                    let k = versine(angular_radius);
                    let radiance = rgb(strength) * sun_radiance(angular_radius);
                    let sun = Sun { toward, k, radiance };
                    sources.suns.push(sun);
                    sources.sampled.extend(samples_all.then_some(Source::Sun(sun)));
                }
                lamp => sources.sampled.push(Source::Lamp(lamp)),
            }
        }
        sources.sampled.extend((samples_all && has_emitters).then_some(Source::Emitters));
        sources.sampled.extend((samples_all && has_sky).then_some(Source::Sky));
        sources
    }

    pub(super) fn count(&self) -> f64 {
        self.sampled.len() as f64
    }

    pub(super) fn density_at_sun(&self, k: f64) -> f64 {
        cone_density(k) / self.count()
    }

    /// The radiance of each sun in a direction, and the density with which light sampling chooses the direction.
    pub(super) fn suns(&self, direction: DVec3) -> impl Iterator<Item = (DVec3, f64)> {
        // |d − t|² is 2 − 2 cos, which does not cancel if the two directions are close.
        let is_hit = move |sun: &&Sun| (direction - sun.toward).length_squared() <= 2.0 * sun.k;
        self.suns.iter().filter(is_hit).map(|sun| (sun.radiance, self.density_at_sun(sun.k)))
    }
}

/// Light that arrives at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// Unit vector towards the light.
    pub(super) direction: DVec3,
    /// Radiance that a white surface facing the light would reflect.
    pub(super) strength: DVec3,
    /// Distance to the light.
    pub(super) distance: f64,
}

/// Light from a random point of a light. The mean of many samples is the light's contribution. `None` for a light at
/// the eye, and for a point light at the point itself.
pub(super) fn arrival(light: &LightKind, point: DVec3, u: [u32; 2]) -> Option<Arrival> {
    match *light {
        LightKind::Head { .. } => None,
        LightKind::Directional { toward, strength, angular_radius } => {
            let direction = if angular_radius > 0.0 {
                TangentFrame::around(toward).to_scene(cone(u, versine(angular_radius)))
            } else {
                toward
            };
            Some(Arrival { direction, strength: rgb(strength) * sun_factor(angular_radius), distance: f64::INFINITY })
        }
        LightKind::Point { position, intensity } => {
            let to_light = position - point;
            let distance = to_light.length();
            (distance > 0.0).then(|| Arrival {
                direction: to_light / distance,
                strength: rgb(intensity) / (distance * distance),
                distance,
            })
        }
        LightKind::Sphere { center, radius, radiance } => {
            let to_center = center - point;
            let distance = to_center.length();
            let (direction, k, is_outside) = match cone_of_sphere(radius, distance) {
                Some(k) => (TangentFrame::around(to_center / distance).to_scene(cone(u, k)), k, true),
                None => (cone(u, 2.0), 2.0, false),
            };
            Some(Arrival {
                direction,
                strength: rgb(radiance) * (2.0 * k),
                distance: distance_to_sphere(to_center, radius, direction, is_outside),
            })
        }
    }
}

/// Light from the middle of a light, which measures how much light could arrive.
pub(super) fn arrival_of_middle(light: &LightKind, point: DVec3) -> Option<Arrival> {
    let arrival = arrival(light, point, [1 << 31; 2])?;
    match *light {
        LightKind::Directional { toward, .. } => Some(Arrival { direction: toward, ..arrival }),
        LightKind::Sphere { center, .. } => {
            let direction = (center - point).try_normalize()?;
            Some(Arrival { direction, ..arrival })
        }
        _ => Some(arrival),
    }
}

/// The radiance of a sun's disk for strength 1. The strength is the light that a surface facing the sun reflects.
fn sun_radiance(angular_radius: f64) -> f64 {
    1.0 / angular_radius.sin().powi(2)
}

/// [`sun_radiance`] times the solid angle of the disk, divided by π. It is 1 for a light without angular radius.
fn sun_factor(angular_radius: f64) -> f64 {
    if angular_radius > 0.0 { sun_radiance(angular_radius) * 2.0 * versine(angular_radius) } else { 1.0 }
}

/// The distance along a direction to a sphere's near side, or from inside to its far side. If rounding makes the ray
/// miss, the distance to the foot point.
pub(super) fn distance_to_sphere(to_center: DVec3, radius: f64, direction: DVec3, is_outside: bool) -> f64 {
    let b = to_center.dot(direction);
    let foot = to_center - b * direction;
    let half_chord = (radius * radius - foot.length_squared()).max(0.0).sqrt();
    if is_outside { b - half_chord } else { b + half_chord }
}
