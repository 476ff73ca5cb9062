//! Puts atoms into the order of their ids: LAMMPS writes them as its processors have them, in another order in every frame.

use crate::load::loaded::ColumnValues;
use crate::load::table::{Table, TableColumn};
use crate::parallel;

/// Sorts the rows by the column `id`, if there is one. Returns for each row the one that it was in the file; `None` if
/// they are in order.
pub(super) fn by_id(table: &mut Table) -> Option<Vec<u32>> {
    let ids = table.columns.iter().find_map(|column| match &column.values {
        ColumnValues::Numbers(ids) if column.name == "id" => Some(ids.as_slice()),
        _ => None,
    })?;
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

/// The order if the ids are consecutive whole numbers, as they are where no atom was lost or left out.
fn of_consecutive(ids: &[f64]) -> Option<Vec<u32>> {
    let least = ids.iter().copied().fold(f64::INFINITY, f64::min);
    let mut order = vec![u32::MAX; ids.len()];
    for (row, id) in ids.iter().enumerate() {
        let place = id - least;
        // Casts saturate, so that a place which is no whole number or too large is noticed.
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
