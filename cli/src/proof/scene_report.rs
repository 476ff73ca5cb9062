//! The shapes of a scene, in the reports of `verify` and `certify`.

use serde::Serialize;

use pinhole::scene::Scene;
use pinhole::verify::run_file::scene_sha256;

/// The shapes of a scene, and the digest of their numbers.
#[derive(Serialize)]
pub(crate) struct SceneReport {
    spheres: usize,
    /// The number of cylinders and cones.
    cones: usize,
    sha256: String,
}

impl SceneReport {
    pub(super) fn new(scene: &Scene) -> Self {
        Self { spheres: scene.len(), cones: scene.cones().len(), sha256: scene_sha256(scene) }
    }

    /// A line about them, with the number of bytes that the digest is of.
    pub(super) fn line(&self) -> String {
        let Self { spheres, cones, sha256 } = self;
        let cones_too = if *cones > 0 { format!(", {cones} cones") } else { String::new() };
        format!("scene: {spheres} spheres{cones_too}, {} bytes, sha256 {sha256}", 16 * spheres + 32 * cones)
    }
}
