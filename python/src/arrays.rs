//! Converts NumPy arrays to spheres and colours, and the meaning of colours to a dict. Python has checked shapes and
//! types. Strides may be any.

use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::fault::{Fault, Outcome};
use pinhole::{LinearRgb, SphereArray};
use pinhole_data::css;
use pinhole_data::load::{Column, ColumnValues, Labels};
use pinhole_figure::color_by::{ColorKey, KeyKind, MapName};

/// Centres, an array of shape (n, 3).
#[derive(FromPyObject)]
pub(crate) enum Centers<'py> {
    Narrow(PyReadonlyArray2<'py, f32>),
    Wide(PyReadonlyArray2<'py, f64>),
}

/// One radius, or an array of shape (n,) with the type of the centres.
#[derive(FromPyObject)]
pub(crate) enum Radii<'py> {
    Narrow(PyReadonlyArray1<'py, f32>),
    Wide(PyReadonlyArray1<'py, f64>),
    /// The radius of all spheres.
    All(f64),
}

/// The values of a column.
#[derive(FromPyObject)]
pub(crate) enum Values<'py> {
    Numbers(PyReadonlyArray1<'py, f64>),
    /// The different texts, and the index of each sphere's text.
    Texts(Vec<String>, PyReadonlyArray1<'py, u32>),
}

/// Colours, an array of shape (n, 3) or (n, 4).
#[derive(FromPyObject)]
pub(crate) enum ColorArray<'py> {
    /// Red, green, blue and perhaps alpha in bytes, sRGB.
    Bytes(PyReadonlyArray2<'py, u8>),
    /// Linear red, green and blue.
    Linear(PyReadonlyArray2<'py, f32>),
}

impl Centers<'_> {
    /// Makes spheres with these centres. Radii are 0 if there are none.
    pub(crate) fn spheres(&self, radii: Option<&Radii<'_>>) -> Outcome<SphereArray> {
        Ok(match (self, radii) {
            (Self::Narrow(centers), Some(Radii::Narrow(radii))) => {
                SphereArray::F32(each(centers.as_array(), radii.as_array()))
            }
            (Self::Wide(centers), Some(Radii::Wide(radii))) => {
                SphereArray::F64(each(centers.as_array(), radii.as_array()))
            }
            (Self::Narrow(centers), Some(Radii::All(radius))) => {
                SphereArray::F32(all(centers.as_array(), *radius as f32))
            }
            (Self::Wide(centers), Some(Radii::All(radius))) => SphereArray::F64(all(centers.as_array(), *radius)),
            (Self::Narrow(centers), None) => SphereArray::F32(all(centers.as_array(), 0.0)),
            (Self::Wide(centers), None) => SphereArray::F64(all(centers.as_array(), 0.0)),
            _ => return Err(Fault::Internal("radii have another type than positions".to_owned())),
        })
    }
}

/// Makes spheres of one radius. The GIL is held, so that no other thread changes the array meanwhile.
fn all<T: Copy>(centers: ArrayView2<'_, T>, radius: T) -> Vec<[T; 4]> {
    match centers.as_slice() {
        Some(numbers) => numbers.as_chunks::<3>().0.iter().map(|[x, y, z]| [*x, *y, *z, radius]).collect(),
        None => centers.rows().into_iter().map(|c| [c[0], c[1], c[2], radius]).collect(),
    }
}

/// Makes spheres with radii of their own.
fn each<T: Copy>(centers: ArrayView2<'_, T>, radii: ArrayView1<'_, T>) -> Vec<[T; 4]> {
    let rows = centers.rows().into_iter().zip(radii);
    rows.map(|(center, radius)| [center[0], center[1], center[2], *radius]).collect()
}

/// A column with its name.
pub(crate) fn column((name, values): (String, Values<'_>)) -> Outcome<Column> {
    let values = match values {
        Values::Numbers(numbers) => ColumnValues::Numbers(numbers.as_array().to_vec()),
        Values::Texts(names, indices) => ColumnValues::Labels(Labels { names, indices: indices.as_array().to_vec() }),
    };
    Ok(Column { name, values })
}

impl ColorArray<'_> {
    /// Returns the colours as sRGB with alpha, if they are bytes.
    pub(crate) fn rgba8(&self) -> Option<Vec<[u8; 4]>> {
        let Self::Bytes(bytes) = self else { return None };
        let rgba = |row: ArrayView1<'_, u8>| [row[0], row[1], row[2], row.get(3).copied().unwrap_or(u8::MAX)];
        Some(bytes.as_array().rows().into_iter().map(rgba).collect())
    }

    /// Returns the colours as linear light.
    pub(crate) fn linear(&self) -> Outcome<Vec<LinearRgb>> {
        match self {
            Self::Bytes(bytes) => {
                let rows = bytes.as_array();
                let rows = rows.rows().into_iter();
                Ok(rows.map(|row| LinearRgb::from_srgb8([row[0], row[1], row[2]])).collect())
            }
            Self::Linear(rgb) => {
                let rgb = rgb.as_array();
                let rows = rgb.rows().into_iter().enumerate();
                rows.map(|(index, row)| {
                    let color = LinearRgb::new([row[0], row[1], row[2]]);
                    color.map_err(|error| Fault::Input(format!("color: sphere {index}: {error}")))
                })
                .collect()
            }
        }
    }

    /// Returns the opacity of each sphere, if the colours have alpha.
    pub(crate) fn opacities(&self) -> Option<Vec<f32>> {
        let Self::Bytes(bytes) = self else { return None };
        let bytes = bytes.as_array();
        (bytes.ncols() == 4).then(|| bytes.column(3).iter().map(|alpha| f32::from(*alpha) / 255.0).collect())
    }
}

/// Makes a dict with `title`, the name of the column; and either `range`, `log` and the table `colors`, three bytes
/// of sRGB for each colour from the low end on, or `categories`, names with their colours.
pub(crate) fn in_python(py: Python<'_>, key: &ColorKey) -> PyResult<Py<PyAny>> {
    let found = PyDict::new(py);
    found.set_item("title", &key.title)?;
    match &key.kind {
        KeyKind::Scale(scale) => {
            let [low, high] = scale.scale().range();
            found.set_item("range", (low, high))?;
            found.set_item("log", scale.scale().is_log())?;
            found.set_item("colors", scale.colors().as_flattened())?;
        }
        KeyKind::Categories(all) => {
            let named = all.iter().map(|one| (one.name.clone(), <(u8, u8, u8)>::from(one.color)));
            let named: Vec<_> = named.collect();
            found.set_item("categories", named)?;
        }
        _ => {}
    }
    Ok(found.into_any().unbind())
}

/// The CSS colours of these names, three bytes of sRGB for each; None if any name is not that of a colour.
#[pyfunction]
pub(crate) fn srgb_of_names(names: Vec<String>) -> Option<Vec<u8>> {
    let colors = names.iter().map(|name| css::color(name).ok().map(LinearRgb::to_srgb8));
    colors.collect::<Option<Vec<_>>>().map(|colors| colors.into_flattened())
}

/// Returns true if there is a colour map of this name.
#[pyfunction]
pub(crate) fn is_color_map(name: &str) -> bool {
    name.parse::<MapName>().is_ok()
}
