//! The tables `[materials.NAME]`, and the keys that refer to them.

use std::collections::BTreeMap;

use super::span::{KeyError, SceneFileError, unknown};
use crate::settings::places::Places;
use pinhole::internals::exact::Table;
use pinhole::internals::text::{one_line, shortened};
use pinhole::scene::material::SurfaceProperties;

/// The surface properties of the materials of a file, by their names.
pub(super) type Materials = BTreeMap<String, Table<SurfaceProperties>>;

/// Checks all materials.
pub(super) fn check(materials: &Materials, places: &Places<'_>) -> Result<(), SceneFileError> {
    materials.iter().try_for_each(|(name, Table(surface))| {
        let refused = |error| places.refused(&format!("materials.{name}"), error);
        surface.check().map_err(refused)
    })
}

/// Applies the keys `material` and `opacity`, where they are given, to the surface properties `base`.
pub(super) fn over(
    materials: &Materials,
    base: SurfaceProperties,
    material: Option<&str>,
    opacity: Option<f64>,
) -> Result<SurfaceProperties, KeyError> {
    let mut surface = base;
    if let Some(name) = material {
        let Table(known) = materials.get(name).ok_or_else(|| {
            let names: Vec<&str> = materials.keys().map(String::as_str).collect();
            match names.is_empty() {
                true => format!(
                    "`material` names `{}`, but there is no such material; add a table `[materials.{0}]`",
                    shortened(name)
                ),
                false => format!("`material`: {}", one_line(&unknown("material", name, &names))),
            }
        })?;
        surface = *known;
    }
    if let Some(opacity) = opacity {
        surface.opacity = opacity as f32;
        surface.check()?;
    }
    Ok(surface)
}
