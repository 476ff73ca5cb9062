//! The tables `[[lights]]`, and `[sun]`, which is also a light.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::scene_file::span::{KeyError, scaled};
use pinhole::geometry::math::{MAX_LENGTH, MIN_LENGTH, unit};
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::{List, degrees};
use pinhole::light::{Light, LightFrame, LightKind};
use pinhole::range::RangeError;

/// A table of the list `lights`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum LightTable {
    /// A light at the eye, without shadows.
    Head {
        /// The colour; white by default.
        color: Option<LinearRgb>,
        /// Factor of the colour, from 0 to 1e6.
        strength: Option<f64>,
    },
    /// A light infinitely far away.
    Directional(DirectionalTable),
    /// A light at a point, which falls off with the square of the distance.
    Point {
        /// The frame of the position: `world` or `camera`.
        #[serde(default)]
        at: LightFrame,
        /// The position in scene units.
        position: List<3>,
        /// The colour; white by default.
        color: Option<LinearRgb>,
        /// Factor of the colour at the distance 1, from 0 to 1e18.
        intensity: Option<f64>,
    },
    /// A sphere that shines, with soft shadows; it is invisible.
    Sphere {
        /// The frame of the position: `world` or `camera`.
        #[serde(default)]
        at: LightFrame,
        /// The position of the centre in scene units.
        position: List<3>,
        /// The radius in scene units, greater than 0.
        radius: f64,
        /// The colour; white by default.
        color: Option<LinearRgb>,
        /// Factor of the colour, from 0 to 1e6.
        radiance: Option<f64>,
    },
}

/// The keys of a light infinitely far away, such as the sun.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DirectionalTable {
    /// The frame of the direction: `world` or `camera`. A sun stands in the world.
    at: Option<LightFrame>,
    /// The direction to the light.
    toward: Option<List<3>>,
    /// The direction in which the light shines, instead of `toward`.
    direction: Option<List<3>>,
    /// Half of the angle under which the light is seen, in degrees: 0, or from 0.06 to 90.
    angular_radius: Option<f64>,
    /// The angle under which the light is seen, in degrees, instead of `angular_radius`.
    angular_diameter: Option<f64>,
    /// The colour; white by default.
    color: Option<LinearRgb>,
    /// Factor of the colour, from 0 to 1e6.
    strength: Option<f64>,
}

/// Angular radius of the sun seen from the earth, in degrees.
const SUN_RADIUS: f64 = 0.27;

/// The largest strength or radiance, by which a colour of light is multiplied.
const STRONGEST: f64 = 1e6;

/// The largest intensity. It may be more, because the light falls off with the square of the distance.
const MOST_INTENSE: f64 = 1e18;

impl LightTable {
    pub(crate) fn of(light: &Light) -> Self {
        let at = light.frame;
        match light.kind {
            LightKind::Head { strength } => Self::Head { color: Some(strength), strength: None },
            LightKind::Directional { toward, strength, angular_radius } => {
                let is_same = |found: f64| found.to_bits() == angular_radius.to_bits();
                Self::Directional(DirectionalTable {
                    at: Some(at),
                    toward: Some(List(toward.into())),
                    direction: None,
                    angular_radius: Some(degrees::of(angular_radius, is_same)),
                    angular_diameter: None,
                    color: Some(strength),
                    strength: None,
                })
            }
            LightKind::Point { position, intensity } => {
                let (position, color) = (List(position.into()), Some(intensity));
                Self::Point { at, position, color, intensity: None }
            }
            LightKind::Sphere { center, radius, radiance } => {
                let (position, color) = (List(center.into()), Some(radiance));
                Self::Sphere { at, position, radius, color, radiance: None }
            }
        }
    }

    pub(super) fn light(&self) -> Result<Light, KeyError> {
        let (kind, frame) = match self {
            Self::Head { color, strength } => {
                let strength = times(*color, "strength", *strength)?;
                (LightKind::Head { strength }, LightFrame::World)
            }
            Self::Directional(table) => (table.kind(0.0)?, table.at.unwrap_or_default()),
            Self::Point { at, position, color, intensity } => {
                let intensity = times(*color, "intensity", *intensity)?;
                (LightKind::Point { position: place(*position)?, intensity }, *at)
            }
            Self::Sphere { at, position, radius, color, radiance } => {
                let range = "a length greater than 0, from 2^-56 to 2^56";
                let bounds = [MIN_LENGTH, MAX_LENGTH];
                let radius = RangeError::unless_within("radius", *radius, bounds, range)?;
                let radiance = times(*color, "radiance", *radiance)?;
                (LightKind::Sphere { center: place(*position)?, radius, radiance }, *at)
            }
        };
        Ok(Light { kind, frame })
    }
}

impl DirectionalTable {
    pub(super) fn sun(&self) -> Result<Light, KeyError> {
        match self.at {
            None => Ok(Light { kind: self.kind(SUN_RADIUS)?, frame: LightFrame::World }),
            Some(_) => Err("`at` does not apply to the sun, which stands in the world; remove it".into()),
        }
    }

    /// The light. Where nothing says how large it is, it has the `default` radius in degrees.
    fn kind(&self, default: f64) -> Result<LightKind, KeyError> {
        Ok(LightKind::Directional {
            toward: self.aim()?,
            strength: times(self.color, "strength", self.strength)?,
            angular_radius: self.angular_radius(default)?,
        })
    }

    /// The direction from the scene to the light.
    fn aim(&self) -> Result<DVec3, KeyError> {
        let (key, List([x, y, z]), sign) = match (self.toward, self.direction) {
            (Some(toward), None) => ("toward", toward, 1.0),
            (None, Some(direction)) => ("direction", direction, -1.0),
            (Some(_), Some(_)) => {
                return Err("`direction` and `toward` both set the direction of the light; remove one of them".into());
            }
            (None, None) => {
                return Err("the light has no direction; add `toward = [x, y, z]`, the direction to the light, or \
                     `direction = [x, y, z]`, the direction in which it shines"
                    .into());
            }
        };
        let toward = sign * DVec3::new(x, y, z);
        unit(toward).map(|_| toward).ok_or_else(|| {
            format!("`{key}` is [{x:?}, {y:?}, {z:?}], which is not a valid direction; its length must not be 0").into()
        })
    }

    /// The angular radius in radians.
    fn angular_radius(&self, default: f64) -> Result<f64, KeyError> {
        // The renderer accepts 0.001 radians or more; this is the next round number in degrees.
        const LEAST: f64 = 0.06;
        let within = |key, degrees: Option<f64>, share: f64, range| {
            let least = if degrees == Some(0.0) { 0.0 } else { share * LEAST };
            let bounds = [least, share * 90.0];
            degrees.map(|d| RangeError::unless_within(key, d, bounds, range)).transpose()
        };
        let (radius, diameter) = (self.angular_radius, self.angular_diameter);
        let radius = within("angular_radius", radius, 1.0, "0, or from 0.06 to 90 degrees")?;
        let diameter = within("angular_diameter", diameter, 2.0, "0, or from 0.12 to 180 degrees")?;
        if radius.is_some() && diameter.is_some() {
            return Err("`angular_radius` and `angular_diameter` exclude each other; remove one of them".into());
        }
        Ok(radius.or(diameter.map(|d| d / 2.0)).unwrap_or(default).to_radians())
    }
}

/// A colour of light, multiplied by the number of a key.
fn times(color: Option<LinearRgb>, key: &'static str, by: Option<f64>) -> Result<LinearRgb, KeyError> {
    let (most, range) = match key {
        "intensity" => (MOST_INTENSE, "from 0 to 1e18"),
        _ => (STRONGEST, "from 0 to 1e6"),
    };
    let by = RangeError::unless_within(key, by.unwrap_or(1.0), [0.0, most], range)?;
    Ok(scaled(color.unwrap_or(LinearRgb::WHITE), by, "the light")?)
}

fn place(List(position): List<3>) -> Result<DVec3, KeyError> {
    if position.iter().all(|x| x.abs() <= MAX_LENGTH) {
        return Ok(position.into());
    }
    let [x, y, z] = position;
    Err(format!("`position` is [{x:?}, {y:?}, {z:?}]; each number must lie between -2^56 and 2^56").into())
}
