//! Columns and parts of spheres, and the same data with other settings.

use numpy::{IntoPyArray as _, PyArray1, PyArrayMethods as _, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::fault::{Fault, Outcome};
use crate::look::SceneText;
use crate::scene::DataExtras;
use crate::spheres::SphereData;
use crate::worker;
use pinhole::scene::Colors;
use pinhole::{Scene, SphereArray};
use pinhole_data::column;
use pinhole_data::load::{Column, ColumnValues, Dataset, Labels};
use pinhole_data::select::Selection;

/// The data of the spheres of a picture, in their order, or of those with these indices.
fn shown(of: &SphereData, indices: Option<&[u32]>) -> Outcome<Dataset> {
    let scene = of.scene();
    let Some(loaded) = &of.loaded else {
        let all = of_scene(&scene, of.is_colored);
        return Ok(match indices {
            Some(indices) => all.taken(indices),
            None => all,
        });
    };
    if of.is_updated() {
        return Err(Fault::Input("these spheres were updated; make new Spheres(...) of a part".to_owned()));
    }
    let mut data = loaded.as_ref().clone();
    if let Some(replicate) = of.replicate {
        replicate.apply(&mut data).map_err(Fault::input)?;
    }
    if of.count() == data.spheres.len() {
        return Ok(match indices {
            Some(indices) => data.taken(indices),
            None => data,
        });
    }
    // Spheres of which others are left out are numbered, unless the data has such a column itself.
    let is_index = |column: &&Column| column.name.eq_ignore_ascii_case("index");
    if data.columns.iter().any(|column| is_index(&column)) {
        let message = "the column `index` has other numbers than those of the spheres; rename it";
        return Err(Fault::Input(message.to_owned()));
    }
    let former = match of.columns().iter().find(is_index).map(|column| &column.values) {
        Some(ColumnValues::Numbers(numbers)) => numbers.iter().map(|former| *former as u32).collect(),
        _ => Vec::new(),
    };
    let asked = |indices: &[u32]| indices.iter().filter_map(|index| former.get(*index as usize).copied()).collect();
    Ok(data.taken(&indices.map_or(former.clone(), asked)))
}

/// The spheres of a scene as data.
fn of_scene(scene: &Scene, is_colored: bool) -> Dataset {
    let count = scene.len() - scene.added();
    let origin = scene.origin();
    let spheres = scene.spheres()[..count].iter().map(|[x, y, z, radius]| {
        let [x, y, z] = [*x, *y, *z].map(f64::from);
        [origin.x + x, origin.y + y, origin.z + z, f64::from(*radius)]
    });
    let mut data = Dataset::new(SphereArray::F64(spheres.collect()));
    data.colors = is_colored.then(|| (0..count as u32).map(|id| scene.color(id)).collect());
    if let Colors::Rgba8(bytes) = scene.appearance().colors() {
        data.opacities = Some(bytes.iter().take(count).map(|[.., alpha]| f32::from(*alpha) / 255.0).collect());
    }
    data
}

/// Returns the same data with other settings.
#[pyfunction]
pub(crate) fn restyled(py: Python<'_>, of: Py<SphereData>, text: SceneText) -> PyResult<SphereData> {
    Ok(worker::run(py, None, move |_| {
        let of = of.get();
        let refused =
            |what: &str| Err(Fault::Input(format!("these spheres {what}; make new Spheres(...) with other settings")));
        if of.is_updated() {
            return refused("were updated");
        }
        match &of.loaded {
            Some(loaded) => made(of, loaded.as_ref().clone(), &text),
            None => refused("have no columns"),
        }
    })?)
}

/// The spheres with these indices, with other settings.
#[pyfunction]
pub(crate) fn taken(
    py: Python<'_>,
    of: Py<SphereData>,
    indices: PyReadonlyArray1<'_, u32>,
    text: SceneText,
) -> PyResult<SphereData> {
    let indices = indices.as_array().to_vec();
    Ok(worker::run(py, None, move |_| {
        let of = of.get();
        made(of, shown(of, Some(&indices))?, &text)
    })?)
}

/// Spheres of data that is like that of others.
fn made(of: &SphereData, data: Dataset, text: &SceneText) -> Outcome<SphereData> {
    let given = DataExtras { radii: of.has_radii, is_colored: of.is_colored, ..DataExtras::default() };
    SphereData::of_loaded(data, text, given, of.z_is_up)
}

/// Returns for each sphere whether an expression selects it, and notes.
#[pyfunction]
pub(crate) fn mask(
    py: Python<'_>,
    of: Py<SphereData>,
    expression: String,
) -> PyResult<(Py<PyArray1<bool>>, Vec<String>)> {
    let (mask, notes) = worker::run(py, None, move |_| {
        let refused = |error: &dyn std::fmt::Display| Fault::Input(format!("select: {error}"));
        let selection: Selection = expression.parse().map_err(|error| refused(&error))?;
        selection.matches(&shown(of.get(), None)?).map_err(|error| refused(&error))
    })?;
    Ok((mask.into_pyarray(py).unbind(), notes))
}

/// A column of the spheres in the picture: numbers, three of them for a vector, or the different texts and the index of
/// each sphere's text.
#[pyfunction]
pub(crate) fn column_of<'py>(py: Python<'py>, of: Py<SphereData>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let of = of.get();
    let columns = of.columns();
    // Most names are those of columns, for which the spheres are not copied.
    let spheres = match columns.iter().any(|column| column.name == name) {
        true => SphereArray::F64(vec![[0.0; 4]; of.count()]),
        false => of_scene(&of.scene(), false).spheres,
    };
    let is_vector = !name.contains('|');
    if let (true, Ok((_, [x, y, z]))) = (is_vector, column::vector(name, &spheres, columns)) {
        let all: Vec<f64> = x.iter().zip(y).zip(z).flat_map(|((x, y), z)| [*x, *y, *z]).collect();
        return Ok(all.into_pyarray(py).reshape([x.len(), 3])?.into_any());
    }
    let found = column::column(name, &spheres, columns).map_err(Fault::input)?;
    match found.values.into_owned() {
        ColumnValues::Numbers(numbers) => Ok(numbers.into_pyarray(py).into_any()),
        ColumnValues::Labels(Labels { names, indices }) => {
            Ok((names, indices.into_pyarray(py)).into_pyobject(py)?.into_any())
        }
    }
}
