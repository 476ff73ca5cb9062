//! The materials that a scene's spheres have, as tables of renderers list them.

use std::collections::HashMap;

use super::checked::SceneAppearance;
use crate::image::color::LinearRgb;
use crate::scene::material::{Finish, Material};

/// What one row of a table of materials is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Surface {
    /// Its opacity is to be multiplied by the alpha of the sphere's colour.
    pub(crate) finish: Finish,
    /// Of a material that absorbs light inside, which depends on the colour; else white.
    pub(crate) color: LinearRgb,
}

/// All rows, and which of them every sphere has.
#[derive(Clone, Debug)]
pub(crate) struct Surfaces {
    rows: Vec<Surface>,
    /// Only where they are not the places of finishes.
    indices: Option<Vec<u32>>,
}

/// Whether the colour decides how much light is absorbed inside.
fn absorbs(finish: &Finish) -> bool {
    matches!(finish.material, Material::Dielectric { attenuation_distance: Some(_), .. })
}

impl Surfaces {
    /// One row for every finish; for one that absorbs light, as many as it has colours.
    pub(super) fn of(appearance: &SceneAppearance) -> Self {
        let finishes = appearance.finishes();
        let mut rows: Vec<Surface> = finishes
            .iter()
            .map(|finish| Surface { finish: *finish, color: LinearRgb::WHITE })
            .collect();
        if !finishes.iter().any(absorbs) {
            return Self { rows, indices: None };
        }
        let mut has_first = vec![false; finishes.len()];
        let mut places = HashMap::new();
        let indices = (0..appearance.sphere_count() as u32).map(|id| {
            let index = appearance.finish_index(id);
            let finish = &finishes[index as usize];
            if !absorbs(finish) {
                return index;
            }
            let color = appearance.color_of(id);
            let key = (index, color.to_array().map(f32::to_bits));
            *places.entry(key).or_insert_with(|| {
                let row = Surface { finish: *finish, color };
                // The first colour takes the finish's own row.
                if std::mem::replace(&mut has_first[index as usize], true) {
                    rows.push(row);
                    return rows.len() as u32 - 1;
                }
                rows[index as usize] = row;
                index
            })
        });
        let indices: Vec<u32> = indices.collect();
        let differ = rows.len() > finishes.len();
        Self { rows, indices: differ.then_some(indices) }
    }

    /// All rows.
    pub(crate) fn rows(&self) -> &[Surface] {
        &self.rows
    }

    pub(super) fn index(&self, id: u32) -> Option<u32> {
        self.indices.as_ref().map(|indices| indices[id as usize])
    }
}
