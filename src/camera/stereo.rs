//! Two eyes, as a scene file gives them.

/// The table `stereo` of a camera's: a picture for each eye.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StereoParameters {
    /// How far the eyes are apart, in scene units.
    pub separation: f64,
    /// How far away things seem to lie in the screen, in scene units; without it, infinitely far.
    #[serde(default = "infinitely_far")]
    pub convergence: f64,
}

fn infinitely_far() -> f64 {
    f64::INFINITY
}
