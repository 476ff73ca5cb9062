//! All properties of spheres that columns may determine, together.

use std::collections::HashMap;

use super::error::ColorByError;
use super::number::short;
use super::{ColorBy, ColorKey, Coloring, is_kept};
use pinhole::image::color::LinearRgb;
use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::sphere_array::SphereArray;
use pinhole::scene::{Appearance, Colors, Scene};
use pinhole_data::added::{AddedSpheres, Additions, Base};
use pinhole_data::column::numbers;
use pinhole_data::load::{Column, Dataset};

/// The columns that determine colour, radius, opacity and strength of light, each if it is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapping {
    /// The colours.
    pub color: Option<ColorBy>,
    /// The radii.
    pub radius: Option<RadiusBy>,
    /// The column of the opacities from 0 to 1, rounded to 256 levels. Others are clamped, with a note.
    pub opacity: Option<String>,
    /// The strengths of light, which make spheres emit light in their colour. They are rounded to 0 and 255 levels with
    /// equal ratios between them.
    pub emission: Option<EmissionBy>,
}

/// Radii from a column.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct RadiusBy {
    /// The column, as for [`ColorBy::column`].
    pub column: String,
    /// The factor by which its numbers are multiplied.
    #[serde(default = "one")]
    pub factor: f64,
}

const fn one() -> f64 {
    1.0
}

/// The properties of spheres from columns; see [`Mapping::apply`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MappedColumns {
    coloring: Option<Coloring>,
    opacities: Option<Vec<u8>>,
    strengths: Option<Strengths>,
    notes: Vec<String>,
}

impl Mapping {
    /// Whether no column is given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns this mapping, completed by `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            color: self.color.or(other.color),
            radius: self.radius.or(other.radius),
            opacity: self.opacity.or(other.opacity),
            emission: self.emission.or(other.emission),
        }
    }

    /// Looks up the columns. Radii are written to `spheres`; colours, opacities and strengths of light are returned.
    /// `left_out` has true for each sphere that is left out of the picture; it may be empty.
    ///
    /// # Errors
    /// Returns an error if there is no such column, or its values cannot be used.
    pub fn apply(
        &self,
        spheres: &mut SphereArray,
        columns: &[Column],
        left_out: &[bool],
    ) -> Result<MappedColumns, ColorByError> {
        let mut mapped = MappedColumns::default();
        if let Some(by) = &self.color {
            let mut coloring = by.apply(spheres, columns, left_out)?;
            mapped.notes.append(&mut coloring.notes);
            mapped.coloring = Some(coloring);
        }
        if let Some(column) = &self.opacity {
            let (name, values) = numbers(column, spheres, columns)?;
            mapped.opacities = Some(opacities(&name, &values, &mut mapped.notes));
        }
        if let Some(by) = &self.emission {
            let (name, values) = numbers(&by.column, spheres, columns)?;
            mapped.strengths = Some(strengths(by, &name, &values, &mut mapped.notes)?);
        }
        if let Some(by) = &self.radius {
            let (name, values) = numbers(&by.column, spheres, columns)?;
            let values = values.into_owned();
            set_radii(spheres, &name, by.factor, &values, left_out)?;
        }
        Ok(mapped)
    }

    /// Makes a scene from a file's spheres, and returns it with the properties from columns. Spheres without a colour
    /// from a column or the file have `color`. Opacities are those of the column, or else of the file.
    ///
    /// # Errors
    /// Returns an error if a column cannot be used, or names the first sphere that is out of range.
    pub fn scene(
        &self,
        loaded: Dataset,
        color: LinearRgb,
    ) -> Result<(Scene, MappedColumns), ColorByError> {
        let (scene, mapped, _) = self.scene_with(loaded, color, &Additions::default())?;
        Ok((scene, mapped))
    }

    /// Makes a scene like [`Mapping::scene`], with bonds or the edges of the cell after the spheres of the file. Added
    /// spheres do not affect the range of colours.
    ///
    /// # Errors
    /// Returns the errors of [`Mapping::scene`], and an error if the file lacks data for the additions.
    pub fn scene_with(
        &self,
        mut loaded: Dataset,
        color: LinearRgb,
        additions: &Additions,
    ) -> Result<(Scene, MappedColumns, AddedSpheres), ColorByError> {
        let mut mapped = self.apply(&mut loaded.spheres, &loaded.columns, &[])?;
        if self.radius.is_none() {
            additions.shrink(&mut loaded);
        }
        let added = additions.add(&Base::of(&loaded))?;
        if let (None, Some(of_file)) = (&mapped.opacities, &loaded.opacities) {
            let level = |opacity: &f32| (opacity * 255.0).round() as u8;
            mapped.opacities = Some(of_file.iter().map(level).collect());
        }
        let base = match loaded.colors {
            Some(colors) if mapped.coloring.is_none() => Colors::distinct(&colors),
            _ => Colors::One(color),
        };
        let count = loaded.spheres.len();
        let mut appearance = mapped.appearance(count, base, SurfaceProperties::default());
        if !added.is_empty() {
            appearance = added.extend_appearance(&appearance, count);
            added.extend_array(&mut loaded.spheres);
        }
        let scene = Scene::from_parts(loaded.spheres, appearance)?.with_added(added.len());
        Ok((scene, mapped, added))
    }
}

fn set_radii(
    spheres: &mut SphereArray,
    column: &str,
    factor: f64,
    values: &[f64],
    left_out: &[bool],
) -> Result<(), ColorByError> {
    check_factor(column, factor)?;
    for (index, value) in values.iter().enumerate() {
        let value = value * factor;
        // A radius must not become zero in f32 either.
        if !(value.is_finite() && value as f32 > 0.0) && is_kept(left_out, index) {
            return Err(ColorByError::Values(format!(
                "sphere {index} would have the radius {}; a radius from `{column}` must be finite and greater than 0",
                short(value)
            )));
        }
    }
    let radii = values.iter().map(|value| value * factor);
    match spheres {
        SphereArray::F32(spheres) => {
            spheres.iter_mut().zip(radii).for_each(|(sphere, radius)| sphere[3] = radius as f32);
        }
        SphereArray::F64(spheres) => {
            spheres.iter_mut().zip(radii).for_each(|(sphere, radius)| sphere[3] = radius);
        }
    }
    Ok(())
}

impl MappedColumns {
    /// The meaning of the colours, if columns gave colours.
    #[must_use]
    pub fn key(&self) -> Option<&ColorKey> {
        self.coloring.as_ref().map(|coloring| &coloring.key)
    }

    /// Notes for the user, one line each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The colour of a sphere by its index in input order, if columns gave colours.
    #[must_use]
    pub fn color(&self, index: usize) -> Option<LinearRgb> {
        self.coloring.as_ref()?.color(index)
    }

    /// The surface properties of a sphere. `base` gives those that no column determines.
    #[must_use]
    pub fn surface(&self, base: SurfaceProperties, index: usize) -> SurfaceProperties {
        let levels = self.levels(index);
        self.of_levels(base, levels)
    }

    fn levels(&self, index: usize) -> [Option<u8>; 2] {
        let strength = self.strengths.as_ref().and_then(|s| s.indices.get(index).copied());
        let opacity = self.opacities.as_ref().and_then(|levels| levels.get(index).copied());
        [strength, opacity]
    }

    fn of_levels(
        &self,
        base: SurfaceProperties,
        [strength, opacity]: [Option<u8>; 2],
    ) -> SurfaceProperties {
        let strength = strength
            .and_then(|level| self.strengths.as_ref()?.strengths.get(usize::from(level)).copied());
        let material = strength.map_or(base.material, |strength| Material::Emissive { strength });
        let opacity = opacity.map_or(1.0, |level| f32::from(level) / 255.0);
        SurfaceProperties { material, opacity: base.opacity * opacity }
    }

    /// The appearance of `count` spheres. `colors` and `base` apply where no column determines colours and surfaces.
    #[must_use]
    pub fn appearance(&self, count: usize, colors: Colors, base: SurfaceProperties) -> Appearance {
        let mut surfaces = Vec::new();
        let mut indices = Vec::new();
        if self.opacities.is_some() || self.strengths.is_some() {
            let mut known = HashMap::new();
            indices = (0..count)
                .map(|index| {
                    let levels = self.levels(index);
                    *known.entry(levels).or_insert_with(|| {
                        surfaces.push(self.of_levels(base, levels));
                        // There are at most 256 levels of opacity and of strength.
                        surfaces.len() as u32 - 1
                    })
                })
                .collect();
        }
        let colors = self.coloring.as_ref().map_or(colors, Coloring::to_colors);
        let appearance = Appearance::new(colors);
        match surfaces.is_empty() {
            true => appearance.with_surface(base),
            false => appearance.with_surfaces(surfaces, indices),
        }
    }
}

/// Light strengths from a column.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct EmissionBy {
    /// The column, as for [`ColorBy::column`].
    pub column: String,
    /// The factor by which its numbers are multiplied.
    #[serde(default = "one")]
    pub factor: f64,
}

const STRONGEST: f64 = 1e6;

/// Levels of opacity for numbers from 0 to 1: byte 0 is clear, byte 255 is opaque. Numbers outside are clamped, and
/// missing ones are opaque. Notes have the numbers of both.
pub(super) fn opacities(column: &str, values: &[f64], notes: &mut Vec<String>) -> Vec<u8> {
    let (mut outside, mut missing) = (0_usize, 0_usize);
    let mut level = |value: &f64| {
        if value.is_nan() {
            missing += 1;
            return 255;
        }
        outside += usize::from(!(0.0..=1.0).contains(value));
        (value.clamp(0.0, 1.0) * 255.0).round() as u8
    };
    let levels = values.iter().map(&mut level).collect();
    if outside > 0 {
        notes.push(format!(
            "{outside} values of `{column}` lie outside 0 to 1, the range of an opacity; they count as its ends"
        ));
    }
    if missing > 0 {
        notes
            .push(format!("spheres without a value in `{column}` are opaque; there are {missing}"));
    }
    levels
}

/// Strengths of light. Each sphere has the index of a level in `strengths`, which has at most 256 levels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Strengths {
    pub(super) strengths: Vec<f32>,
    pub(super) indices: Vec<u8>,
}

/// Turns numbers into strengths. Levels have equal ratios, because light strengths differ by powers of ten. Level 0 is
/// dark.
pub(super) fn strengths(
    by: &EmissionBy,
    column: &str,
    values: &[f64],
    notes: &mut Vec<String>,
) -> Result<Strengths, ColorByError> {
    check_factor(column, by.factor)?;
    // NaN becomes dark.
    let strength = |value: &f64| {
        if *value > 0.0 { (value * by.factor).min(STRONGEST) } else { 0.0 }
    };
    let ends = values
        .iter()
        .map(strength)
        .filter(|strength| *strength > 0.0)
        .fold(None, |ends: Option<[f64; 2]>, s| {
            Some(ends.map_or([s; 2], |[a, b]| [a.min(s), b.max(s)]))
        });
    let dark = values.iter().filter(|value| strength(value) <= 0.0).count();
    if dark > 0 {
        notes.push(format!(
            "{dark} spheres emit no light, because `{column}` is not a number greater than 0"
        ));
    }
    let bright = values.iter().filter(|value| **value * by.factor > STRONGEST).count();
    if bright > 0 {
        notes.push(format!(
            "{bright} values of `{column}` are stronger than {}, the strongest light; they count as that",
            short(STRONGEST)
        ));
    }
    let Some([low, high]) = ends else {
        return Ok(Strengths { strengths: vec![0.0], indices: vec![0; values.len()] });
    };
    let ratio = (high / low).ln();
    let level = |value: &f64| match strength(value) {
        s if s <= 0.0 => 0,
        _ if ratio <= 0.0 => 255,
        s => 1 + ((s / low).ln() / ratio * 254.0).round().clamp(0.0, 254.0) as u8,
    };
    let of_level = |level: u8| match level {
        0 => 0.0,
        level => (low * (ratio * f64::from(level - 1) / 254.0).exp()).min(high) as f32,
    };
    Ok(Strengths {
        strengths: (0..=255).map(of_level).collect(),
        indices: values.iter().map(level).collect(),
    })
}

pub(super) fn check_factor(column: &str, value: f64) -> Result<(), ColorByError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(ColorByError::Values(format!(
        "the factor of `{column}` is {}; it must be finite and greater than 0",
        short(value)
    )))
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "what is compared is exact")]
mod tests {
    use super::*;

    #[test]
    fn opacities_are_clamped_and_noted() {
        let mut notes = Vec::new();
        let values = [0.0, 0.5, 1.0, -3.0, 7.0, f64::NAN, f64::INFINITY];
        assert_eq!(opacities("q", &values, &mut notes), [0, 128, 255, 0, 255, 255, 255]);
        assert!(notes[0].starts_with("3 values of `q` lie outside 0 to 1"), "{notes:?}");
        assert_eq!(notes.len(), 2);
        notes.clear();
        opacities("q", &[0.25], &mut notes);
        assert!(notes.is_empty());
    }

    #[test]
    fn strengths_keep_ratios() {
        let by = EmissionBy { column: "l".to_owned(), factor: 2.0 };
        let values = [0.5, 5.0, 500.0, 0.0, -1.0, f64::NAN, 77.0];
        let mut notes = Vec::new();
        let found = strengths(&by, "l", &values, &mut notes).unwrap();
        let of = |index: usize| found.strengths[usize::from(found.indices[index])];
        for (index, value) in values.iter().enumerate() {
            let exact = if *value > 0.0 { 2.0 * *value as f32 } else { 0.0 };
            // The tolerance is half a step, of 254 steps over three decades.
            assert!((of(index) - exact).abs() <= 0.014 * exact, "{value}: {}", of(index));
        }
        assert_eq!([of(0), of(2)], [1.0, 1000.0]);
        assert!(notes[0].starts_with("3 spheres emit no light"), "{notes:?}");
        let one = strengths(&by, "l", &[3.0], &mut notes).unwrap();
        assert_eq!(one.strengths[usize::from(one.indices[0])], 6.0);
        let bad = EmissionBy { factor: 0.0, ..by };
        assert!(matches!(strengths(&bad, "l", &values, &mut notes), Err(ColorByError::Values(_))));
    }
}
