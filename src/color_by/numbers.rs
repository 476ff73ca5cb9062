//! Colours of numbers on a scale.

use super::column::BUILT_IN;
use super::error::ColorByError;
use super::key::{ColorKey, ColorScale, KeyKind};
use super::maps::MapName;
use super::number::short;
use super::scale::{Scale, is_shown};
use super::{ColorBy, Coloring, column, hex, is_kept};
use crate::image::color::LinearRgb;

/// Different whole numbers that become categories unless a map or a range is chosen.
const MOST_CATEGORIES: usize = 8;

impl ColorBy {
    /// Whether the numbers of a column are categories: those for which a palette is chosen, and few different whole
    /// numbers for which nothing is chosen that needs a scale.
    pub(super) fn are_categories(
        &self,
        found: &column::Found<'_>,
        values: &[f64],
        left_out: &[bool],
    ) -> bool {
        if self.categories.is_some() {
            return true;
        }
        if let Some(map) = &self.map {
            return map.is_palette();
        }
        if self.is_log
            || self.limits != super::Limits::default()
            || BUILT_IN.contains(&&*found.name)
        {
            return false;
        }
        let mut different: Vec<f64> = Vec::new();
        for (index, value) in values.iter().enumerate() {
            if value.is_nan() || !is_kept(left_out, index) || different.contains(value) {
                continue;
            }
            if value.fract() != 0.0 || value.abs() > 1e9 || different.len() == MOST_CATEGORIES {
                return false;
            }
            different.push(*value);
        }
        !different.is_empty()
    }

    /// Colours numbers by their position on the scale.
    pub(super) fn color_numbers(
        &self,
        column: &str,
        values: &[f64],
        left_out: &[bool],
    ) -> Result<Coloring, ColorByError> {
        let mut notes = Vec::new();
        let kept = || {
            let kept = values.iter().enumerate().filter(|(index, _)| is_kept(left_out, *index));
            kept.map(|(_, value)| *value)
        };
        let scale = self.scale(column, kept(), &mut notes)?;
        let map = self.map.unwrap_or(MapName::VIRIDIS).reversed_if(self.is_reversed);
        let scale = ColorScale::new(scale, map.colors());
        let missing_index = scale.colors().len();
        let indices =
            values.iter().map(|value| scale.index(*value).unwrap_or(missing_index) as u32);
        let indices = indices.collect();
        let missing = kept().filter(|value| !is_shown(*value, self.is_log)).count();
        self.note_missing(column, missing, self.is_log, &mut notes);
        if self.limits != super::Limits::default() {
            let [low, high] = scale.scale().range();
            let outside = kept().filter(|v| is_shown(*v, self.is_log) && (*v < low || *v > high));
            let outside = outside.count();
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

    /// Chooses the scale, and notes it if it comes from the values.
    fn scale(
        &self,
        column: &str,
        values: impl Iterator<Item = f64>,
        notes: &mut Vec<String>,
    ) -> Result<Scale, ColorByError> {
        let Some([low, high]) = self.limits.resolve(values, self.is_log)? else {
            let what = if self.is_log { "number greater than 0" } else { "finite number" };
            return Err(ColorByError::NoValue { column: column.to_owned(), what });
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

    /// Notes how many spheres have no value.
    pub(super) fn note_missing(
        &self,
        column: &str,
        missing: usize,
        is_log: bool,
        notes: &mut Vec<String>,
    ) {
        if missing == 0 {
            return;
        }
        let what = if is_log { "number greater than 0" } else { "value" };
        let (spheres, are) =
            if missing == 1 { ("sphere has", "is") } else { ("spheres have", "are") };
        notes.push(format!(
            "{missing} {spheres} no {what} in `{column}` and {are} shown in {}",
            hex(self.missing)
        ));
    }
}

/// A range with a number in its middle.
fn around(value: f64, is_log: bool) -> [f64; 2] {
    if is_log {
        return [(value / 10.0).max(f64::MIN_POSITIVE), (value * 10.0).min(f64::MAX)];
    }
    let half = if value == 0.0 { 0.5 } else { 0.1 * value.abs() };
    [(value - half).max(f64::MIN), (value + half).min(f64::MAX)]
}
