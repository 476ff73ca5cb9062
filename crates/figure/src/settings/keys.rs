//! The keys of each table, as its struct has them. A table that holds a key which does not exist is read, and serde says
//! which do.

use std::fmt;

use serde::de::value::{MapAccessDeserializer, MapDeserializer, SeqDeserializer};
use serde::de::{DeserializeOwned, Deserializer, Error, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;

use crate::scene_file::{
    ArrowsTable, BondsTable, BoxTable, ConeTable, CylinderTable, DepthCuePlan, Document, ShowTable, SphereTable,
    TubeTable,
};

/// A name that no key and no kind has.
const UNKNOWN: &str = "\0";

/// The keys of a table of a scene file, such as `studio.outline` or `materials.NAME`; of the file itself for an empty
/// text. Lists of tables are named like tables: `lights`.
#[must_use]
pub fn keys_of(table: &str) -> Vec<&'static str> {
    match table {
        "box" => keys_in::<BoxTable>(""),
        "bonds" => keys_in::<BondsTable>(""),
        "arrows" => keys_in::<ArrowsTable>(""),
        "show" => keys_in::<ShowTable>(""),
        "studio.depth_cue" => keys_in::<DepthCuePlan>(""),
        "spheres" => keys_in::<SphereTable>(""),
        "cylinders" => keys_in::<CylinderTable>(""),
        "cones" => keys_in::<ConeTable>(""),
        "tubes" => keys_in::<TubeTable>(""),
        // A material is part of the surface properties, which have this key, too.
        table if table.starts_with("materials.") => [keys_in::<Document>(table), vec!["opacity"]].concat(),
        table => keys_in::<Document>(table),
    }
}

fn keys_in<T: DeserializeOwned>(table: &str) -> Vec<&'static str> {
    let read = |kind| T::deserialize(Probe::Table { path: table, kind }).err();
    match read(None) {
        Some(Known::Names(keys)) => keys.to_vec(),
        Some(Known::Nothing { missing: "kind" }) => {
            let Some(Known::Names(kinds)) = read(Some(UNKNOWN)) else { return Vec::new() };
            let mut keys = vec!["kind"];
            for kind in kinds {
                let Some(Known::Names(of_kind)) = read(Some(kind)) else { continue };
                keys.extend(of_kind.iter().filter(|key| !keys.contains(key)).collect::<Vec<_>>());
            }
            keys
        }
        _ => Vec::new(),
    }
}

/// What serde says about a key or a kind that does not exist.
#[derive(Debug)]
enum Known {
    Names(&'static [&'static str]),
    Nothing { missing: &'static str },
}

impl fmt::Display for Known {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self:?}")
    }
}

impl std::error::Error for Known {}

impl Error for Known {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self::Nothing { missing: "" }
    }

    fn missing_field(field: &'static str) -> Self {
        Self::Nothing { missing: field }
    }

    fn unknown_field(_: &str, expected: &'static [&'static str]) -> Self {
        Self::Names(expected)
    }

    fn unknown_variant(_: &str, expected: &'static [&'static str]) -> Self {
        Self::Names(expected)
    }
}

/// A scene with a single table, or a list with it, which holds a kind and an unknown key.
#[derive(Clone, Copy)]
enum Probe<'a> {
    Table { path: &'a str, kind: Option<&'a str> },
    Text(&'a str),
}

impl<'de> IntoDeserializer<'de, Known> for Probe<'_> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = Known;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Known> {
        let (path, kind) = match self {
            Probe::Text(text) => return visitor.visit_str(text),
            Probe::Table { path, kind } => (path, kind),
        };
        let (first, rest) = path.split_once('.').unwrap_or((path, ""));
        let inner = [(first, Probe::Table { path: rest, kind })];
        let kind = kind.map(|kind| ("kind", Probe::Text(kind)));
        let entries: Vec<_> = match path {
            "" => kind.into_iter().chain([(UNKNOWN, Probe::Text(""))]).collect(),
            _ => inner.into(),
        };
        visitor.visit_map(MapDeserializer::new(entries.into_iter()))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Known> {
        visitor.visit_some(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Known> {
        visitor.visit_seq(SeqDeserializer::new([self].into_iter()))
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Known> {
        visitor.visit_newtype_struct(self)
    }

    /// The kinds of a camera are tables of their own.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Known> {
        let Probe::Table { path, kind } = self else { return Err(Known::Names(variants)) };
        let (first, rest) = path.split_once('.').unwrap_or((path, ""));
        let inner = [(first, Probe::Table { path: rest, kind })];
        let map = MapAccessDeserializer::new(MapDeserializer::new(inner.into_iter()));
        map.deserialize_enum(name, variants, visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct tuple tuple_struct map
        struct identifier ignored_any
    }
}
