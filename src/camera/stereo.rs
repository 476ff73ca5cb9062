//! The parameters of a stereo pair in a scene file.

/// The table `stereo` of a camera, which asks for one picture for each eye.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct StereoParameters {
    /// Distance between the eyes, in scene units.
    pub separation: f64,
    /// Distance, in scene units, at which objects seem to lie in the screen; infinite if left out.
    #[serde(default = "infinitely_far")]
    pub convergence: f64,
}

fn infinitely_far() -> f64 {
    f64::INFINITY
}
