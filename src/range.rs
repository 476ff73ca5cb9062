//! A number that is out of its range, in words that every parameter shares.

/// A parameter is out of range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{parameter}` is {value:?}; it must be {range}")]
pub struct RangeError {
    /// The key of a scene file.
    pub parameter: &'static str,
    /// As given.
    pub value: f64,
    /// What it must be.
    pub range: &'static str,
}

impl RangeError {
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
