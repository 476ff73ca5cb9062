//! Lights that are no spheres of the scene, seen from a point.

use glam::DVec3;

use super::context::rgb;
use super::maps::{TangentFrame, cone, cone_of_sphere, versine};
use crate::light::LightKind;

/// Light that arrives at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// Where it comes from; unit.
    pub(super) direction: DVec3,
    /// What a white surface that faces it sends back.
    pub(super) strength: DVec3,
    /// How far away the light is.
    pub(super) distance: f64,
}

/// Light from a point of a lamp, chosen by chance; the mean of many is its light. `None` for a light at the eye, and
/// where a light has no direction.
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

/// The same of the light's middle, for a measure of how much light there could be.
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

/// The radiance of a sun's disk whose light has the given strength where a surface faces it, for strength 1.
pub(super) fn sun_radiance(angular_radius: f64) -> f64 {
    1.0 / angular_radius.sin().powi(2)
}

/// The same times the cone's solid angle over π, which is 1 for what is infinitely small.
fn sun_factor(angular_radius: f64) -> f64 {
    if angular_radius > 0.0 {
        sun_radiance(angular_radius) * 2.0 * versine(angular_radius)
    } else {
        1.0
    }
}

/// The distance to a sphere's near side, or to its far side from inside, in a direction that meets it: where rounding
/// says that it does not, to the foot point.
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
