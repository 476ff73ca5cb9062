//! Applies the keys of a scene file to the spheres of its data.

use super::data::{Data, Element, add_spheres};
use super::span::DEFAULT_COLOR;
use crate::color_by::{ColorByError, ColorKey, MappedColumns, Mapping};
use pinhole::image::color::LinearRgb;
use pinhole::scene::sphere::Sphere;
use pinhole::scene::sphere_array::SphereArray;
use pinhole_data::added::{AddError, AddedSpheres};
use pinhole_data::load::{ColumnValues, Dataset, Labels};
use pinhole_data::select::{KeptSpheres, SelectError};

/// The spheres of a scene's data.
#[derive(Clone, Debug)]
pub enum DataSpheres {
    /// Spheres with their own colours and surface properties.
    Spheres(Vec<Sphere>),
    /// Centres and radii, and what columns decide; the scene gives the rest, to all the same.
    Array(SphereArray, Box<MappedColumns>),
}

/// The spheres of a scene's data, with all that the keys of the scene file say about them.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct AppliedData {
    /// The spheres: first those of the data, then those that were added.
    pub spheres: DataSpheres,
    /// What colours mean, if a column gives them.
    pub color_key: Option<ColorKey>,
    /// Notes for the user, such as names that do not occur in the data.
    pub notes: Vec<String>,
    /// What the selection kept, if there is one.
    pub kept: Option<KeptSpheres>,
    /// What was added to the spheres of the data.
    pub added: AddedSpheres,
}

/// An error of applying the keys of a scene file to its data.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// The selection does not apply to the data.
    #[error("`select`: {0}")]
    Select(#[from] SelectError),
    /// Bonds or the edges of the cell cannot be added.
    #[error(transparent)]
    Add(#[from] AddError),
    /// A column cannot decide what it should.
    #[error(transparent)]
    ColorBy(#[from] ColorByError),
    /// The data has no text column that a key of the scene file names.
    #[error("{0}")]
    NoColumn(String),
}

impl Data {
    /// Applies the colours, radii and surface properties of the scene file to the spheres of its data, and leaves out
    /// the spheres that it names and those that it does not select. Then adds bonds and the edges of the cell.
    ///
    /// # Errors
    /// If the scene file names a column that the data does not have, or whose values cannot be used; if it selects
    /// nothing; or if the data lacks what bonds or a box need.
    pub fn apply(&self, mut loaded: Dataset) -> Result<AppliedData, DataError> {
        let kept = self.select.as_ref().map(|select| select.apply(&mut loaded)).transpose()?;
        let Mapping { color, radius, .. } = &self.mapping;
        let is_given = |species: &str| {
            let by_species =
                self.elements_by.is_empty() || self.elements_by.iter().any(|c| c == "species");
            by_species && self.elements.iter().any(|element| element.name == species)
        };
        loaded.correct_notes(color.is_some(), radius.is_some(), is_given);
        let mut notes = std::mem::take(&mut loaded.notes);
        notes.extend(kept.iter().flat_map(|kept| kept.notes.clone()));
        if loaded.colors.is_none()
            && loaded.opacities.is_none()
            && !self.asks_for_text()
            && self.additions.is_empty()
        {
            let mapped = self.mapping.apply(&mut loaded.spheres, &loaded.columns, &[])?;
            loaded.spheres.scale_radii(self.radius_scale);
            notes.extend_from_slice(mapped.notes());
            let color_key = mapped.key().cloned();
            let spheres = DataSpheres::Array(loaded.spheres, Box::new(mapped));
            return Ok(AppliedData {
                spheres,
                color_key,
                notes,
                kept,
                added: AddedSpheres::default(),
            });
        }
        let is_left_out = self.left_out(&loaded, &mut notes)?;
        let mapped = self.mapping.apply(&mut loaded.spheres, &loaded.columns, &is_left_out)?;
        notes.extend_from_slice(mapped.notes());
        let has_chosen_radii = self.radius.is_some()
            || self.mapping.radius.is_some()
            || self.radius_scale.to_bits() != 1.0_f64.to_bits();
        if !has_chosen_radii {
            self.additions.shrink(&mut loaded);
        }
        let species = ["species".to_owned()];
        let by = if self.elements_by.is_empty() && self.elements.is_empty() {
            &[]
        } else if self.elements_by.is_empty() {
            &species[..]
        } else {
            &self.elements_by
        };
        let key = if self.elements_by.is_empty() { "elements" } else { "elements_by" };
        let columns: Vec<&Labels> =
            by.iter().map(|column| self.labels(&loaded, key, column)).collect::<Result<_, _>>()?;
        let element_of = |name: &String| self.elements.iter().find(|element| element.name == *name);
        let elements: Vec<Vec<Option<&Element>>> =
            columns.iter().map(|labels| labels.names.iter().map(element_of).collect()).collect();
        let element_at = |index: usize| {
            columns.iter().zip(&elements).find_map(|(labels, elements)| {
                let value = *labels.indices.get(index)? as usize;
                elements.get(value).copied().flatten()
            })
        };
        let color = self.color.unwrap_or(LinearRgb::from_srgb8(DEFAULT_COLOR));
        let (mut spheres, mut indices) = (Vec::new(), Vec::new());
        for (index, mut sphere) in loaded.colored_spheres(color).enumerate() {
            if is_left_out.get(index).copied().unwrap_or(false) {
                continue;
            }
            let element = element_at(index);
            let mut surface = element.map_or(self.surface, |element| element.surface);
            // Columns take precedence over what the file says by itself, here too.
            if self.mapping.opacity.is_none() {
                surface.opacity *= sphere.surface.opacity;
            }
            sphere.surface = mapped.surface(surface, index);
            if let Some(Element { radius, color, .. }) = element {
                // Columns take precedence over tables of elements.
                let radius = radius.filter(|_| self.mapping.radius.is_none());
                sphere.radius = radius.unwrap_or(sphere.radius);
                sphere.color = color.unwrap_or(sphere.color);
            }
            sphere.color = mapped.color(index).unwrap_or(sphere.color);
            sphere.radius *= self.radius_scale;
            spheres.push(sphere);
            if !self.additions.is_empty() {
                indices.push(index);
            }
        }
        if spheres.is_empty() && !is_left_out.is_empty() {
            notes.push(format!(
                "`leave_out` removes all atoms of {}; remove some of its values",
                self.file
            ));
        }
        let occurs = |name: &String| columns.iter().any(|labels| labels.names.contains(name));
        let absent = self.elements.iter().filter(|element| !occurs(&element.name));
        notes.extend(absent.map(|element| {
            let Element { name, .. } = element;
            format!(
                "`[elements.{name}]`: no atom of {} has this name; check its spelling or remove the table",
                self.file
            )
        }));
        let added = add_spheres(&self.additions, &mut spheres, &loaded, &indices)?;
        notes.extend_from_slice(added.notes());
        let (spheres, color_key) = (DataSpheres::Spheres(spheres), mapped.key().cloned());
        Ok(AppliedData { spheres, color_key, notes, kept, added })
    }

    /// Whether keys ask for columns of text.
    fn asks_for_text(&self) -> bool {
        !(self.elements.is_empty() && self.elements_by.is_empty() && self.leave_out.is_empty())
    }

    /// Returns the text column that a key of the scene file names.
    fn labels<'a>(
        &self,
        loaded: &'a Dataset,
        key: &str,
        column: &str,
    ) -> Result<&'a Labels, DataError> {
        let file = &self.file;
        loaded.labels(column).ok_or_else(|| {
            let mut texts = loaded
                .columns
                .iter()
                .filter(|column| matches!(column.values, ColumnValues::Labels(_)))
                .peekable();
            if texts.peek().is_none() {
                return DataError::NoColumn(format!(
                    "`{key}` applies only to data with text, such as the names of atoms, and {file} has none; remove it"
                ));
            }
            let columns = texts.map(|column| column.name.as_str()).collect::<Vec<_>>().join(", ");
            DataError::NoColumn(format!(
                "`{key}`: {file} has no text column `{column}`; its text columns are {columns}"
            ))
        })
    }

    /// Returns for each sphere whether it is left out; the result is empty if the scene file leaves out nothing.
    fn left_out(&self, loaded: &Dataset, notes: &mut Vec<String>) -> Result<Vec<bool>, DataError> {
        let mut is_left_out = Vec::new();
        for (column, values) in &self.leave_out {
            let labels = self.labels(loaded, "leave_out", column)?;
            is_left_out.resize(loaded.spheres.len(), false);
            let is_named: Vec<bool> =
                labels.names.iter().map(|name| values.contains(name)).collect();
            for (is_out, index) in is_left_out.iter_mut().zip(&labels.indices) {
                *is_out |= is_named.get(*index as usize).copied().unwrap_or(false);
            }
            let absent = values.iter().filter(|value| !labels.names.contains(value));
            notes.extend(absent.map(|value| {
                format!(
                    "`leave_out`: no atom of {} has the {column} {value}; check its spelling or remove it",
                    self.file
                )
            }));
        }
        Ok(is_left_out)
    }
}
