//! Colour maps, which turn numbers into colours.

use crate::image::color::LinearRgb;

/// A table of colours for a range of numbers. The first entry is the colour of the low end, and the last that of the
/// high end. The others are spaced evenly between them.
///
/// A number has the colour of the nearest entry. A number outside the range has that of the nearest end. With n
/// entries, that is entry ⌊(value − low) / (high − low) · (n − 1) + ½⌋, computed in f64. Colours are not interpolated,
/// so all renderers show the same ones to the bit. 256 entries are as fine as an 8-bit display.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorMap {
    colors: Vec<LinearRgb>,
    range: [f32; 2],
}

/// The reason why a table and a range do not make a colour map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct ColorMapError(String);

impl ColorMap {
    /// A colour map from a table and the numbers of its first and last entry.
    ///
    /// # Errors
    /// Returns an error if there is no colour, if the ends are not finite, or if the first is not less than the second.
    pub fn new(colors: Vec<LinearRgb>, range: [f32; 2]) -> Result<Self, ColorMapError> {
        if colors.is_empty() {
            return Err(ColorMapError("a color map needs at least one color".to_owned()));
        }
        let [low, high] = range;
        if !(low.is_finite() && high.is_finite() && low < high) {
            return Err(ColorMapError(format!(
                "the range of a color map is {range:?}; its ends must be finite, and the first less than the second"
            )));
        }
        Ok(Self { colors, range })
    }

    /// The table of colours.
    #[must_use]
    pub fn colors(&self) -> &[LinearRgb] {
        &self.colors
    }

    /// The numbers of the first and the last entry.
    #[must_use]
    pub fn range(&self) -> [f32; 2] {
        self.range
    }

    /// The index of the entry for a number. Infinities have the entries of the ends. NaN, which no scene accepts, has
    /// the first entry.
    #[must_use]
    pub fn index(&self, value: f32) -> usize {
        let [low, high] = self.range.map(f64::from);
        let last = self.colors.len() - 1;
        let along = (f64::from(value) - low) / (high - low);
        // The conversion turns negative numbers and NaN into 0.
        ((along * last as f64 + 0.5).floor() as usize).min(last)
    }

    /// The colour of a number.
    #[must_use]
    pub fn color(&self, value: f32) -> LinearRgb {
        self.colors[self.index(value)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_the_nearest_entry() {
        let colors = [0.0, 0.5, 1.0].map(LinearRgb::gray);
        let map = ColorMap::new(colors.to_vec(), [-1.0, 3.0]).unwrap();
        for (value, entry) in [
            (-1.0, 0),
            (-0.01, 0),
            (0.0, 1),
            (1.0, 1),
            (1.99, 1),
            (2.0, 2),
            (3.0, 2),
            (-9.0, 0),
            (9.0, 2),
            (f32::NEG_INFINITY, 0),
            (f32::INFINITY, 2),
            (f32::MAX, 2),
        ] {
            assert_eq!(map.index(value), entry, "{value}");
            assert_eq!(map.color(value), colors[entry]);
        }
        let widest = ColorMap::new(colors.to_vec(), [f32::MIN, f32::MAX]).unwrap();
        assert_eq!([f32::MIN, 0.0, f32::MAX].map(|value| widest.index(value)), [0, 1, 2]);
        let one = ColorMap::new(vec![LinearRgb::WHITE], [0.0, 1.0]).unwrap();
        assert_eq!(one.index(0.7), 0);
    }

    #[test]
    fn what_is_no_map() {
        let refused = |colors, range| ColorMap::new(colors, range).unwrap_err().to_string();
        assert_eq!(refused(Vec::new(), [0.0, 1.0]), "a color map needs at least one color");
        for range in [[1.0, 1.0], [2.0, 1.0], [f32::NAN, 1.0], [0.0, f32::INFINITY]] {
            let error = refused(vec![LinearRgb::WHITE], range);
            assert!(error.starts_with("the range of a color map is"), "{error}");
        }
    }
}
