//! What a file of spheres holds.

use crate::image::color::LinearRgb;
use crate::scene::sphere::Sphere;
use crate::scene::sphere_array::SphereArray;
use crate::scene::{Appearance, Colors, Scene, SceneError};

/// The spheres of one frame of a file, and what else the file says of each.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Loaded {
    /// Centres and radii, in the order of the file. Not checked:
    /// [`Scene::from_parts`](crate::Scene::from_parts) does that.
    pub spheres: SphereArray,
    /// The colour of each sphere, if the file or the elements of its atoms give one.
    pub colors: Option<Vec<LinearRgb>>,
    /// Named values of each sphere, in the order of the file.
    pub columns: Vec<Column>,
    /// The three edges of the periodic cell, if the file has one.
    pub cell: Option<[[f64; 3]; 3]>,
    /// How many frames the file has; `None` if it was not read to its end.
    pub frames: Option<usize>,
    /// What the user should know although it is not an error, one line each, without the file's name.
    pub notes: Vec<String>,
}

/// One value of every sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What the value is called, such as `species`, `chain` or `b_factor`.
    pub name: String,
    /// One value for each sphere.
    pub values: ColumnValues,
}

/// The values of a [`Column`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ColumnValues {
    /// Text of which few different values occur.
    Labels(Labels),
    /// Numbers.
    Numbers(Vec<f64>),
}

/// Text for each sphere, of which few different values occur.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    /// The different values, each once, in order of appearance.
    pub names: Vec<String>,
    /// For each sphere, the index of its value in `names`.
    pub indices: Vec<u32>,
}

impl Loaded {
    /// Spheres without anything else.
    #[must_use]
    pub fn new(spheres: SphereArray) -> Self {
        Self {
            spheres,
            colors: None,
            columns: Vec::new(),
            cell: None,
            frames: None,
            notes: Vec::new(),
        }
    }

    /// The column of a name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&ColumnValues> {
        self.columns.iter().find(|column| column.name == name).map(|column| &column.values)
    }

    /// The column of a name, if it has text.
    #[must_use]
    pub fn labels(&self, name: &str) -> Option<&Labels> {
        match self.column(name)? {
            ColumnValues::Labels(labels) => Some(labels),
            ColumnValues::Numbers(_) => None,
        }
    }

    /// The spheres one by one; `color` is that of spheres whose file gives none.
    pub fn colored_spheres(&self, color: LinearRgb) -> impl Iterator<Item = Sphere> {
        let color_of = move |index: usize| {
            self.colors.as_ref().and_then(|colors| colors.get(index)).copied().unwrap_or(color)
        };
        let colored =
            move |(index, sphere): (usize, Sphere)| Sphere { color: color_of(index), ..sphere };
        self.spheres.with_color(color).enumerate().map(colored)
    }

    /// The spheres as a scene; `color` is that of spheres whose file gives none.
    ///
    /// # Errors
    /// The first sphere that is out of range.
    pub fn scene(self, color: LinearRgb) -> Result<Scene, SceneError> {
        let colors = self.colors.map_or(Colors::One(color), |colors| Colors::distinct(&colors));
        Scene::from_parts(self.spheres, Appearance::new(colors))
    }
}
