//! Makes the scene of data, as the keys of a scene file say.

use super::data::{Data, Element};
use super::data_error::DataError;
use super::shapes::OwnShapes;
use super::show::{RuleLooks, shown};
use super::span::DEFAULT_COLOR;
use crate::color_by::{ColorBy, ColorKey};
use pinhole::image::color::LinearRgb;
use pinhole::scene::{Colors, Scene};
use pinhole_data::added::{Additions, ArrowKey};
use pinhole_data::load::{Column, ColumnValues, Dataset, Labels};
use pinhole_data::select::KeptSpheres;
use pinhole_data::show::{ShowRule, ShowStyle};

/// The scene of data, with what else the keys of the scene file say about them.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DataScene {
    /// The scene: spheres of the scene file, those of the data, and those that were added; then cones of the scene file,
    /// and sticks that were added.
    pub scene: Scene,
    /// What colours mean, if a column gives them.
    pub color_key: Option<ColorKey>,
    /// The meaning of arrows, if there are any.
    pub arrow_key: Option<ArrowKey>,
    /// The columns of the spheres of the data, without those that were not selected or left out.
    pub columns: Vec<Column>,
    /// Notes for the user, such as names that do not occur in the data.
    pub notes: Vec<String>,
    /// The number of spheres that the selection kept and rules draw, if there are any.
    pub kept: Option<KeptSpheres>,
    /// The number of bonds, if bonds are drawn.
    pub bonds: Option<usize>,
}

/// A part of the shapes of data.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    All,
    Ghosts,
    Others,
}

impl Data {
    /// Colours the spheres by kind, if neither a key nor the data gives colours: by `kinds`, or else as
    /// [`ColorBy::of_kinds`] does. Returns the choice.
    pub fn color_by_kinds(&mut self, loaded: &Dataset, kinds: Option<ColorBy>) -> Option<ColorBy> {
        let has_kinds = self.elements.iter().any(|element| element.color.is_some());
        if self.color.is_some() || self.mapping.color.is_some() || has_kinds {
            return None;
        }
        let kinds = kinds.or_else(|| ColorBy::of_kinds(loaded));
        self.mapping.color.clone_from(&kinds);
        kinds
    }

    /// Makes the scene of data. `replicate` repeats its spheres, and then `select` and `leave_out` take spheres away. Columns decide colours, radii, opacities and
    /// strengths of light, then the tables of elements, then the file, and last the keys for all spheres. Opacities of
    /// the file are multiplied by those of the keys. Bonds, the edges of the cell and arrows come last.
    ///
    /// `own` are the shapes of the scene file. If there are none, the array of the data is not copied.
    ///
    /// # Errors
    /// If a key names a column that the data does not have, or whose values cannot be used; if it selects nothing; if
    /// the data lacks what bonds, a box or arrows need; or if a sphere is out of range.
    pub fn scene(&self, loaded: Dataset, own: &OwnShapes) -> Result<DataScene, DataError> {
        if !self.shows.iter().any(|show| show.rule.style == ShowStyle::Ghost) {
            return self.part(loaded, own, Part::All);
        }
        let ghosts = self.part(loaded.clone(), &OwnShapes::default(), Part::Ghosts)?.scene;
        let made = self.part(loaded, own, Part::Others)?;
        Ok(DataScene { scene: made.scene.with_ghosts(ghosts), ..made })
    }

    fn part(&self, mut loaded: Dataset, own: &OwnShapes, part: Part) -> Result<DataScene, DataError> {
        if let Some(replicate) = self.replicate {
            replicate.apply(&mut loaded).map_err(DataError::Replicate)?;
        }
        let kept = self.select.as_ref().map(|select| select.apply(&mut loaded)).transpose()?;
        let has_radii = self.mapping.radius.is_some();
        let by_species = self.elements_by.is_empty() || self.elements_by.iter().any(|column| column == "species");
        let is_given = |name: &str| by_species && self.elements.iter().any(|e| e.name == name);
        let has_colors = self.color.is_some() || self.mapping.color.is_some();
        loaded.correct_notes(has_colors, has_radii, is_given);
        let absent = self.absent_elements(&loaded)?;
        let left_out = self.leave_out(&mut loaded)?;
        let rules: Vec<ShowRule> = self.shows.iter().map(|show| show.rule.clone()).collect();
        let mut shown = shown(&rules, &loaded)?;
        let kept = match &shown {
            Some(shown) => Some(shown.kept(kept)),
            None => kept,
        };
        let are_framed: Vec<bool> = match &shown {
            // Ghosts are framed, too.
            Some(shown) if part == Part::Others => {
                (0..loaded.spheres.len()).map(|index| shown.is_seen(index)).collect()
            }
            _ => Vec::new(),
        };
        shown = match part {
            Part::All => shown,
            _ => shown.map(|shown| shown.only(part == Part::Ghosts)),
        };
        let focus = self.focus.as_ref().map(|focus| focus.chosen(&loaded)).transpose().map_err(DataError::Focus)?;
        let mut notes = std::mem::take(&mut loaded.notes);
        notes.extend(kept.iter().flat_map(|kept| kept.notes.clone()).chain(left_out));
        let mut mapped = self.mapping.apply(&mut loaded)?;
        notes.append(&mut mapped.notes);
        notes.extend(absent);
        notes.extend(focus.iter().flat_map(|(_, notes)| notes.clone()));
        let elements = self.element_of_each(&loaded)?;
        let scale = self.radius_scale;
        let is_scaled = scale.to_bits() != 1.0_f64.to_bits();
        if !(has_radii || is_scaled || self.radius.is_some()) {
            self.additions.shrink(&mut loaded, |index| shown.as_ref().is_none_or(|shown| shown.is_plain(index)));
        }
        if is_scaled || !elements.is_empty() {
            let of_element = |index: usize| self.element(*elements.get(index)?)?.radius;
            loaded
                .spheres
                .map_radii(|index, radius| of_element(index).filter(|_| !has_radii).unwrap_or(radius) * scale);
        }
        if let Some(shown) = &mut shown {
            notes.append(&mut shown.notes);
            shown.set_radii(&mut loaded);
        }
        let of_elements = loaded.colors.clone().filter(|_| shown.is_some());
        let count = loaded.spheres.len();
        let mut color_key = mapped.coloring.as_ref().map(|coloring| coloring.key.clone());
        let colors = match color_key {
            Some(_) => Colors::One(LinearRgb::WHITE),
            None => self.colors(loaded.colors.take(), &elements, count),
        };
        let mut surfaces = vec![self.surface];
        surfaces.extend(self.elements.iter().map(|element| element.surface));
        let differ = surfaces.iter().any(|surface| *surface != self.surface);
        let surface_of: &[u32] = if differ { &elements } else { &[] };
        let mut appearance = mapped.appearance(count, colors, &surfaces, surface_of);
        let looks = shown
            .as_ref()
            .map(|shown| RuleLooks::new(&self.shows, shown, &loaded, &appearance, of_elements.as_deref()));
        let looks = looks.transpose()?;
        let of_rules = looks.as_ref().map(|looks| looks.appearance(count));
        let drawn = shown.as_ref().map(|shown| shown.drawn_spheres(&loaded, self.additions.bonds.is_some()));
        let additions = match part {
            Part::Ghosts => &Additions { cell: None, arrows: None, ..self.additions.clone() },
            _ => &self.additions,
        };
        let mut added = additions.add(&loaded, of_rules.as_ref().unwrap_or(&appearance), drawn.as_ref())?;
        if let (Some(shown), Some(looks)) = (&shown, &looks) {
            shown.add_tubes(&loaded, &mut added, |rule, index| looks.look(Some(rule), index))?;
            notes.extend(looks.notes());
            color_key = color_key.or_else(|| looks.key());
        }
        notes.extend_from_slice(added.notes());
        appearance = of_rules.unwrap_or(appearance);
        let is_in = focus.as_ref().map_or(&are_framed, |(is_in, _)| is_in);
        let in_focus = (0..count).filter(|index| is_in.get(*index) == Some(&true));
        let in_focus: Vec<[f64; 4]> = in_focus.map(|index| loaded.spheres.at(index)).collect();
        let are_drawn = drawn.as_ref().map(|drawn| &*drawn.are_drawn);
        if !added.is_empty() || are_drawn.is_some() {
            let is_drawn = |index: usize| are_drawn.is_none_or(|are_drawn| are_drawn[index]);
            appearance = added.extend_appearance(&appearance, count, is_drawn);
            loaded.keep(are_drawn.unwrap_or_default());
            added.extend_array(&mut loaded.spheres);
        }
        let scene = own
            .scene_with(loaded.spheres, added.sticks(), appearance)?
            .with_added(added.sphere_count())
            .with_focus(&in_focus);
        let bonds = (self.additions.bonds.is_some() || added.bonds() > 0).then_some(added.bonds());
        let arrow_key = added.arrow_key().cloned();
        Ok(DataScene { scene, color_key, arrow_key, columns: loaded.columns, notes, kept, bonds })
    }

    /// The colours of spheres that no column colours.
    fn colors(&self, own: Option<Vec<LinearRgb>>, elements: &[u32], count: usize) -> Colors {
        let color = self.color.unwrap_or(LinearRgb::from_srgb8(DEFAULT_COLOR));
        let of_element = |number: &u32| self.element(*number)?.color;
        let mut colors = own.filter(|_| self.color.is_none());
        if self.elements.iter().any(|element| element.color.is_some()) {
            let all = colors.get_or_insert_with(|| vec![color; count]);
            for (own, number) in all.iter_mut().zip(elements) {
                *own = of_element(number).unwrap_or(*own);
            }
        }
        colors.map_or(Colors::One(color), |colors| Colors::distinct(&colors))
    }

    /// Returns the text columns whose values are looked up in the tables of elements.
    fn element_columns<'a>(&self, loaded: &'a Dataset) -> Result<Vec<&'a Labels>, DataError> {
        let labels = |key, column| self.labels(loaded, key, column);
        match &self.elements_by[..] {
            [] if self.elements.is_empty() => Ok(Vec::new()),
            [] => Ok(vec![labels("elements", "species")?]),
            columns => columns.iter().map(|column| labels("elements_by", column)).collect(),
        }
    }

    /// Returns the table of elements of each sphere, as its number from 1, or 0 for none. Empty if there are no tables.
    fn element_of_each(&self, loaded: &Dataset) -> Result<Vec<u32>, DataError> {
        let number = |name: &String| {
            let place = self.elements.iter().position(|element| element.name == *name);
            place.map_or(0, |place| place as u32 + 1)
        };
        let mut numbers = Vec::new();
        for labels in self.element_columns(loaded)? {
            let of_names: Vec<u32> = labels.names.iter().map(number).collect();
            numbers.resize(loaded.spheres.len(), 0);
            for (found, name) in numbers.iter_mut().zip(&labels.indices).filter(|(n, _)| **n == 0) {
                *found = of_names.get(*name as usize).copied().unwrap_or_default();
            }
        }
        Ok(numbers)
    }

    /// The table of elements with a number from 1.
    fn element(&self, number: u32) -> Option<&Element> {
        self.elements.get((number as usize).checked_sub(1)?)
    }

    /// Returns a note about each table of elements whose name does not occur.
    fn absent_elements(&self, loaded: &Dataset) -> Result<Vec<String>, DataError> {
        let columns = self.element_columns(loaded)?;
        let occurs = |name: &String| columns.iter().any(|labels| labels.names.contains(name));
        let absent = self.elements.iter().filter(|element| !occurs(&element.name));
        let note = |Element { name, .. }: &Element| {
            format!(
                "`[elements.{name}]`: no atom of {} has this name; check its spelling or remove the table",
                self.file
            )
        };
        Ok(absent.map(note).collect())
    }

    /// Returns the text column that a key of the scene file names.
    fn labels<'a>(&self, loaded: &'a Dataset, key: &str, column: &str) -> Result<&'a Labels, DataError> {
        let file = &self.file;
        loaded.labels(column).ok_or_else(|| {
            let mut texts =
                loaded.columns.iter().filter(|column| matches!(column.values, ColumnValues::Labels(_))).peekable();
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

    /// Takes the spheres away that `leave_out` names. Returns notes.
    fn leave_out(&self, loaded: &mut Dataset) -> Result<Vec<String>, DataError> {
        let (mut notes, mut is_kept) = (Vec::new(), Vec::new());
        for (column, values) in &self.leave_out {
            let labels = self.labels(loaded, "leave_out", column)?;
            is_kept.resize(loaded.spheres.len(), true);
            let stays: Vec<bool> = labels.names.iter().map(|name| !values.contains(name)).collect();
            for (is_kept, index) in is_kept.iter_mut().zip(&labels.indices) {
                *is_kept &= stays.get(*index as usize).copied().unwrap_or(true);
            }
            let absent = values.iter().filter(|value| !labels.names.contains(value));
            notes.extend(absent.map(|value| {
                format!(
                    "`leave_out`: no atom of {} has the {column} {value}; check its spelling or remove it",
                    self.file
                )
            }));
        }
        if !is_kept.is_empty() && !is_kept.contains(&true) {
            notes.push(format!("`leave_out` removes all atoms of {}; remove some of its values", self.file));
        }
        loaded.keep(&is_kept);
        Ok(notes)
    }
}
