//! A camera together with the film that it exposes.

use super::Camera;
use crate::camera::film::Film;
use crate::geometry::ray::Ray;

/// A camera and a film: what is seen, and in how many pixels.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The camera, which says which ray belongs to each location in the picture.
    pub camera: &'a dyn Camera,
    /// The size of the picture.
    pub film: Film,
}

impl<'a> View<'a> {
    /// The picture that `camera` takes on `film`.
    #[must_use]
    pub fn new(camera: &'a dyn Camera, film: Film) -> Self {
        Self { camera, film }
    }

    /// The ray through the centre of a pixel, given as column and row; `None` where the camera has no ray.
    #[must_use]
    pub fn ray_through_center(&self, [column, row]: [u32; 2]) -> Option<Ray> {
        let location = self.film.relative_location(f64::from(column) + 0.5, f64::from(row) + 0.5);
        self.camera.sees(location).then(|| self.camera.ray_in_world(location))
    }
}
