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
mod string;

use std::collections::HashMap;

use crate::image::color::LinearRgb;
use crate::load::{ColumnValues, Labels, Loaded};
use crate::scene::material::SurfaceProperties;
use crate::scene::sphere::Sphere;
use crate::scene::sphere_array::SphereArray;
use crate::scene::{Appearance, Colors};

pub use bonds::{BondLength, Bonds};
pub use cell_edges::CellEdges;
pub use error::AddError;

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

/// The spheres that were added, after those of the data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Added {
    spheres: Vec<[f64; 4]>,
    /// One after the other, how many spheres have one look, and which.
    runs: Vec<(usize, Look)>,
    /// The number of bonds.
    bonds: usize,
    notes: Vec<String>,
}

/// What added spheres look like.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    /// Like the sphere of the data with this index.
    Sphere(u32),
    /// Matt and opaque, in this colour.
    Own(LinearRgb),
}

/// The spheres to which others are added.
#[derive(Clone, Copy)]
pub(crate) struct Base<'a> {
    /// Centres and radii as they are drawn.
    pub(crate) spheres: &'a SphereArray,
    /// For each sphere, what it is.
    pub(crate) species: Option<&'a Labels>,
    pub(crate) cell: Option<[[f64; 3]; 3]>,
    pub(crate) cell_origin: [f64; 3],
}

impl<'a> Base<'a> {
    pub(crate) fn of(loaded: &'a Loaded) -> Self {
        Self {
            spheres: &loaded.spheres,
            species: loaded.labels("species"),
            cell: loaded.cell,
            cell_origin: loaded.cell_origin,
        }
    }
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

impl Added {
    /// The number of spheres that were added.
    #[must_use]
    pub fn len(&self) -> usize {
        self.spheres.len()
    }

    /// Whether no spheres were added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.spheres.is_empty()
    }

    /// The number of bonds, also of those that lie within spheres and need none.
    #[must_use]
    pub fn bonds(&self) -> usize {
        self.bonds
    }

    /// Notes for the user, one line each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Adds spheres that have one look.
    fn push(&mut self, spheres: impl Iterator<Item = [f64; 4]>, look: Look) {
        let before = self.spheres.len();
        self.spheres.extend(spheres);
        self.runs.push((self.spheres.len() - before, look));
    }

    /// The look of each added sphere.
    fn looks(&self) -> impl Iterator<Item = Look> {
        self.runs.iter().flat_map(|(count, look)| std::iter::repeat_n(*look, *count))
    }

    /// Adds the spheres to an array.
    pub(crate) fn extend_array(&self, array: &mut SphereArray) {
        match array {
            SphereArray::F32(all) => {
                all.extend(self.spheres.iter().map(|sphere| sphere.map(|value| value as f32)));
            }
            SphereArray::F64(all) => all.extend_from_slice(&self.spheres),
        }
    }

    /// Adds the spheres to those that they were made for.
    pub(crate) fn extend_spheres(&self, all: &mut Vec<Sphere>) {
        for ([x, y, z, radius], look) in self.spheres.iter().zip(self.looks()) {
            let like = match look {
                Look::Sphere(index) => all.get(index as usize).copied(),
                Look::Own(color) => Some(Sphere::new([0.0; 3], 1.0, color)),
            };
            let center = [*x, *y, *z];
            all.extend(like.map(|like| Sphere { center, radius: *radius, ..like }));
        }
    }

    /// Adds the look of the spheres to that of `count` spheres.
    pub(crate) fn extend_appearance(&self, appearance: &Appearance, count: usize) -> Appearance {
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
                    // There are a few colours more than spheres at most.
                    palette.len() as u32 - 1
                }),
            };
            indices.push(index);
        }
        Colors::Palette { palette, indices }
    }

    /// The surface properties of all spheres; `None` if all have the same.
    fn surfaces(
        &self,
        appearance: &Appearance,
        count: usize,
    ) -> Option<(Vec<SurfaceProperties>, Vec<u32>)> {
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
