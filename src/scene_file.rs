//! Scene files: TOML text in; film, camera, settings and spheres out. No file system.
//!
//! `examples/three-spheres.toml` shows every part with comments.

use std::fmt;

use serde::Deserialize;
use serde::de::{self, SeqAccess, Visitor};
use toml::Spanned;

use crate::camera::{Camera, CameraKind, CameraParameters};
use crate::color::LinearRgb;
use crate::exact::{self, Table};
use crate::film::{Film, YAxis};
use crate::points::Points;
use crate::scene::{Scene, SceneError};
use crate::settings::{Settings, Shading};
use crate::sphere::Sphere;
use crate::text::{one_line, shortened};

/// What a scene file says.
#[derive(Debug)]
pub struct SceneFile {
    /// The picture's size.
    pub film: Film,
    /// Shading and background.
    pub settings: Settings,
    data: Option<Placed<Data>>,
    camera: Placed<CameraParameters>,
    spheres: Vec<Placed<Sphere>>,
}

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
}

/// What is wrong with a scene file, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct SceneFileError {
    /// From 1.
    pub line: usize,
    /// From 1, in characters.
    pub column: usize,
    /// What is wrong, and what to do.
    pub message: String,
}

/// A value and its place in the text.
#[derive(Clone, Copy, Debug)]
struct Placed<T> {
    value: T,
    place: Place,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    line: usize,
    column: usize,
}

impl Place {
    /// Where nothing more precise is known.
    const START: Self = Self { line: 1, column: 1 };

    fn error(self, message: impl fmt::Display) -> SceneFileError {
        SceneFileError { line: self.line, column: self.column, message: message.to_string() }
    }
}

impl SceneFile {
    /// Reads a scene file.
    ///
    /// # Errors
    /// The first thing in the text that is not as it should be.
    pub fn parse(text: &str) -> Result<Self, SceneFileError> {
        let lines = Lines::of(text);
        let document: Document = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            lines.place(start).error(explain(error.message()))
        })?;
        let film_place = lines.place(document.film.span().start);
        let FilmTable { width, height, y } = document.film.into_inner().0;
        let film = Film::new(width, height).map_err(|error| film_place.error(error))?;
        let defaults = Settings::default();
        Ok(Self {
            film: film.with_y_axis(y),
            settings: defaults
                .with_shading(document.shading.unwrap_or(defaults.shading()))
                .with_background(document.background.map_or(defaults.background(), |c| c.0)),
            data: DataKeys {
                file: document.data,
                frame: document.frame,
                radius: document.radius,
                radius_scale: document.radius_scale,
                color: document.color,
            }
            .read(&lines)?,
            camera: Placed {
                place: lines.place(document.camera.span().start),
                value: document.camera.into_inner(),
            },
            spheres: document
                .spheres
                .into_iter()
                .map(|sphere| Placed {
                    place: lines.place(sphere.span().start),
                    value: sphere.into_inner().0.sphere(),
                })
                .collect(),
        })
    }

    /// The scene: the file's own spheres, then those of its data.
    ///
    /// # Errors
    /// The first sphere that is out of range, with its place if it stands in this file.
    pub fn scene(&self, data: &[Sphere]) -> Result<Scene, SceneFileError> {
        let own = self.spheres.iter().map(|sphere| sphere.value);
        let spheres: Vec<Sphere> = own.chain(data.iter().copied()).collect();
        Scene::new(&spheres).map_err(|error| self.placed(&error))
    }

    /// As [`SceneFile::scene`], with data that has no colours; where the file has no spheres of its own,
    /// without a copy.
    ///
    /// # Errors
    /// As [`SceneFile::scene`].
    pub fn scene_with_points(
        &self,
        data: Points,
        color: LinearRgb,
    ) -> Result<Scene, SceneFileError> {
        if self.spheres.is_empty() {
            return data.scene(color).map_err(|error| self.placed(&error));
        }
        let data: Vec<Sphere> = data.spheres(color).collect();
        self.scene(&data)
    }

    fn placed(&self, error: &SceneError) -> SceneFileError {
        let &SceneError::Sphere { index, error: fault } = error else {
            return Place::START.error(error);
        };
        match (self.spheres.get(index), &self.data) {
            (Some(sphere), _) => sphere.place.error(error),
            (None, Some(data)) => {
                let in_data = index - self.spheres.len();
                data.place.error(format!("sphere {in_data} of {}: {fault}", data.value.file))
            }
            (None, None) => Place::START.error(error),
        }
    }

    /// The file with more spheres, if there is one.
    #[must_use]
    pub fn data(&self) -> Option<&Data> {
        self.data.as_ref().map(|data| &data.value)
    }

    /// The camera, or of two eyes that in the middle, for a film of this shape; without a fixed place it frames
    /// the scene.
    ///
    /// # Errors
    /// If a parameter is out of range, or parameters exclude each other.
    pub fn camera(&self, film: &Film, scene: &Scene) -> Result<Box<dyn Camera>, SceneFileError> {
        self.camera
            .value
            .camera(film.aspect(), &scene.bounds_to_frame())
            .map_err(|error| self.camera.place.error(error))
    }

    /// The cameras of the left and of the right eye, if the camera has two.
    ///
    /// # Errors
    /// As [`SceneFile::camera`].
    pub fn stereo_pair(
        &self,
        film: &Film,
        scene: &Scene,
    ) -> Result<Option<[Box<dyn Camera>; 2]>, SceneFileError> {
        self.camera
            .value
            .stereo_pair(film.aspect(), &scene.bounds_to_frame())
            .map_err(|error| self.camera.place.error(error))
    }
}

/// The keys that name a file with spheres and say how to read it.
struct DataKeys {
    file: Option<Spanned<String>>,
    frame: Option<Spanned<usize>>,
    radius: Option<Spanned<f64>>,
    radius_scale: Option<Spanned<f64>>,
    color: Option<Spanned<ColorValue>>,
}

impl DataKeys {
    fn read(self, lines: &Lines<'_>) -> Result<Option<Placed<Data>>, SceneFileError> {
        let Some(file) = self.file else {
            let orphans = [
                ("frame", self.frame.map(|value| value.span())),
                ("radius", self.radius.map(|value| value.span())),
                ("radius_scale", self.radius_scale.map(|value| value.span())),
                ("color", self.color.map(|value| value.span())),
            ];
            let orphan = orphans.into_iter().find_map(|(key, span)| Some((key, span?.start)));
            return match orphan {
                Some((key, start)) => Err(lines
                    .place(start)
                    .error(format!("`{key}` concerns `data`, which is not given"))),
                None => Ok(None),
            };
        };
        let positive = |key, value: Option<Spanned<f64>>| match value {
            Some(value) if !(value.get_ref().is_finite() && *value.get_ref() > 0.0) => {
                Err(lines.place(value.span().start).error(format!(
                    "`{key}` is {:?}; it must be finite and greater than 0",
                    value.get_ref()
                )))
            }
            value => Ok(value.map(Spanned::into_inner)),
        };
        Ok(Some(Placed {
            place: lines.place(file.span().start),
            value: Data {
                file: file.into_inner(),
                frame: self.frame.map(Spanned::into_inner),
                radius: positive("radius", self.radius)?,
                radius_scale: positive("radius_scale", self.radius_scale)?.unwrap_or(1.0),
                color: self.color.map(|color| color.into_inner().0),
            },
        }))
    }
}

/// Where the lines of a text start.
struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    fn of(text: &'a str) -> Self {
        let ends = text.match_indices('\n').map(|(end, _)| end + 1);
        Self { text, starts: std::iter::once(0).chain(ends).collect() }
    }

    /// Line and column of a byte.
    fn place(&self, byte: usize) -> Place {
        // At least one line starts at or before any byte.
        let line = self.starts.partition_point(|start| *start <= byte);
        let before = self.text.get(self.starts[line - 1]..byte).unwrap_or_default();
        Place { line, column: before.chars().count() + 1 }
    }
}

/// Puts serde's words for an unknown key or name into a user's, with a suggestion.
fn explain(message: &str) -> String {
    let (what, rest) = match message.split_once(" `") {
        Some(("unknown field", rest)) => ("key", rest),
        Some(("unknown variant", rest)) => ("name", rest),
        // The camera is the only enumeration whose variants have contents.
        _ if message.starts_with("wanted exactly 1 element, more") => {
            return "a scene has one camera; remove the other tables `[camera.…]`".to_owned();
        }
        _ if message.starts_with("wanted exactly 1 element")
            || message.starts_with("invalid type: unit variant") =>
        {
            return format!("a camera is a table; write {}", camera_tables());
        }
        // toml's messages of its own are good, but may span lines.
        _ => return in_plain_words(message),
    };
    // unknown field `widht`, expected one of `width`, `height`
    let mut quoted = rest.split('`').step_by(2);
    let unknown = &shortened(quoted.next().unwrap_or_default());
    let known: Vec<&str> = quoted.filter(|name| !name.is_empty()).collect();
    let nearest = known.iter().copied().max_by(|a, b| {
        strsim::jaro_winkler(a, unknown).total_cmp(&strsim::jaro_winkler(b, unknown))
    });
    match nearest.filter(|name| strsim::jaro_winkler(name, unknown) > 0.75) {
        Some(nearest) => format!("unknown {what} `{unknown}`; did you mean `{nearest}`?"),
        None => format!("unknown {what} `{unknown}`; known here: {}", known.join(", ")),
    }
}

/// Puts Rust's words for types, and serde's for a missing key, into a user's.
fn in_plain_words(message: &str) -> String {
    let mut text = one_line(message);
    for (rust, plain) in [
        ("expected f64", "expected a number"),
        ("expected f32", "expected a number"),
        ("expected u32", "expected a whole number from 0 to 4294967295"),
        ("expected usize", "expected a whole number, 0 or more"),
        ("missing field", "missing key"),
    ] {
        text = text.replace(rust, plain);
    }
    text
}

/// `[camera.pinhole]` or …
fn camera_tables() -> String {
    let tables = CameraKind::ALL.iter().map(|kind| format!("`[camera.{}]`", kind.name()));
    tables.collect::<Vec<_>>().join(" or ")
}

/// The file's tables, as serde reads them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default = "default_film")]
    film: Spanned<Table<FilmTable>>,
    #[serde(default = "default_camera")]
    camera: Spanned<CameraParameters>,
    background: Option<ColorValue>,
    shading: Option<Shading>,
    #[serde(default)]
    spheres: Vec<Spanned<Table<SphereTable>>>,
    data: Option<Spanned<String>>,
    frame: Option<Spanned<usize>>,
    radius: Option<Spanned<f64>>,
    radius_scale: Option<Spanned<f64>>,
    color: Option<Spanned<ColorValue>>,
}

fn default_film() -> Spanned<Table<FilmTable>> {
    Spanned::new(0..0, Table::default())
}

fn default_camera() -> Spanned<CameraParameters> {
    Spanned::new(0..0, CameraParameters::default())
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FilmTable {
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereTable {
    #[serde(deserialize_with = "exact::array")]
    center: [f64; 3],
    radius: f64,
    #[serde(default)]
    color: ColorValue,
}

impl SphereTable {
    fn sphere(self) -> Sphere {
        Sphere { center: self.center, radius: self.radius, color: self.color.0 }
    }
}

/// A CSS colour, or a linear triple.
struct ColorValue(LinearRgb);

/// The colour of spheres that are given none, as 8-bit sRGB: a light grey.
pub const DEFAULT_COLOR: [u8; 3] = [0xcc; 3];

impl Default for ColorValue {
    fn default() -> Self {
        Self(LinearRgb::from_srgb8(DEFAULT_COLOR))
    }
}

impl<'de> Deserialize<'de> for ColorValue {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ColorVisitor;

        impl<'de> Visitor<'de> for ColorVisitor {
            type Value = ColorValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a CSS color in quotes or a linear triple [r, g, b]")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<ColorValue, E> {
                LinearRgb::from_css(text).map(ColorValue).map_err(E::custom)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<ColorValue, A::Error> {
                let rgb = exact::elements(seq, &self)?;
                LinearRgb::new(rgb).map(ColorValue).map_err(de::Error::custom)
            }
        }

        deserializer.deserialize_any(ColorVisitor)
    }
}
