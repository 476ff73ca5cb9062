//! Joins positions from a trajectory with what another file, the topology, says about the spheres.

use std::path::PathBuf;

use super::error::LoadError;
use super::format::Options;
use super::loaded::{Column, Loaded};
use super::open::open;
use crate::scene::sphere_array::SphereArray;

/// An error of joining a trajectory with its topology.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TopologyError {
    /// No topology was given.
    #[error(
        "a {format} file has positions alone; give a topology, a file that says what the atoms are, such as the .pdb \
         or .xyz file of the same system"
    )]
    Missing {
        /// Name of the trajectory's format.
        format: &'static str,
    },
    /// The topology cannot be read.
    #[error("the topology {}: {error}", path.display())]
    Unreadable {
        /// The path of the topology.
        path: PathBuf,
        /// Why it cannot be read.
        error: Box<LoadError>,
    },
    /// The topology has more or fewer atoms.
    #[error(
        "frame {frame} has {atoms} atoms, but the topology {} has {found}; use a file of the same system as the \
         topology, with all of its atoms",
        path.display()
    )]
    Count {
        /// Index of the frame, from 0.
        frame: usize,
        /// Number of atoms of the frame.
        atoms: usize,
        /// The path of the topology.
        path: PathBuf,
        /// Number of atoms of the topology.
        found: usize,
    },
}

/// What the spheres of a trajectory are.
#[derive(Debug)]
pub(super) struct Topology {
    path: PathBuf,
    loaded: Loaded,
}

/// What a frame of a trajectory has.
#[derive(Debug, Default)]
pub(super) struct Positions {
    /// In Å.
    pub(super) centers: Vec<[f64; 3]>,
    pub(super) cell: Option<[[f64; 3]; 3]>,
    pub(super) columns: Vec<Column>,
}

impl Topology {
    /// Reads the first frame of the file that the options name.
    pub(super) fn open(options: &Options, format: &'static str) -> Result<Self, LoadError> {
        let path = options.topology.as_deref().ok_or(TopologyError::Missing { format })?;
        let loaded = open(path, &Options::default()).map_err(|error| {
            let error = match error {
                LoadError::File { error, .. } => LoadError::Io(error),
                other => other,
            };
            TopologyError::Unreadable { path: path.to_path_buf(), error: error.into() }
        })?;
        Ok(Self { path: path.to_path_buf(), loaded })
    }

    /// Checks that a frame has as many atoms as the topology.
    pub(super) fn check(&self, frame: usize, atoms: usize) -> Result<(), TopologyError> {
        let found = self.loaded.spheres.len();
        if atoms == found {
            return Ok(());
        }
        Err(TopologyError::Count { frame, atoms, path: self.path.clone(), found })
    }

    /// Returns the spheres of a frame: radii, colours and columns are those of the topology; positions, cell and further
    /// columns are those of the frame.
    pub(super) fn join(&self, frame: usize, positions: Positions) -> Result<Loaded, LoadError> {
        let Positions { centers, cell, columns } = positions;
        self.check(frame, centers.len())?;
        let radius = |index: usize| self.loaded.spheres.at(index)[3];
        let spheres = centers.iter().enumerate().map(|(i, [x, y, z])| [*x, *y, *z, radius(i)]);
        let mut loaded = Loaded::new(SphereArray::F64(spheres.collect()));
        loaded.colors.clone_from(&self.loaded.colors);
        loaded.opacities.clone_from(&self.loaded.opacities);
        let is_new = |column: &&Column| columns.iter().all(|new| new.name != column.name);
        loaded.columns = self.loaded.columns.iter().filter(is_new).cloned().collect();
        loaded.columns.extend(columns);
        loaded.cell = cell;
        let named = |note: &String| format!("the topology {}: {note}", self.path.display());
        loaded.notes = self.loaded.notes.iter().map(named).collect();
        loaded.unknown.clone_from(&self.loaded.unknown);
        Ok(loaded)
    }
}
