//! Reads the tables `[sky]` and `[ground]`.

use std::sync::Arc;

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use crate::scene_file::span::{
    Keys, Lines, Number, SceneFileError, Vector, WithSpan, default_color, name_of, range_of,
    refuse_foreign, scaled,
};
use pinhole::geometry::math::{MAX_LENGTH, unit};
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::Table;
use pinhole::light::environment::Environment;
use pinhole::light::{Ground, Sky, SkyLight};
use pinhole::scene::Scene;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    Constant,
    Gradient,
    Image,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SkyTable {
    kind: Kind,
    color: Option<Spanned<LinearRgb>>,
    zenith: Option<Spanned<LinearRgb>>,
    horizon: Option<Spanned<LinearRgb>>,
    nadir: Option<Spanned<LinearRgb>>,
    image: Option<Spanned<String>>,
    rotation: Option<Number>,
    strength: Option<Number>,
    visible: Option<bool>,
}

/// The sky as the file gives it; its image is not loaded yet.
#[derive(Debug)]
pub(crate) struct SkyPlan {
    light: SkyPlanLight,
    is_visible: bool,
}

#[derive(Debug)]
enum SkyPlanLight {
    Known(SkyLight),
    Image { file: WithSpan<String>, strength: f32, rotation: f64 },
}

impl SkyPlan {
    pub(super) fn read(
        table: Spanned<Table<SkyTable>>,
        lines: &Lines<'_>,
    ) -> Result<Self, SceneFileError> {
        let span = lines.span(table.span().start);
        let table = table.into_inner().0;
        let kind = table.kind;
        refuse_foreign(
            lines,
            &name_of(&kind),
            &[
                ("color", range_of(&table.color), kind == Kind::Constant),
                ("zenith", range_of(&table.zenith), kind == Kind::Gradient),
                ("horizon", range_of(&table.horizon), kind == Kind::Gradient),
                ("nadir", range_of(&table.nadir), kind == Kind::Gradient),
                ("image", range_of(&table.image), kind == Kind::Image),
                ("rotation", range_of(&table.rotation), kind == Kind::Image),
            ],
        )?;
        let numbers = vec![("rotation", table.rotation), ("strength", table.strength)];
        let keys = Keys { lines, numbers, table: span };
        let strength = keys.within("strength", [0.0, 1e6], "from 0 to 1e6")?.unwrap_or(1.0);
        let color = |value: Option<Spanned<LinearRgb>>, default: f32| {
            let color = value.map_or(LinearRgb::gray(default), Spanned::into_inner);
            scaled(color, strength, "the sky").map_err(|error| span.error(error))
        };
        // The defaults of the gradient are those of the sky without a scene file.
        let light = match kind {
            Kind::Constant => SkyPlanLight::Known(SkyLight::Constant(color(table.color, 1.0)?)),
            Kind::Gradient => SkyPlanLight::Known(SkyLight::Gradient {
                zenith: color(table.zenith, 1.0)?,
                horizon: color(table.horizon, 0.8)?,
                nadir: color(table.nadir, 0.4)?,
            }),
            Kind::Image => {
                let range = "from -36000 to 36000 degrees";
                let degrees = keys.within("rotation", [-36e3, 36e3], range)?.unwrap_or(0.0);
                let file = table.image.ok_or_else(|| {
                    span.error("a sky of the kind `image` needs a file; add `image = \"FILE.hdr\"`, or .exr")
                })?;
                SkyPlanLight::Image {
                    file: lines.spanned(file),
                    strength: strength as f32,
                    rotation: degrees.to_radians(),
                }
            }
        };
        Ok(Self { light, is_visible: table.visible.unwrap_or(true) })
    }

    pub(crate) fn image(&self) -> Option<&str> {
        match &self.light {
            SkyPlanLight::Image { file, .. } => Some(&file.value),
            SkyPlanLight::Known(_) => None,
        }
    }

    pub(crate) fn sky(&self, image: Option<Environment>) -> Result<Sky, SceneFileError> {
        let light = match &self.light {
            SkyPlanLight::Known(light) => light.clone(),
            SkyPlanLight::Image { file, strength, rotation } => SkyLight::Image {
                environment: Arc::new(image.ok_or_else(|| {
                    file.span.error("the settings need this image of the sky, which was not given")
                })?),
                strength: *strength,
                rotation: *rotation,
            },
        };
        Ok(Sky { light, is_visible: self.is_visible })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GroundTable {
    height: Option<Number>,
    point: Option<Spanned<Vector>>,
    normal: Option<Spanned<Vector>>,
    #[serde(default = "default_color")]
    color: LinearRgb,
    #[serde(default)]
    shadow_catcher: bool,
}

/// The ground as the file gives it. Without a point, it will touch the lowest sphere of the scene.
#[derive(Debug)]
pub(crate) struct GroundPlan {
    point: Option<DVec3>,
    normal: DVec3,
    color: LinearRgb,
    is_shadow_catcher: bool,
}

impl GroundPlan {
    pub(super) fn read(
        table: Spanned<Table<GroundTable>>,
        lines: &Lines<'_>,
    ) -> Result<WithSpan<Self>, SceneFileError> {
        let span = lines.span(table.span().start);
        let GroundTable { height, point, normal, color, shadow_catcher } = table.into_inner().0;
        if let (Some(height), Some(_)) = (&height, point.as_ref().or(normal.as_ref())) {
            return Err(lines.span(height.span().start).error(
                "`height` cannot be combined with `point` or `normal`; remove one of them",
            ));
        }
        if let (Some(normal), None) = (&normal, &point) {
            let span = lines.span(normal.span().start);
            return Err(span.error("`normal` needs a point on the ground; add `point = [x, y, z]`"));
        }
        let is_near = |v: &[f64; 3]| v.iter().all(|x| x.abs() <= MAX_LENGTH);
        for (key, vector) in [("point", &point), ("normal", &normal)] {
            let Some(vector) = vector else {
                continue;
            };
            let [x, y, z] = vector.get_ref().0;
            let is_direction = key == "point" || unit(DVec3::new(x, y, z)).is_some();
            if !(is_near(&[x, y, z]) && is_direction) {
                return Err(lines.span(vector.span().start).error(format!(
                    "`{key}` is [{x:?}, {y:?}, {z:?}]; each number must lie between -2^56 and 2^56, \
                     and a normal must not have the length 0"
                )));
            }
        }
        let keys = Keys { lines, numbers: vec![("height", height)], table: span };
        let range = "between -2^56 and 2^56";
        let height = keys.within("height", [-MAX_LENGTH, MAX_LENGTH], range)?;
        let point = point.map(|point| DVec3::from(point.get_ref().0));
        let value = Self {
            point: point.or(height.map(|height| DVec3::new(0.0, height, 0.0))),
            normal: normal.map_or(DVec3::Y, |normal| DVec3::from(normal.get_ref().0)),
            color,
            is_shadow_catcher: shadow_catcher,
        };
        Ok(WithSpan { value, span })
    }

    pub(crate) fn ground(&self, scene: &Scene) -> Ground {
        let lowest = || {
            let bounds = scene.bounds_to_frame();
            let center = bounds.center();
            DVec3::new(center.x, bounds.min().y, center.z)
        };
        Ground {
            point: self.point.unwrap_or_else(lowest),
            normal: self.normal,
            color: self.color,
            is_shadow_catcher: self.is_shadow_catcher,
        }
    }
}
