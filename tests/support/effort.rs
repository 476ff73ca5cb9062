//! The fraction of a heavy campaign that runs.

/// The fraction of heavy campaigns that runs. It is an eighth, or the value of the environment variable
/// `PINHOLE_EFFORT`, which must be above 0 and at most 1.
pub(crate) fn effort() -> f64 {
    let Ok(text) = std::env::var("PINHOLE_EFFORT") else { return 0.125 };
    let effort = text.parse().unwrap_or(0.0);
    assert!(effort > 0.0 && effort <= 1.0, "PINHOLE_EFFORT is {text}, not above 0 and at most 1");
    effort
}

/// Selects the cases of a campaign that run: the first, and by default every eighth from there. At effort 1, all.
pub(crate) fn share<T>(all: impl Iterator<Item = T>) -> impl Iterator<Item = T> {
    all.step_by((1.0 / effort()).round() as usize)
}

/// The number of tries of a campaign that has `full` tries if all of it runs. At least one.
pub(crate) fn tries(full: u32) -> u32 {
    (f64::from(full) * effort()).ceil() as u32
}
