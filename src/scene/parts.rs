//! Scenes that are too large for memory, of which one part at a time is read.

use glam::Vec3;

use super::{Scene, Whole};

/// A scene whose parts are read one at a time, as often as they are needed.
///
/// The parts share the frame and the box of the whole. Spheres that are equal to the bit are in the same part, because a
/// ray that leaves a sphere must not meet an equal one.
pub trait SceneParts {
    /// All spheres together.
    fn whole(&self) -> Whole;

    /// What is known of each part before it is read. There is at least one part, and none is empty.
    fn extents(&self) -> Vec<PartExtent>;

    /// Reads the part with this index.
    ///
    /// # Errors
    /// A text for people if the part cannot be read, or is not what it was.
    fn read(&mut self, part: usize) -> Result<ScenePart, String>;
}

/// What is known of a part before it is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartExtent {
    /// The number of its spheres, which is not zero.
    pub count: u32,
    /// The corner with the smallest coordinates of the box of its spheres, in the frame of the whole.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
}

/// A part of a scene in memory.
#[derive(Clone, Debug)]
pub struct ScenePart {
    /// The spheres, made by [`Scene::part`].
    pub scene: Scene,
    /// The id of each sphere in the whole scene, ascending.
    pub ids: Vec<u32>,
}
