//! A number that is out of its range, in words that every parameter shares.

/// A parameter is out of range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{parameter}` is {}; it must be {range}", self.value())]
pub struct RangeError {
    /// The key of a scene file.
    pub parameter: &'static str,
    /// As given.
    pub value: f64,
    /// What it must be.
    pub range: &'static str,
}

impl RangeError {
    /// The number as people write it: a whole number has no point.
    #[must_use]
    pub fn value(&self) -> String {
        format!("{:?}", self.value).trim_end_matches(".0").to_owned()
    }

    /// The number, if it is at least `low` and at most `high`; NaN is not.
    pub(crate) fn unless_within(
        parameter: &'static str,
        value: f64,
        [low, high]: [f64; 2],
        range: &'static str,
    ) -> Result<f64, Self> {
        if (low..=high).contains(&value) {
            Ok(value)
        } else {
            Err(Self { parameter, value, range })
        }
    }
}
