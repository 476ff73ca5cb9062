//! Finds biases: results that lie to one side of the middle of their bounds. If a device rounds without preference, its
//! results are as likely above the middle as below. A fault that is smaller than a bound moves all results to one side.
//! A conforming device may also prefer a side, so a bias is a note and not a violation.

use std::fmt;

use super::rounding::Interval;

/// Largest mean deviation that is not a bias. Devices without a fault stay below 0.01.
pub const LARGEST_MEAN: f64 = 0.02;

/// Distance of a mean from 0, in its standard errors, from which on it counts as a bias.
const STANDARD_ERRORS: f64 = 6.0;

/// Minimum number of results from which a bias can be concluded.
const FEWEST: u64 = 500;

/// Width of the widest bounds that are measured, relative to the middle.
const WIDEST: f64 = 0.1;

/// The distance of the results for a quantity from the middle of their bounds. A deviation belongs to the magnitude,
/// relative to half the width: 1 at the outer bound, -1 at the inner one.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// The stage that computes the quantity.
    pub stage: &'static str,
    /// The quantity.
    pub what: &'static str,
    count: u64,
    sum: f64,
    squares: f64,
}

impl Deviation {
    /// The number of results.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean deviation, from -1 to 1.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    /// Returns true if results lie to one side by more than [`LARGEST_MEAN`], and by more than chance explains.
    #[must_use]
    pub fn is_biased(&self) -> bool {
        let (count, mean) = (self.count as f64, self.mean());
        let variance = (self.squares / count - mean * mean).max(0.0);
        let error = (variance / count).sqrt();
        self.count >= FEWEST && mean.abs() > LARGEST_MEAN.max(STANDARD_ERRORS * error)
    }
}

impl fmt::Display for Deviation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stage, what, count, .. } = self;
        write!(f, "{stage}, {what}: {:+.4} of the bound in the mean of {count}", self.mean())
    }
}

/// The deviations of all quantities.
#[derive(Clone, Debug, Default)]
pub struct Deviations {
    all: Vec<Deviation>,
    /// Index of the quantity that was found last. The next quantity is usually the one behind it.
    last: usize,
}

impl PartialEq for Deviations {
    fn eq(&self, other: &Self) -> bool {
        self.all == other.all
    }
}

impl Deviations {
    /// The deviations of all quantities that were measured.
    pub fn iter(&self) -> impl Iterator<Item = &Deviation> {
        self.all.iter()
    }

    /// The quantities whose results lie to one side.
    pub fn biased(&self) -> impl Iterator<Item = &Deviation> {
        self.iter().filter(|deviation| deviation.is_biased())
    }

    fn of(&mut self, stage: &'static str, what: &'static str) -> &mut Deviation {
        let is_it = |one: &Deviation| one.what == what && one.stage == stage;
        let next = self.last + 1;
        self.last = match self.all.get(next) {
            Some(one) if is_it(one) => next,
            _ => self.all.iter().position(is_it).unwrap_or_else(|| {
                self.all.push(Deviation { stage, what, count: 0, sum: 0.0, squares: 0.0 });
                self.all.len() - 1
            }),
        };
        &mut self.all[self.last]
    }

    pub(super) fn add(&mut self, stage: &'static str, what: &'static str, deviation: f64) {
        let one = self.of(stage, what);
        one.count += 1;
        one.sum += deviation;
        one.squares += deviation * deviation;
    }

    /// Adds the result for a quantity, unless its bounds are too wide or too narrow to measure a deviation.
    pub(super) fn measure(&mut self, stage: &'static str, what: &'static str, found: f64, legal: Interval) {
        if let Some(deviation) = deviation(found, legal) {
            self.add(stage, what, deviation);
        }
    }

    pub(super) fn join(&mut self, other: &Self) {
        for Deviation { stage, what, count, sum, squares } in &other.all {
            let one = self.of(stage, what);
            one.count += count;
            one.sum += sum;
            one.squares += squares;
        }
    }
}

/// The deviation of the magnitude of a legal number from the middle of its bounds, relative to half their width. `None`
/// for bounds that contain zero, are wide, or belong to exact numbers.
pub(super) fn deviation(found: f64, Interval { low, high }: Interval) -> Option<f64> {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let is_telling = half > 0.0 && half <= WIDEST * middle.abs();
    is_telling.then(|| (found - middle) / half * middle.signum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_to_one_side_are_biased_and_others_are_not() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut deviations = Deviations::default();
        for _ in 0..20_000 {
            let middle = random.f64() - 0.5;
            let half = 1e-6 * middle.abs();
            let legal = Interval { low: middle - half, high: middle + half };
            let by_chance = 0.6 * (random.f64() - 0.5);
            for (what, shift) in [("fair", 0.0), ("larger", 0.05), ("smaller", -0.05)] {
                let found = middle + (by_chance + shift) * half * middle.signum();
                deviations.measure("test", what, found, legal);
            }
        }
        let biased: Vec<_> = deviations.biased().map(|one| one.what).collect();
        assert_eq!(biased, ["larger", "smaller"]);
        assert!(deviations.iter().all(|one| one.count() > 19_000));
        let mut twice = deviations.clone();
        twice.join(&deviations);
        assert!(twice.iter().zip(deviations.iter()).all(|(a, b)| a.count() == 2 * b.count()));
    }

    #[test]
    fn what_says_nothing_is_left_out() {
        let around = |middle: f64, half: f64| Interval { low: middle - half, high: middle + half };
        assert_eq!(deviation(1.0, around(1.0, 0.0)), None);
        assert_eq!(deviation(0.1, around(0.0, 1.0)), None);
        assert_eq!(deviation(1.1, around(1.0, 0.2)), None);
        assert_eq!(deviation(1.04, around(1.0, 0.08)).map(|d| (d * 8.0).round()), Some(4.0));
        assert_eq!(deviation(-1.04, around(-1.0, 0.08)).map(|d| (d * 8.0).round()), Some(4.0));
    }
}
