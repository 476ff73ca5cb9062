//! The keys `color_by`, `radius_by`, `opacity_by` and `emission_by`.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde::{Deserialize, Serialize, de};

use crate::color_by::{ColorBy, EmissionBy, RadiusBy};

/// A table that may also be written as a text, the name of its column.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub(super) struct ByColumn<T>(pub(super) T);

/// A column alone.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ColumnTable {
    /// The column; see `color_by`.
    pub(super) column: String,
}

impl<'de, T: Deserialize<'de> + OfColumn> Deserialize<'de> for ByColumn<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TextOrMap<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de> + OfColumn> Visitor<'de> for TextOrMap<T> {
            type Value = ByColumn<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a column, or a table with the key `column`")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<ByColumn<T>, E> {
                Ok(ByColumn(T::of_column(text.to_owned())))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ByColumn<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(ByColumn)
            }
        }

        deserializer.deserialize_any(TextOrMap(PhantomData))
    }
}

/// What a column decides, with everything else as it is by default.
pub(super) trait OfColumn {
    fn of_column(column: String) -> Self;
}

impl OfColumn for ColorBy {
    fn of_column(column: String) -> Self {
        Self::column(column)
    }
}

impl OfColumn for ColumnTable {
    fn of_column(column: String) -> Self {
        Self { column }
    }
}

impl OfColumn for RadiusBy {
    fn of_column(column: String) -> Self {
        Self { column, factor: 1.0 }
    }
}

impl OfColumn for EmissionBy {
    fn of_column(column: String) -> Self {
        Self { column, factor: 1.0 }
    }
}
