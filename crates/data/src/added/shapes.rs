//! The shapes that are added to the spheres of data, their colours and surfaces, and the error of adding them.

use glam::DVec3;

use pinhole::image::color::LinearRgb;
use pinhole::scene::cone::{Cone, ConeError};
use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::sphere_array::SphereArray;
use pinhole::scene::{Appearance, Colors};

/// The shapes that were added: the corners of the cell, which are spheres behind those of the data, and sticks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AddedShapes {
    pub(super) corners: Vec<[f64; 4]>,
    sticks: Vec<Cone>,
    /// The look of each stick.
    looks: Vec<Look>,
    pub(super) bonds: usize,
    pub(super) arrow_key: Option<ArrowKey>,
    pub(super) notes: Vec<String>,
}

/// The meaning of the arrows of a picture.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ArrowKey {
    /// The name of the vector, spelled as in the data.
    pub name: String,
    /// The length of an arrow, in scene units, for a vector of length 1.
    pub scale: f64,
    /// The colour.
    pub color: LinearRgb,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Look {
    /// Like the sphere of the data with this index.
    Sphere(u32),
    /// Matt and opaque, in this colour.
    Color(LinearRgb),
}

impl Look {
    /// The look of edges of the cell: a dark grey, near that of outlines, which are as wide as an edge.
    pub(super) fn of_edges() -> Self {
        Self::Color(LinearRgb::from_srgb8([0x33, 0x38, 0x3f]))
    }
}

impl AddedShapes {
    /// Returns true if no shapes were added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sticks.is_empty() && self.corners.is_empty()
    }

    /// The number of added spheres.
    #[must_use]
    pub fn sphere_count(&self) -> usize {
        self.corners.len()
    }

    /// The sticks of bonds, then the edges of the cell, and then the parts of arrows.
    #[must_use]
    pub fn sticks(&self) -> &[Cone] {
        &self.sticks
    }

    /// The number of bonds. It includes bonds that lie within spheres and need no stick.
    #[must_use]
    pub fn bonds(&self) -> usize {
        self.bonds
    }

    /// The meaning of the arrows, if there are any.
    #[must_use]
    pub fn arrow_key(&self) -> Option<&ArrowKey> {
        self.arrow_key.as_ref()
    }

    /// Notes for the user, one line each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Adds a cylinder or a cone. An error if it is out of range.
    pub(super) fn push(&mut self, stick: Cone, look: Look) -> Result<(), ConeError> {
        stick.check()?;
        self.sticks.push(stick);
        self.looks.push(look);
        Ok(())
    }

    /// Appends the spheres to an array.
    pub fn extend_array(&self, array: &mut SphereArray) {
        match array {
            SphereArray::F32(all) => {
                all.extend(self.corners.iter().map(|sphere| sphere.map(|value| value as f32)));
            }
            SphereArray::F64(all) => all.extend_from_slice(&self.corners),
        }
    }

    /// Returns the look of `count` spheres of the data, followed by the look of the added spheres and of the sticks.
    /// Sticks of shining spheres are matt.
    #[must_use]
    pub fn extend_appearance(&self, appearance: &Appearance, count: usize) -> Appearance {
        let (mut palette, mut colors) = match appearance.colors() {
            Colors::Palette { palette, indices } => (palette.clone(), indices.clone()),
            Colors::One(color) => (vec![*color], vec![0; count]),
            _ => ((0..count as u32).filter_map(|id| appearance.color(id)).collect(), (0..count as u32).collect()),
        };
        let mut surfaces = appearance.surfaces().to_vec();
        let mut indices = appearance.surface_indices().map_or_else(|| vec![0; count], <[u32]>::to_vec);
        let own_surface = surfaces.len() as u32;
        surfaces.push(SurfaceProperties::default());
        // Few colours are added, one after the other.
        let mut own_color = |color: LinearRgb| {
            if palette.last() != Some(&color) {
                palette.push(color);
            }
            palette.len() as u32 - 1
        };
        let matt: Vec<u32> = (0..surfaces.len()).map(|index| matt(&mut surfaces, index)).collect();
        let of_corners = std::iter::repeat_n(Look::of_edges(), self.corners.len());
        for look in of_corners.chain(self.looks.iter().copied()) {
            let (color, surface) = match look {
                Look::Sphere(id) => [&colors, &indices].map(|all| all.get(id as usize).copied().unwrap_or_default()),
                Look::Color(color) => [own_color(color), own_surface],
            }
            .into();
            colors.push(color);
            indices.push(matt.get(surface as usize).copied().unwrap_or(surface));
        }
        Appearance::new(Colors::Palette { palette, indices: colors }).with_surfaces(surfaces, indices)
    }
}

/// The index of surface properties without light. They are listed behind the others if those at this index shine.
fn matt(surfaces: &mut Vec<SurfaceProperties>, index: usize) -> u32 {
    let SurfaceProperties { material, opacity } = surfaces[index];
    if !matches!(material, Material::Emissive { .. }) {
        return index as u32;
    }
    surfaces.push(SurfaceProperties { opacity, ..SurfaceProperties::default() });
    surfaces.len() as u32 - 1
}

/// A cylinder between two points.
pub(super) fn between([start, end]: [DVec3; 2], radius: f64) -> Cone {
    Cone::cylinder(start.to_array(), end.to_array(), radius)
}

/// The reason why shapes cannot be added to the spheres of data, on one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct AddError(pub(super) String);
