//! What a certificate says as a whole.

use std::fmt;

/// The largest share of answers that may stay undecided in a certificate that proves something.
pub const MOST_UNDECIDED: f64 = 0.01;

/// What a certificate says as a whole.
///
/// Only [`Outcome::Proved`] means that a picture is legal. A picture of which too much stays undecided is not called
/// legal, even if nothing in it is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Outcome {
    /// Nothing is wrong, and at most [`MOST_UNDECIDED`] of all answers are undecided.
    Proved,
    /// Nothing is known to be wrong, but more than [`MOST_UNDECIDED`] of all answers are undecided, or there are none.
    Undecided,
    /// At least one answer is wrong.
    Violated,
}

impl Outcome {
    /// All outcomes, from good to bad.
    pub const ALL: &'static [Self] = &[Self::Proved, Self::Undecided, Self::Violated];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Proved => "proved",
            Self::Undecided => "undecided",
            Self::Violated => "violated",
        }
    }

    /// The outcome of `all` answers.
    pub(super) fn of(is_violated: bool, undecided: u64, all: u64) -> Self {
        match (is_violated, undecided as f64 <= MOST_UNDECIDED * all as f64 && all > 0) {
            (true, _) => Self::Violated,
            (false, true) => Self::Proved,
            (false, false) => Self::Undecided,
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_violation_counts_more_than_what_is_undecided() {
        for (is_violated, undecided, all, outcome) in [
            (false, 0, 1, Outcome::Proved),
            (false, 1, 100, Outcome::Proved),
            (false, 2, 100, Outcome::Undecided),
            (false, 0, 0, Outcome::Undecided),
            (true, 0, 1, Outcome::Violated),
            (true, 2, 100, Outcome::Violated),
        ] {
            assert_eq!(Outcome::of(is_violated, undecided, all), outcome);
        }
        assert!(Outcome::ALL.is_sorted());
    }
}
