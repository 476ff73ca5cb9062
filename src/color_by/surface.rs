//! Opacities and strengths of light from numbers, each in at most 256 levels, so that few surface properties differ.

use super::error::ColorByError;
use super::number::short;

/// Light strengths from a column.
#[derive(Clone, Debug, PartialEq)]
pub struct EmissionBy {
    /// The column; see [`column::column`](super::column::column).
    pub column: String,
    /// The factor by which its numbers are multiplied.
    pub factor: f64,
}

/// The largest strength of a material that emits light.
const STRONGEST: f64 = 1e6;

/// Levels of opacity for numbers from 0 to 1: byte 0 is clear, byte 255 is opaque. Numbers outside are clamped, and
/// missing ones are opaque; notes count both.
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

/// Strengths of light: for each sphere the index of its level in `strengths`, of which there are at most 256.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Strengths {
    pub(super) strengths: Vec<f32>,
    pub(super) indices: Vec<u8>,
}

/// Turns numbers into strengths. Equal ratios are equal steps between levels, because light strengths differ by powers
/// of ten. Level 0 is dark.
pub(super) fn strengths(
    by: &EmissionBy,
    column: &str,
    values: &[f64],
    notes: &mut Vec<String>,
) -> Result<Strengths, ColorByError> {
    check_factor(column, by.factor)?;
    // NaN is dark.
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

/// Refuses a factor that is not a positive number.
pub(super) fn check_factor(column: &str, value: f64) -> Result<(), ColorByError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(ColorByError::Factor { column: column.to_owned(), value })
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
            // Half a step of 254 over three decades.
            assert!((of(index) - exact).abs() <= 0.014 * exact, "{value}: {}", of(index));
        }
        assert_eq!([of(0), of(2)], [1.0, 1000.0]);
        assert!(notes[0].starts_with("3 spheres emit no light"), "{notes:?}");
        let one = strengths(&by, "l", &[3.0], &mut notes).unwrap();
        assert_eq!(one.strengths[usize::from(one.indices[0])], 6.0);
        let bad = EmissionBy { factor: 0.0, ..by };
        assert!(matches!(
            strengths(&bad, "l", &values, &mut notes),
            Err(ColorByError::Factor { .. })
        ));
    }
}
