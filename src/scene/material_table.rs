//! The table of the materials of a scene's spheres, as renderers use it.

use std::collections::HashMap;

use super::checked::SceneAppearance;
use crate::image::color::LinearRgb;
use crate::scene::material::{Material, SurfaceProperties};

/// The content of one row of the material table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MaterialRow {
    /// The surface properties, whose opacity is still to be multiplied by the alpha of the sphere's colour.
    pub(crate) surface: SurfaceProperties,
    /// The colour of a material that absorbs light inside, which depends on it; white for all others.
    pub(crate) color: LinearRgb,
}

/// All rows, and the assignment of rows to spheres.
#[derive(Clone, Debug)]
pub(crate) struct MaterialTable {
    rows: Vec<MaterialRow>,
    /// For every sphere, the index of its row; `None` if that is the index of its surface properties.
    indices: Option<Vec<u32>>,
}

/// Whether the surface belongs to a material whose colour determines the absorption inside.
fn absorbs(surface: &SurfaceProperties) -> bool {
    matches!(surface.material, Material::Dielectric { attenuation_distance: Some(_), .. })
}

impl MaterialTable {
    /// Makes one row for each set of surface properties; if its material absorbs light, one for each colour that occurs
    /// with it.
    pub(super) fn of(appearance: &SceneAppearance) -> Self {
        let surfaces = appearance.surfaces();
        let mut rows: Vec<MaterialRow> = surfaces
            .iter()
            .map(|surface| MaterialRow { surface: *surface, color: LinearRgb::WHITE })
            .collect();
        if !surfaces.iter().any(absorbs) {
            return Self { rows, indices: None };
        }
        let mut has_first = vec![false; surfaces.len()];
        let mut indices = HashMap::new();
        let indices = (0..appearance.sphere_count() as u32).map(|id| {
            let index = appearance.surface_index(id);
            let surface = &surfaces[index as usize];
            if !absorbs(surface) {
                return index;
            }
            let color = appearance.color_of(id);
            let key = (index, color.to_array().map(f32::to_bits));
            *indices.entry(key).or_insert_with(|| {
                let row = MaterialRow { surface: *surface, color };
                // The first colour uses the row of the surface properties.
                if std::mem::replace(&mut has_first[index as usize], true) {
                    rows.push(row);
                    return rows.len() as u32 - 1;
                }
                rows[index as usize] = row;
                index
            })
        });
        let indices: Vec<u32> = indices.collect();
        let differ = rows.len() > surfaces.len();
        Self { rows, indices: differ.then_some(indices) }
    }

    /// All rows of the table.
    pub(crate) fn rows(&self) -> &[MaterialRow] {
        &self.rows
    }

    pub(super) fn index(&self, id: u32) -> Option<u32> {
        self.indices.as_ref().map(|indices| indices[id as usize])
    }
}
