//! The materials that a scene's spheres have, as tables of renderers list them.

use std::collections::HashMap;

use super::checked::SceneAppearance;
use crate::image::color::LinearRgb;
use crate::scene::material::{Material, SurfaceProperties};

/// What one row of a table of materials is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MaterialRow {
    /// Its opacity is to be multiplied by the alpha of the sphere's colour.
    pub(crate) surface: SurfaceProperties,
    /// Of a material that absorbs light inside, which depends on the colour; else white.
    pub(crate) color: LinearRgb,
}

/// All rows, and which of them every sphere has.
#[derive(Clone, Debug)]
pub(crate) struct MaterialTable {
    rows: Vec<MaterialRow>,
    /// `None` where they are the indices of surface properties.
    indices: Option<Vec<u32>>,
}

/// Whether the colour decides how much light is absorbed inside.
fn absorbs(surface: &SurfaceProperties) -> bool {
    matches!(surface.material, Material::Dielectric { attenuation_distance: Some(_), .. })
}

impl MaterialTable {
    /// One row for each set of surface properties; where these absorb light, one for each colour they have.
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
                // The first colour takes the row of the surface properties.
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

    /// All rows.
    pub(crate) fn rows(&self) -> &[MaterialRow] {
        &self.rows
    }

    pub(super) fn index(&self, id: u32) -> Option<u32> {
        self.indices.as_ref().map(|indices| indices[id as usize])
    }
}
