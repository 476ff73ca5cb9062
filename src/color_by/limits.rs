//! The ends of a range, given as numbers or percentiles.

use std::str::FromStr;

use super::scale::{ScaleError, is_shown};

/// One end of a range.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Limit {
    /// The smallest or the largest finite value.
    #[default]
    Automatic,
    /// A number.
    Value(f64),
    /// A percentile of the finite values, from 0 to 100; between two values it is interpolated.
    Percentile(f64),
}

/// Both ends of a range.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// The low end.
    pub low: Limit,
    /// The high end.
    pub high: Limit,
}

/// A text is not a limit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is not a number; write a number, a percentile such as 2%, or nothing for the end of the data"
)]
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
            parsed.ok_or_else(|| LimitError { text: crate::text::one_line(text) })
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

    /// Reads two limits that a comma separates, such as `0,5` or `2%,98%` or `0,`.
    fn from_str(text: &str) -> Result<Self, LimitError> {
        let missing_comma = || LimitError { text: crate::text::one_line(text) };
        let (low, high) = text.split_once(',').ok_or_else(missing_comma)?;
        Ok(Self { low: low.parse()?, high: high.parse()? })
    }
}

impl Limits {
    /// Whether both ends are numbers, so that the values do not matter.
    #[must_use]
    pub fn are_values(&self) -> bool {
        matches!((self.low, self.high), (Limit::Value(_), Limit::Value(_)))
    }

    /// The ends as numbers. Only values that the scale can show count: finite ones, and on a logarithmic scale positive
    /// ones. `None` if there are none and an end depends on them.
    ///
    /// # Errors
    /// Returns an error if a percentile does not lie between 0 and 100.
    pub fn resolve(
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

/// A percentile of sorted numbers, of which there is at least one; between two of them it is interpolated linearly.
fn percentile(sorted: &[f64], percent: f64) -> f64 {
    let place = percent / 100.0 * (sorted.len() - 1) as f64;
    let below = place.floor();
    let part = place - below;
    let at = |index: usize| sorted.get(index).or(sorted.last()).copied().unwrap_or(f64::NAN);
    let (low, high) = (at(below as usize), at(below as usize + 1));
    low * (1.0 - part) + high * part
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// The numbers are those of NumPy's `percentile`.
    #[test]
    fn percentiles_are_interpolated() {
        let values: Vec<f64> = (0..=10).rev().map(f64::from).collect();
        assert_eq!(resolved("25%,98%", &values, false), Some([2.5, 9.8]));
        assert_eq!(resolved("0%,100%", &values, false), Some([0.0, 10.0]));
        assert_eq!(resolved("50%,", &[7.0], false), Some([7.0, 7.0]));
        let wrong: Limits = "-1%,5".parse().unwrap();
        assert_eq!(
            wrong.resolve(values.into_iter(), false),
            Err(ScaleError::Percentile { percent: -1.0 })
        );
    }

    #[test]
    fn texts_that_are_no_limits_are_refused() {
        for text in ["5", "a,b", "1,2,3", "nan,1", "1,inf", "%,1"] {
            assert!(text.parse::<Limits>().is_err(), "{text}");
        }
    }
}
