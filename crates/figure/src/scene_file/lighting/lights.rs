//! Reads the tables `[[lights]]`, and `[sun]`, which is also a light.

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use crate::scene_file::span::{
    Keys, Lines, Number, SceneFileError, Span, Vector, name_of, range_of, refuse_foreign, scaled,
};
use pinhole::geometry::math::{MAX_LENGTH, MIN_LENGTH, unit};
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::Table;
use pinhole::light::{Light, LightFrame, LightKind};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    Head,
    Directional,
    Point,
    Sphere,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightTable {
    kind: Kind,
    at: Option<Spanned<LightFrame>>,
    toward: Option<Spanned<Vector>>,
    direction: Option<Spanned<Vector>>,
    angular_radius: Option<Number>,
    angular_diameter: Option<Number>,
    position: Option<Spanned<Vector>>,
    radius: Option<Number>,
    color: Option<LinearRgb>,
    strength: Option<Number>,
    intensity: Option<Number>,
    radiance: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SunTable {
    toward: Option<Spanned<Vector>>,
    direction: Option<Spanned<Vector>>,
    angular_radius: Option<Number>,
    angular_diameter: Option<Number>,
    color: Option<LinearRgb>,
    strength: Option<Number>,
}

/// Angular radius of the sun seen from the earth, in degrees.
const SUN_RADIUS: f64 = 0.27;

/// The largest strength or radiance, by which a colour of light is multiplied.
const STRONGEST: f64 = 1e6;

/// The largest intensity. It may be more, because the light falls off with the square of the distance.
const MOST_INTENSE: f64 = 1e18;

/// Returns the direction from the scene to the light.
fn aim(
    toward: Option<Spanned<Vector>>,
    direction: Option<Spanned<Vector>>,
    lines: &Lines<'_>,
    table: Span,
) -> Result<DVec3, SceneFileError> {
    let (key, vector, sign) = match (toward, direction) {
        (Some(toward), None) => ("toward", toward, 1.0),
        (None, Some(direction)) => ("direction", direction, -1.0),
        (Some(_), Some(direction)) => {
            return Err(lines.span(direction.span().start).error(
                "`toward` and `direction` both set the direction of the light; remove one of them",
            ));
        }
        (None, None) => {
            return Err(table.error(
                    "the light has no direction; add `toward = [x, y, z]`, the direction to the light, or \
                     `direction = [x, y, z]`, the direction in which it shines",
                ));
        }
    };
    let toward = sign * DVec3::from(vector.get_ref().0);
    unit(toward).map(|_| toward).ok_or_else(|| {
            let [x, y, z] = vector.get_ref().0;
            let span = lines.span(vector.span().start);
            span.error(format!(
                "`{key}` is [{x:?}, {y:?}, {z:?}], which is not a valid direction; its length must not be 0"
            ))
        })
}

/// Returns the angular radius in radians. The `default` is in degrees.
fn angular_radius(keys: &Keys<'_>, default: f64) -> Result<f64, SceneFileError> {
    // The renderer accepts 0.001 radians or more; this is the next round number in degrees.
    const LEAST: f64 = 0.06;
    let within = |key, most, range| {
        let given = keys.within(key, [0.0, most], range)?;
        match given {
            Some(degrees) if degrees != 0.0 => keys.within(key, [most / 90.0 * LEAST, most], range),
            given => Ok(given),
        }
    };
    let radius = within("angular_radius", 90.0, "0, or from 0.06 to 90 degrees")?;
    let diameter = within("angular_diameter", 180.0, "0, or from 0.12 to 180 degrees")?;
    match (radius, diameter) {
        (Some(_), Some(_)) => Err(keys.table.error(
            "`angular_radius` and `angular_diameter` exclude each other; remove one of them",
        )),
        (radius, diameter) => {
            Ok(radius.or(diameter.map(|d| d / 2.0)).unwrap_or(default).to_radians())
        }
    }
}

fn times(
    color: Option<LinearRgb>,
    keys: &Keys<'_>,
    key: &'static str,
) -> Result<LinearRgb, SceneFileError> {
    let (most, range) = match key {
        "intensity" => (MOST_INTENSE, "from 0 to 1e18"),
        _ => (STRONGEST, "from 0 to 1e6"),
    };
    let by = keys.within(key, [0.0, most], range)?.unwrap_or(1.0);
    scaled(color.unwrap_or(LinearRgb::WHITE), by, "the light")
        .map_err(|error| keys.table.error(error))
}

fn position(
    vector: Option<Spanned<Vector>>,
    kind: Kind,
    keys: &Keys<'_>,
) -> Result<DVec3, SceneFileError> {
    let Some(vector) = vector else {
        let kind = name_of(&kind);
        return Err(keys
            .table
            .error(format!("a {kind} light needs a position; add `position = [x, y, z]`")));
    };
    let position = vector.get_ref().0;
    if position.iter().all(|x| x.abs() <= MAX_LENGTH) {
        return Ok(DVec3::from(position));
    }
    let [x, y, z] = position;
    Err(keys.lines.span(vector.span().start).error(format!(
        "`position` is [{x:?}, {y:?}, {z:?}]; each number must lie between -2^56 and 2^56"
    )))
}

pub(super) fn read(
    table: Spanned<Table<LightTable>>,
    lines: &Lines<'_>,
) -> Result<Light, SceneFileError> {
    let span = lines.span(table.span().start);
    let table = table.into_inner().0;
    let kind = table.kind;
    let is_one = |kinds: &[Kind]| kinds.contains(&kind);
    let (far, near) = (is_one(&[Kind::Directional]), is_one(&[Kind::Point, Kind::Sphere]));
    refuse_foreign(
        lines,
        &name_of(&kind),
        &[
            ("at", range_of(&table.at), kind != Kind::Head),
            ("toward", range_of(&table.toward), far),
            ("direction", range_of(&table.direction), far),
            ("angular_radius", range_of(&table.angular_radius), far),
            ("angular_diameter", range_of(&table.angular_diameter), far),
            ("position", range_of(&table.position), near),
            ("radius", range_of(&table.radius), is_one(&[Kind::Sphere])),
            ("strength", range_of(&table.strength), !near),
            ("intensity", range_of(&table.intensity), is_one(&[Kind::Point])),
            ("radiance", range_of(&table.radiance), is_one(&[Kind::Sphere])),
        ],
    )?;
    let numbers = vec![
        ("angular_radius", table.angular_radius),
        ("angular_diameter", table.angular_diameter),
        ("radius", table.radius),
        ("strength", table.strength),
        ("intensity", table.intensity),
        ("radiance", table.radiance),
    ];
    let keys = Keys { lines, numbers, table: span };
    let light = match kind {
        Kind::Head => LightKind::Head { strength: times(table.color, &keys, "strength")? },
        Kind::Directional => LightKind::Directional {
            toward: aim(table.toward, table.direction, lines, span)?,
            strength: times(table.color, &keys, "strength")?,
            angular_radius: angular_radius(&keys, 0.0)?,
        },
        Kind::Point => LightKind::Point {
            position: position(table.position, kind, &keys)?,
            intensity: times(table.color, &keys, "intensity")?,
        },
        Kind::Sphere => {
            let range = "a length greater than 0, from 2^-56 to 2^56";
            let radius = keys.within("radius", [MIN_LENGTH, MAX_LENGTH], range)?;
            LightKind::Sphere {
                center: position(table.position, kind, &keys)?,
                radius: radius.ok_or_else(|| {
                    span.error(
                        "a sphere light needs a radius; add `radius`, a length greater than 0",
                    )
                })?,
                radiance: times(table.color, &keys, "radiance")?,
            }
        }
    };
    Ok(Light { kind: light, frame: table.at.map(Spanned::into_inner).unwrap_or_default() })
}

pub(super) fn read_sun(
    table: Spanned<Table<SunTable>>,
    lines: &Lines<'_>,
) -> Result<Light, SceneFileError> {
    let span = lines.span(table.span().start);
    let table = table.into_inner().0;
    let numbers = vec![
        ("angular_radius", table.angular_radius),
        ("angular_diameter", table.angular_diameter),
        ("strength", table.strength),
    ];
    let keys = Keys { lines, numbers, table: span };
    let kind = LightKind::Directional {
        toward: aim(table.toward, table.direction, lines, span)?,
        strength: times(table.color, &keys, "strength")?,
        angular_radius: angular_radius(&keys, SUN_RADIUS)?,
    };
    Ok(Light { kind, frame: LightFrame::World })
}
