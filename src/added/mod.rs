//! Spheres that are added to those of data: the edges of the periodic cell, and bonds between atoms.
//!
//! An edge or a bond is a string of spheres that overlap so far that it looks like a stick. They come after the spheres
//! of the data, whose indices stay as they are, and do not count for what follows from the data, such as the range of
//! colours. [`Additions`] says what is wanted; [`Mapping::scene_with`](crate::color_by::Mapping::scene_with) makes a scene
//! with it.

mod bonds;
mod cell_edges;
mod error;
mod pairs;
mod spheres;
mod string;

use crate::load::{ColumnValues, Loaded};
use crate::scene::sphere_array::SphereArray;

pub use bonds::{BondLength, Bonds};
pub use cell_edges::CellEdges;
pub use error::AddError;
pub use spheres::Added;
pub(crate) use spheres::Base;

/// What is added to the spheres of data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Additions {
    /// The edges of the periodic cell.
    pub cell: Option<CellEdges>,
    /// Bonds between atoms.
    pub bonds: Option<Bonds>,
    /// Whether spheres keep their radii with bonds, because the user chose them. Others become smaller: atoms of elements
    /// by the factor 0.25, others by 0.5, so that the sticks between them can be seen.
    pub keeps_radii: bool,
}

impl Additions {
    /// Whether nothing is added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cell.is_none() && self.bonds.is_none()
    }

    /// The factor by which bonds make a sphere of a species smaller, if the user did not choose its radius.
    pub(crate) fn radius_factor(&self, species: Option<&str>) -> f64 {
        match &self.bonds {
            Some(_) if !self.keeps_radii => bonds::radius_factor(species),
            _ => 1.0,
        }
    }

    /// Makes spheres of data smaller, if bonds need it and the user did not choose the radii.
    pub(crate) fn shrink(&self, loaded: &mut Loaded) {
        if self.bonds.is_none() || self.keeps_radii {
            return;
        }
        let labels = loaded.columns.iter().find_map(|column| match &column.values {
            ColumnValues::Labels(labels) if column.name == "species" => Some(labels),
            _ => None,
        });
        let factor_of = |name: &String| bonds::radius_factor(Some(name));
        let factors: Vec<f64> =
            labels.map(|labels| labels.names.iter().map(factor_of).collect()).unwrap_or_default();
        let indices = labels.map_or(&[][..], |labels| &labels.indices);
        let other = bonds::radius_factor(None);
        let factor = |row: usize| {
            let species = indices.get(row).and_then(|index| factors.get(*index as usize));
            species.copied().unwrap_or(other)
        };
        match &mut loaded.spheres {
            SphereArray::F32(spheres) => spheres.iter_mut().enumerate().for_each(|(row, s)| {
                s[3] = (f64::from(s[3]) * factor(row)) as f32;
            }),
            SphereArray::F64(spheres) => {
                spheres.iter_mut().enumerate().for_each(|(row, s)| s[3] *= factor(row));
            }
        }
    }

    /// Makes the spheres that are added to others.
    pub(crate) fn add(&self, base: &Base<'_>) -> Result<Added, AddError> {
        let mut added = Added::default();
        if let Some(bonds) = &self.bonds {
            bonds.add(base, &mut added)?;
        }
        if let Some(edges) = &self.cell {
            edges.add(base, &mut added)?;
        }
        Ok(added)
    }
}
