//! The part of a scene that a camera frames.

use std::sync::Arc;

use glam::DVec3;

use super::Scene;
use super::frame::moved;
use crate::geometry::bounds::Bounds;

impl Scene {
    /// The scene with the spheres (x, y, z, radius) that a camera should frame, in the place of all shapes. Without
    /// spheres, nothing changes.
    #[must_use]
    pub fn with_focus(mut self, spheres: &[[f64; 4]]) -> Self {
        let bounds = spheres.iter().map(|&[x, y, z, radius]| Bounds::of_sphere(DVec3::new(x, y, z), radius));
        let in_frame = spheres.iter().map(|sphere| moved(*sphere, self.origin)).collect();
        self.focus = bounds.reduce(Bounds::union).map(|bounds| Arc::new((in_frame, bounds)));
        self
    }

    /// The spheres that a camera should frame, in the frame of the scene; `None` if it should frame all shapes.
    #[must_use]
    pub fn focus(&self) -> Option<&[[f32; 4]]> {
        self.focus.as_deref().map(|(spheres, _)| &**spheres)
    }
}
