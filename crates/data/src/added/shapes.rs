//! The shapes that are added to the spheres of data, their colours and surfaces, and the error of adding them.

use glam::DVec3;

use pinhole::image::color::LinearRgb;
use pinhole::scene::cone::{Cone, ConeError};
use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::sphere_array::SphereArray;
use pinhole::scene::tube::Tube;
use pinhole::scene::{Appearance, Colors};

/// The shapes that were added: the corners of the cell, which are spheres behind those of the data, and sticks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AddedShapes {
    /// Spheres: the corners of the cell, and those between the pieces of tubes.
    pub(super) balls: Vec<([f64; 4], Look)>,
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
    /// In this colour, with these surface properties.
    Own(LinearRgb, SurfaceProperties),
}

impl Look {
    /// The look of edges of the cell: a dark grey, near that of outlines, which are as wide as an edge.
    pub(super) fn of_edges() -> Self {
        Self::of_color(LinearRgb::from_srgb8([0x33, 0x38, 0x3f]))
    }

    /// Matt and opaque, in this colour.
    pub(super) fn of_color(color: LinearRgb) -> Self {
        Self::Own(color, SurfaceProperties::default())
    }
}

impl AddedShapes {
    /// Returns true if no shapes were added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sticks.is_empty() && self.balls.is_empty()
    }

    /// The number of added spheres.
    #[must_use]
    pub fn sphere_count(&self) -> usize {
        self.balls.len()
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
                all.extend(self.balls.iter().map(|(sphere, _)| sphere.map(|value| value as f32)));
            }
            SphereArray::F64(all) => all.extend(self.balls.iter().map(|(sphere, _)| *sphere)),
        }
    }

    /// Returns the look of `count` spheres of the data without those that are not kept, followed by the look of the added
    /// spheres and of the sticks. Sticks and tubes of shining spheres are matt.
    #[must_use]
    pub fn extend_appearance(
        &self,
        appearance: &Appearance,
        count: usize,
        is_kept: impl Fn(usize) -> bool,
    ) -> Appearance {
        let (mut palette, colors) = match appearance.colors() {
            Colors::Palette { palette, indices } => (palette.clone(), indices.clone()),
            Colors::One(color) => (vec![*color], vec![0; count]),
            _ => ((0..count as u32).filter_map(|id| appearance.color(id)).collect(), (0..count as u32).collect()),
        };
        let mut surfaces = appearance.surfaces().to_vec();
        let of_spheres = appearance.surface_indices().map_or_else(|| vec![0; count], <[u32]>::to_vec);
        // Few looks are added, one after the other.
        let (from, mut last) = (surfaces.len(), (None, 0, 0));
        let all = self.balls.iter().map(|(_, look)| *look).chain(self.looks.iter().copied());
        let added: Vec<[u32; 2]> = all
            .map(|look| {
                let (color, surface) = match look {
                    Look::Sphere(id) => {
                        return [&colors, &of_spheres].map(|all| all.get(id as usize).copied().unwrap_or_default());
                    }
                    Look::Own(color, surface) => (color, surface),
                };
                if last.0 != Some(color) {
                    palette.push(color);
                    (last.0, last.1) = (Some(color), palette.len() as u32 - 1);
                }
                let known = surfaces[from..].iter().position(|known| *known == surface);
                last.2 = known.map_or(surfaces.len(), |known| from + known) as u32;
                if known.is_none() {
                    surfaces.push(surface);
                }
                [last.1, last.2]
            })
            .collect();
        let matt: Vec<u32> = (0..surfaces.len()).map(|index| matt(&mut surfaces, index)).collect();
        let kept = (0..count).filter(|index| is_kept(*index)).map(|index| [colors[index], of_spheres[index]]);
        let added = added.iter().map(|[color, surface]| [*color, matt[*surface as usize]]);
        let (colors, indices) = kept.chain(added).map(|[color, surface]| (color, surface)).unzip();
        Appearance::new(Colors::Palette { palette, indices: colors }).with_surfaces(surfaces, indices)
    }

    /// Adds a tube through points. `look` is that at each point.
    pub(crate) fn push_tube(
        &mut self,
        tube: &Tube,
        points: &[[f64; 4]],
        look: impl Fn(usize) -> (LinearRgb, SurfaceProperties),
    ) -> Result<(), AddError> {
        let place = |point: &[f64]| DVec3::from_slice(&point[..3]);
        // The point that is nearest to a piece. Pieces and points are in the same order.
        let walk = || {
            let mut at = 0;
            move |piece: DVec3| {
                while at + 1 < points.len()
                    && place(&points[at + 1]).distance(piece) < place(&points[at]).distance(piece)
                {
                    at += 1;
                }
                at
            }
        };
        let own = |at: usize| {
            let (color, surface) = look(at);
            Look::Own(color, surface)
        };
        let refused = |error: &dyn std::fmt::Display| AddError(format!("a tube cannot be drawn: {error}"));
        let mut nearest = walk();
        for sphere in &tube.spheres {
            pinhole::scene::sphere::check(*sphere).map_err(|error| refused(&error))?;
            self.balls.push((*sphere, own(nearest(place(sphere)))));
        }
        let mut nearest = walk();
        for side in &tube.sides {
            let middle = 0.5 * (DVec3::from(side.start) + DVec3::from(side.end));
            self.push(*side, own(nearest(middle))).map_err(|error| refused(&error))?;
        }
        Ok(())
    }

    /// Adds a note for the user.
    pub(crate) fn note(&mut self, note: String) {
        self.notes.push(note);
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
