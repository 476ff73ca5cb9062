//! The lists `cylinders` and `cones`, whose tables hold one shape or name a file of them.

use std::fmt;

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::materials::{Materials, over};
use super::span::{SceneFileError, Span, default_color};
use crate::settings::places::Places;
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::{List, Table};
use pinhole::scene::cone::{Caps, Cone};
use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::sphere::{self, SphereError};
use pinhole_data::load::{ConeKind, ConeSet};

/// The cylinders or cones of one table of a scene file, and their look.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnCones {
    /// The shapes.
    pub cones: Vec<Cone>,
    /// The spheres (x, y, z, radius) at round ends.
    pub ends: Vec<[f64; 4]>,
    /// One colour for all; or one for each shape, and then for each sphere.
    pub colors: Vec<LinearRgb>,
    /// The surface properties.
    pub surface: SurfaceProperties,
}

/// A file of cylinders or cones that a table of a scene file names.
#[derive(Clone, Debug, PartialEq)]
pub struct ConeFile {
    /// The path, relative to the scene file.
    pub file: String,
    /// What the file has.
    pub kind: ConeKind,
    /// The radii of both ends of all shapes, for a file without radii.
    pub radii: Option<[f64; 2]>,
}

impl OwnCones {
    /// Shapes that were checked. `colors` is one for all, or one for each.
    #[must_use]
    pub const fn new(cones: Vec<Cone>, colors: Vec<LinearRgb>, surface: SurfaceProperties) -> Self {
        Self { cones, ends: Vec::new(), colors, surface }
    }

    /// The shapes with round ends, as [`Cone::rounded`] makes them.
    ///
    /// # Errors
    /// Returns an error if a sphere at an end is out of range, with the index of the shape.
    pub fn rounded(&self) -> Result<Self, (usize, SphereError)> {
        let color = |index: usize| self.colors.get(index).copied().filter(|_| self.colors.len() > 1);
        let (mut cones, mut ends) = (Vec::with_capacity(self.cones.len()), Vec::with_capacity(2 * self.cones.len()));
        let (mut colors, mut of_ends) = (Vec::new(), Vec::new());
        for (index, cone) in self.cones.iter().enumerate() {
            let sphere = |[x, y, z]: [f64; 3], radius| [x, y, z, radius];
            let [first, second] = [sphere(cone.start, cone.radii[0]), sphere(cone.end, cone.radii[1])];
            let (side, spheres) = Cone::rounded(first, second);
            colors.extend(side.and(color(index)));
            cones.extend(side);
            for end in spheres.into_iter().flatten() {
                sphere::check(end).map_err(|error| (index, error))?;
                of_ends.extend(color(index));
                ends.push(end);
            }
        }
        colors.append(&mut of_ends);
        if colors.is_empty() {
            colors.clone_from(&self.colors);
        }
        Ok(Self { cones, ends, colors, surface: self.surface })
    }

    /// The looks of the cones.
    pub(super) fn looks(&self) -> impl Iterator<Item = (LinearRgb, SurfaceProperties)> {
        (0..self.cones.len()).map(|index| self.look(index))
    }

    /// The looks of the spheres at round ends.
    pub(super) fn looks_of_ends(&self) -> impl Iterator<Item = (LinearRgb, SurfaceProperties)> {
        (0..self.ends.len()).map(|index| self.look(self.cones.len() + index))
    }

    fn look(&self, index: usize) -> (LinearRgb, SurfaceProperties) {
        let color = match &self.colors[..] {
            [color] => *color,
            colors => colors.get(index).copied().unwrap_or(LinearRgb::WHITE),
        };
        (color, self.surface)
    }
}

/// A table of the lists `cylinders` and `cones`.
#[derive(Clone, Debug)]
pub(super) struct ConesTable {
    /// The place of the table, or of its key `file`.
    pub(super) span: Span,
    /// The table in words, such as `cylinder 3`.
    pub(super) name: String,
    /// The file of the shapes.
    pub(super) file: Option<ConeFile>,
    /// Whether the file has not been read.
    pub(super) is_open: bool,
    pub(super) color: LinearRgb,
    pub(super) surface: SurfaceProperties,
    caps: Caps,
    is_round: bool,
}

/// A table of the list `cylinders`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CylinderTable {
    /// Path of a file of cylinders, relative to the scene file, in the place of `start` and `end`.
    pub(super) file: Option<String>,
    /// The middle of the first end in scene units.
    start: Option<List<3>>,
    /// The middle of the second end.
    end: Option<List<3>>,
    /// The radius in scene units, greater than 0.
    radius: Option<f64>,
    /// The closed ends: `none`, `first`, `second` or `both`, which is the default.
    caps: Option<Caps>,
    /// Whether the ends are round: a sphere at each.
    #[serde(default)]
    round: bool,
    /// The colour; a light grey by default. Colours of a file take precedence.
    #[serde(default = "default_color")]
    color: LinearRgb,
    /// The name of a material, which must not be emissive.
    material: Option<String>,
    /// Opacity, from 0 (clear) to 1 (opaque).
    opacity: Option<f64>,
}

/// A table of the list `cones`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConeTable {
    /// Path of a file of cones, relative to the scene file, in the place of `start` and `end`.
    pub(super) file: Option<String>,
    /// The middle of the first end in scene units.
    start: Option<List<3>>,
    /// The middle of the second end.
    end: Option<List<3>>,
    /// The radii of both ends in scene units. One of them may be 0, which makes a tip.
    radii: Option<Pair>,
    /// The closed ends: `none`, `first`, `second` or `both`, which is the default.
    caps: Option<Caps>,
    /// Whether the ends are round: a sphere at each, which the side touches.
    #[serde(default)]
    round: bool,
    /// The colour; a light grey by default. Colours of a file take precedence.
    #[serde(default = "default_color")]
    color: LinearRgb,
    /// The name of a material, which must not be emissive.
    material: Option<String>,
    /// Opacity, from 0 (clear) to 1 (opaque).
    opacity: Option<f64>,
}

type Pair = List<2>;

/// The tables of a list.
type Tables<T> = [Spanned<Table<T>>];

/// The keys of a table of either list.
struct Keys<'a> {
    file: Option<&'a String>,
    ends: [(&'static str, Option<[f64; 3]>); 2],
    radii: Option<[f64; 2]>,
    caps: Option<Caps>,
    is_round: bool,
    color: LinearRgb,
    material: Option<&'a str>,
    opacity: Option<f64>,
}

/// Reads the list `cylinders`, and then the list `cones`. Files are not read.
pub(super) fn cones(
    (cylinders, cones): (&Tables<CylinderTable>, &Tables<ConeTable>),
    materials: &Materials,
    places: &Places<'_>,
) -> Result<Vec<(ConesTable, OwnCones)>, SceneFileError> {
    let place = |place: &Option<List<3>>| place.map(|place| place.0);
    let cylinder = |(index, spanned): (usize, &Spanned<Table<CylinderTable>>)| {
        let Table(table) = spanned.get_ref();
        let keys = Keys {
            file: table.file.as_ref(),
            ends: [("start", place(&table.start)), ("end", place(&table.end))],
            radii: table.radius.map(|radius| [radius; 2]),
            caps: table.caps,
            is_round: table.round,
            color: table.color,
            material: table.material.as_deref(),
            opacity: table.opacity,
        };
        read(&keys, ConeKind::Cylinder, (index, spanned.span().start), materials, places)
    };
    let cone = |(index, spanned): (usize, &Spanned<Table<ConeTable>>)| {
        let Table(table) = spanned.get_ref();
        let keys = Keys {
            file: table.file.as_ref(),
            ends: [("start", place(&table.start)), ("end", place(&table.end))],
            radii: table.radii.map(|radii| radii.0),
            caps: table.caps,
            is_round: table.round,
            color: table.color,
            material: table.material.as_deref(),
            opacity: table.opacity,
        };
        read(&keys, ConeKind::Cone, (index, spanned.span().start), materials, places)
    };
    cylinders.iter().enumerate().map(cylinder).chain(cones.iter().enumerate().map(cone)).collect()
}

/// The surface of a table, which must not emit light. The table has a place among the keys, such as `cones.3`, and a name
/// in words, such as `cone 3`.
pub(super) fn matt_surface(
    (list, name): (&str, &str),
    (material, opacity): (Option<&str>, Option<f64>),
    materials: &Materials,
    at_table: Span,
    places: &Places<'_>,
) -> Result<SurfaceProperties, SceneFileError> {
    let surface = over(materials, SurfaceProperties::default(), material, opacity)
        .map_err(|error| places.refused(list, error))?;
    if matches!(surface.material, Material::Emissive { .. }) {
        return Err(at_table.error(format!(
            "{name}: it has an emissive material, but only spheres emit light; name another material"
        )));
    }
    Ok(surface)
}

/// Reads a table, which begins at a byte.
fn read(
    keys: &Keys<'_>,
    kind: ConeKind,
    (index, byte): (usize, usize),
    materials: &Materials,
    places: &Places<'_>,
) -> Result<(ConesTable, OwnCones), SceneFileError> {
    let (list, name) = match kind {
        ConeKind::Cylinder => (format!("cylinders.{index}"), format!("cylinder {index}")),
        ConeKind::Cone => (format!("cones.{index}"), format!("cone {index}")),
    };
    let refused = |error: String| places.refused(&list, error);
    let at_table = places.lines.span(byte);
    let surface = matt_surface((&list, &name), (keys.material, keys.opacity), materials, at_table, places)?;
    if keys.is_round && keys.caps.is_some() {
        return Err(refused("`caps` and `round` exclude each other; remove one of them".to_owned()));
    }
    let (file, span) = match keys.file {
        Some(file) => {
            if let Some((end, _)) = keys.ends.iter().find(|(_, place)| place.is_some()) {
                return Err(refused(format!("`{end}` and `file` exclude each other; remove one of them")));
            }
            let file = ConeFile { file: file.clone(), kind, radii: keys.radii };
            (Some(file), places.span(&format!("{list}.file")))
        }
        None => (None, at_table),
    };
    let (caps, is_round) = (keys.caps.unwrap_or_default(), keys.is_round);
    let is_open = file.is_some();
    let table = ConesTable { span, name, file, is_open, color: keys.color, surface, caps, is_round };
    let mut own = OwnCones::new(Vec::new(), vec![keys.color], surface);
    if !table.is_open {
        let missing = |key: &str| at_table.error(format!("missing key `{key}`; add it"));
        let [start, end] = keys.ends.map(|(key, place)| place.ok_or_else(|| missing(key)));
        let radii = keys.radii.ok_or_else(|| missing(kind.radii()));
        let cone = Cone::new(start?, end?, radii?);
        let refused = |error: &dyn fmt::Display| at_table.error(format!("{}: {error}", table.name));
        cone.check().map_err(|error| refused(&error))?;
        own = table.shapes(vec![cone], None).map_err(|(_, error)| refused(&error))?;
    }
    Ok((table, own))
}

impl ConesTable {
    /// The table of shapes that are known.
    pub(super) const fn of_one(span: Span, name: String, color: LinearRgb, surface: SurfaceProperties) -> Self {
        Self { span, name, file: None, is_open: false, color, surface, caps: Caps::None, is_round: false }
    }

    /// The shapes of a file that was read.
    pub(super) fn fill(&mut self, set: ConeSet) -> Result<OwnCones, SceneFileError> {
        let file = self.file.as_ref().map_or("", |of| of.file.as_str());
        let refused = |(row, error)| self.span.error(format!("{file}: row {row}: {error}"));
        let own = self.shapes(set.cones, set.colors).map_err(refused)?;
        self.is_open = false;
        Ok(own)
    }

    /// Shapes that were checked, with the ends and the look that the table says.
    fn shapes(&self, mut cones: Vec<Cone>, colors: Option<Vec<LinearRgb>>) -> Result<OwnCones, (usize, SphereError)> {
        cones.iter_mut().for_each(|cone| cone.caps = self.caps);
        let own = OwnCones::new(cones, colors.unwrap_or_else(|| vec![self.color]), self.surface);
        if self.is_round { own.rounded() } else { Ok(own) }
    }
}
