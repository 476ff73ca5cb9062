//! All keys and tables of a scene file, as they are read and written.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::camera_path::CameraPathTable;
use super::cones::{ConeTable, CylinderTable};
use super::data::{ArrowsValue, BondsValue, BoxValue, Data, Element, ElementTable};
use super::lighting::{DirectionalTable, GroundTable, IntegratorKind, LightTable, SkyTable};
use super::mapping::{ByColumn, ColumnTable};
use super::materials::{Materials, over};
use super::shapes::SphereTable;
use super::show::{ShowTable, shows};
use super::span::{KeyError, SceneFileError, WithSpan, positive, unknown};
use super::tubes::TubeTable;
use crate::annotate::{AnnotationPlan, Annotations, AxesPlan, Label, LegendPlan, ScaleBarPlan, TextPlan};
use crate::color_by::{ColorBy, EmissionBy, Mapping, RadiusBy};
use crate::settings::layers::Joined;
use crate::settings::places::Places;
use pinhole::camera::CameraParameters;
use pinhole::camera::film::{Film, YAxis};
use pinhole::image::color::LinearRgb;
use pinhole::image::encoding::{Bits, Encoding, EncodingError};
use pinhole::image::tone::ToneCurve;
use pinhole::internals::exact::Table;
use pinhole::range::RangeError;
use pinhole::render::{PathTracing, Sampling, Shading, Studio};
use pinhole::scene::material::SurfaceProperties;
use pinhole_data::added::Additions;
use pinhole_data::load::FORMATS;
use pinhole_data::replicate::Replicate;
use pinhole_data::select::NamedSelections;

/// All keys and tables at the top level of a scene file.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Document {
    /// The name of a style, whose keys are those that the scene does not give itself.
    pub(super) style: Option<String>,
    /// What computes the colour of a pixel: `primary`, `studio` or `path`. By default what other keys need.
    pub(super) integrator: Option<IntegratorKind>,
    /// The shading of a picture without light: `headlight` or `flat`.
    pub(super) shading: Option<Shading>,
    /// The colour where there is nothing; white by default.
    pub(super) background: Option<LinearRgb>,
    /// Path of a data file, relative to the scene file.
    pub(super) data: Option<String>,
    /// Name of the data's format, if the file's extension does not show it.
    pub(super) format: Option<String>,
    /// Frame of a trajectory, counted from 0.
    pub(super) frame: Option<usize>,
    /// Path of the file that says what the spheres of a trajectory are, relative to the scene file.
    pub(super) topology: Option<String>,
    /// Names of the columns of a table without a header.
    pub(super) columns: Option<Vec<String>>,
    /// Radius of all spheres in scene units, for atoms and data without radii: greater than 0.
    pub(super) radius: Option<f64>,
    /// Factor of every radius: greater than 0.
    pub(super) radius_scale: Option<f64>,
    /// Colour of all spheres of the data, in the place of those of the data.
    pub(super) color: Option<LinearRgb>,
    /// The name of the material of all spheres of the data.
    pub(super) material: Option<String>,
    /// Opacity of all spheres of the data, from 0 (clear) to 1 (opaque).
    pub(super) opacity: Option<f64>,
    /// Columns whose values name tables `[elements.NAME]`; `species` by default.
    pub(super) elements_by: Option<Vec<String>>,
    /// Spheres to leave out: values by the names of their columns.
    pub(super) leave_out: Option<BTreeMap<String, Vec<String>>>,
    /// How many cells of periodic data there are along each edge, such as `2x2x1`; or `faces`, which repeats spheres at a
    /// face of the cell at the opposite one; or `wrap`, which only moves all into the cell; or
    /// `whole`, which puts molecules together that faces cut.
    pub(super) replicate: Option<String>,
    /// The kind of a data file that no scene file describes, which `--kind` names. It applies to nothing else.
    pub(super) kind: Option<String>,
    /// An expression that is true for the spheres to keep.
    pub(super) select: Option<String>,
    /// Selections by names, which other selections may use.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) selections: BTreeMap<String, String>,
    /// Rules for what is drawn and as what, of which the last for a sphere counts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) show: Vec<Table<ShowTable>>,
    /// An expression that is true for the spheres that a camera frames; by default it frames all.
    pub(super) focus: Option<String>,
    /// Whether the edges of the periodic cell are drawn, and their width.
    #[serde(rename = "box")]
    pub(super) cell: Option<BoxValue>,
    /// Whether bonds are drawn, and between which spheres.
    pub(super) bonds: Option<BondsValue>,
    /// The vector of each sphere that an arrow shows, and how.
    pub(super) arrows: Option<ArrowsValue>,
    /// The column that gives colours, and how.
    pub(super) color_by: Option<ByColumn<ColorBy>>,
    /// The column that gives radii.
    pub(super) radius_by: Option<ByColumn<RadiusBy>>,
    /// The column that gives opacities.
    pub(super) opacity_by: Option<ByColumn<ColumnTable>>,
    /// The column that gives strengths of light.
    pub(super) emission_by: Option<ByColumn<EmissionBy>>,
    /// Size of the picture, and the direction of its y axis.
    pub(super) film: Table<FilmTable>,
    /// The camera.
    pub(super) camera: CameraParameters,
    /// The path along which the camera moves from picture to picture.
    pub(super) camera_path: Option<Table<CameraPathTable>>,
    /// How the picture is written.
    pub(super) output: Table<OutputTable>,
    /// A legend of the colours that a column gives.
    pub(super) legend: Option<Table<LegendPlan>>,
    /// A scale bar.
    pub(super) scale_bar: Option<Table<ScaleBarPlan>>,
    /// The directions of x, y and z, as arrows over the picture.
    pub(super) axes: Option<Table<AxesPlan>>,
    /// Texts over the picture.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) labels: Vec<Table<Label>>,
    /// The look of all text over the picture.
    pub(super) text: Option<Table<TextPlan>>,
    /// The number of samples, their positions, the random seed, and the removal of noise.
    pub(super) sampling: Option<Table<Sampling>>,
    /// Settings of the integrator `studio`.
    pub(super) studio: Option<Table<Studio>>,
    /// Settings of the integrator `path`.
    pub(super) path: Option<Table<PathTracing>>,
    /// Lights; by default a key light and a fill light at the camera, unless there is a sun or a sky.
    pub(super) lights: Option<Vec<Table<LightTable>>>,
    /// A light from a direction, as large as the sun.
    pub(super) sun: Option<Table<DirectionalTable>>,
    /// Light from all around, for the integrator `path`.
    pub(super) sky: Option<Table<SkyTable>>,
    /// A plane below the spheres.
    pub(super) ground: Option<Table<GroundTable>>,
    /// Materials by their names.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) materials: Materials,
    /// The look of atoms, or of other spheres, by what a column says of them.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) elements: BTreeMap<String, Table<ElementTable>>,
    /// Spheres, which come before those of the data.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) spheres: Vec<Spanned<Table<SphereTable>>>,
    /// Cylinders, which come after all spheres.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) cylinders: Vec<Spanned<Table<CylinderTable>>>,
    /// Cones, which come after the cylinders.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) cones: Vec<Spanned<Table<ConeTable>>>,
    /// Tubes, whose pieces come after the cones.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) tubes: Vec<Spanned<Table<TubeTable>>>,
}

/// The keys at the top of a scene file that apply to its data, beside the tables `[elements.NAME]`.
pub const KEYS_OF_DATA: [&str; 23] = [
    "format",
    "frame",
    "topology",
    "columns",
    "radius",
    "radius_scale",
    "color",
    "material",
    "opacity",
    "elements_by",
    "leave_out",
    "color_by",
    "radius_by",
    "opacity_by",
    "emission_by",
    "replicate",
    "select",
    "selections",
    "show",
    "focus",
    "box",
    "bonds",
    "arrows",
];

impl Document {
    /// The data with the keys that concern it; `None` if there is none.
    pub(super) fn data(&self, layers: &Joined<'_>) -> Result<Option<WithSpan<Data>>, SceneFileError> {
        let places = &layers.places;
        if layers.in_file.has("kind") {
            let message = "`kind` applies to data files without a scene; remove it, and write the settings that --print-scene \
                           shows for a kind";
            return Err(places.span("kind").error(message));
        }
        let Some(file) = self.data.clone() else {
            let is_given = |key: &&str| places.keys.has(key);
            let element = self.elements.keys().next().map(|name| format!("elements.{name}"));
            let orphan = KEYS_OF_DATA.into_iter().find(is_given).map(str::to_owned).or(element);
            return orphan.map_or(Ok(None), |key| {
                let span = places.span(&key);
                let name = key.split('.').next().unwrap_or_default();
                Err(span.error(match span.flag {
                    Some(flag) => {
                        format!("{flag} applies to the `data` of a scene, but this scene has no `data`; remove {flag}")
                    }
                    None => format!("`{name}` applies to `data`, which is missing; add `data` or remove `{name}`"),
                }))
            });
        };
        let value = self.read_data(file, places)?;
        Ok(Some(WithSpan { span: places.span("data"), value }))
    }

    fn read_data(&self, file: String, places: &Places<'_>) -> Result<Data, SceneFileError> {
        let top = |error: KeyError| places.refused("", error);
        let number = |error: RangeError| places.refused("", error);
        let (material, opacity) = (self.material.as_deref(), self.opacity);
        let base = SurfaceProperties::default();
        let surface = over(&self.materials, base, material, opacity).map_err(top)?;
        let elements = self.elements.iter().map(|(name, Table(table))| {
            let element = || {
                let ElementTable { material, opacity, color, radius } = table;
                let surface = over(&self.materials, surface, material.as_deref(), *opacity)?;
                let radius = positive("radius", *radius)?;
                Ok(Element { name: name.clone(), radius, color: *color, surface })
            };
            element().map_err(|error: KeyError| places.refused(&format!("elements.{name}"), error))
        });
        let selections = self.selections.iter().map(|(name, text)| (&**name, &**text));
        let names = NamedSelections::new(selections)
            .map_err(|error| places.span(&format!("selections.{}", error.name)).error(error))?;
        let selection = |key: &str, text: &Option<String>| {
            let selection = text.as_ref().map(|text| names.selection(text)).transpose();
            selection.map_err(|error| places.span(key).error(error))
        };
        let cell = self.cell.as_ref().map(BoxValue::edges).transpose();
        let bonds = self.bonds.as_ref().map(BondsValue::bonds).transpose();
        let arrows = self.arrows.as_ref().map(ArrowsValue::arrows).transpose();
        let within = |table: &'static str| {
            move |error| match error {
                // A factor alone stands at the key itself.
                KeyError::Range(error) if error.parameter == table => places.refused("", error),
                error => places.refused(table, error),
            }
        };
        let additions = Additions {
            cell: cell.map_err(within("box"))?.flatten(),
            bonds: bonds.map_err(within("bonds"))?.flatten(),
            arrows: arrows.map_err(within("arrows"))?,
            keeps_radii: false,
        };
        let format = self.format.as_ref().map(|name| {
            let known: Vec<&str> = FORMATS.iter().map(|format| format.name).collect();
            match known.contains(&name.as_str()) {
                true => Ok(name.clone()),
                false => Err(places.span("format").error(unknown("format", name, &known))),
            }
        });
        let replicate = self.replicate.as_ref().map(|text| text.parse::<Replicate>());
        let replicate = replicate.transpose().map_err(|error| places.span("replicate").error(error))?;
        Ok(Data {
            file,
            replicate,
            format: format.transpose()?,
            frame: self.frame,
            topology: self.topology.clone(),
            columns: self.columns.clone().unwrap_or_default(),
            radius: positive("radius", self.radius).map_err(number)?,
            radius_scale: positive("radius_scale", self.radius_scale).map_err(number)?.unwrap_or(1.0),
            color: self.color,
            surface,
            elements: elements.collect::<Result<_, _>>()?,
            elements_by: self.elements_by.clone().unwrap_or_default(),
            leave_out: self.leave_out.clone().into_iter().flatten().collect(),
            select: selection("select", &self.select)?,
            focus: selection("focus", &self.focus)?,
            shows: shows(&self.show, &names, &self.materials, places)?,
            additions,
            mapping: Mapping {
                color: self.color_by.as_ref().map(|by| by.0.clone()),
                radius: self.radius_by.as_ref().map(|by| by.0.clone()),
                opacity: self.opacity_by.as_ref().map(|by| by.0.column.clone()),
                emission: self.emission_by.as_ref().map(|by| by.0.clone()),
            },
        })
    }

    /// What is drawn over the picture.
    pub(super) fn annotations(&self, places: &Places<'_>) -> Result<AnnotationPlan, SceneFileError> {
        let text = self.text.map(|Table(text)| text).unwrap_or_default();
        if let Some(scale) = text.scale {
            let range = "from 0.2 to 10";
            RangeError::unless_within("scale", scale.into(), Annotations::TEXT_SCALES, range)
                .map_err(|error| places.refused("text", error))?;
        }
        Ok(AnnotationPlan {
            legend: self.legend.as_ref().map(|Table(legend)| legend.clone()),
            scale_bar: self.scale_bar.as_ref().map(|Table(bar)| bar.clone()),
            axes: self.axes.as_ref().map(|Table(axes)| axes.clone()),
            labels: self.labels.iter().map(|Table(label)| label.clone()).collect(),
            arrows: self.arrows.as_ref().map(|arrows| arrows.vector().to_owned()),
            text,
        })
    }
}

/// The table `[film]`.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct FilmTable {
    /// Width in pixels, from 1 to 8388608.
    width: u32,
    /// Height in pixels, from 1 to 8388608.
    height: u32,
    /// The direction of y: `up` or `down`.
    y: YAxis,
}

impl Default for FilmTable {
    fn default() -> Self {
        Self::of(&Film::default())
    }
}

impl FilmTable {
    pub(super) fn of(film: &Film) -> Self {
        Self { width: film.width(), height: film.height(), y: film.y_axis() }
    }

    pub(super) fn film(self, places: &Places<'_>) -> Result<Film, SceneFileError> {
        let film = Film::new(self.width, self.height);
        let film = film.map_err(|error| places.span("film.width").error(error))?;
        Ok(film.with_y_axis(self.y))
    }
}

/// The table `[output]`.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct OutputTable {
    /// Stops by which the picture is made brighter, from -32 to 32.
    exposure: f32,
    /// The tone curve: `none`, `filmic` or `agx`.
    tone: ToneCurve,
    /// Whether the picture is transparent where there is nothing.
    transparent: bool,
    /// Bits of each sample of a PNG: 8 or 16.
    bits: u32,
    /// Pixels per inch at which a PNG is printed, from 1 to 100000.
    dpi: Option<f32>,
}

impl Default for OutputTable {
    fn default() -> Self {
        Self::of(&Encoding::default())
    }
}

impl OutputTable {
    pub(super) fn of(encoding: &Encoding) -> Self {
        Self {
            exposure: encoding.exposure(),
            tone: encoding.tone,
            transparent: encoding.transparent,
            bits: encoding.bits.count(),
            dpi: encoding.dots_per_inch(),
        }
    }

    pub(super) fn encoding(self, places: &Places<'_>) -> Result<Encoding, SceneFileError> {
        let refused = |error: EncodingError| places.refused("output", error.to_string());
        let mut encoding = Encoding::default().with_exposure(self.exposure).map_err(refused)?;
        (encoding.tone, encoding.transparent) = (self.tone, self.transparent);
        encoding.bits = Bits::new(self.bits).map_err(refused)?;
        encoding.with_dots_per_inch(self.dpi).map_err(refused)
    }
}
