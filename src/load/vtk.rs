//! Reads the points of VTK's XML files: `PolyData` (`.vtp`) and `UnstructuredGrid` (`.vtu`).
//!
//! The points of all pieces are the centres, and the arrays of point data are columns: one of three components is
//! `name.x`, `name.y` and `name.z`. An array of bytes with three or four components is a colour, whatever its name. Cells,
//! and arrays of cells, are not used, and a note says so.

mod document;
#[cfg(test)]
mod tests;
mod values;

use std::collections::HashSet;

use document::{Array, Document};

use super::error::{LoadError, Place};
use super::format::Options;
use super::loaded::Loaded;
use super::scalar::Scalar;
use super::table::{Table, TableColumn};
use crate::text::{one_line, shortened, without_byte_order_mark};

/// The first line of legacy files.
const LEGACY: &[u8] = b"# vtk DataFile";

/// Whether the first bytes are XML with the element `VTKFile`, or those of a legacy file, which is refused with advice.
pub(super) fn starts(bytes: &[u8]) -> bool {
    const NAME: &[u8] = b"<VTKFile";
    let text = without_byte_order_mark(bytes).trim_ascii_start();
    let first = &text[..text.len().min(1 << 10)];
    text.starts_with(LEGACY)
        || (first.starts_with(b"<") && first.windows(NAME.len()).any(|window| window == NAME))
}

/// Reads the points of a file.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Loaded, LoadError> {
    let bytes = without_byte_order_mark(bytes);
    if bytes.starts_with(LEGACY) {
        return Err(LoadError::new(
            "this is a legacy VTK file, which is not read; save it as .vtp or .vtu, such as with PyVista: \
             pyvista.read('a.vtk').save('a.vtp')",
        ));
    }
    let document = document::read(bytes)?;
    let mut notes: Vec<String> =
        document.unused.iter().take(8).map(|what| format!("not used: {what}")).collect();
    if document.unused.len() > 8 {
        notes.push(format!("not used: {} more arrays", document.unused.len() - 8));
    }
    let columns = columns(&document, &mut notes)?;
    let mut loaded = Table { columns }.into_loaded(options)?;
    loaded.notes.extend(notes);
    Ok(loaded)
}

/// The columns of all pieces together.
fn columns(
    document: &Document<'_>,
    notes: &mut Vec<String>,
) -> Result<Vec<TableColumn>, LoadError> {
    let mut pieces = document.pieces.iter().enumerate().filter(|(_, piece)| piece.points > 0);
    let Some((index, first)) = pieces.next() else {
        return Ok(["x", "y", "z"].map(|name| TableColumn::numbers(name, Vec::new())).into());
    };
    let no_points = |piece, points| {
        move || {
            let message = format!(
                "it declares NumberOfPoints={points}, but has no array in an element Points, which holds their positions"
            );
            LoadError::at(Place::Piece(piece), message)
        }
    };
    let positions = first.positions.as_ref().ok_or_else(no_points(index, first.points))?;
    if positions.components != 3 {
        let message = format!("it must have 3 components, but has {}", positions.components);
        return Err(in_array(index, "Points", &message));
    }
    let mut groups = vec![group(document, index, positions, "Points")?];
    let mut names = HashSet::new();
    for array in &first.arrays {
        // A name that comes again would be read with the array of the first.
        if names.insert(array.name.as_str()) {
            groups.push(group(document, index, array, &array.name)?);
        }
    }
    let mut kept: Vec<&Array<'_>> = Vec::new();
    names.clear();
    kept.extend(first.arrays.iter().filter(|array| names.insert(array.name.as_str())));
    for (index, piece) in pieces {
        let positions = piece.positions.as_ref().ok_or_else(no_points(index, piece.points))?;
        append(&mut groups[0], group(document, index, positions, "Points")?, index, "Points")?;
        for at in (0..kept.len()).rev() {
            let name = &kept[at].name;
            match piece.arrays.iter().find(|array| array.name == *name) {
                Some(array) => {
                    let more = group(document, index, array, name)?;
                    append(&mut groups[at + 1], more, index, name)?;
                }
                None => {
                    let name = shortened(&one_line(name));
                    notes.push(format!("not used: the array {name}, which piece {index} lacks"));
                    kept.remove(at);
                    groups.remove(at + 1);
                }
            }
        }
    }
    let has_colors = kept.iter().any(|array| {
        let name = array.name.to_lowercase();
        ["color", "colour", "colors", "rgb", "rgba"].contains(&name.as_str())
    });
    let bytes = |array: &Array<'_>| array.scalar == Scalar::U8 && matches!(array.components, 3 | 4);
    let color = kept.iter().position(|array| bytes(array)).filter(|_| !has_colors);
    let mut columns = Vec::new();
    for (at, group) in groups.into_iter().enumerate() {
        let array = if at == 0 { positions } else { kept[at - 1] };
        let full = array.scalar.full();
        let parts = ["red", "green", "blue", "alpha"];
        for (component, numbers) in group.into_iter().enumerate() {
            let name = if at == 0 {
                ["x", "y", "z"][component.min(2)].to_owned()
            } else if color.is_some_and(|color| color + 1 == at) {
                parts[component.min(3)].to_owned()
            } else {
                component_name(array, component)
            };
            columns.push(TableColumn { full, ..TableColumn::numbers(name, numbers) });
        }
    }
    Ok(columns)
}

/// The name of a component of an array.
fn component_name(Array { name, components, .. }: &Array<'_>, component: usize) -> String {
    let is_color = ["rgb", "rgba"].contains(&name.to_lowercase().as_str());
    match components {
        1 => name.clone(),
        2 | 3 if !is_color => format!("{name}.{}", ["x", "y", "z"][component.min(2)]),
        _ => format!("{name}.{component}"),
    }
}

/// The numbers of an array of one piece, component by component.
fn group(
    document: &Document<'_>,
    piece: usize,
    array: &Array<'_>,
    name: &str,
) -> Result<Vec<Vec<f64>>, LoadError> {
    let points = document.pieces.get(piece).map_or(0, |piece| piece.points);
    values::numbers(array, points, document).map_err(|message| in_array(piece, name, &message))
}

fn in_array(piece: usize, name: &str, message: &str) -> LoadError {
    let name = shortened(&one_line(name));
    LoadError::at(Place::Piece(piece), format!("the array {name}: {message}"))
}

/// Adds the numbers of another piece.
fn append(
    all: &mut [Vec<f64>],
    more: Vec<Vec<f64>>,
    piece: usize,
    name: &str,
) -> Result<(), LoadError> {
    if all.len() != more.len() {
        let (all, more) = (all.len(), more.len());
        let message = format!("it has {more} components, but that of the first piece has {all}");
        return Err(in_array(piece, name, &message));
    }
    all.iter_mut().zip(more).for_each(|(all, more)| all.extend(more));
    Ok(())
}
