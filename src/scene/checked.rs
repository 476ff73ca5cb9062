//! What the spheres of a scene look like, with what follows from it.

use std::ops::{Deref, Range};
use std::sync::OnceLock;

use super::appearance::{Appearance, Colors};
use super::surfaces::{Surface, Surfaces};
use super::update::NewColors;
use crate::image::color::LinearRgb;
use crate::scene::material::Finish;

/// The appearance of so many spheres, which has been checked. What follows from it is found out when it is first asked
/// for.
#[derive(Clone, Debug)]
pub(crate) struct SceneAppearance {
    appearance: Appearance,
    count: usize,
    surfaces: OnceLock<Surfaces>,
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
        Self { appearance, count, surfaces: OnceLock::new(), is_opaque: OnceLock::new() }
    }

    /// Gives some spheres other colours, which have been checked and are of the same kind.
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
        (self.surfaces, self.is_opaque) = (OnceLock::new(), OnceLock::new());
    }

    /// The appearance alone.
    pub(super) fn into_inner(self) -> Appearance {
        self.appearance
    }

    /// Of how many spheres it is.
    pub(crate) fn sphere_count(&self) -> usize {
        self.count
    }

    /// The colour of a sphere that there is.
    pub(crate) fn color_of(&self, id: u32) -> LinearRgb {
        self.color(id).unwrap_or(LinearRgb::BLACK)
    }

    /// The place of a sphere's finish.
    pub(crate) fn finish_index(&self, id: u32) -> u32 {
        self.finish_indices().map_or(0, |indices| indices[id as usize])
    }

    /// The finish of a sphere that there is, with the alpha of its colour.
    pub(crate) fn finish_of(&self, id: u32) -> Finish {
        let Finish { material, opacity } = self.finishes()[self.finish_index(id) as usize];
        Finish { material, opacity: opacity * self.alpha(id) }
    }

    /// Whether nothing is seen through any sphere.
    pub(crate) fn is_opaque(&self) -> bool {
        *self.is_opaque.get_or_init(|| {
            let has_alpha = match self.colors() {
                Colors::Rgba8(colors) => colors.iter().any(|[_, _, _, alpha]| *alpha < u8::MAX),
                Colors::One(_) | Colors::Palette { .. } | Colors::Scalars { .. } => false,
            };
            !has_alpha && self.finishes().iter().all(|finish| finish.opacity >= 1.0)
        })
    }

    fn all_surfaces(&self) -> &Surfaces {
        self.surfaces.get_or_init(|| Surfaces::of(self))
    }

    /// The rows of a table of all materials.
    pub(crate) fn surfaces(&self) -> &[Surface] {
        self.all_surfaces().rows()
    }

    /// The row of a sphere's material among them.
    pub(crate) fn surface_index(&self, id: u32) -> u32 {
        self.all_surfaces().index(id).unwrap_or_else(|| self.finish_index(id))
    }
}
