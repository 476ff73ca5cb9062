//! Light that arrives at a point from the lights of the settings.

use glam::DVec3;

use super::color::rgb;
use super::maps::{TangentFrame, cone, cone_of_sphere, versine};
use crate::light::LightKind;

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

/// Light from a random point of a light, such that the mean of many samples is the light's contribution. `None` for a
/// light at the eye, and for a point light at the point itself.
pub(super) fn arrival(light: &LightKind, point: DVec3, u: [u32; 2]) -> Option<Arrival> {
    match *light {
        LightKind::Head { .. } => None,
        LightKind::Directional { toward, strength, angular_radius } => {
            let direction = if angular_radius > 0.0 {
                TangentFrame::around(toward).to_scene(cone(u, versine(angular_radius)))
            } else {
                toward
            };
            Some(Arrival {
                direction,
                strength: rgb(strength) * sun_factor(angular_radius),
                distance: f64::INFINITY,
            })
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
                Some(k) => {
                    (TangentFrame::around(to_center / distance).to_scene(cone(u, k)), k, true)
                }
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

/// Light from the middle of a light, as a measure of how much light could arrive.
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

/// The radiance of a sun's disk for strength 1, which is the light that a surface facing it reflects.
pub(super) fn sun_radiance(angular_radius: f64) -> f64 {
    1.0 / angular_radius.sin().powi(2)
}

/// [`sun_radiance`] times the solid angle of the disk over π; 1 for a light without angular radius.
fn sun_factor(angular_radius: f64) -> f64 {
    if angular_radius > 0.0 {
        sun_radiance(angular_radius) * 2.0 * versine(angular_radius)
    } else {
        1.0
    }
}

/// The distance to a sphere's near side, or from inside to its far side, along a direction that hits it. If rounding
/// makes the ray miss, the distance to the foot point.
pub(super) fn distance_to_sphere(
    to_center: DVec3,
    radius: f64,
    direction: DVec3,
    is_outside: bool,
) -> f64 {
    let b = to_center.dot(direction);
    let foot = to_center - b * direction;
    let half_chord = (radius * radius - foot.length_squared()).max(0.0).sqrt();
    if is_outside { b - half_chord } else { b + half_chord }
}
