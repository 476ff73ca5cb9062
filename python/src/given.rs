//! Makes spheres of arrays.

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Centers, ColorArray, Radii, Values, column};
use crate::fault::Fault;
use crate::files::JoinedFrames;
use crate::look::SceneText;
use crate::scene::DataExtras;
use crate::spheres::SphereData;
use crate::worker;
use pinhole_data::load::{Column, Dataset};

/// The edges of a periodic cell, its corner, and the edges along which the data repeats.
type Cell = ([[f64; 3]; 3], [f64; 3], [bool; 3]);

/// Makes spheres of arrays that Python has checked.
#[pyfunction]
#[pyo3(signature = (positions, radius, color, columns, text, cell, bonds, keys))]
#[expect(clippy::too_many_arguments, reason = "Python calls it")]
pub(crate) fn of_arrays(
    py: Python<'_>,
    positions: Centers<'_>,
    radius: Option<Radii<'_>>,
    color: Option<ColorArray<'_>>,
    columns: Vec<(String, Values<'_>)>,
    text: SceneText,
    cell: Option<Cell>,
    bonds: Option<PyReadonlyArray2<'_, u32>>,
    keys: Option<&JoinedFrames>,
) -> PyResult<SphereData> {
    let spheres = positions.spheres(radius.as_ref())?;
    let rgba8 = color.as_ref().and_then(ColorArray::rgba8);
    // The bytes of simple spheres are used unchanged.
    let is_simple = rgba8.is_some() && columns.is_empty() && text.is_empty() && cell.is_none() && bonds.is_none();
    let linear = color.as_ref().filter(|_| !is_simple).map(ColorArray::linear).transpose()?;
    let opacities = color.as_ref().filter(|_| !is_simple).and_then(ColorArray::opacities);
    let columns: Vec<Column> = columns.into_iter().map(column).collect::<Result<_, _>>()?;
    let (has_radius, is_colored) = (radius.is_some(), color.is_some());
    let bonds: Option<Vec<[u32; 2]>> =
        bonds.map(|bonds| bonds.as_array().rows().into_iter().map(|row| [row[0], row[1]]).collect());
    let (keys, traits) = keys.map(JoinedFrames::joined).unzip();
    Ok(worker::run(py, None, move |_| {
        let mut loaded = Dataset::of_columns(spheres, has_radius, linear, columns).map_err(Fault::input)?;
        loaded.opacities = opacities;
        if let Some((edges, origin, is_periodic)) = cell {
            (loaded.cell, loaded.cell_origin, loaded.is_periodic) = (Some(edges), origin, is_periodic);
        }
        if let Some(bonds) = bonds {
            loaded.set_bonds(bonds);
        }
        let colors = rgba8.filter(|_| is_simple);
        let given = DataExtras { colors, radii: has_radius, is_colored, keys, traits: traits.flatten() };
        SphereData::of_loaded(loaded, &text, given, false)
    })?)
}
