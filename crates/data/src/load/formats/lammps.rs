//! Reads files of the molecular dynamics program LAMMPS: dumps of atoms, and data files.
//!
//! The formats are those of its manual, on the pages of the commands `dump`, `dump_modify` and `read_data`. Lengths are
//! taken as they are, in the simulation's unit.

pub(super) mod data;
pub(super) mod dump;
mod types;

use crate::load::dataset::ColumnValues;
use crate::load::error::LoadError;
use crate::load::numbers::number;
use crate::load::rows::Values;
use crate::load::table::{Table, TableColumn};
use pinhole::internals::parallel;
use pinhole::internals::text::shortened;

/// The error of a text in the wrong place, or one that cannot be read; `what` is the end of the sentence.
fn wrong_text(line: usize, text: &[u8], what: &str) -> LoadError {
    let text = shortened(&String::from_utf8_lossy(text.trim_ascii()));
    LoadError::line(line, format!("`{text}` {what}"))
}

fn too_few_atoms(line: usize, declared: usize, found: usize) -> LoadError {
    let message = format!("{declared} atoms are declared, but the file ends after {found}");
    LoadError::line(line, message)
}

/// The layout of the three lines of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// Low and high end along x, y and z.
    Orthogonal,
    /// Ends of the box around the cell, each pair followed by one of the tilt factors xy, xz and yz.
    Triclinic,
    /// The components of an edge and one component of the origin.
    General,
}

impl Shape {
    /// The shape that `ITEM: BOX BOUNDS` declares.
    fn of_item(item: &str) -> Self {
        let mut words = item.split_whitespace();
        match words.nth(2) {
            Some("xy") => Self::Triclinic,
            Some("abc") => Self::General,
            _ => Self::Orthogonal,
        }
    }

    const fn values(self) -> &'static str {
        match self {
            Self::Orthogonal => "two numbers belong here: low end and high end",
            Self::Triclinic => "three numbers belong here: low end, high end and tilt factor",
            Self::General => "four numbers belong here: an edge and a component of the origin",
        }
    }
}

/// An origin and three edges.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    origin: [f64; 3],
    edges: [[f64; 3]; 3],
}

impl Cell {
    /// Reads the three lines of a box in a dump, or names the first that is wrong, from 0.
    fn of_dump(shape: Shape, lines: [&[u8]; 3]) -> Result<Self, usize> {
        let mut rows = [[0.0; 4]; 3];
        let wanted = match shape {
            Shape::Orthogonal => 2,
            Shape::Triclinic => 3,
            Shape::General => 4,
        };
        for (index, (row, line)) in rows.iter_mut().zip(lines).enumerate() {
            let mut values = Values { rest: line };
            for value in row.iter_mut().take(wanted) {
                let parsed = values.next().and_then(number).filter(|number| number.is_finite());
                *value = parsed.ok_or(index)?;
            }
            if values.next().is_some() {
                return Err(index);
            }
        }
        let [a, b, c] = rows;
        Ok(match shape {
            Shape::Orthogonal => Self::tilted([a[0], b[0], c[0]], [a[1], b[1], c[1]], [0.0; 3]),
            Shape::Triclinic => {
                let [xy, xz, yz] = [a[2], b[2], c[2]];
                // A dump has the bounds of the box around the cell.
                let ends = [0.0, xy, xz, xy + xz];
                let least = ends.into_iter().fold(f64::INFINITY, f64::min);
                let most = ends.into_iter().fold(f64::NEG_INFINITY, f64::max);
                let low = [a[0] - least, b[0] - yz.min(0.0), c[0]];
                let high = [a[1] - most, b[1] - yz.max(0.0), c[1]];
                Self::tilted(low, high, [xy, xz, yz])
            }
            Shape::General => Self { origin: [a[3], b[3], c[3]], edges: [a, b, c].map(|[x, y, z, _]| [x, y, z]) },
        })
    }

    /// A cell whose first edge lies along x and whose second lies in the plane of x and y.
    fn tilted(low: [f64; 3], high: [f64; 3], [xy, xz, yz]: [f64; 3]) -> Self {
        let [x, y, z] = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        Self { origin: low, edges: [[x, 0.0, 0.0], [xy, y, 0.0], [xz, yz, z]] }
    }

    /// The point with these coordinates as fractions of the edges.
    fn place(&self, fractions: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.edges;
        let [u, v, w] = fractions;
        [0, 1, 2].map(|axis| self.origin[axis] + u * a[axis] + v * b[axis] + w * c[axis])
    }
}

/// The directions in which the cell of a dump repeats: all, unless the item names the boundaries, `pp` if they are periodic.
fn periodic_of(item: &str) -> [bool; 3] {
    let words: Vec<&str> = item.split_whitespace().collect();
    let is_boundary = |word: &&str| word.len() == 2 && word.bytes().all(|byte| b"pfsm".contains(&byte));
    match words.last_chunk::<3>() {
        Some(ends) if ends.iter().all(is_boundary) => ends.map(|ends| ends == "pp"),
        _ => [true; 3],
    }
}

/// Sorts the rows by the column `id`, if there is one. Returns the former index of each row; `None` if the rows were
/// in order.
fn by_id(table: &mut Table) -> Option<Vec<u32>> {
    let ids = numbers(table, "id")?;
    if ids.is_sorted() {
        return None;
    }
    let order = of_consecutive(ids).unwrap_or_else(|| {
        // There are fewer than 2³² spheres.
        let mut order: Vec<u32> = (0..ids.len() as u32).collect();
        order.sort_by(|a, b| ids[*a as usize].total_cmp(&ids[*b as usize]));
        order
    });
    for TableColumn { values, .. } in &mut table.columns {
        match values {
            ColumnValues::Numbers(numbers) => *numbers = gathered(numbers, &order),
            ColumnValues::Labels(labels) => labels.indices = gathered(&labels.indices, &order),
        }
    }
    Some(order)
}

fn numbers<'a>(table: &'a Table, name: &str) -> Option<&'a [f64]> {
    let column = table.columns.iter().find(|column| column.name == name)?;
    match &column.values {
        ColumnValues::Numbers(numbers) => Some(numbers),
        ColumnValues::Labels(_) => None,
    }
}

/// A note about ids that several spheres have, which are in order.
fn repeated_ids(table: &Table) -> Option<String> {
    let ids = numbers(table, "id")?;
    let mut again = ids.windows(2).filter(|pair| pair[0].to_bits() == pair[1].to_bits());
    let first = again.next()?[0];
    let more = match again.count() {
        0 => String::new(),
        count => format!(", and {count} more"),
    };
    Some(format!("several spheres have the same id: {first}{more}; all of them are drawn"))
}

/// Returns the order if the ids are consecutive whole numbers, as they are if no atom was lost or left out.
fn of_consecutive(ids: &[f64]) -> Option<Vec<u32>> {
    let least = ids.iter().copied().fold(f64::INFINITY, f64::min);
    let mut order = vec![u32::MAX; ids.len()];
    for (row, id) in ids.iter().enumerate() {
        let place = id - least;
        // Casts saturate, so that a place is refused if it is not a whole number or is too large.
        let index = place as usize;
        let slot = order.get_mut(index).filter(|slot| **slot == u32::MAX)?;
        if (index as f64 - place).abs() > 0.0 || !place.is_finite() {
            return None;
        }
        *slot = row as u32;
    }
    Some(order)
}

fn gathered<T: Copy + Send + Sync>(values: &[T], order: &[u32]) -> Vec<T> {
    parallel::map(order.len(), |row| values[order[row] as usize])
}
