//! The checked appearance of a scene, with data that is derived from it.

use std::ops::{Deref, Range};
use std::sync::OnceLock;

use super::appearance::{Appearance, Colors};
use super::material_table::{MaterialRow, MaterialTable};
use super::update::NewColors;
use crate::image::color::LinearRgb;
use crate::scene::material::SurfaceProperties;

/// An appearance that has been checked for `count` spheres. Derived data is computed when it is first needed.
#[derive(Clone, Debug)]
pub(crate) struct SceneAppearance {
    appearance: Appearance,
    count: usize,
    material_table: OnceLock<MaterialTable>,
    is_opaque: OnceLock<bool>,
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

    /// Replaces the colours of some spheres. The new colours have been checked and are of the same kind.
    pub(super) fn set_colors(&mut self, range: Range<usize>, new: &NewColors<'_>) {
        match (&mut self.appearance.colors, new) {
            (Colors::Palette { indices, .. }, NewColors::Palette(new)) => {
                indices[range].copy_from_slice(new);
            }
            (Colors::Rgba8(colors), NewColors::Rgba8(new)) => colors[range].copy_from_slice(new),
            (Colors::Scalars { values, .. }, NewColors::Scalars(new)) => {
                values[range].copy_from_slice(new);
            }
            _ => {}
        }
        (self.material_table, self.is_opaque) = (OnceLock::new(), OnceLock::new());
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
