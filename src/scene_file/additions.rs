//! Reads the keys `select`, `box` and `bonds`, and adds bonds and the edges of the cell to the spheres of data.

use std::fmt;
use std::ops::Range;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, Deserializer, MapAccess, Visitor};
use toml::Spanned;

use super::span::{Keys, Lines, Number, SceneFileError, Span, range_of};
use crate::added::{AddError, Added, Additions, Base, BondLength, Bonds, CellEdges};
use crate::load::{Labels, Loaded};
use crate::scene::sphere::Sphere;
use crate::scene::sphere_array::SphereArray;
use crate::select::Selection;

/// The value of `box`.
pub(super) enum BoxValue {
    Is(bool),
    Table(BoxTable),
}

/// The value of `bonds`.
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

/// The keys that select spheres and add others.
#[derive(Default)]
pub(super) struct AdditionKeys {
    pub(super) select: Option<Spanned<String>>,
    pub(super) cell: Option<Spanned<BoxValue>>,
    pub(super) bonds: Option<Spanned<BondsValue>>,
}

impl AdditionKeys {
    /// The keys with their positions, if they are given.
    pub(super) fn spans(&self) -> [(&'static str, Option<Range<usize>>); 3] {
        [
            ("select", range_of(&self.select)),
            ("box", range_of(&self.cell)),
            ("bonds", range_of(&self.bonds)),
        ]
    }

    pub(super) fn read(
        self,
        lines: &Lines<'_>,
    ) -> Result<(Option<Selection>, Additions), SceneFileError> {
        let select = self.select.map(|text| {
            let parsed = text.get_ref().parse::<Selection>();
            parsed.map_err(|error| lines.span(text.span().start).error(error))
        });
        let cell = self.cell.map(|value| match value.into_inner() {
            BoxValue::Is(is) => Ok(is.then(CellEdges::default)),
            BoxValue::Table(BoxTable { width }) => {
                let width = positive("width", width, lines)?;
                Ok(Some(width.map_or_else(CellEdges::default, CellEdges::of_width)))
            }
        });
        let bonds = self.bonds.map(|value| {
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
}

/// Checks that a number, if it is given, is finite and greater than 0.
fn positive(
    key: &'static str,
    value: Option<Number>,
    lines: &Lines<'_>,
) -> Result<Option<f64>, SceneFileError> {
    let keys = Keys { lines, numbers: vec![(key, value)], table: Span::START };
    keys.within(key, [f64::from_bits(1), f64::MAX], "finite and greater than 0")
}

/// Adds spheres to those of data. `kept` has the index in `loaded` of each sphere.
pub(super) fn add(
    additions: &Additions,
    spheres: &mut Vec<Sphere>,
    loaded: &Loaded,
    kept: &[usize],
) -> Result<Added, AddError> {
    if additions.is_empty() {
        return Ok(Added::default());
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
