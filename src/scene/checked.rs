//! The checked appearance of a scene, with data that is derived from it, such as the table of materials that renderers use.

use std::collections::HashMap;
use std::ops::Deref;
use std::sync::OnceLock;

use super::appearance::{Appearance, Colors};
use crate::image::color::LinearRgb;
use crate::scene::material::{Material, SurfaceProperties};

/// An appearance that has been checked for `count` spheres. Derived data is computed when it is first needed.
#[derive(Clone, Debug)]
pub(crate) struct SceneAppearance {
    pub(super) appearance: Appearance,
    count: usize,
    pub(super) material_table: OnceLock<MaterialTable>,
    pub(super) is_opaque: OnceLock<bool>,
}

impl Deref for SceneAppearance {
    type Target = Appearance;

    fn deref(&self) -> &Appearance {
        &self.appearance
    }
}

impl SceneAppearance {
    pub(crate) fn new(appearance: Appearance, count: usize) -> Self {
        Self { appearance, count, material_table: OnceLock::new(), is_opaque: OnceLock::new() }
    }

    /// The appearance without the derived data.
    pub(super) fn into_inner(self) -> Appearance {
        self.appearance
    }

    /// The number of spheres.
    pub(crate) fn sphere_count(&self) -> usize {
        self.count
    }

    /// The colour of a sphere, whose index must be valid.
    pub(crate) fn color_of(&self, id: u32) -> LinearRgb {
        self.color(id).unwrap_or(LinearRgb::BLACK)
    }

    /// The index of a sphere's surface properties.
    pub(crate) fn surface_index(&self, id: u32) -> u32 {
        self.surface_indices().map_or(0, |indices| indices[id as usize])
    }

    /// The surface properties of a sphere of this scene, with the alpha of its colour.
    pub(crate) fn surface_of(&self, id: u32) -> SurfaceProperties {
        let SurfaceProperties { material, opacity } =
            self.surfaces()[self.surface_index(id) as usize];
        SurfaceProperties { material, opacity: opacity * self.alpha(id) }
    }

    /// Whether all spheres are opaque.
    pub(crate) fn is_opaque(&self) -> bool {
        *self.is_opaque.get_or_init(|| {
            let has_alpha = match self.colors() {
                Colors::Rgba8(colors) => colors.iter().any(|[_, _, _, alpha]| *alpha < u8::MAX),
                Colors::One(_) | Colors::Palette { .. } | Colors::Scalars { .. } => false,
            };
            !has_alpha && self.surfaces().iter().all(|surface| surface.opacity >= 1.0)
        })
    }

    fn material_table(&self) -> &MaterialTable {
        self.material_table.get_or_init(|| MaterialTable::of(self))
    }

    /// The rows of the material table.
    pub(crate) fn material_rows(&self) -> &[MaterialRow] {
        self.material_table().rows()
    }

    /// The index of a sphere's material in the rows of the material table.
    pub(crate) fn material_row(&self, id: u32) -> u32 {
        self.material_table().index(id).unwrap_or_else(|| self.surface_index(id))
    }
}

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
pub(super) struct MaterialTable {
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
    fn of(appearance: &SceneAppearance) -> Self {
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
    fn rows(&self) -> &[MaterialRow] {
        &self.rows
    }

    fn index(&self, id: u32) -> Option<u32> {
        self.indices.as_ref().map(|indices| indices[id as usize])
    }
}
