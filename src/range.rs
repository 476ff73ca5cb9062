//! The error for a number that is out of range, shared by all parameters.

/// A parameter is out of range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{parameter}` is {}; it must be {range}", self.value())]
pub struct RangeError {
    /// The name of the parameter, which is its key in a scene file.
    pub parameter: &'static str,
    /// The value as given.
    pub value: f64,
    /// The valid range, in words that follow "it must be".
    pub range: &'static str,
}

impl RangeError {
    /// The value in decimal; whole numbers are written without a decimal point.
    #[must_use]
    pub fn value(&self) -> String {
        format!("{:?}", self.value).trim_end_matches(".0").to_owned()
    }

    /// Returns the value if it is at least `low` and at most `high`. NaN is always out of range.
    ///
    /// # Errors
    /// Returns an error that names the parameter if the value is out of range.
    pub fn unless_within(
        parameter: &'static str,
        value: f64,
        [low, high]: [f64; 2],
        range: &'static str,
    ) -> Result<f64, Self> {
        if (low..=high).contains(&value) { Ok(value) } else { Err(Self { parameter, value, range }) }
    }
}
