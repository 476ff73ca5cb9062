//! Data from arrays, which have the meaning of the columns of a file.

use super::atoms::species_of;
use super::bonds;
use super::dataset::labels_in;
use super::table::{Table, TableColumn, is_element};
use super::{Column, ColumnValues, Dataset, LoadError, Options};
use pinhole::image::color::LinearRgb;
use pinhole::scene::sphere_array::SphereArray;

impl Dataset {
    /// Makes spheres with the columns of arrays. A column of chemical elements gives radii to spheres that have none, and
    /// colours where `colors` is `None`, as that of a file does; so do names of atoms and residues. Other spheres
    /// without radii all get one with which neighbours about touch, and a note has it.
    ///
    /// # Errors
    /// Returns an error if the data cannot be used.
    pub fn of_columns(
        spheres: SphereArray,
        have_radii: bool,
        colors: Option<Vec<LinearRgb>>,
        mut columns: Vec<Column>,
    ) -> Result<Self, LoadError> {
        let elements = columns.iter_mut().find(|column| is_element(&column.name));
        match elements {
            Some(column) if matches!(column.values, ColumnValues::Labels(_)) => "species".clone_into(&mut column.name),
            Some(_) => {}
            None => {
                let found = species_of(&columns).map(ColumnValues::Labels);
                columns.extend(found.map(|values| Column { name: "species".to_owned(), values }));
            }
        }
        let species = labels_in(&columns, "species").map(|labels| TableColumn::labels("species", labels.clone()));
        let table = Table { columns: species.into_iter().collect() };
        let mut loaded = table.dress(spheres, have_radii, &Options::default())?;
        loaded.correct_notes(colors.is_some(), false, |_| false);
        loaded.colors = colors.or(loaded.colors);
        loaded.columns = columns;
        Ok(loaded)
    }

    /// Adds all bonds that there are: pairs of indices of spheres, in any order.
    pub fn set_bonds(&mut self, pairs: impl IntoIterator<Item = [u32; 2]>) {
        (self.bonds, self.has_all_bonds) = (bonds::ordered(pairs), true);
    }

    /// The spheres with these indices, in this order, with all their values. Bonds stay if no index occurs twice. Indices
    /// that no sphere has are left out.
    #[must_use]
    pub fn taken(mut self, indices: &[u32]) -> Self {
        let mut new = vec![u32::MAX; self.spheres.len()];
        let mut is_several = false;
        for (place, index) in (0..).zip(indices) {
            if let Some(new) = new.get_mut(*index as usize) {
                is_several |= *new != u32::MAX;
                *new = place;
            }
        }
        let pairs = std::mem::take(&mut self.bonds);
        let kept = pairs.iter().map(|pair| pair.map(|end| new.get(end as usize).copied().unwrap_or(u32::MAX)));
        let kept = kept.filter(|pair| !is_several && !pair.contains(&u32::MAX));
        let kept = bonds::ordered(kept);
        self.repeat(indices);
        self.bonds = kept;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::Labels;

    fn labels(name: &str, texts: &[&str]) -> Column {
        let mut names: Vec<String> = Vec::new();
        let index = |text: &&str| {
            let found = names.iter().position(|name| name == text).unwrap_or(names.len());
            if found == names.len() {
                names.push((*text).to_owned());
            }
            found as u32
        };
        let indices = texts.iter().map(index).collect();
        Column { name: name.to_owned(), values: ColumnValues::Labels(Labels { names, indices }) }
    }

    fn water() -> SphereArray {
        SphereArray::F64(vec![[0.0; 4], [0.96, 0.0, 0.0, 0.0], [-0.24, 0.93, 0.0, 0.0]])
    }

    #[test]
    fn elements_give_radii_and_colors() {
        let loaded = Dataset::of_columns(water(), false, None, vec![labels("element", &["O", "H", "H"])]).unwrap();
        let radii: Vec<String> = (0..3).map(|index| loaded.spheres.at(index)[3].to_string()).collect();
        assert_eq!(radii, ["1.5", "1.2", "1.2"]);
        assert_eq!(loaded.colors.as_ref().map(Vec::len), Some(3));
        assert_eq!(loaded.columns[0].name, "species");
        let names = vec![labels("name", &["OW", "HW1", "HW2"]), labels("residue", &["SOL", "SOL", "SOL"])];
        let by_names = Dataset::of_columns(water(), false, None, names).unwrap();
        assert_eq!((by_names.colors, by_names.spheres), (loaded.colors, loaded.spheres));
        let one = Dataset::of_columns(water(), false, None, vec![labels("kind", &["O", "H", "H"])]).unwrap();
        assert!(one.colors.is_none() && one.notes.len() == 1, "{:?}", one.notes);
    }

    #[test]
    fn taken_spheres_keep_their_bonds() {
        let mut loaded = Dataset::of_columns(water(), false, None, vec![labels("element", &["O", "H", "H"])]).unwrap();
        loaded.set_bonds([[1, 0], [0, 2], [0, 1], [1, 1]]);
        assert_eq!(loaded.bonds, [[0, 1], [0, 2]]);
        let part = loaded.clone().taken(&[2, 0]);
        assert_eq!((part.spheres.len(), part.bonds.as_slice()), (2, [[0, 1]].as_slice()));
        assert_eq!(part.labels("species").unwrap().indices, [1, 0]);
        assert!(loaded.taken(&[0, 1, 1]).bonds.is_empty());
    }
}
