//! All properties of spheres that columns may determine, together.

use std::collections::HashMap;

use super::ColorByError;
use super::number::short;
use super::{ColorBy, Coloring};
use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::{Appearance, Colors};
use pinhole_data::column::numbers;
use pinhole_data::load::Dataset;

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
#[derive(Default)]
pub(crate) struct MappedColumns {
    pub(crate) coloring: Option<Coloring>,
    /// Levels from 0 to 255 of opacities from 0 to 1.
    opacities: Option<Vec<u8>>,
    strengths: Option<Strengths>,
    /// Notes for the user, one line each.
    pub(crate) notes: Vec<String>,
}

impl Mapping {
    /// Looks up the columns. Radii are written to the spheres; colours, opacities and strengths of light are returned.
    /// Opacities are those of the column, or else of the data.
    pub(crate) fn apply(&self, loaded: &mut Dataset) -> Result<MappedColumns, ColorByError> {
        let Dataset { spheres, columns, .. } = loaded;
        let mut mapped = MappedColumns::default();
        if let Some(by) = &self.color {
            let mut coloring = by.apply(spheres, columns)?;
            mapped.notes.append(&mut coloring.notes);
            mapped.coloring = Some(coloring);
        }
        if let Some(column) = &self.opacity {
            let (name, values) = numbers(column, spheres, columns)?;
            mapped.opacities = Some(opacities(&name, &values, &mut mapped.notes));
        } else if let Some(of_data) = &loaded.opacities {
            let level = |opacity: &f32| (opacity * 255.0).round() as u8;
            mapped.opacities = Some(of_data.iter().map(level).collect());
        }
        if let Some(by) = &self.emission {
            let (name, values) = numbers(&by.column, spheres, columns)?;
            mapped.strengths = Some(strengths(by, &name, &values, &mut mapped.notes)?);
        }
        if let Some(by) = &self.radius {
            let (name, values) = numbers(&by.column, spheres, columns)?;
            let radii = radii(by, &name, &values)?;
            spheres.map_radii(|index, radius| radii.get(index).copied().unwrap_or(radius));
        }
        Ok(mapped)
    }
}

fn radii(by: &RadiusBy, column: &str, values: &[f64]) -> Result<Vec<f64>, ColorByError> {
    check_factor(column, by.factor)?;
    let radii: Vec<f64> = values.iter().map(|value| value * by.factor).collect();
    // A radius must not become zero in f32 either.
    let is_radius = |radius: &f64| radius.is_finite() && *radius as f32 > 0.0;
    match radii.iter().enumerate().find(|(_, radius)| !is_radius(radius)) {
        None => Ok(radii),
        Some((index, radius)) => Err(ColorByError::Values(format!(
            "sphere {index} would have the radius {}; a radius from `{column}` must be finite and greater than 0",
            short(*radius)
        ))),
    }
}

impl MappedColumns {
    /// The appearance of `count` spheres. Where no column determines them, colours are `colors`. The surface that no
    /// column determines is, of each sphere, the one of `bases` whose index is in `base_of`, or else the first.
    pub(crate) fn appearance(
        self,
        count: usize,
        colors: Colors,
        bases: &[SurfaceProperties],
        base_of: &[u32],
    ) -> Appearance {
        let Self { coloring, opacities, strengths, .. } = self;
        let by_column = |Coloring { palette, indices, .. }| Colors::Palette { palette, indices };
        let appearance = Appearance::new(coloring.map_or(colors, by_column));
        let are_equal = base_of.is_empty() && opacities.is_none() && strengths.is_none();
        if are_equal || count == 0 {
            return appearance.with_surface(bases.first().copied().unwrap_or_default());
        }
        let surface = |base: u32, strength: Option<u8>, opacity: Option<u8>| {
            let mut surface = bases.get(base as usize).copied().unwrap_or_default();
            let of_level = |level: u8| strengths.as_ref()?.strengths.get(usize::from(level));
            if let Some(strength) = strength.and_then(of_level) {
                surface.material = Material::Emissive { strength: *strength };
            }
            surface.opacity *= opacity.map_or(1.0, |level| f32::from(level) / 255.0);
            surface
        };
        // Only surfaces that occur are listed. There are at most 256 levels of opacity and of strength.
        let (mut surfaces, mut known) = (Vec::new(), HashMap::new());
        let indices = (0..count).map(|index| {
            let base = base_of.get(index).copied().unwrap_or_default();
            let strength = strengths.as_ref().and_then(|s| s.indices.get(index).copied());
            let opacity = opacities.as_ref().and_then(|levels| levels.get(index).copied());
            *known.entry((base, strength, opacity)).or_insert_with(|| {
                surfaces.push(surface(base, strength, opacity));
                surfaces.len() as u32 - 1
            })
        });
        let indices = indices.collect();
        appearance.with_surfaces(surfaces, indices)
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
        notes.push(format!("spheres without a value in `{column}` are opaque; there are {missing}"));
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
        .fold(None, |ends: Option<[f64; 2]>, s| Some(ends.map_or([s; 2], |[a, b]| [a.min(s), b.max(s)])));
    let dark = values.iter().filter(|value| strength(value) <= 0.0).count();
    if dark > 0 {
        notes.push(format!("{dark} spheres emit no light, because `{column}` is not a number greater than 0"));
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
    Ok(Strengths { strengths: (0..=255).map(of_level).collect(), indices: values.iter().map(level).collect() })
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
