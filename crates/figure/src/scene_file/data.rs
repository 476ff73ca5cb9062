//! Reads the keys that name a data file, tell how to read it, select its spheres, set their appearance, and add bonds and
//! the edges of the cell to them.

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde::{Deserialize, de};
use toml::Spanned;

use super::span::{Keys, Lines, Number, SceneFileError, Span};
use crate::color_by::Mapping;
use pinhole::image::color::LinearRgb;
use pinhole::scene::material::SurfaceProperties;
use pinhole::scene::sphere::Sphere;
use pinhole::scene::sphere_array::SphereArray;
use pinhole_data::added::{AddError, AddedSpheres, Additions, Base, BondLength, Bonds, CellEdges};
use pinhole_data::load::{Dataset, Labels};
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
    /// Radius of all spheres, for data without radii.
    pub radius: Option<f64>,
    /// Factor for every radius.
    pub radius_scale: f64,
    /// Colour of all spheres, for data without colours.
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
    /// Which spheres are kept; all if there is no such expression.
    pub select: Option<Selection>,
    /// The edges of the cell, and bonds.
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ElementTable {
    pub(super) material: Option<Spanned<String>>,
    pub(super) opacity: Option<Number>,
    pub(super) color: Option<LinearRgb>,
    pub(super) radius: Option<Number>,
}

impl Data {
    /// Whether no key gives spheres a look or a radius of their own, but for columns.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.elements.is_empty()
            && self.elements_by.is_empty()
            && self.leave_out.is_empty()
            && self.surface == SurfaceProperties::default()
            && self.radius_scale.to_bits() == 1.0_f64.to_bits()
    }

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
            select: None,
            additions: Additions::default(),
        }
    }
}

/// Checks that a number, if it is given, is finite and greater than 0.
pub(super) fn positive(
    key: &'static str,
    value: Option<Number>,
    lines: &Lines<'_>,
) -> Result<Option<f64>, SceneFileError> {
    let keys = Keys { lines, numbers: vec![(key, value)], table: Span::START };
    keys.within(key, [f64::from_bits(1), f64::MAX], "finite and greater than 0")
}

pub(super) enum BoxValue {
    Is(bool),
    Table(BoxTable),
}

pub(super) enum BondsValue {
    Is(bool),
    Factor(f64),
    Table(BondsTable),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BoxTable {
    width: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BondsTable {
    factor: Option<Number>,
    length: Option<Number>,
}

impl<'de> Deserialize<'de> for BoxValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BoxVisitor;

        impl<'de> Visitor<'de> for BoxVisitor {
            type Value = BoxValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("true, false, or a table with the key `width`")
            }

            fn visit_bool<E: de::Error>(self, is: bool) -> Result<BoxValue, E> {
                Ok(BoxValue::Is(is))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<BoxValue, A::Error> {
                BoxTable::deserialize(MapAccessDeserializer::new(map)).map(BoxValue::Table)
            }
        }

        deserializer.deserialize_any(BoxVisitor)
    }
}

impl<'de> Deserialize<'de> for BondsValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BondsVisitor;

        impl<'de> Visitor<'de> for BondsVisitor {
            type Value = BondsValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "true, false, a factor of covalent radii, or a table with the key `factor` or `length`",
                )
            }

            fn visit_bool<E: de::Error>(self, is: bool) -> Result<BondsValue, E> {
                Ok(BondsValue::Is(is))
            }

            fn visit_f64<E: de::Error>(self, factor: f64) -> Result<BondsValue, E> {
                Ok(BondsValue::Factor(factor))
            }

            fn visit_i64<E: de::Error>(self, factor: i64) -> Result<BondsValue, E> {
                self.visit_f64(factor as f64)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<BondsValue, A::Error> {
                BondsTable::deserialize(MapAccessDeserializer::new(map)).map(BondsValue::Table)
            }
        }

        deserializer.deserialize_any(BondsVisitor)
    }
}

pub(super) fn read_additions(
    select: Option<Spanned<String>>,
    cell: Option<Spanned<BoxValue>>,
    bonds: Option<Spanned<BondsValue>>,
    lines: &Lines<'_>,
) -> Result<(Option<Selection>, Additions), SceneFileError> {
    let select = select.map(|text| {
        let parsed = text.get_ref().parse::<Selection>();
        parsed.map_err(|error| lines.span(text.span().start).error(error))
    });
    let cell = cell.map(|value| match value.into_inner() {
        BoxValue::Is(is) => Ok(is.then(CellEdges::default)),
        BoxValue::Table(BoxTable { width }) => {
            let width = positive("width", width, lines)?;
            Ok(Some(width.map_or_else(CellEdges::default, CellEdges::of_width)))
        }
    });
    let bonds = bonds.map(|value| {
            let span = lines.span(value.span().start);
            let length = match value.into_inner() {
                BondsValue::Is(is) => return Ok(is.then(Bonds::default)),
                BondsValue::Factor(factor) if factor.is_finite() && factor > 0.0 => {
                    BondLength::Covalent(factor)
                }
                BondsValue::Factor(factor) => {
                    let message = format!("`bonds` is {factor}; it must be finite and greater than 0");
                    return Err(span.error(message));
                }
                BondsValue::Table(BondsTable { factor, length }) => {
                    match (positive("factor", factor, lines)?, positive("length", length, lines)?) {
                        (Some(_), Some(_)) => {
                            return Err(span.error(
                                "`bonds` has both `factor` and `length`, which exclude each other; remove one",
                            ));
                        }
                        (_, Some(length)) => BondLength::Below(length),
                        (factor, None) => BondLength::Covalent(factor.unwrap_or(Bonds::FACTOR)),
                    }
                }
            };
            Ok(Some(Bonds::new(length)))
        });
    let additions = Additions {
        cell: cell.transpose()?.flatten(),
        bonds: bonds.transpose()?.flatten(),
        keeps_radii: false,
    };
    Ok((select.transpose()?, additions))
}

/// Adds spheres to those of data. `kept` has the index in `loaded` of each sphere.
pub(super) fn add_spheres(
    additions: &Additions,
    spheres: &mut Vec<Sphere>,
    loaded: &Dataset,
    kept: &[usize],
) -> Result<AddedSpheres, AddError> {
    if additions.is_empty() {
        return Ok(AddedSpheres::default());
    }
    let place = |sphere: &Sphere| {
        let [x, y, z] = sphere.center;
        [x, y, z, sphere.radius]
    };
    let array = SphereArray::F64(spheres.iter().map(place).collect());
    let species = loaded.labels("species").map(|labels| Labels {
        names: labels.names.clone(),
        indices: kept.iter().filter_map(|index| labels.indices.get(*index).copied()).collect(),
    });
    let base = Base { spheres: &array, species: species.as_ref(), ..Base::of(loaded) };
    let added = additions.add(&base)?;
    added.extend_spheres(spheres);
    Ok(added)
}
