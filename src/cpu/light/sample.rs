//! One sample of a pixel: its random numbers, its ray, and its result.

use glam::{DVec2, DVec3};

use super::surface_ray::{Start, SurfaceRay};
use crate::camera::View;
use crate::camera::filter;
use crate::camera::sampling::{self, pixel_seed};
use crate::geometry::ray::Ray;

/// The result of one sample of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Radiance, in linear light.
    pub color: [f64; 3],
    /// How much the sample hides the background: 0 to 1.
    pub alpha: f64,
    /// Colour of the first surface, each component at most 1. With the path integrator, this is the first surface that
    /// the path does not pass through. Zero for a miss, and for a shadow catcher.
    pub albedo: [f64; 3],
}

/// The result of a sample while it is accumulated.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    pub(super) color: DVec3,
    pub(super) alpha: f64,
    pub(super) albedo: DVec3,
}

impl From<Found> for Sample {
    fn from(Found { color, alpha, albedo }: Found) -> Self {
        Self { color: color.to_array(), alpha, albedo: albedo.to_array() }
    }
}

/// The address of a sample's random numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Address {
    seed: u32,
    sample: u32,
}

impl Address {
    pub(super) fn new(pixel: [u32; 2], sample: u32, seed: u32) -> Self {
        Self { seed: pixel_seed(pixel, seed), sample }
    }

    pub(super) fn pair(self, pair: u32) -> [u32; 2] {
        sampling::pair(self.seed, self.sample, pair)
    }

    /// The address of the j-th of `count` parts of the sample. Beyond 2³² parts addresses repeat.
    pub(super) fn part(self, j: u32, count: u32) -> Self {
        let sample = self.sample.wrapping_mul(count).wrapping_add(j);
        Self { sample, ..self }
    }
}

/// The generator of camera rays for samples.
#[derive(Debug)]
pub(super) struct Lens<'a> {
    view: View<'a>,
    offsets: [f32; 257],
    /// Origin of the scene's frame.
    origin: DVec3,
}

impl<'a> Lens<'a> {
    pub(super) fn new(view: &View<'a>, offsets: [f32; 257], origin: DVec3) -> Self {
        Self { view: *view, offsets, origin }
    }

    /// The ray of a sample in the scene's frame; `None` where the camera has no ray.
    pub(super) fn surface_ray(&self, pixel: [u32; 2], address: Address) -> Option<SurfaceRay> {
        let offset = address.pair(0).map(|u| filter::offset(&self.offsets, u));
        let View { camera, film } = self.view;
        // In the whole film, so that a part rounds as the whole does.
        let place = film.in_whole(pixel);
        let [column, row] = [0, 1].map(|axis| f64::from(place[axis]) + 0.5 + offset[axis]);
        let location = film.whole().relative_location(column, row);
        if !camera.sees(location) {
            return None;
        }
        let ray = if camera.has_lens() {
            let lens = DVec2::from(address.pair(1).map(sampling::unit));
            camera.ray_through_lens(location, lens)
        } else {
            camera.ray_in_world(location)
        };
        let ray = Ray { origin: ray.origin - self.origin, ..ray };
        Some(SurfaceRay { ray, start: Start::Free })
    }
}
