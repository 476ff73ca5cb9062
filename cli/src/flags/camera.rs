//! The camera as a table of a scene file, of which programs change keys.

use serde::Deserialize;

use pinhole::camera::CameraParameters;
use pinhole::glam::DVec3;

/// A camera of any kind, as the table of this kind in a scene file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CameraTable {
    pub(crate) kind: String,
    pub(crate) table: toml::Table,
}

impl CameraTable {
    pub(crate) fn new(parameters: &CameraParameters) -> Option<Self> {
        let toml::Value::Table(document) = toml::Value::try_from(parameters).ok()? else {
            return None;
        };
        let (kind, toml::Value::Table(table)) = document.into_iter().next()? else { return None };
        Some(Self { kind, table })
    }

    pub(crate) fn vector(&self, key: &str) -> Option<DVec3> {
        let numbers = self.table.get(key)?.as_array()?;
        let numbers: Vec<f64> = numbers.iter().filter_map(toml::Value::as_float).collect();
        <[f64; 3]>::try_from(numbers).ok().map(DVec3::from)
    }

    pub(crate) fn set(&mut self, key: &str, value: impl Into<toml::Value>) {
        self.table.insert(key.to_owned(), value.into());
    }

    /// The parameters of the camera, or why it has none, in words.
    pub(crate) fn parameters(self) -> Result<CameraParameters, String> {
        let document = toml::Table::from_iter([(self.kind, toml::Value::Table(self.table))]);
        CameraParameters::deserialize(toml::Value::Table(document)).map_err(|error| error.message().to_owned())
    }
}

/// Converts numbers to a TOML array.
pub(crate) fn list<const N: usize>(numbers: [f64; N]) -> toml::Value {
    numbers.to_vec().into()
}
