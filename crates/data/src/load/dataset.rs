//! The contents of a file of spheres.

use glam::{DVec3, Vec3};

use super::bonds;
use super::elements::UnknownSpecies;
use super::spacing::{self, NO_RADII};
use pinhole::image::color::LinearRgb;
use pinhole::scene::sphere::Sphere;
use pinhole::scene::sphere_array::SphereArray;
use pinhole::scene::{Appearance, Colors, Scene, SceneError};

/// The spheres of one frame of a file, with their colours and other named values.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Dataset {
    /// Centres and radii, in the order of the file. They are not checked;
    /// [`Scene::from_parts`](pinhole::Scene::from_parts) does that.
    pub spheres: SphereArray,
    /// The colour of each sphere, if the file or the elements of its atoms give one.
    pub colors: Option<Vec<LinearRgb>>,
    /// The opacity of each sphere, from 0 to 1, if the file has opacities.
    pub opacities: Option<Vec<f32>>,
    /// Other named values of the spheres. Each column has one value for each sphere, in the order of the file.
    pub columns: Vec<Column>,
    /// The three edge vectors of the periodic cell, if the file has one.
    pub cell: Option<[[f64; 3]; 3]>,
    /// The corner of the cell from which the edge vectors start; zero if the file does not say where it is.
    pub cell_origin: [f64; 3],
    /// The directions of the cell's edges in which the data repeats.
    pub is_periodic: [bool; 3],
    /// Is true if the cell is that of a crystal whose symmetry is not applied, so that the spheres are only a part of what
    /// is in it. Distances in selections do not reach across its borders then.
    pub is_part_of_crystal: bool,
    /// Bonds that the file lists: pairs of indices of spheres, the smaller index first, sorted, and each pair once.
    pub bonds: Vec<[u32; 2]>,
    /// Is true if bonds are listed and these are all there are, so that distances add none unless all spheres are atoms of
    /// elements.
    pub has_all_bonds: bool,
    /// Number of frames in the file; `None` if the file was not read to its end.
    pub frames: Option<usize>,
    /// Notes for the user that are not errors, one line each and without the file's name.
    pub notes: Vec<String>,
    /// The species that one of the notes is about.
    pub(super) unknown: Option<UnknownSpecies>,
}

/// A named value of every sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name of the value, such as `species`, `chain` or `b_factor`.
    pub name: String,
    /// One value for each sphere.
    pub values: ColumnValues,
}

/// The values of a [`Column`].
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnValues {
    /// Text that takes few different values.
    Labels(Labels),
    /// Numbers.
    Numbers(Vec<f64>),
}

/// A text for each sphere, stored as an index because few different texts occur.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    /// The different texts, each once, in order of first appearance.
    pub names: Vec<String>,
    /// For each sphere, the index of its text in `names`.
    pub indices: Vec<u32>,
}

impl Labels {
    /// Leaves out the spheres for which `is_kept` is false, and texts that no remaining sphere has. Returns the former
    /// index of each remaining text.
    pub(super) fn keep(&mut self, is_kept: &[bool]) -> Vec<u32> {
        retain(&mut self.indices, is_kept);
        let mut renumbered: Vec<Option<u32>> = vec![None; self.names.len()];
        let (mut names, mut former) = (Vec::new(), Vec::new());
        for index in &mut self.indices {
            let old = *index as usize;
            // An index without a text stays without one.
            let (Some(new), Some(name)) = (renumbered.get_mut(old), self.names.get_mut(old)) else {
                *index = u32::MAX;
                continue;
            };
            *index = *new.get_or_insert_with(|| {
                names.push(std::mem::take(name));
                former.push(old as u32);
                names.len() as u32 - 1
            });
        }
        self.names = names;
        former
    }
}

/// Keeps the values for which `is_kept` is true.
pub(super) fn retain<T>(values: &mut Vec<T>, is_kept: &[bool]) {
    let mut is_kept = is_kept.iter();
    values.retain(|_| is_kept.next().copied().unwrap_or(true));
}

/// The values with some indices.
fn taken<T: Copy>(values: &[T], indices: &[u32]) -> Vec<T> {
    indices.iter().filter_map(|index| values.get(*index as usize).copied()).collect()
}

/// The column with this name, if its values are text.
pub(crate) fn labels_in<'a>(columns: &'a [Column], name: &str) -> Option<&'a Labels> {
    match &columns.iter().find(|column| column.name == name)?.values {
        ColumnValues::Labels(labels) => Some(labels),
        ColumnValues::Numbers(_) => None,
    }
}

/// The centre of a sphere.
pub(super) fn center(spheres: &SphereArray, index: usize) -> DVec3 {
    let [x, y, z, _] = spheres.at(index);
    DVec3::new(x, y, z)
}

impl Dataset {
    /// Makes a `Dataset` that has spheres and nothing else.
    #[must_use]
    pub fn new(spheres: SphereArray) -> Self {
        Self {
            spheres,
            colors: None,
            opacities: None,
            columns: Vec::new(),
            cell: None,
            cell_origin: [0.0; 3],
            is_periodic: [true; 3],
            is_part_of_crystal: false,
            bonds: Vec::new(),
            has_all_bonds: false,
            frames: None,
            notes: Vec::new(),
            unknown: None,
        }
    }

    /// The median distance from a sphere to its nearest neighbour; the diameter of the largest sphere if all are in one
    /// place.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        let count = self.spheres.len();
        let largest = || (0..count).map(|index| self.spheres.at(index)[3]).fold(0.0, f64::max);
        2.0 * spacing::radius(count, |index| self.center(index)).unwrap_or_else(largest)
    }

    /// The distance to the nearest neighbour that this part of the spheres has at most.
    pub(crate) fn spacing_of(&self, part: f64) -> Option<f64> {
        spacing::distance(self.spheres.len(), |index| self.center(index), part)
    }

    /// The centre of a sphere.
    pub(crate) fn center(&self, index: usize) -> DVec3 {
        center(&self.spheres, index)
    }

    /// Returns the values of the column with this name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&ColumnValues> {
        self.columns.iter().find(|column| column.name == name).map(|column| &column.values)
    }

    /// Returns the column with this name, if its values are text.
    #[must_use]
    pub fn labels(&self, name: &str) -> Option<&Labels> {
        labels_in(&self.columns, name)
    }

    /// Returns true if nothing gives the colours of species that are not chemical elements, and the same for radii.
    pub(crate) fn unknown_lack(&self) -> [bool; 2] {
        self.unknown.as_ref().map_or([false; 2], UnknownSpecies::lack)
    }

    /// Removes notes made obsolete by colours or radii from elsewhere: for all spheres, or for the species for which
    /// `is_given` is true.
    pub fn correct_notes(&mut self, has_colors: bool, has_radii: bool, is_given: impl Fn(&str) -> bool) {
        if has_radii {
            self.notes.retain(|note| !note.contains(NO_RADII));
        }
        let Some(unknown) = self.unknown.take() else { return };
        let (former, left) = (unknown.note(), unknown.after(has_colors, has_radii, is_given));
        // A path may stand before the note.
        let place = self.notes.iter().position(|note| note.ends_with(&former));
        if let Some(place) = place {
            let note = self.notes.remove(place);
            let before = note.strip_suffix(&former).unwrap_or_default();
            if let Some(left) = &left {
                self.notes.insert(place, format!("{before}{}", left.note()));
            }
        }
        self.unknown = left;
    }

    /// The radius of all spheres and the note about it, if the file gives none.
    pub(crate) fn guessed_radius(&self) -> Option<(f64, String)> {
        let note = self.notes.iter().find(|note| note.contains(NO_RADII))?;
        (!self.spheres.is_empty()).then(|| (self.spheres.at(0)[3], note.clone()))
    }

    /// Gives all spheres a radius, if there is one.
    pub fn give_radius(&mut self, radius: Option<f64>) {
        if let Some(radius) = radius {
            self.spheres.map_radii(|_, _| radius);
            self.correct_notes(false, true, |_| false);
        }
    }

    /// Leaves out the spheres for which `is_kept` is false, with their colours, opacities, bonds and other values. Spheres
    /// beyond the end of `is_kept` stay. If any is left out, a new column `index` has the former indices, unless the data
    /// has a column of this name.
    pub fn keep(&mut self, is_kept: &[bool]) {
        if !is_kept.contains(&false) {
            return;
        }
        if !self.columns.iter().any(|column| column.name.eq_ignore_ascii_case("index")) {
            let indices = (0..self.spheres.len()).map(|index| index as f64).collect();
            let values = ColumnValues::Numbers(indices);
            self.columns.push(Column { name: "index".to_owned(), values });
        }
        match &mut self.spheres {
            SphereArray::F32(spheres) => retain(spheres, is_kept),
            SphereArray::F64(spheres) => retain(spheres, is_kept),
        }
        self.colors.iter_mut().for_each(|colors| retain(colors, is_kept));
        self.opacities.iter_mut().for_each(|opacities| retain(opacities, is_kept));
        for column in &mut self.columns {
            match &mut column.values {
                ColumnValues::Labels(labels) => drop(labels.keep(is_kept)),
                ColumnValues::Numbers(numbers) => retain(numbers, is_kept),
            }
        }
        self.bonds = bonds::kept(&self.bonds, is_kept);
        // A note about species that are not in the picture would be useless.
        let left: Option<Vec<String>> = self.labels("species").map(|labels| labels.names.clone());
        if let Some(left) = left {
            self.correct_notes(false, false, |name| left.iter().all(|other| other != name));
        }
    }

    /// Replaces the spheres by those with these indices, which may occur several times, with all their values. Bonds are
    /// lost, as nothing says which of equal ends they join. Indices that no sphere has are left out.
    pub(crate) fn repeat(&mut self, indices: &[u32]) {
        match &mut self.spheres {
            SphereArray::F32(spheres) => *spheres = taken(spheres, indices),
            SphereArray::F64(spheres) => *spheres = taken(spheres, indices),
        }
        self.colors.iter_mut().for_each(|colors| *colors = taken(colors, indices));
        self.opacities.iter_mut().for_each(|opacities| *opacities = taken(opacities, indices));
        for column in &mut self.columns {
            match &mut column.values {
                ColumnValues::Labels(labels) => labels.indices = taken(&labels.indices, indices),
                ColumnValues::Numbers(numbers) => *numbers = taken(numbers, indices),
            }
        }
        self.bonds.clear();
    }

    /// Moves the centres of all spheres.
    pub(crate) fn move_centers(&mut self, to: impl Fn(usize, DVec3) -> DVec3) {
        match &mut self.spheres {
            SphereArray::F64(all) => all.iter_mut().enumerate().for_each(|(index, sphere)| {
                let center = to(index, DVec3::new(sphere[0], sphere[1], sphere[2]));
                sphere[..3].copy_from_slice(&center.to_array());
            }),
            SphereArray::F32(all) => all.iter_mut().enumerate().for_each(|(index, sphere)| {
                let center = to(index, Vec3::new(sphere[0], sphere[1], sphere[2]).as_dvec3());
                sphere[..3].copy_from_slice(&center.as_vec3().to_array());
            }),
        }
    }

    /// Iterates over the spheres. If the file gives no colours, every sphere gets `color`.
    pub fn colored_spheres(&self, color: LinearRgb) -> impl Iterator<Item = Sphere> {
        let color_of =
            move |index: usize| self.colors.as_ref().and_then(|colors| colors.get(index)).copied().unwrap_or(color);
        let opacity_of = |index: usize| self.opacities.as_ref().and_then(|all| all.get(index)).copied().unwrap_or(1.0);
        let colored = move |(index, mut sphere): (usize, Sphere)| {
            sphere.color = color_of(index);
            sphere.with_opacity(opacity_of(index))
        };
        self.spheres.with_color(color).enumerate().map(colored)
    }

    /// Makes a scene of the spheres. If the file gives no colours, every sphere gets `color`.
    ///
    /// # Errors
    /// Returns an error that names the first sphere out of range.
    pub fn scene(self, color: LinearRgb) -> Result<Scene, SceneError> {
        let colors = match (self.colors, self.opacities) {
            (colors, Some(opacities)) => {
                let rgba = |(index, opacity): (usize, &f32)| {
                    let own = colors.as_ref().and_then(|colors| colors.get(index)).copied();
                    let [r, g, b] = own.unwrap_or(color).to_srgb8();
                    [r, g, b, (opacity * 255.0).round() as u8]
                };
                Colors::Rgba8(opacities.iter().enumerate().map(rgba).collect())
            }
            (Some(colors), None) => Colors::distinct(&colors),
            (None, None) => Colors::One(color),
        };
        Scene::from_parts(self.spheres, Appearance::new(colors))
    }
}
