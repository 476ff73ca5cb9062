//! Spheres, checked once and then immutable.

use std::collections::HashMap;

use glam::DVec3;

use crate::bounds::Bounds;
use crate::color::LinearRgb;
use crate::sphere::{Sphere, SphereError};

/// Spheres in the scene's own frame: an f64 origin, and f32 offsets from it.
///
/// The frame is the world's own unless the data lies farther from the world's origin, along an axis, than
/// it is wide; then the scene's origin is the middle of the data, so that f32 offsets keep its shape.
/// Both the GPU and the CPU reference see the same f32 numbers.
#[derive(Clone, Debug)]
pub struct Scene {
    origin: DVec3,
    spheres: Vec<[f32; 4]>,
    palette: Vec<LinearRgb>,
    /// Of each sphere, its place in the palette; `None` if all have the first colour.
    color_indices: Option<Vec<u32>>,
    bounds: Option<Bounds>,
}

/// Which sphere a scene refuses, and why.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A sphere is out of range.
    #[error("sphere {index}: {error}")]
    Sphere {
        /// Index in input order.
        index: usize,
        /// What is wrong with it.
        error: SphereError,
    },
    /// More spheres than ids.
    #[error("{count} spheres are too many; ids are u32 and {} means a miss", u32::MAX)]
    TooMany {
        /// How many were given.
        count: usize,
    },
}

impl Scene {
    /// Checks the spheres and moves them into the scene's frame. A scene may be empty.
    ///
    /// # Errors
    /// The first sphere, in input order, with a centre or radius that is out of range.
    pub fn new(spheres: &[Sphere]) -> Result<Self, SceneError> {
        if spheres.len() >= u32::MAX as usize {
            return Err(SceneError::TooMany { count: spheres.len() });
        }
        for (index, sphere) in spheres.iter().enumerate() {
            sphere.check().map_err(|error| SceneError::Sphere { index, error })?;
        }
        let bounds = spheres
            .iter()
            .map(|s| Bounds::of_sphere(DVec3::from(s.center), s.radius))
            .reduce(Bounds::union);
        let origin = bounds.map_or(DVec3::ZERO, frame_origin);
        let (palette, color_indices) = palette(spheres.iter().map(|s| s.color));
        Ok(Self {
            origin,
            spheres: spheres
                .iter()
                .map(|s| {
                    let offset = (DVec3::from(s.center) - origin).as_vec3();
                    [offset.x, offset.y, offset.z, s.radius as f32]
                })
                .collect(),
            palette,
            color_indices,
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

    /// The colour of a sphere, by its index in input order.
    ///
    /// # Panics
    /// If there is no such sphere.
    #[must_use]
    pub fn color(&self, id: u32) -> LinearRgb {
        assert!((id as usize) < self.spheres.len(), "there is no sphere {id}");
        match &self.color_indices {
            Some(indices) => self.palette[indices[id as usize] as usize],
            None => self.palette[0],
        }
    }

    /// Every colour that occurs, once; at least one if there is a sphere.
    #[must_use]
    pub fn palette(&self) -> &[LinearRgb] {
        &self.palette
    }

    /// Of every sphere, in input order, the place of its colour in the palette; `None` if all have the
    /// first.
    #[must_use]
    pub fn color_indices(&self) -> Option<&[u32]> {
        self.color_indices.as_deref()
    }

    /// The box of all spheres in the world, or `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// The box that a camera should show: of all spheres, or if there are none a unit cube.
    #[must_use]
    pub fn bounds_to_frame(&self) -> Bounds {
        self.bounds.unwrap_or(Bounds::of_sphere(self.origin, 0.5))
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

/// Where the scene's frame lies: zero along an axis while the world's origin is about as near as the data
/// is wide, else the data's middle.
///
/// The middle is rounded to f32. Then coordinates that were exact in f32 stay exact after the move,
/// because neither of two f32 is more than twice the other (Sterbenz).
fn frame_origin(bounds: Bounds) -> DVec3 {
    let width = bounds.size().max_element();
    let along = |center: f64| if center.abs() <= width { 0.0 } else { f64::from(center as f32) };
    DVec3::from(bounds.center().to_array().map(along))
}

/// Every colour once, in the order of first use, and the place of each sphere's; `None` if there is but
/// one.
fn palette(colors: impl Iterator<Item = LinearRgb>) -> (Vec<LinearRgb>, Option<Vec<u32>>) {
    let mut palette = Vec::new();
    let mut places = HashMap::new();
    let indices: Vec<u32> = colors
        .map(|color| {
            *places.entry(color.to_array().map(f32::to_bits)).or_insert_with(|| {
                palette.push(color);
                // No more than spheres, which are fewer than 2³².
                palette.len() as u32 - 1
            })
        })
        .collect();
    let several = palette.len() > 1;
    (palette, several.then_some(indices))
}
