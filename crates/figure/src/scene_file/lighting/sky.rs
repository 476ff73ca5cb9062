//! The tables `[sky]` and `[ground]`.

use std::sync::Arc;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::scene_file::span::{KeyError, default_color, scaled};
use pinhole::geometry::math::{MAX_LENGTH, unit};
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::{List, degrees};
use pinhole::light::environment::Environment;
use pinhole::light::{Ground, Sky, SkyLight};
use pinhole::range::RangeError;
use pinhole::scene::Scene;

/// The table `[sky]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum SkyTable {
    /// One light from all directions.
    Constant {
        /// The colour; white by default.
        #[serde(default = "white")]
        color: LinearRgb,
        /// Factor of the colour, from 0 to 1e6.
        #[serde(default = "one")]
        strength: f64,
        /// Whether the camera sees the sky.
        #[serde(default = "yes")]
        visible: bool,
    },
    /// Light that changes with the height y of its direction.
    Gradient {
        /// The colour straight up; white by default.
        #[serde(default = "white")]
        zenith: LinearRgb,
        /// The colour at the horizon; a light grey by default.
        #[serde(default = "horizon")]
        horizon: LinearRgb,
        /// The colour straight down; a grey by default.
        #[serde(default = "nadir")]
        nadir: LinearRgb,
        /// Factor of the colours, from 0 to 1e6.
        #[serde(default = "one")]
        strength: f64,
        /// Whether the camera sees the sky.
        #[serde(default = "yes")]
        visible: bool,
    },
    /// An image of all directions.
    Image {
        /// The file, .hdr or .exr, relative to the scene file.
        image: String,
        /// Rotation about +y in degrees, counter-clockwise seen from above: -36000 to 36000.
        #[serde(default)]
        rotation: f64,
        /// Factor of the colours, from 0 to 1e6.
        #[serde(default = "one")]
        strength: f64,
        /// Whether the camera sees the sky.
        #[serde(default = "yes")]
        visible: bool,
    },
}

fn white() -> LinearRgb {
    LinearRgb::WHITE
}

fn horizon() -> LinearRgb {
    LinearRgb::gray(0.8)
}

fn nadir() -> LinearRgb {
    LinearRgb::gray(0.4)
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

impl SkyTable {
    /// The path of the image, if the sky is one.
    pub(crate) fn image(&self) -> Option<&str> {
        match self {
            Self::Image { image, .. } => Some(image),
            _ => None,
        }
    }

    /// The table of a sky, whose image is in a file if it is one.
    pub(crate) fn of(sky: &Sky, image: Option<String>) -> Self {
        let (strength, visible) = (1.0, sky.is_visible);
        match sky.light {
            SkyLight::Constant(color) => Self::Constant { color, strength, visible },
            SkyLight::Gradient { zenith, horizon, nadir } => {
                Self::Gradient { zenith, horizon, nadir, strength, visible }
            }
            SkyLight::Image { strength, rotation, .. } => Self::Image {
                image: image.unwrap_or_default(),
                rotation: degrees::of(rotation, |found| found.to_bits() == rotation.to_bits()),
                strength: strength.into(),
                visible,
            },
        }
    }

    /// The light of the sky; `None` for that of an image, whose numbers are checked.
    pub(super) fn light(&self) -> Result<Option<SkyLight>, KeyError> {
        let bounded = |strength: f64| RangeError::unless_within("strength", strength, [0.0, 1e6], "from 0 to 1e6");
        Ok(match *self {
            Self::Constant { color, strength, .. } => {
                Some(SkyLight::Constant(scaled(color, bounded(strength)?, "the sky")?))
            }
            Self::Gradient { zenith, horizon, nadir, strength, .. } => {
                let by = bounded(strength)?;
                let scaled = |color| scaled(color, by, "the sky");
                let (zenith, horizon, nadir) = (scaled(zenith)?, scaled(horizon)?, scaled(nadir)?);
                Some(SkyLight::Gradient { zenith, horizon, nadir })
            }
            Self::Image { rotation, strength, .. } => {
                let range = "from -36000 to 36000 degrees";
                RangeError::unless_within("rotation", rotation, [-36e3, 36e3], range)?;
                bounded(strength).map(|_| None)?
            }
        })
    }

    /// The sky, with its image if it has one.
    pub(crate) fn sky(&self, image: Option<Environment>) -> Result<Sky, KeyError> {
        let light = match (self.light()?, self) {
            (None, Self::Image { rotation, strength, .. }) => SkyLight::Image {
                environment: Arc::new(
                    image.ok_or("`image`: the settings need this image of the sky, which was not given")?,
                ),
                strength: *strength as f32,
                rotation: rotation.to_radians(),
            },
            (light, _) => light.unwrap_or(SkyLight::Constant(LinearRgb::BLACK)),
        };
        let (Self::Constant { visible, .. } | Self::Gradient { visible, .. } | Self::Image { visible, .. }) = self;
        Ok(Sky { light, is_visible: *visible })
    }
}

/// The table `[ground]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GroundTable {
    /// The height y of a level ground, in scene units; by default it touches the lowest sphere.
    height: Option<f64>,
    /// A point of the ground, instead of `height`.
    point: Option<List<3>>,
    /// The direction that is above the ground; +y by default.
    normal: Option<List<3>>,
    /// The colour; a light grey by default.
    #[serde(default = "default_color")]
    color: LinearRgb,
    /// Whether only shadows on the ground are seen.
    #[serde(default)]
    shadow_catcher: bool,
}

impl GroundTable {
    pub(crate) fn of(ground: &Ground) -> Self {
        Self {
            height: None,
            point: Some(List(ground.point.into())),
            normal: Some(List(ground.normal.into())),
            color: ground.color,
            shadow_catcher: ground.is_shadow_catcher,
        }
    }

    pub(super) fn check(&self) -> Result<(), KeyError> {
        if self.height.is_some() && (self.point.is_some() || self.normal.is_some()) {
            return Err("`height` cannot be combined with `point` or `normal`; remove one of them".into());
        }
        if self.normal.is_some() && self.point.is_none() {
            return Err("`normal` needs a point on the ground; add `point = [x, y, z]`".into());
        }
        for (key, vector) in [("point", self.point), ("normal", self.normal)] {
            let Some(List([x, y, z])) = vector else { continue };
            let is_near = [x, y, z].iter().all(|x| x.abs() <= MAX_LENGTH);
            let is_direction = key == "point" || unit(DVec3::new(x, y, z)).is_some();
            if !(is_near && is_direction) {
                return Err(format!(
                    "`{key}` is [{x:?}, {y:?}, {z:?}]; each number must lie between -2^56 and 2^56, and a normal must \
                     not have the length 0"
                )
                .into());
            }
        }
        let range = "between -2^56 and 2^56";
        let height = self.height.unwrap_or_default();
        RangeError::unless_within("height", height, [-MAX_LENGTH, MAX_LENGTH], range)?;
        Ok(())
    }

    pub(crate) fn ground(&self, scene: &Scene) -> Ground {
        let lowest = || {
            let bounds = scene.bounds_to_frame();
            let center = bounds.center();
            DVec3::new(center.x, bounds.min().y, center.z)
        };
        let point = self.point.map(|point| DVec3::from(point.0));
        let at_height = || self.height.map(|height| DVec3::new(0.0, height, 0.0));
        Ground {
            point: point.or_else(at_height).unwrap_or_else(lowest),
            normal: self.normal.map_or(DVec3::Y, |normal| DVec3::from(normal.0)),
            color: self.color,
            is_shadow_catcher: self.shadow_catcher,
        }
    }
}
