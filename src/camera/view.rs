//! A camera with the film that it exposes.

use super::Camera;
use crate::camera::film::Film;
use crate::geometry::ray::Ray;

/// What is seen, and in how many pixels: a camera and a film.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// Which ray belongs to a place in the picture.
    pub camera: &'a dyn Camera,
    /// The picture's size.
    pub film: Film,
}

impl<'a> View<'a> {
    /// The picture of this size that a camera takes.
    #[must_use]
    pub fn new(camera: &'a dyn Camera, film: Film) -> Self {
        Self { camera, film }
    }

    /// The ray through the centre of a pixel, which is column and row; `None` where the camera sees nothing.
    #[must_use]
    pub fn ray_through_center(&self, [column, row]: [u32; 2]) -> Option<Ray> {
        let location = self.film.relative_location(f64::from(column) + 0.5, f64::from(row) + 0.5);
        self.camera.sees(location).then(|| self.camera.ray_in_world(location))
    }
}
