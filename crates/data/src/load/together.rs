//! Several files in one picture: their spheres, one after another.

use std::path::Path;

use pinhole::image::color::LinearRgb;
use pinhole::scene::sphere_array::SphereArray;

use super::dataset::{Column, ColumnValues, Dataset};
use super::error::LoadError;
use super::file_set::FileSet;
use super::format::{Format, Options};
use super::labels::LabelsBuilder;
use super::open::open_file;

/// Colour of spheres to which nothing gives one, beside others that have colours.
const UNCOLORED: [u8; 3] = [0xcc; 3];

/// Reads the first frame of each of these files, and puts them together.
pub(super) fn open_together(set: &FileSet, options: &Options) -> Result<Dataset, LoadError> {
    let read = |path: &Path| {
        let format = Format::of_path(path).map_err(|error| LoadError::from(error).in_file(path))?;
        let options = Options { format: format.or(options.format), ..options.clone() };
        open_file(path, &options)
            .map_err(|error| LoadError::new(format!("{}: {error}", path.display())).of_kind(error.kind))
    };
    let parts = set.files().iter().map(|path| Ok((path.as_path(), read(path)?)));
    Dataset::joined(parts.collect::<Result<Vec<_>, LoadError>>()?)
}

impl Dataset {
    /// Puts the spheres of several files together, in their order. The column `file` has the names of the files. Numbers
    /// that a file lacks are NaN, texts are empty. There is a cell if all files that have one have the same.
    ///
    /// # Errors
    /// Returns an error if there are more spheres than numbers for them.
    pub fn joined(parts: Vec<(&Path, Self)>) -> Result<Self, LoadError> {
        let count: usize = parts.iter().map(|(_, part)| part.spheres.len()).sum();
        if u32::try_from(count).is_err() {
            return Err(LoadError::new(format!("the files together have {count} spheres, more than {}", u32::MAX)));
        }
        let mut names: Vec<(&str, bool)> = Vec::new();
        for column in parts.iter().flat_map(|(_, part)| &part.columns) {
            let is_text = matches!(column.values, ColumnValues::Labels(_));
            match names.iter_mut().find(|(name, _)| *name == column.name) {
                Some((_, has_text)) => *has_text |= is_text,
                None => names.push((&column.name, is_text)),
            }
        }
        let columns = names.into_iter().map(|(name, is_text)| {
            let of_parts = parts.iter().map(|(_, part)| (part.column(name), part.spheres.len()));
            let values = if is_text { texts(of_parts) } else { numbers(of_parts) };
            Column { name: name.to_owned(), values }
        });
        let mut columns: Vec<Column> = columns.filter(|column| column.name != "file").collect();
        let files = parts.iter().map(|(path, part)| (path.file_name().unwrap_or_default(), part.spheres.len()));
        let mut of_files = LabelsBuilder::default();
        for (name, count) in files {
            let index = of_files.index(name.to_string_lossy().as_bytes());
            of_files.indices.resize(of_files.indices.len() + count, index);
        }
        columns.push(Column { name: "file".to_owned(), values: of_files.into_values() });

        let is_f64 = parts.iter().any(|(_, part)| matches!(part.spheres, SphereArray::F64(_)));
        let mut all = Self::new(if is_f64 { SphereArray::F64(Vec::new()) } else { SphereArray::F32(Vec::new()) });
        let has_colors = parts.iter().any(|(_, part)| part.colors.is_some());
        let has_opacities = parts.iter().any(|(_, part)| part.opacities.is_some());
        all.colors = has_colors.then(Vec::new);
        all.opacities = has_opacities.then(Vec::new);
        all.has_all_bonds = parts.iter().all(|(_, part)| part.has_all_bonds);
        all.frames = Some(1);
        let cells: Vec<_> = parts.iter().filter_map(|(_, part)| part.cell.map(bits)).collect();
        let has_one_cell = cells.iter().all(|cell| *cell == cells[0]);
        for (_, part) in parts {
            let (before, count) = (all.spheres.len() as u32, part.spheres.len());
            all.bonds.extend(part.bonds.iter().map(|bond| bond.map(|index| before + index)));
            match (&mut all.spheres, part.spheres) {
                (SphereArray::F32(all), SphereArray::F32(part)) => all.extend(part),
                (SphereArray::F64(all), SphereArray::F64(part)) => all.extend(part),
                (SphereArray::F64(all), part) => all.extend((0..count).map(|index| part.at(index))),
                (SphereArray::F32(_), SphereArray::F64(_)) => {}
            }
            if let Some(all) = &mut all.colors {
                all.extend(part.colors.unwrap_or_else(|| vec![LinearRgb::from_srgb8(UNCOLORED); count]));
            }
            if let Some(all) = &mut all.opacities {
                all.extend(part.opacities.unwrap_or_else(|| vec![1.0; count]));
            }
            all.notes.extend(part.notes);
            all.is_part_of_crystal |= part.is_part_of_crystal;
            all.unknown = all.unknown.or(part.unknown);
            if all.cell.is_none() && part.cell.is_some() && has_one_cell {
                (all.cell, all.cell_origin, all.is_periodic) = (part.cell, part.cell_origin, part.is_periodic);
            }
        }
        if !has_one_cell {
            all.notes.push("the files have different cells, of which none is drawn".to_owned());
        }
        all.columns = columns;
        Ok(all)
    }
}

fn bits(cell: [[f64; 3]; 3]) -> [[u64; 3]; 3] {
    cell.map(|edge| edge.map(f64::to_bits))
}

fn numbers<'a>(parts: impl Iterator<Item = (Option<&'a ColumnValues>, usize)>) -> ColumnValues {
    let values = parts.flat_map(|(values, count)| match values {
        Some(ColumnValues::Numbers(numbers)) => numbers.clone(),
        _ => vec![f64::NAN; count],
    });
    ColumnValues::Numbers(values.collect())
}

/// The texts of a column, with numbers as texts.
fn texts<'a>(parts: impl Iterator<Item = (Option<&'a ColumnValues>, usize)>) -> ColumnValues {
    let mut texts = LabelsBuilder::default();
    for (values, count) in parts {
        match values {
            Some(ColumnValues::Labels(labels)) => {
                let renumbered: Vec<u32> = labels.names.iter().map(|name| texts.index(name.as_bytes())).collect();
                let of = |index: &u32| renumbered.get(*index as usize).copied().unwrap_or(u32::MAX);
                texts.indices.extend(labels.indices.iter().map(of));
            }
            Some(ColumnValues::Numbers(numbers)) => {
                for number in numbers {
                    texts.push(number.to_string().as_bytes());
                }
            }
            None => {
                let empty = texts.index(b"");
                texts.indices.resize(texts.indices.len() + count, empty);
            }
        }
    }
    texts.into_values()
}
