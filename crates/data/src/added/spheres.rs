//! The spheres that are added to those of data, their colours and surfaces, and the error of adding them.

use std::collections::HashMap;

use glam::DVec3;

use pinhole::image::color::LinearRgb;
use pinhole::scene::material::SurfaceProperties;
use pinhole::scene::sphere_array::SphereArray;
use pinhole::scene::{Appearance, Colors};

/// The spheres that were added, after those of the data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AddedSpheres {
    spheres: Vec<[f64; 4]>,
    /// The look of the spheres in order: each entry has a number of spheres that follow each other, and their look.
    runs: Vec<(usize, Look)>,
    pub(super) bonds: usize,
    pub(super) notes: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Look {
    /// Like the sphere of the data with this index.
    Sphere(u32),
    /// Matt and opaque, in this colour.
    Own(LinearRgb),
}

impl AddedSpheres {
    /// The number of spheres that were added.
    #[must_use]
    pub fn len(&self) -> usize {
        self.spheres.len()
    }

    /// Returns true if no spheres were added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.spheres.is_empty()
    }

    /// The number of bonds. It includes bonds that lie within spheres and need no spheres of their own.
    #[must_use]
    pub fn bonds(&self) -> usize {
        self.bonds
    }

    /// Notes for the user, one line each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(super) fn push(&mut self, spheres: impl Iterator<Item = [f64; 4]>, look: Look) {
        let before = self.spheres.len();
        self.spheres.extend(spheres);
        self.runs.push((self.spheres.len() - before, look));
    }

    fn looks(&self) -> impl Iterator<Item = Look> {
        self.runs.iter().flat_map(|(count, look)| std::iter::repeat_n(*look, *count))
    }

    /// Appends the spheres to an array.
    pub fn extend_array(&self, array: &mut SphereArray) {
        match array {
            SphereArray::F32(all) => {
                all.extend(self.spheres.iter().map(|sphere| sphere.map(|value| value as f32)));
            }
            SphereArray::F64(all) => all.extend_from_slice(&self.spheres),
        }
    }

    /// Returns the look of `count` spheres, followed by the look of the added spheres.
    #[must_use]
    pub fn extend_appearance(&self, appearance: &Appearance, count: usize) -> Appearance {
        let surfaces = self.surfaces(appearance, count);
        let colors = self.colors(appearance, count);
        match surfaces {
            Some((surfaces, indices)) => Appearance::new(colors).with_surfaces(surfaces, indices),
            None => {
                let surface = appearance.surfaces().first().copied().unwrap_or_default();
                Appearance::new(colors).with_surface(surface)
            }
        }
    }

    fn colors(&self, appearance: &Appearance, count: usize) -> Colors {
        if let Colors::Rgba8(former) = appearance.colors() {
            let mut all = former.clone();
            all.extend(self.looks().map(|look| match look {
                Look::Sphere(index) => former.get(index as usize).copied().unwrap_or([255; 4]),
                Look::Own(color) => {
                    let [r, g, b] = color.to_srgb8();
                    [r, g, b, 255]
                }
            }));
            return Colors::Rgba8(all);
        }
        let (mut palette, mut indices) = match appearance.colors() {
            Colors::Palette { palette, indices } => (palette.clone(), indices.clone()),
            Colors::One(color) => (vec![*color], vec![0; count]),
            _ => {
                let color = |id: u32| appearance.color(id).unwrap_or(LinearRgb::WHITE);
                let all: Vec<LinearRgb> = (0..count as u32).map(color).collect();
                match Colors::distinct(&all) {
                    Colors::Palette { palette, indices } => (palette, indices),
                    _ => (all.first().copied().into_iter().collect(), vec![0; count]),
                }
            }
        };
        let mut own = HashMap::new();
        indices.reserve(self.len());
        for look in self.looks() {
            let index = match look {
                Look::Sphere(index) => indices.get(index as usize).copied().unwrap_or_default(),
                Look::Own(color) => *own.entry(color.to_srgb8()).or_insert_with(|| {
                    palette.push(color);
                    // The palette has at most a few colours more than there are spheres.
                    palette.len() as u32 - 1
                }),
            };
            indices.push(index);
        }
        Colors::Palette { palette, indices }
    }

    /// The surface properties of all spheres; `None` if all have the same.
    fn surfaces(&self, appearance: &Appearance, count: usize) -> Option<(Vec<SurfaceProperties>, Vec<u32>)> {
        let matt = SurfaceProperties::default();
        let has_own = self.runs.iter().any(|(_, look)| matches!(look, Look::Own(_)));
        let former = appearance.surface_indices();
        if former.is_none() && (!has_own || appearance.surfaces().first() == Some(&matt)) {
            return None;
        }
        let mut surfaces = appearance.surfaces().to_vec();
        let mut indices = former.map_or_else(|| vec![0; count], <[u32]>::to_vec);
        surfaces.push(matt);
        let own = surfaces.len() as u32 - 1;
        indices.reserve(self.len());
        for look in self.looks() {
            let index = match look {
                Look::Sphere(index) => indices.get(index as usize).copied().unwrap_or_default(),
                Look::Own(_) => own,
            };
            indices.push(index);
        }
        Some((surfaces, indices))
    }
}

/// The reason why spheres cannot be added to those of data, on one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct AddError(pub(super) String);

/// The number of spheres in a string of this length whose centres are at most `spacing` radii apart.
pub(super) fn string_count(length: f64, radius: f64, spacing: f64) -> f64 {
    (length / (spacing * radius)).ceil().max(1.0)
}

/// Spheres in the middles of `count` equal parts of a line. Distances are also equal where two strings meet.
pub(super) fn string_between(from: DVec3, to: DVec3, radius: f64, count: usize) -> impl Iterator<Item = [f64; 4]> {
    (0..count).map(move |index| {
        let center = from.lerp(to, (index as f64 + 0.5) / count as f64);
        [center.x, center.y, center.z, radius]
    })
}
