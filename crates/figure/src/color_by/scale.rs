//! Maps numbers to positions on a colour map and back. The ends of a range are given as numbers or percentiles.

use std::str::FromStr;

use super::number::short;

/// A linear or logarithmic scale: it maps the numbers of a range to positions from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    low: f64,
    high: f64,
    is_log: bool,
}

/// The reason why a range does not make a scale.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScaleError {
    /// An end is not finite, or the first is not less than the second.
    #[error(
        "it is {} to {}; its ends must be finite, and the first less than the second (to turn the colors around, \
         reverse the map)",
        short(*.low), short(*.high)
    )]
    Range {
        /// The low end.
        low: f64,
        /// The high end.
        high: f64,
    },
    /// A logarithmic scale has an end that is not positive.
    #[error("it is {} to {}; the ends of a logarithmic scale must be greater than 0", short(*.low), short(*.high))]
    Log {
        /// The low end.
        low: f64,
        /// The high end.
        high: f64,
    },
    /// A percentile does not lie between 0 and 100.
    #[error("the percentile {}% does not lie between 0% and 100%", short(*.percent))]
    Percentile {
        /// The percentile as given.
        percent: f64,
    },
}

impl Scale {
    /// Makes a scale from `low`, at the position 0, to `high`, at the position 1.
    ///
    /// # Errors
    /// Returns an error if an end is not finite, if `low` is not less than `high`, or if the scale is logarithmic and an
    /// end is not positive.
    pub fn new([low, high]: [f64; 2], is_log: bool) -> Result<Self, ScaleError> {
        if !(low.is_finite() && high.is_finite() && low < high) {
            return Err(ScaleError::Range { low, high });
        }
        if is_log && low <= 0.0 {
            return Err(ScaleError::Log { low, high });
        }
        Ok(Self { low, high, is_log })
    }

    /// The numbers at the positions 0 and 1.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Returns true if positions follow the logarithm of the numbers.
    #[must_use]
    pub fn is_log(&self) -> bool {
        self.is_log
    }

    /// The position of a number, from 0 to 1. Numbers outside the range have the position of the nearer end. `None` for
    /// NaN, and on a logarithmic scale for numbers that are not positive.
    #[must_use]
    pub fn position(&self, value: f64) -> Option<f64> {
        if !is_shown(value, self.is_log) {
            return None;
        }
        if value <= self.low || value >= self.high {
            return Some(if value <= self.low { 0.0 } else { 1.0 });
        }
        let along = if self.is_log {
            (value.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            // Each is halved, because the difference of the ends may be too large for f64.
            (0.5 * value - 0.5 * self.low) / (0.5 * self.high - 0.5 * self.low)
        };
        Some(along.clamp(0.0, 1.0))
    }
}

/// Whether a number has a position: it is not NaN and, on a logarithmic scale, is positive.
pub(super) fn is_shown(value: f64, is_log: bool) -> bool {
    !value.is_nan() && (!is_log || value > 0.0)
}

/// The entry of a table of `count` colours for a position from 0 to 1, chosen as by [`ColorMap`](crate::ColorMap):
/// the nearest, with the first at 0 and the last at 1.
pub(super) fn entry(position: f64, count: usize) -> usize {
    let last = count.saturating_sub(1);
    ((position * last as f64 + 0.5).floor() as usize).min(last)
}

/// One end of a range.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(try_from = "LimitValue", into = "LimitValue")]
pub enum Limit {
    /// The smallest or the largest finite value.
    #[default]
    Automatic,
    /// A number.
    Value(f64),
    /// A percentile of the finite values, from 0 to 100. It is interpolated between two values.
    Percentile(f64),
}

/// The end of a range as a file gives it.
#[derive(serde::Deserialize, serde::Serialize)]
#[serde(untagged, expecting = "expected a number, or a percentile in quotes such as \"2%\"")]
enum LimitValue {
    Number(f64),
    Text(String),
}

impl TryFrom<LimitValue> for Limit {
    type Error = LimitError;

    fn try_from(value: LimitValue) -> Result<Self, LimitError> {
        match value {
            LimitValue::Number(number) => Ok(Self::Value(number)),
            LimitValue::Text(text) => text.parse(),
        }
    }
}

impl From<Limit> for LimitValue {
    fn from(limit: Limit) -> Self {
        match limit {
            Limit::Automatic => Self::Text(String::new()),
            Limit::Value(value) => Self::Number(value),
            Limit::Percentile(percent) => Self::Text(format!("{percent:?}%")),
        }
    }
}

/// Both ends of a range.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(try_from = "Vec<Limit>", into = "[Limit; 2]")]
pub struct Limits {
    /// The low end.
    pub low: Limit,
    /// The high end.
    pub high: Limit,
}

impl TryFrom<Vec<Limit>> for Limits {
    type Error = &'static str;

    fn try_from(ends: Vec<Limit>) -> Result<Self, &'static str> {
        match ends[..] {
            [low, high] => Ok(Self { low, high }),
            _ => Err("a range has two ends, such as [0, 1] or [\"2%\", \"98%\"]"),
        }
    }
}

impl From<Limits> for [Limit; 2] {
    fn from(Limits { low, high }: Limits) -> Self {
        [low, high]
    }
}

/// The error of a text that is not a limit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` is not a number; write a number, a percentile such as 2%, or nothing for the end of the data")]
#[non_exhaustive]
pub struct LimitError {
    /// The text as given.
    pub text: String,
}

impl FromStr for Limit {
    type Err = LimitError;

    /// Reads a number, a percentile such as `2%`, or an empty text for the end of the data.
    fn from_str(text: &str) -> Result<Self, LimitError> {
        let text = text.trim();
        let number = |digits: &str| {
            let parsed = digits.trim_end().parse().ok().filter(|number: &f64| number.is_finite());
            parsed.ok_or_else(|| LimitError { text: pinhole::internals::text::one_line(text) })
        };
        match text.strip_suffix('%') {
            _ if text.is_empty() => Ok(Self::Automatic),
            Some(percent) => number(percent).map(Self::Percentile),
            None => number(text).map(Self::Value),
        }
    }
}

impl FromStr for Limits {
    type Err = LimitError;

    /// Reads two limits, separated by a comma, such as `0,5` or `2%,98%` or `0,`.
    fn from_str(text: &str) -> Result<Self, LimitError> {
        let missing_comma = || LimitError { text: pinhole::internals::text::one_line(text) };
        let (low, high) = text.split_once(',').ok_or_else(missing_comma)?;
        Ok(Self { low: low.parse()?, high: high.parse()? })
    }
}

impl Limits {
    /// Whether both ends are given as numbers, so that they do not depend on the values.
    pub(crate) fn are_values(&self) -> bool {
        matches!((self.low, self.high), (Limit::Value(_), Limit::Value(_)))
    }

    /// The ends as numbers. Only values that the scale can show count: finite ones, and on a logarithmic scale positive
    /// ones. `None` if there are no such values and an end depends on them.
    pub(crate) fn resolve(
        &self,
        values: impl Iterator<Item = f64>,
        is_log: bool,
    ) -> Result<Option<[f64; 2]>, ScaleError> {
        for limit in [self.low, self.high] {
            match limit {
                Limit::Percentile(percent) if !(0.0..=100.0).contains(&percent) => {
                    return Err(ScaleError::Percentile { percent });
                }
                _ => {}
            }
        }
        if let (Limit::Value(low), Limit::Value(high)) = (self.low, self.high) {
            return Ok(Some([low, high]));
        }
        let shown = values.filter(|value| value.is_finite() && is_shown(*value, is_log));
        let is_percentile = |limit| matches!(limit, Limit::Percentile(_));
        if !is_percentile(self.low) && !is_percentile(self.high) {
            let ends = shown.fold(None, |ends: Option<[f64; 2]>, value| {
                Some(ends.map_or([value; 2], |[low, high]| [low.min(value), high.max(value)]))
            });
            return Ok(ends.map(|[low, high]| [self.low.or(low), self.high.or(high)]));
        }
        let mut sorted: Vec<f64> = shown.collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let (Some(first), Some(last)) = (sorted.first().copied(), sorted.last().copied()) else {
            return Ok(None);
        };
        let end = |limit: Limit, automatic| match limit {
            Limit::Percentile(percent) => percentile(&sorted, percent),
            _ => limit.or(automatic),
        };
        Ok(Some([end(self.low, first), end(self.high, last)]))
    }
}

impl Limit {
    fn or(self, automatic: f64) -> f64 {
        if let Self::Value(value) = self { value } else { automatic }
    }
}

/// A percentile of one or more sorted numbers, linearly interpolated between two of them.
fn percentile(sorted: &[f64], percent: f64) -> f64 {
    let place = percent / 100.0 * (sorted.len() - 1) as f64;
    let below = place.floor();
    let part = place - below;
    let at = |index: usize| sorted.get(index).or(sorted.last()).copied().unwrap_or(f64::NAN);
    let (low, high) = (at(below as usize), at(below as usize + 1));
    low * (1.0 - part) + high * part
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "what is compared is exact")]
mod tests {
    use super::*;

    #[test]
    fn positions_of_a_linear_scale() {
        let scale = Scale::new([-1.0, 3.0], false).unwrap();
        for (value, position) in [
            (-1.0, 0.0),
            (0.0, 0.25),
            (1.0, 0.5),
            (3.0, 1.0),
            (-9.0, 0.0),
            (9.0, 1.0),
            (f64::INFINITY, 1.0),
            (f64::NEG_INFINITY, 0.0),
        ] {
            assert_eq!(scale.position(value), Some(position), "{value}");
        }
        assert_eq!(scale.position(f64::NAN), None);
        let widest = Scale::new([f64::MIN, f64::MAX], false).unwrap();
        assert_eq!(widest.position(0.0), Some(0.5));
    }

    #[test]
    fn positions_of_a_logarithmic_scale() {
        let scale = Scale::new([0.01, 100.0], true).unwrap();
        for (value, position) in [(0.01, 0.0), (0.1, 0.25), (1.0, 0.5), (10.0, 0.75), (1e9, 1.0)] {
            assert!((scale.position(value).unwrap() - position).abs() < 1e-15, "{value}");
        }
        for value in [0.0, -0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
            assert_eq!(scale.position(value), None, "{value}");
        }
    }

    #[test]
    fn ranges_that_are_none_are_refused() {
        for [low, high] in [[1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]] {
            assert!(matches!(Scale::new([low, high], false), Err(ScaleError::Range { .. })));
        }
        assert!(matches!(Scale::new([0.0, 1.0], true), Err(ScaleError::Log { .. })));
    }

    #[test]
    fn the_ends_of_a_table_are_the_ends_of_the_scale() {
        assert_eq!([0.0, 0.24, 0.25, 0.5, 0.75, 1.0].map(|at| entry(at, 3)), [0, 0, 1, 1, 2, 2]);
        assert_eq!([entry(0.0, 256), entry(1.0, 256), entry(0.7, 1)], [0, 255, 0]);
    }

    fn resolved(text: &str, values: &[f64], is_log: bool) -> Option<[f64; 2]> {
        text.parse::<Limits>().unwrap().resolve(values.iter().copied(), is_log).unwrap()
    }

    #[test]
    fn ends_come_from_the_user_or_from_finite_values() {
        let values = [3.0, f64::NAN, -2.0, f64::INFINITY, 8.0, 0.0];
        assert_eq!(resolved(",", &values, false), Some([-2.0, 8.0]));
        assert_eq!(resolved("1, 1e3", &values, false), Some([1.0, 1e3]));
        assert_eq!(resolved("-1,", &values, false), Some([-1.0, 8.0]));
        assert_eq!(resolved(",", &values, true), Some([3.0, 8.0]));
        assert_eq!(resolved(",", &[f64::NAN], false), None);
        assert_eq!(resolved("1%,", &[-1.0], true), None);
        assert_eq!(resolved("0,1", &[], false), Some([0.0, 1.0]));
    }

    /// The expected numbers are those of NumPy's `percentile`.
    #[test]
    fn percentiles_are_interpolated() {
        let values: Vec<f64> = (0..=10).rev().map(f64::from).collect();
        assert_eq!(resolved("25%,98%", &values, false), Some([2.5, 9.8]));
        assert_eq!(resolved("0%,100%", &values, false), Some([0.0, 10.0]));
        assert_eq!(resolved("50%,", &[7.0], false), Some([7.0, 7.0]));
        let wrong: Limits = "-1%,5".parse().unwrap();
        assert_eq!(wrong.resolve(values.into_iter(), false), Err(ScaleError::Percentile { percent: -1.0 }));
    }

    #[test]
    fn texts_that_are_no_limits_are_refused() {
        for text in ["5", "a,b", "1,2,3", "nan,1", "1,inf", "%,1"] {
            assert!(text.parse::<Limits>().is_err(), "{text}");
        }
    }
}
