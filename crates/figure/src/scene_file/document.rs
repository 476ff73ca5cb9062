//! The tables of a scene file, as serde reads them.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::annotations::{LabelTable, LegendTable, ScaleBarTable, TextTable};
use super::camera_path::CameraPathTable;
use super::data::{BondsValue, BoxValue, Data, Element, ElementTable, positive, read_additions};
use super::lighting::{GroundTable, IntegratorKind, LightTable, SkyTable, SunTable};
use super::mapping::{ByColumn, ColorTable, ColumnTable, read_mapping};
use super::materials::{MaterialTable, Materials};
use super::span::{
    Lines, Number, SceneFileError, Span, WithSpan, default_color, range_of, unknown,
};
use pinhole::camera::CameraParameters;
use pinhole::camera::film::{Film, YAxis};
use pinhole::image::color::LinearRgb;
use pinhole::image::encoding::{Bits, Encoding, EncodingError};
use pinhole::image::tone::ToneCurve;
use pinhole::internals::exact::{self, Table};
use pinhole::render::{PathTracing, Sampling, Shading, Studio};
use pinhole::scene::material::SurfaceProperties;
use pinhole::scene::sphere::Sphere;
use pinhole_data::load::FORMATS;

/// All keys and tables at the top level of a scene file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    /// Read beforehand, as `integrator`.
    #[serde(rename = "style")]
    _style: Option<String>,
    #[serde(default = "default_film")]
    pub(super) film: Spanned<Table<FilmTable>>,
    #[serde(default = "default_camera")]
    pub(super) camera: Spanned<CameraParameters>,
    pub(super) camera_path: Option<Table<CameraPathTable>>,
    #[serde(default)]
    pub(super) output: Table<OutputTable>,
    pub(super) background: Option<LinearRgb>,
    #[serde(default)]
    pub(super) shading: Shading,
    #[serde(rename = "integrator")]
    _integrator: Option<IntegratorKind>,
    #[serde(default)]
    pub(super) studio: Table<Studio>,
    #[serde(default)]
    pub(super) path: Table<PathTracing>,
    #[serde(default)]
    pub(super) sampling: Table<Sampling>,
    pub(super) lights: Option<Vec<Spanned<Table<LightTable>>>>,
    pub(super) sky: Option<Spanned<Table<SkyTable>>>,
    pub(super) sun: Option<Spanned<Table<SunTable>>>,
    pub(super) ground: Option<Spanned<Table<GroundTable>>>,
    #[serde(default)]
    pub(super) materials: BTreeMap<String, Spanned<Table<MaterialTable>>>,
    #[serde(default)]
    pub(super) spheres: Vec<Spanned<Table<SphereTable>>>,
    pub(super) data: Option<Spanned<String>>,
    pub(super) format: Option<Spanned<String>>,
    pub(super) frame: Option<Spanned<usize>>,
    pub(super) topology: Option<Spanned<String>>,
    pub(super) columns: Option<Spanned<Vec<String>>>,
    pub(super) radius: Option<Number>,
    pub(super) radius_scale: Option<Number>,
    pub(super) color: Option<Spanned<LinearRgb>>,
    pub(super) material: Option<Spanned<String>>,
    pub(super) opacity: Option<Number>,
    #[serde(default)]
    pub(super) elements: BTreeMap<String, Spanned<Table<ElementTable>>>,
    pub(super) elements_by: Option<Spanned<Vec<String>>>,
    pub(super) leave_out: Option<Spanned<BTreeMap<String, Vec<String>>>>,
    pub(super) select: Option<Spanned<String>>,
    #[serde(rename = "box")]
    pub(super) cell: Option<Spanned<BoxValue>>,
    pub(super) bonds: Option<Spanned<BondsValue>>,
    pub(super) color_by: Option<Spanned<ByColumn<ColorTable>>>,
    pub(super) radius_by: Option<Spanned<ByColumn<ColumnTable>>>,
    pub(super) opacity_by: Option<Spanned<ByColumn<ColumnTable>>>,
    pub(super) emission_by: Option<Spanned<ByColumn<ColumnTable>>>,
    pub(super) legend: Option<Table<LegendTable>>,
    pub(super) scale_bar: Option<Table<ScaleBarTable>>,
    #[serde(default)]
    pub(super) labels: Vec<Table<LabelTable>>,
    pub(super) text: Option<Table<TextTable>>,
}

impl Document {
    /// Takes the keys that concern data; `None` if there are none.
    pub(super) fn read_data(
        &mut self,
        materials: &Materials,
        lines: &Lines<'_>,
    ) -> Result<Option<WithSpan<Data>>, SceneFileError> {
        let Some(file) = self.data.take() else {
            let orphans = [
                ("format", range_of(&self.format)),
                ("frame", range_of(&self.frame)),
                ("topology", range_of(&self.topology)),
                ("columns", range_of(&self.columns)),
                ("radius", range_of(&self.radius)),
                ("radius_scale", range_of(&self.radius_scale)),
                ("color", range_of(&self.color)),
                ("material", range_of(&self.material)),
                ("opacity", range_of(&self.opacity)),
                ("elements", self.elements.values().next().map(Spanned::span)),
                ("elements_by", range_of(&self.elements_by)),
                ("leave_out", range_of(&self.leave_out)),
                ("color_by", range_of(&self.color_by)),
                ("radius_by", range_of(&self.radius_by)),
                ("opacity_by", range_of(&self.opacity_by)),
                ("emission_by", range_of(&self.emission_by)),
                ("select", range_of(&self.select)),
                ("box", range_of(&self.cell)),
                ("bonds", range_of(&self.bonds)),
            ];
            let orphan = orphans.into_iter().find_map(|(key, span)| Some((key, span?.start)));
            return match orphan {
                Some((key, start)) => {
                    let span = lines.span(start);
                    Err(span.error(match span.flag {
                        Some(flag) => format!(
                            "{flag} applies to the `data` of a scene, but this scene has no `data`; remove {flag}"
                        ),
                        None => format!(
                            "`{key}` applies to `data`, which is missing; add `data` or remove `{key}`"
                        ),
                    }))
                }
                None => Ok(None),
            };
        };
        let surface = materials.over(
            SurfaceProperties::default(),
            self.material.take(),
            self.opacity.take(),
            lines,
        )?;
        let elements = std::mem::take(&mut self.elements).into_iter().map(|(name, table)| {
            let ElementTable { material, opacity, color, radius } = table.into_inner().0;
            Ok(Element {
                name,
                radius: positive("radius", radius, lines)?,
                color,
                surface: materials.over(surface, material, opacity, lines)?,
            })
        });
        let (select, additions) =
            read_additions(self.select.take(), self.cell.take(), self.bonds.take(), lines)?;
        Ok(Some(WithSpan {
            span: lines.span(file.span().start),
            value: Data {
                file: file.into_inner(),
                format: self.format.take().map(|name| format_name(&name, lines)).transpose()?,
                frame: self.frame.take().map(Spanned::into_inner),
                topology: self.topology.take().map(Spanned::into_inner),
                columns: self.columns.take().map(Spanned::into_inner).unwrap_or_default(),
                radius: positive("radius", self.radius.take(), lines)?,
                radius_scale: positive("radius_scale", self.radius_scale.take(), lines)?
                    .unwrap_or(1.0),
                color: self.color.take().map(Spanned::into_inner),
                surface,
                elements: elements.collect::<Result<_, _>>()?,
                elements_by: self.elements_by.take().map(Spanned::into_inner).unwrap_or_default(),
                leave_out: self
                    .leave_out
                    .take()
                    .into_iter()
                    .flat_map(Spanned::into_inner)
                    .collect(),
                select,
                additions,
                mapping: read_mapping(
                    self.color_by.take(),
                    [self.radius_by.take(), self.opacity_by.take(), self.emission_by.take()],
                    lines,
                )?,
            },
        }))
    }
}

fn format_name(name: &Spanned<String>, lines: &Lines<'_>) -> Result<String, SceneFileError> {
    let known: Vec<&str> = FORMATS.iter().map(|format| format.name).collect();
    match known.contains(&name.get_ref().as_str()) {
        true => Ok(name.get_ref().clone()),
        false => {
            let span = lines.span(name.span().start);
            Err(span.error(unknown("format", name.get_ref(), &known)))
        }
    }
}

fn default_film() -> Spanned<Table<FilmTable>> {
    Spanned::new(0..0, Table::default())
}

fn default_camera() -> Spanned<CameraParameters> {
    Spanned::new(0..0, CameraParameters::default())
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct FilmTable {
    width: u32,
    height: u32,
    y: YAxis,
}

impl Default for FilmTable {
    fn default() -> Self {
        let film = Film::default();
        Self { width: film.width(), height: film.height(), y: film.y_axis() }
    }
}

impl FilmTable {
    pub(super) fn film(table: Spanned<Table<Self>>, span: Span) -> Result<Film, SceneFileError> {
        let Self { width, height, y } = table.into_inner().0;
        let film = Film::new(width, height).map_err(|error| span.error(error))?;
        Ok(film.with_y_axis(y))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereTable {
    #[serde(deserialize_with = "exact::array")]
    center: [f64; 3],
    radius: f64,
    #[serde(default = "default_color")]
    color: LinearRgb,
    material: Option<Spanned<String>>,
    opacity: Option<Number>,
}

impl SphereTable {
    pub(super) fn sphere(
        table: Spanned<Table<Self>>,
        materials: &Materials,
        lines: &Lines<'_>,
    ) -> Result<WithSpan<Sphere>, SceneFileError> {
        let span = lines.span(table.span().start);
        let Self { center, radius, color, material, opacity } = table.into_inner().0;
        let mut sphere = Sphere::new(center, radius, color);
        sphere.surface = materials.over(SurfaceProperties::default(), material, opacity, lines)?;
        Ok(WithSpan { value: sphere, span })
    }
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct OutputTable {
    exposure: Option<Spanned<f32>>,
    tone: ToneCurve,
    transparent: bool,
    bits: Option<Spanned<u32>>,
    dpi: Option<Spanned<f32>>,
}

impl OutputTable {
    pub(super) fn encoding(self, lines: &Lines<'_>) -> Result<Encoding, SceneFileError> {
        let span = |start| move |error: EncodingError| lines.span(start).error(error);
        let mut encoding = Encoding::default();
        (encoding.tone, encoding.transparent) = (self.tone, self.transparent);
        if let Some(exposure) = self.exposure {
            let start = exposure.span().start;
            encoding = encoding.with_exposure(exposure.into_inner()).map_err(span(start))?;
        }
        if let Some(bits) = self.bits {
            let start = bits.span().start;
            encoding.bits = Bits::new(bits.into_inner()).map_err(span(start))?;
        }
        if let Some(dpi) = self.dpi {
            let start = dpi.span().start;
            encoding = encoding.with_dots_per_inch(Some(dpi.into_inner())).map_err(span(start))?;
        }
        Ok(encoding)
    }
}
