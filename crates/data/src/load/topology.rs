//! Joins positions from a trajectory with the topology, another file that describes the spheres.

use std::path::PathBuf;

use super::dataset::{Column, Dataset};
use super::error::{LoadError, LoadErrorKind};
use pinhole::scene::sphere_array::SphereArray;

/// The descriptions of the spheres of a trajectory.
#[derive(Debug)]
pub(super) struct Topology {
    path: PathBuf,
    loaded: Dataset,
}

#[derive(Debug, Default)]
pub(super) struct Positions {
    /// Centres in Å.
    pub(super) centers: Vec<[f64; 3]>,
    pub(super) cell: Option<[[f64; 3]; 3]>,
    pub(super) columns: Vec<Column>,
}

impl Topology {
    pub(super) fn new(path: PathBuf, loaded: Dataset) -> Self {
        Self { path, loaded }
    }

    /// Returns the topology, or an error if it was not given, because a file of this format cannot be read without.
    pub(super) fn required(given: Option<Self>, format: &str) -> Result<Self, LoadError> {
        given.ok_or_else(|| {
            let message = format!(
                "a {format} file has positions alone; give a topology, a file that says what the atoms are, such as the \
                 .pdb or .gro file of the same system"
            );
            LoadError::new(message).of_kind(LoadErrorKind::NoTopology)
        })
    }

    pub(super) fn check(&self, frame: usize, atoms: usize) -> Result<(), LoadError> {
        let found = self.loaded.spheres.len();
        if atoms == found {
            return Ok(());
        }
        Err(LoadError::new(format!(
            "frame {frame} has {atoms} atoms, but the topology {} has {found}; use a file of the same system as the \
             topology, with all of its atoms",
            self.path.display()
        )))
    }

    /// Returns the spheres of a frame. Radii, colours, bonds and columns are those of the topology, but for its velocities,
    /// which belong to another frame. Positions, cell and further columns are those of the frame.
    pub(super) fn join(&self, frame: usize, positions: Positions) -> Result<Dataset, LoadError> {
        let Positions { centers, cell, columns } = positions;
        self.check(frame, centers.len())?;
        let radius = |index: usize| self.loaded.spheres.at(index)[3];
        let spheres = centers.iter().enumerate().map(|(i, [x, y, z])| [*x, *y, *z, radius(i)]);
        let mut loaded = Dataset::new(SphereArray::F64(spheres.collect()));
        loaded.colors.clone_from(&self.loaded.colors);
        loaded.opacities.clone_from(&self.loaded.opacities);
        let stays = |column: &&Column| {
            columns.iter().all(|new| new.name != column.name) && !column.name.starts_with("velocity.")
        };
        loaded.columns = self.loaded.columns.iter().filter(stays).cloned().collect();
        loaded.columns.extend(columns);
        loaded.cell = cell;
        loaded.bonds.clone_from(&self.loaded.bonds);
        loaded.has_all_bonds = self.loaded.has_all_bonds;
        let named = |note: &String| format!("the topology {}: {note}", self.path.display());
        loaded.notes = self.loaded.notes.iter().map(named).collect();
        loaded.unknown.clone_from(&self.loaded.unknown);
        Ok(loaded)
    }
}
