//! Reads the table `[ground]`.

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use crate::exact::Table;
use crate::geometry::math::{MAX_LENGTH, unit};
use crate::image::color::LinearRgb;
use crate::light::Ground;
use crate::scene::Scene;
use crate::scene_file::span::{Keys, Lines, Number, SceneFileError, WithSpan};
use crate::scene_file::value::{ColorValue, Vector};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene_file) struct GroundTable {
    height: Option<Number>,
    point: Option<Spanned<Vector>>,
    normal: Option<Spanned<Vector>>,
    #[serde(default)]
    color: ColorValue,
    #[serde(default)]
    shadow_catcher: bool,
}

/// The ground as the file gives it. Without a point, it will touch the lowest sphere of the scene.
#[derive(Debug)]
pub(in crate::scene_file) struct GroundPlan {
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
            color: color.0,
            is_shadow_catcher: shadow_catcher,
        };
        Ok(WithSpan { value, span })
    }

    pub(in crate::scene_file) fn ground(&self, scene: &Scene) -> Ground {
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
