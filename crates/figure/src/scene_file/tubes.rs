//! The list `tubes`, whose tables have the points of a tube.

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::cones::{ConesTable, OwnCones, matt_surface};
use super::materials::Materials;
use super::span::{SceneFileError, default_color};
use crate::settings::places::Places;
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::{List, Table};
use pinhole::scene::sphere;
use pinhole::scene::tube::Tube;

/// A table of the list `tubes`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TubeTable {
    /// The points that the tube goes through, at least two; it is closed if the last one is the first one.
    points: Vec<List<3>>,
    /// The radius in scene units, greater than 0.
    radius: Option<f64>,
    /// A radius for each point, in the place of `radius`.
    radii: Option<Vec<f64>>,
    /// The colour; a light grey by default.
    #[serde(default = "default_color")]
    color: LinearRgb,
    /// The name of a material, which must not be emissive.
    material: Option<String>,
    /// Opacity, from 0 (clear) to 1 (opaque).
    opacity: Option<f64>,
}

/// Reads the list `tubes`, as shapes of tables of cones.
pub(super) fn tubes(
    tables: &[Spanned<Table<TubeTable>>],
    materials: &Materials,
    places: &Places<'_>,
) -> Result<Vec<(ConesTable, OwnCones)>, SceneFileError> {
    let tube = |(index, spanned): (usize, &Spanned<Table<TubeTable>>)| {
        let Table(table) = spanned.get_ref();
        let (list, name) = (format!("tubes.{index}"), format!("tube {index}"));
        let at_table = places.lines.span(spanned.span().start);
        let refused = |error: String| at_table.error(format!("{name}: {error}"));
        let count = table.points.len();
        let radius_of: Box<dyn Fn(usize) -> f64> = match (table.radius, &table.radii) {
            (Some(radius), None) => Box::new(move |_| radius),
            (None, Some(radii)) if radii.len() == count => Box::new(|point| radii[point]),
            (None, Some(radii)) => {
                return Err(refused(format!(
                    "there are {} `radii` for {count} points; give one for each",
                    radii.len()
                )));
            }
            (Some(_), Some(_)) => {
                return Err(refused("`radius` and `radii` exclude each other; remove one of them".to_owned()));
            }
            (None, None) => return Err(at_table.error("missing key `radius` or `radii`; add one of them")),
        };
        let points = table.points.iter().enumerate();
        let points: Vec<[f64; 4]> = points.map(|(index, List([x, y, z]))| [*x, *y, *z, radius_of(index)]).collect();
        for (index, point) in points.iter().enumerate() {
            sphere::check(*point).map_err(|error| refused(format!("point {index}: {error}")))?;
        }
        let surface =
            matt_surface((&list, &name), (table.material.as_deref(), table.opacity), materials, at_table, places)?;
        let Tube { spheres, sides } = Tube::through(&points);
        if spheres.len() < 2 {
            return Err(refused("a tube needs two points in different places; add some".to_owned()));
        }
        if let Some(error) = sides.iter().find_map(|side| side.check().err()) {
            return Err(refused(format!("a piece of it cannot be drawn: {error}")));
        }
        let own = OwnCones { ends: spheres, ..OwnCones::new(sides, vec![table.color], surface) };
        Ok((ConesTable::of_one(at_table, name, table.color, surface), own))
    };
    tables.iter().enumerate().map(tube).collect()
}
