//! Spheres, checked once and then immutable.

use glam::DVec3;

use crate::bounds::Bounds;
use crate::color::LinearRgb;
use crate::math::{MAX_LENGTH, MIN_LENGTH};
use crate::sphere::Sphere;

/// Spheres in the scene's own frame: an f64 origin, and f32 offsets from it.
///
/// The frame is the world's own unless the data lies farther from the world's origin than it is wide;
/// then the scene's origin is the middle of the data, so that f32 offsets keep its shape.
/// Both the GPU and the CPU reference see the same f32 numbers.
#[derive(Clone, Debug)]
pub struct Scene {
    origin: DVec3,
    spheres: Vec<[f32; 4]>,
    colors: Vec<LinearRgb>,
    bounds: Option<Bounds>,
}

/// Which sphere a scene refuses, and why.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A centre is NaN, infinite or too far away.
    #[error(
        "sphere {index}: its center is ({}, {}, {}); every coordinate must be finite and at most {MAX_LENGTH:e} in size",
        center[0], center[1], center[2]
    )]
    Center {
        /// Index in input order.
        index: usize,
        /// The centre as given.
        center: [f64; 3],
    },
    /// A radius is NaN, infinite, zero, negative or too small or large for f32 kernels.
    #[error(
        "sphere {index}: its radius is {radius}; a radius must be finite, greater than 0, and between {MIN_LENGTH:e} and {MAX_LENGTH:e}"
    )]
    Radius {
        /// Index in input order.
        index: usize,
        /// The radius as given.
        radius: f64,
    },
    /// A colour has a component that is NaN, infinite or negative.
    #[error(
        "sphere {index}: its color is ({}, {}, {}); every component must be finite and not negative",
        color[0], color[1], color[2]
    )]
    Color {
        /// Index in input order.
        index: usize,
        /// The colour as given, linear.
        color: [f32; 3],
    },
    /// More spheres than ids.
    #[error("{count} spheres are too many; ids are u32 and {} means a miss", u32::MAX)]
    TooMany {
        /// How many were given.
        count: usize,
    },
}

impl SceneError {
    /// The index of the sphere that is at fault, if it is one sphere.
    #[must_use]
    pub fn index(&self) -> Option<usize> {
        match *self {
            Self::Center { index, .. } | Self::Radius { index, .. } | Self::Color { index, .. } => {
                Some(index)
            }
            Self::TooMany { .. } => None,
        }
    }
}

impl Scene {
    /// Checks the spheres and moves them into the scene's frame. A scene may be empty.
    ///
    /// # Errors
    /// The first sphere, in input order, with a centre, radius or colour that is out of range.
    pub fn new(spheres: &[Sphere]) -> Result<Self, SceneError> {
        if spheres.len() >= u32::MAX as usize {
            return Err(SceneError::TooMany { count: spheres.len() });
        }
        for (index, sphere) in spheres.iter().enumerate() {
            check(index, sphere)?;
        }
        let bounds = spheres
            .iter()
            .map(|s| Bounds::of_sphere(DVec3::from(s.center), s.radius))
            .reduce(Bounds::union);
        let origin = bounds.map_or(DVec3::ZERO, frame_origin);
        Ok(Self {
            origin,
            spheres: spheres
                .iter()
                .map(|s| {
                    let offset = (DVec3::from(s.center) - origin).as_vec3();
                    [offset.x, offset.y, offset.z, s.radius as f32]
                })
                .collect(),
            colors: spheres.iter().map(|s| s.color).collect(),
            bounds,
        })
    }

    /// Where the scene's frame lies in the world.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Centre (x, y, z) in the scene's frame, and radius, of every sphere, in input order.
    #[must_use]
    pub fn spheres(&self) -> &[[f32; 4]] {
        &self.spheres
    }

    /// The colour of every sphere, in input order.
    #[must_use]
    pub fn colors(&self) -> &[LinearRgb] {
        &self.colors
    }

    /// The box of all spheres in the world, or `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// How many spheres there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.spheres.len()
    }

    /// Whether there is no sphere.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.spheres.is_empty()
    }
}

fn check(index: usize, sphere: &Sphere) -> Result<(), SceneError> {
    // `contains` is false for NaN.
    let in_range = |x: &f64| (-MAX_LENGTH..=MAX_LENGTH).contains(x);
    if !sphere.center.iter().all(in_range) {
        return Err(SceneError::Center { index, center: sphere.center });
    }
    if !(MIN_LENGTH..=MAX_LENGTH).contains(&sphere.radius) {
        return Err(SceneError::Radius { index, radius: sphere.radius });
    }
    if !sphere.color.0.iter().all(|c| c.is_finite() && *c >= 0.0) {
        return Err(SceneError::Color { index, color: sphere.color.0 });
    }
    Ok(())
}

/// Zero while the world's origin is about as near as the data is wide, else the data's middle.
///
/// The middle is rounded to f32, so that data which was exact in f32 stays exact after the move.
fn frame_origin(bounds: Bounds) -> DVec3 {
    let center = bounds.center();
    if center.abs().max_element() <= bounds.size().max_element() {
        DVec3::ZERO
    } else {
        center.as_vec3().as_dvec3()
    }
}
