//! Reads the tables `[materials.NAME]`, and the keys that refer to them.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::span::{
    Keys, Lines, Number, SceneFileError, name_of, range_of, refuse_foreign, unknown,
};
use pinhole::internals::exact::Table;
use pinhole::internals::text::{one_line, shortened};
use pinhole::scene::material::{Material, SurfaceProperties};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    Lambert,
    Conductor,
    Dielectric,
    Emissive,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    kind: Kind,
    specular: Option<Number>,
    roughness: Option<Number>,
    ior: Option<Number>,
    attenuation_distance: Option<Number>,
    strength: Option<Number>,
    opacity: Option<Number>,
}

impl MaterialTable {
    fn surface(
        &self,
        lines: &Lines<'_>,
        start: usize,
    ) -> Result<SurfaceProperties, SceneFileError> {
        let kind = self.kind;
        let is_one = |kinds: &[Kind]| kinds.contains(&kind);
        refuse_foreign(
            lines,
            &name_of(&kind),
            &[
                ("specular", range_of(&self.specular), is_one(&[Kind::Lambert])),
                ("roughness", range_of(&self.roughness), !is_one(&[Kind::Emissive])),
                ("ior", range_of(&self.ior), is_one(&[Kind::Dielectric])),
                (
                    "attenuation_distance",
                    range_of(&self.attenuation_distance),
                    is_one(&[Kind::Dielectric]),
                ),
                ("strength", range_of(&self.strength), is_one(&[Kind::Emissive])),
            ],
        )?;
        let or = |number: &Option<Number>, default: f32| {
            number.as_ref().map_or(default, |number| *number.get_ref() as f32)
        };
        let material = match kind {
            Kind::Lambert => Material::Lambert {
                specular: or(&self.specular, 0.0),
                roughness: or(&self.roughness, 0.3),
            },
            Kind::Conductor => Material::Conductor { roughness: or(&self.roughness, 0.2) },
            Kind::Dielectric => Material::Dielectric {
                ior: or(&self.ior, 1.5),
                roughness: or(&self.roughness, 0.0),
                attenuation_distance: self
                    .attenuation_distance
                    .as_ref()
                    .map(|distance| *distance.get_ref() as f32),
            },
            Kind::Emissive => Material::Emissive { strength: or(&self.strength, 1.0) },
        };
        let surface = SurfaceProperties { material, opacity: or(&self.opacity, 1.0) };
        let numbers = vec![
            ("specular", self.specular.clone()),
            ("roughness", self.roughness.clone()),
            ("ior", self.ior.clone()),
            ("attenuation_distance", self.attenuation_distance.clone()),
            ("strength", self.strength.clone()),
            ("opacity", self.opacity.clone()),
        ];
        let keys = Keys { lines, numbers, table: lines.span(start) };
        surface.check().map(|()| surface).map_err(|error| keys.refused(&error))
    }
}

/// The surface properties of the materials of a file, by their names.
pub(super) struct Materials(BTreeMap<String, SurfaceProperties>);

impl Materials {
    pub(super) fn new(
        tables: BTreeMap<String, Spanned<Table<MaterialTable>>>,
        lines: &Lines<'_>,
    ) -> Result<Self, SceneFileError> {
        let surfaces = tables.into_iter().map(|(name, table)| {
            let start = table.span().start;
            Ok((name, table.into_inner().0.surface(lines, start)?))
        });
        Ok(Self(surfaces.collect::<Result<_, _>>()?))
    }

    /// Applies the keys `material` and `opacity`, where they are given, to the surface properties `base`.
    pub(super) fn over(
        &self,
        base: SurfaceProperties,
        material: Option<Spanned<String>>,
        opacity: Option<Number>,
        lines: &Lines<'_>,
    ) -> Result<SurfaceProperties, SceneFileError> {
        let mut surface = base;
        if let Some(name) = material {
            let known = self.0.get(name.get_ref());
            surface = *known.ok_or_else(|| {
                let names: Vec<&str> = self.0.keys().map(String::as_str).collect();
                let message = if names.is_empty() {
                    format!(
                        "there is no material `{}`; add a table `[materials.{0}]`",
                        shortened(name.get_ref())
                    )
                } else {
                    one_line(&unknown("material", name.get_ref(), &names))
                };
                lines.span(name.span().start).error(message)
            })?;
        }
        if let Some(opacity) = opacity {
            surface.opacity = *opacity.get_ref() as f32;
            let span = lines.span(opacity.span().start);
            let keys = Keys { lines, numbers: vec![("opacity", Some(opacity))], table: span };
            surface.check().map_err(|error| keys.refused(&error))?;
        }
        Ok(surface)
    }
}
