//! The keys that name a file with spheres, and say how to read it and what its spheres look like.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::materials::Materials;
use super::span::{Keys, Lines, Number, SceneFileError, WithSpan, range_of};
use super::value::ColorValue;
use crate::exact::Table;
use crate::image::color::LinearRgb;
use crate::scene::material::SurfaceProperties;

/// A reference to a file with spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// The path, relative to the scene file.
    pub file: String,
    /// Which frame of a trajectory, from 0.
    pub frame: Option<usize>,
    /// The radius of all, for data that has none.
    pub radius: Option<f64>,
    /// What every radius is multiplied by.
    pub radius_scale: f64,
    /// The colour of all, for data that has none.
    pub color: Option<LinearRgb>,
    /// What all surfaces do with light.
    pub surface: SurfaceProperties,
    /// What atoms of one species, or with one value of another column, look like.
    pub elements: Vec<Element>,
    /// The columns whose values name `elements`. A sphere looks as the first of them says for which there is an element;
    /// empty for `species`.
    pub elements_by: Vec<String>,
    /// Columns, and of each the values of spheres that are left out.
    pub leave_out: Vec<(String, Vec<String>)>,
}

/// What atoms of one species look like, whatever the data or the tables of elements say.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// The species, or the value of another column, as it is written in the data.
    pub name: String,
    /// The radius, before `radius_scale`.
    pub radius: Option<f64>,
    /// The colour.
    pub color: Option<LinearRgb>,
    /// What the surface does with light.
    pub surface: SurfaceProperties,
}

/// A table `[elements.NAME]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ElementTable {
    material: Option<Spanned<String>>,
    opacity: Option<Number>,
    color: Option<ColorValue>,
    radius: Option<Number>,
}

/// The keys, as they stand at the top of the file.
pub(super) struct DataKeys {
    pub(super) file: Option<Spanned<String>>,
    pub(super) frame: Option<Spanned<usize>>,
    pub(super) radius: Option<Number>,
    pub(super) radius_scale: Option<Number>,
    pub(super) color: Option<Spanned<ColorValue>>,
    pub(super) material: Option<Spanned<String>>,
    pub(super) opacity: Option<Number>,
    pub(super) elements: BTreeMap<String, Spanned<Table<ElementTable>>>,
    pub(super) elements_by: Option<Spanned<Vec<String>>>,
    pub(super) leave_out: Option<Spanned<BTreeMap<String, Vec<String>>>>,
}

impl DataKeys {
    pub(super) fn read(
        self,
        materials: &Materials,
        lines: &Lines<'_>,
    ) -> Result<Option<WithSpan<Data>>, SceneFileError> {
        let Some(file) = self.file else {
            let orphans = [
                ("frame", range_of(&self.frame)),
                ("radius", range_of(&self.radius)),
                ("radius_scale", range_of(&self.radius_scale)),
                ("color", range_of(&self.color)),
                ("material", range_of(&self.material)),
                ("opacity", range_of(&self.opacity)),
                ("elements", self.elements.values().next().map(Spanned::span)),
                ("elements_by", range_of(&self.elements_by)),
                ("leave_out", range_of(&self.leave_out)),
            ];
            let orphan = orphans.into_iter().find_map(|(key, span)| Some((key, span?.start)));
            return match orphan {
                Some((key, start)) => Err(lines
                    .span(start)
                    .error(format!("`{key}` concerns `data`, which is not given"))),
                None => Ok(None),
            };
        };
        let surface =
            materials.over(SurfaceProperties::default(), self.material, self.opacity, lines)?;
        let elements = self.elements.into_iter().map(|(name, table)| {
            let ElementTable { material, opacity, color, radius } = table.into_inner().0;
            Ok(Element {
                name,
                radius: positive("radius", radius, lines)?,
                color: color.map(|color| color.0),
                surface: materials.over(surface, material, opacity, lines)?,
            })
        });
        Ok(Some(WithSpan {
            span: lines.span(file.span().start),
            value: Data {
                file: file.into_inner(),
                frame: self.frame.map(Spanned::into_inner),
                radius: positive("radius", self.radius, lines)?,
                radius_scale: positive("radius_scale", self.radius_scale, lines)?.unwrap_or(1.0),
                color: self.color.map(|color| color.into_inner().0),
                surface,
                elements: elements.collect::<Result<_, _>>()?,
                elements_by: self.elements_by.map(Spanned::into_inner).unwrap_or_default(),
                leave_out: self.leave_out.into_iter().flat_map(Spanned::into_inner).collect(),
            },
        }))
    }
}

fn positive(
    key: &'static str,
    value: Option<Number>,
    lines: &Lines<'_>,
) -> Result<Option<f64>, SceneFileError> {
    let keys = Keys { lines, numbers: vec![(key, value)], table: super::span::Span::START };
    keys.within(key, [f64::from_bits(1), f64::MAX], "finite and greater than 0")
}
