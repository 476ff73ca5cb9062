//! Reads the keys that name a data file, tell how to read it, select its spheres, set their appearance, and add bonds and
//! the edges of the cell to them.

use serde::{Deserialize, Serialize};

use super::show::Show;
use super::span::{KeyError, positive};
use crate::color_by::Mapping;
use pinhole::image::color::LinearRgb;
use pinhole::scene::material::SurfaceProperties;
use pinhole_data::added::{Additions, Arrows, BondLength, Bonds, CellEdges};
use pinhole_data::replicate::Replicate;
use pinhole_data::select::Selection;

/// A reference to a data file, and the keys of the scene file that concern its spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// Path of the data file, relative to the scene file.
    pub file: String,
    /// Name of the data's format, if the file's extension does not show it.
    pub format: Option<String>,
    /// Frame of a trajectory, counted from 0.
    pub frame: Option<usize>,
    /// Path of the file that says what the spheres of a trajectory are, relative to the scene file.
    pub topology: Option<String>,
    /// Names of the columns of a table without a header.
    pub columns: Vec<String>,
    /// Radius of all spheres, for atoms and data without radii.
    pub radius: Option<f64>,
    /// Factor for every radius.
    pub radius_scale: f64,
    /// Colour of all spheres, in the place of those of the data.
    pub color: Option<LinearRgb>,
    /// Surface properties of all spheres, unless `elements` says otherwise.
    pub surface: SurfaceProperties,
    /// Appearance of atoms of one species, or with one value of another column.
    pub elements: Vec<Element>,
    /// Columns whose values are looked up in `elements`. The first column with a match decides; if the list is empty,
    /// the column is `species`.
    pub elements_by: Vec<String>,
    /// Spheres to leave out, as pairs of a column and values of that column.
    pub leave_out: Vec<(String, Vec<String>)>,
    /// How many cells there are of periodic data.
    pub replicate: Option<Replicate>,
    /// Which spheres are kept; all if there is no such expression.
    pub select: Option<Selection>,
    /// Rules for what is drawn, and as what. Without any, all spheres are drawn as spheres, or as balls where there are
    /// bonds.
    pub shows: Vec<Show>,
    /// The spheres that a camera frames; all if there is no such expression.
    pub focus: Option<Selection>,
    /// The edges of the cell, bonds, and arrows.
    pub additions: Additions,
    /// What columns decide: colours, radii, opacities, strengths of light.
    pub mapping: Mapping,
}

/// Appearance of the atoms of one species. It replaces what the data or the table of chemical elements gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// The species, or the value of another column, spelled as in the data.
    pub name: String,
    /// Radius before it is multiplied by `radius_scale`.
    pub radius: Option<f64>,
    /// Colour of the atoms.
    pub color: Option<LinearRgb>,
    /// Surface properties of the atoms.
    pub surface: SurfaceProperties,
}

/// The table `[elements.NAME]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ElementTable {
    /// Radius before it is multiplied by `radius_scale`: greater than 0.
    pub(super) radius: Option<f64>,
    /// Colour of the atoms.
    pub(super) color: Option<LinearRgb>,
    /// The name of a material.
    pub(super) material: Option<String>,
    /// Opacity, from 0 (clear) to 1 (opaque).
    pub(super) opacity: Option<f64>,
}

impl Data {
    /// A reference to a data file, without any other key.
    #[must_use]
    pub fn of_file(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            format: None,
            frame: None,
            topology: None,
            columns: Vec::new(),
            mapping: Mapping::default(),
            radius: None,
            radius_scale: 1.0,
            color: None,
            surface: SurfaceProperties::default(),
            elements: Vec::new(),
            elements_by: Vec::new(),
            leave_out: Vec::new(),
            replicate: None,
            select: None,
            shows: Vec::new(),
            focus: None,
            additions: Additions::default(),
        }
    }
}

/// The key `box`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(untagged, expecting = "expected true, false, or a table with the key `width`")]
pub(super) enum BoxValue {
    Is(bool),
    Table(BoxTable),
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BoxTable {
    /// Width of the edges in scene units, greater than 0; by default 1/300 of the cell's diagonal.
    width: Option<f64>,
}

/// The key `bonds`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(
    untagged,
    expecting = "expected true, false, a factor of covalent radii, or a table with the key `factor` or `length`"
)]
pub(super) enum BondsValue {
    Is(bool),
    Factor(f64),
    Table(BondsTable),
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BondsTable {
    /// Factor of the sum of covalent radii below which two atoms are bonded, greater than 0.
    factor: Option<f64>,
    /// Distance in scene units below which any two spheres are bonded, greater than 0.
    length: Option<f64>,
}

/// The key `arrows`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(
    untagged,
    expecting = "expected the name of a vector, or a table with `vector` and any of `scale`, `radius`, `color`, `min` and \
                 `at`, which is start or middle"
)]
pub(super) enum ArrowsValue {
    Vector(String),
    Table(ArrowsTable),
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ArrowsTable {
    /// Name of the vector: `v` for the columns `v.x`, `v.y` and `v.z`, or `vx`, `vy` and `vz`.
    vector: String,
    /// Length of an arrow in scene units for a vector of length 1, greater than 0; by default 95 of 100 arrows are at
    /// most 1.5 times as long as the median distance to the nearest sphere.
    scale: Option<f64>,
    /// Radius of a shaft in scene units, greater than 0; by default 0.08 of that distance.
    radius: Option<f64>,
    /// The colour; a green by default.
    color: Option<LinearRgb>,
    /// Length of the shortest vector that has an arrow, greater than 0.
    min: Option<f64>,
    /// The part of an arrow at the centre of its sphere: `start`, which is the default, or `middle`.
    #[serde(default)]
    at: ArrowPlace,
}

/// The part of an arrow that is at the centre of its sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
enum ArrowPlace {
    #[default]
    Start,
    Middle,
}

impl ArrowsValue {
    pub(super) fn vector(&self) -> &str {
        match self {
            Self::Vector(vector) | Self::Table(ArrowsTable { vector, .. }) => vector,
        }
    }

    pub(super) fn arrows(&self) -> Result<Arrows, KeyError> {
        let mut arrows = Arrows::new(self.vector());
        let Self::Table(table) = self else { return Ok(arrows) };
        arrows.scale = positive("scale", table.scale)?;
        arrows.radius = positive("radius", table.radius)?;
        arrows.color = table.color.unwrap_or(arrows.color);
        arrows.min = positive("min", table.min)?.unwrap_or(arrows.min);
        arrows.is_centered = table.at == ArrowPlace::Middle;
        Ok(arrows)
    }
}

impl BoxValue {
    pub(super) fn edges(&self) -> Result<Option<CellEdges>, KeyError> {
        let width = match self {
            Self::Is(false) => return Ok(None),
            Self::Is(true) => None,
            Self::Table(table) => positive("width", table.width)?,
        };
        Ok(Some(width.map_or_else(CellEdges::default, CellEdges::of_width)))
    }
}

impl BondsValue {
    pub(super) fn bonds(&self) -> Result<Option<Bonds>, KeyError> {
        let length = match self {
            Self::Is(is) => return Ok(is.then(Bonds::default)),
            Self::Factor(factor) => {
                positive("bonds", Some(*factor))?;
                BondLength::Covalent(*factor)
            }
            Self::Table(BondsTable { factor, length }) => {
                match (positive("factor", *factor)?, positive("length", *length)?) {
                    (Some(_), Some(_)) => {
                        return Err(
                            "`bonds` has both `factor` and `length`, which exclude each other; remove one".into()
                        );
                    }
                    (_, Some(length)) => BondLength::Below(length),
                    (factor, None) => BondLength::Covalent(factor.unwrap_or(Bonds::FACTOR)),
                }
            }
        };
        Ok(Some(Bonds::new(length)))
    }
}
