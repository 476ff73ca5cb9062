//! Colours for numbers on a scale, and for categories: texts, or a small number of different whole numbers.

use std::cmp::Ordering;
use std::collections::HashMap;

use super::ColorByError;
use super::key::{Category, ColorKey, ColorScale, KeyKind};
use super::maps::MapName;
use super::number::short;
use super::scale::{Scale, entry, is_shown};
use super::{ColorBy, Coloring, Limits, hex};
use pinhole::image::color::LinearRgb;
use pinhole::internals::text::one_line;
use pinhole_data::column;
use pinhole_data::column::BUILT_IN;
use pinhole_data::load::Labels;

/// The most different whole numbers that become categories by default.
const MOST_CATEGORIES: usize = 8;

impl ColorBy {
    /// Whether the numbers of a column are categories. They are if a palette is chosen, or if they are few
    /// different whole numbers and no choice needs a scale.
    pub(super) fn are_categories(&self, found: &column::NamedColumn<'_>, values: &[f64]) -> bool {
        if self.categories.is_some() {
            return true;
        }
        if let Some(map) = &self.map {
            return map.is_palette();
        }
        if self.is_log || self.limits != super::Limits::default() || BUILT_IN.contains(&&*found.name) {
            return false;
        }
        let mut different: Vec<f64> = Vec::new();
        for value in values {
            if value.is_nan() || different.contains(value) {
                continue;
            }
            if value.fract() != 0.0 || value.abs() > 1e9 || different.len() == MOST_CATEGORIES {
                return false;
            }
            different.push(*value);
        }
        !different.is_empty()
    }

    pub(super) fn color_numbers(&self, column: &str, values: &[f64]) -> Result<Coloring, ColorByError> {
        let mut notes = Vec::new();
        let scale = self.scale(column, values.iter().copied(), &mut notes)?;
        let map = self.map.unwrap_or(MapName::VIRIDIS).reversed_if(self.is_reversed);
        let scale = ColorScale::new(scale, map.colors());
        let missing_index = scale.colors().len();
        let indices = values.iter().map(|value| scale.index(*value).unwrap_or(missing_index) as u32);
        let indices = indices.collect();
        let missing = values.iter().filter(|value| !is_shown(**value, self.is_log)).count();
        self.note_missing(column, missing, self.is_log, &mut notes);
        if self.limits != super::Limits::default() {
            let [low, high] = scale.scale().range();
            let is_outside = |v: f64| is_shown(v, self.is_log) && (v < low || v > high);
            let outside = values.iter().filter(|value| is_outside(**value)).count();
            if outside > 0 {
                let spheres = if outside == 1 { "sphere" } else { "spheres" };
                notes.push(format!(
                    "`{column}` of {outside} {spheres} lies outside the range {} to {} and has the color of its end",
                    short(low),
                    short(high)
                ));
            }
        }
        let palette = scale.colors().iter().chain([&self.missing]);
        Ok(Coloring {
            palette: palette.map(|color| LinearRgb::from_srgb8(*color)).collect(),
            indices,
            key: ColorKey {
                title: column.to_owned(),
                kind: KeyKind::Scale(scale),
                missing: (missing > 0).then_some(self.missing),
            },
            notes,
        })
    }

    /// Chooses the scale, and adds a note if it comes from the values.
    fn scale(
        &self,
        column: &str,
        values: impl Iterator<Item = f64>,
        notes: &mut Vec<String>,
    ) -> Result<Scale, ColorByError> {
        let Some([low, high]) = self.limits.resolve(values, self.is_log)? else {
            let what = if self.is_log { "number greater than 0" } else { "finite number" };
            return Err(no_value(column, what));
        };
        if self.limits.are_values() {
            return Ok(Scale::new([low, high], self.is_log)?);
        }
        if high - low == 0.0 {
            let value = low;
            let [low, high] = around(value, self.is_log);
            notes.push(if self.limits == super::Limits::default() {
                format!(
                    "`{column}` is {} for all spheres, so they all have one color; choose a range to place it on the map",
                    short(value)
                )
            } else {
                format!(
                    "both ends of the range of `{column}` are {}, so colors show {} to {}; choose another range",
                    short(value),
                    short(low),
                    short(high)
                )
            });
            return Ok(Scale::new([low, high], self.is_log)?);
        }
        let scale = Scale::new([low, high], self.is_log)?;
        notes.push(format!(
            "colors show `{column}` from {} to {}{}",
            short(low),
            short(high),
            if self.is_log { " on a logarithmic scale" } else { "" }
        ));
        Ok(scale)
    }

    pub(super) fn note_missing(&self, column: &str, missing: usize, is_log: bool, notes: &mut Vec<String>) {
        if missing == 0 {
            return;
        }
        let what = if is_log { "number greater than 0" } else { "value" };
        let (spheres, are) = if missing == 1 { ("sphere has", "is") } else { ("spheres have", "are") };
        notes.push(format!("{missing} {spheres} no {what} in `{column}` and {are} shown in {}", hex(self.missing)));
    }
}

fn no_value(column: &str, what: &str) -> ColorByError {
    ColorByError::Values(format!("the column `{column}` has no {what}, so it gives no colors"))
}

/// A range with a number in its middle.
fn around(value: f64, is_log: bool) -> [f64; 2] {
    if is_log {
        return [(value / 10.0).max(f64::MIN_POSITIVE), (value * 10.0).min(f64::MAX)];
    }
    let half = if value == 0.0 { 0.5 } else { 0.1 * value.abs() };
    [(value - half).max(f64::MIN), (value + half).min(f64::MAX)]
}

/// The most different numbers for which a palette may be used.
const MOST_NUMBERS: usize = 256;

const NONE: u32 = u32::MAX;

impl ColorBy {
    /// Colours texts. Texts are ordered as whole numbers if all are whole numbers, and otherwise alphabetically, so
    /// that they have the same colours in every frame with the same texts. Empty texts are missing values.
    pub(super) fn color_labels(&self, column: &str, labels: &Labels) -> Result<Coloring, ColorByError> {
        self.refuse_scale(|| format!("`{column}` holds text"))?;
        let mut counts = vec![0_usize; labels.names.len()];
        for label in &labels.indices {
            counts.get_mut(*label as usize).into_iter().for_each(|count| *count += 1);
        }
        // Texts that were in the file before a selection keep their colours.
        let is_used = |label: &usize| !labels.names[*label].trim().is_empty();
        let mut used: Vec<usize> = (0..labels.names.len()).filter(is_used).collect();
        let order = order(used.iter().map(|label| labels.names[*label].as_str()));
        used.sort_by(|a, b| order(&labels.names[*a], &labels.names[*b]));
        let mut category_of = vec![NONE; labels.names.len()];
        for (category, label) in used.iter().enumerate() {
            category_of[*label] = category as u32;
        }
        let of = |label: &u32| category_of.get(*label as usize).copied().unwrap_or(NONE);
        let categories = used.iter().map(|label| (one_line(&labels.names[*label]), counts[*label])).collect();
        let indices = labels.indices.iter().map(of).collect();
        self.color_categories(column, categories, indices, 0)
    }

    pub(super) fn color_whole_numbers(&self, column: &str, values: &[f64]) -> Result<Coloring, ColorByError> {
        let palette = self.map.unwrap_or(MapName::OKABE_ITO).name();
        self.refuse_scale(|| format!("`{palette}` is a palette for categories"))?;
        let refused = |why: String| {
            ColorByError::Values(format!(
                "`{palette}` is a palette for few different whole numbers or text, but {why}; choose a color map, such as \
                 viridis"
            ))
        };
        let mut categories: Vec<(f64, usize)> = Vec::new();
        let given: Option<Vec<f64>> =
            self.categories.as_ref().map(|names| names.iter().filter_map(|name| name.parse().ok()).collect());
        let mut others = 0;
        for value in values {
            if value.is_nan() {
                continue;
            }
            if given.as_ref().is_some_and(|given| !given.contains(value)) {
                others += 1;
                continue;
            }
            if value.fract() != 0.0 || value.is_infinite() {
                return Err(refused(format!("`{column}` contains {}", short(*value))));
            }
            match categories.binary_search_by(|(known, _)| known.total_cmp(&(value + 0.0))) {
                Ok(place) => categories[place].1 += 1,
                Err(_) if categories.len() == MOST_NUMBERS => {
                    return Err(refused(format!("`{column}` has more than {MOST_NUMBERS} different numbers")));
                }
                Err(place) => categories.insert(place, (value + 0.0, 1)),
            }
        }
        let index_of = |value: &f64| {
            let place = categories.binary_search_by(|(known, _)| known.total_cmp(&(value + 0.0)));
            place.map_or(NONE, |place| place as u32)
        };
        let indices = values.iter().map(index_of).collect();
        let named = categories.iter().map(|(value, count)| (format!("{value}"), *count)).collect();
        self.color_categories(column, named, indices, others)
    }

    fn refuse_scale(&self, why: impl Fn() -> String) -> Result<(), ColorByError> {
        let given = [("a logarithmic scale", self.is_log), ("a range", self.limits != Limits::default())];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((what, _)) => Err(ColorByError::Values(format!(
                "{what} applies only to numbers on a color map, but {}; remove it",
                why()
            ))),
            None => Ok(()),
        }
    }

    /// Gives colours to categories, each a name and the number of its spheres. `indices` has the category of each
    /// sphere, or [`NONE`]. `others` is the number of spheres whose value is not among the given categories.
    fn color_categories(
        &self,
        column: &str,
        categories: Vec<(String, usize)>,
        mut indices: Vec<u32>,
        mut others: usize,
    ) -> Result<Coloring, ColorByError> {
        let mut notes = Vec::new();
        let categories = match &self.categories {
            Some(given) => given_categories(given, &categories, &mut indices, &mut others),
            None => categories,
        };
        if self.categories.is_none() && categories.iter().all(|(_, count)| *count == 0) {
            return Err(no_value(column, "value"));
        }
        let map = self.map.unwrap_or(MapName::OKABE_ITO).reversed_if(self.is_reversed);
        let (colors, count) = (map.colors(), categories.len());
        let color_of = |category: usize| {
            if map.is_palette() {
                return colors[category % colors.len()];
            }
            // Categories are spread over the whole map. A single category has the middle colour.
            let position = if count > 1 { category as f64 / (count - 1) as f64 } else { 0.5 };
            colors[entry(position, colors.len())]
        };
        if map.is_palette() && count > colors.len() {
            notes.push(format!(
                "`{column}` has {count} different values and the palette {} only {} colors, so colors repeat; {}a \
                 color map such as batlow gives each its own",
                map.name(),
                colors.len(),
                if column == "name" { "`species` colors by element, and " } else { "" }
            ));
        }
        let mut missing = 0;
        for category in indices.iter_mut().filter(|category| **category == NONE) {
            *category = count as u32;
            missing += 1;
        }
        self.note_missing(column, missing - others, false, &mut notes);
        if others > 0 {
            let have = if others == 1 { "sphere has" } else { "spheres have" };
            notes.push(format!(
                "{others} {have} a value of `{column}` that is not among the categories and the color {}",
                hex(self.missing)
            ));
        }
        let categories: Vec<Category> = categories
            .into_iter()
            .enumerate()
            .map(|(index, (name, count))| Category { name, color: color_of(index), count })
            .collect();
        let colors = categories.iter().map(|category| category.color).chain([self.missing]);
        let palette = colors.map(LinearRgb::from_srgb8).collect();
        let is_seen = |category: &Category| category.count > 0 || self.categories.is_some();
        let categories = categories.into_iter().filter(is_seen).collect();
        Ok(Coloring {
            palette,
            indices,
            key: ColorKey {
                title: column.to_owned(),
                kind: KeyKind::Categories(categories),
                missing: (missing > 0).then_some(self.missing),
            },
            notes,
        })
    }
}

/// Puts categories, each a name and the number of its spheres, into the given order. Spheres of other categories are
/// counted in `others`.
fn given_categories(
    given: &[String],
    found: &[(String, usize)],
    indices: &mut [u32],
    others: &mut usize,
) -> Vec<(String, usize)> {
    let places: HashMap<&str, usize> = given.iter().enumerate().map(|(place, name)| (name.as_str(), place)).collect();
    let mut counts = vec![0; given.len()];
    let renumbered: Vec<u32> = found
        .iter()
        .map(|(name, count)| match places.get(name.as_str()) {
            Some(place) => {
                counts[*place] += count;
                *place as u32
            }
            None => {
                *others += count;
                NONE
            }
        })
        .collect();
    for index in indices {
        *index = renumbered.get(*index as usize).copied().unwrap_or(NONE);
    }
    given.iter().cloned().zip(counts).collect()
}

/// The order of categories with these names: that of whole numbers if all are, and otherwise alphabetic.
pub(super) fn order<'a>(mut names: impl Iterator<Item = &'a str>) -> fn(&str, &str) -> Ordering {
    fn whole(name: &str) -> Option<i64> {
        name.parse().ok()
    }
    match names.all(|name| whole(name).is_some()) {
        true => |a, b| whole(a).cmp(&whole(b)),
        false => |a, b| a.cmp(b),
    }
}
