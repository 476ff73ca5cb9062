//! Rows of a table that follow a curve, such as a trajectory.

use crate::load::Dataset;

/// The fewest points of a curve, and the most: longer ones fill space in a picture.
const COUNT: std::ops::RangeInclusive<usize> = 20..=100_000;

/// The longest step, as a part of the diagonal of the box, and the part of the steps that turn by less than 60 degrees at
/// least. Points that are sorted along a curve that fills space turn more.
const STEP: f64 = 0.1;
const SMOOTH: f64 = 0.9;

/// Tells whether the centres follow a smooth curve in their order.
pub(crate) fn is_curve(data: &Dataset, diagonal: f64) -> bool {
    let count = data.spheres.len();
    if !COUNT.contains(&count) {
        return false;
    }
    let step = |index: usize| data.center(index + 1) - data.center(index);
    // The negation refuses steps that are no numbers, too.
    if !(0..count - 1).all(|index| step(index).length() <= STEP * diagonal) {
        return false;
    }
    let directions: Vec<_> = (0..count - 1).filter_map(|index| step(index).try_normalize()).collect();
    let smooth = directions.windows(2).filter(|pair| pair[0].dot(pair[1]) > 0.5).count();
    directions.len() >= *COUNT.start() / 2 && smooth as f64 >= SMOOTH * (directions.len() - 1) as f64
}

/// The radius of a tube through the centres in their order: thinner where it is long, so that windings stay apart.
/// `None` if all are in one place.
pub(super) fn radius(data: &Dataset, diagonal: f64) -> Option<f64> {
    let count = data.spheres.len();
    let steps = (1..count).map(|index| data.center(index).distance(data.center(index - 1)));
    let length: f64 = steps.filter(|step| step.is_finite()).sum();
    let part = (0.018 * (diagonal / length).sqrt()).clamp(1.0 / 600.0, 1.0 / 100.0);
    Some(diagonal * part).filter(|radius| *radius > 0.0)
}
