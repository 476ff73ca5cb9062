//! What a renderer answered, for which rays, and whether that can be judged.

use glam::DVec3;

use crate::camera::View;
use crate::geometry::ray::Ray;
use crate::image::NO_ID;
use crate::scene::Scene;

/// The unit of k: 2⁻²⁴, half the distance from 1 to the next f32.
pub const EPSILON: f64 = 1.0 / (1 << 24) as f64;

/// The largest k that an honest f32 renderer needs for ids and depths, for rays that it is given.
pub const OF_GIVEN_RAYS: f64 = 24.0;

/// What is added to the limit if the renderer made the rays by itself.
pub const FOR_CAMERAS: f64 = 16.0;

/// What is added to the limit if normals are judged.
pub const FOR_NORMALS: f64 = 8.0;

/// The part of the distance of a ray's start from the origin that is added to the size of a sphere.
pub(super) const OF_COORDINATES: f64 = 1.0 / 8.0;

/// The largest deviation of a ray's direction from unit length: 2⁻²⁰.
pub(super) const LENGTH_ERROR: f64 = 1.0 / (1 << 20) as f64;

/// The answers of a renderer, row by row from the top.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answers<'a> {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// The sphere of each pixel, as an index in input order; [`NO_ID`] for a miss.
    pub ids: &'a [u32],
    /// The depth of each pixel, in scene units. Depths of misses are not looked at.
    pub depths: Option<&'a [f64]>,
    /// What depths are.
    pub depth_kind: DepthKind,
    /// The unit normal of each pixel in world space, which points away from the sphere's centre. Normals of misses are
    /// not looked at.
    pub normals: Option<&'a [[f64; 3]]>,
}

/// What depths are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthKind {
    /// Distances from the ray's start, along the ray.
    #[default]
    Distance,
    /// Distances from the camera's plane, as a z-buffer has them once it is made linear.
    AlongAxis,
}

/// The rays of a picture.
#[derive(Clone, Copy, Debug)]
pub enum Rays<'a> {
    /// The rays through the centres of pixels, exactly. The renderer made them by itself.
    View(View<'a>),
    /// These rays in world space, row by row from the top. The renderer was given the same numbers. Directions are of
    /// unit length up to 2⁻²⁰.
    Given(&'a [Ray]),
}

/// Why answers cannot be judged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConformanceError {
    /// A list has the wrong length.
    #[error("there are {found} {what} for a picture of {}x{} pixels", size[0], size[1])]
    Count {
        /// What the list is of.
        what: &'static str,
        /// The length of the list.
        found: usize,
        /// Width and height of the picture.
        size: [u32; 2],
    },
    /// The picture is not as large as the view.
    #[error(
        "the picture is {}x{} pixels, but the view is {}x{}; render and certify the same size",
        found[0], found[1], view[0], view[1]
    )]
    Size {
        /// Width and height of the picture.
        found: [u32; 2],
        /// Width and height of the view.
        view: [u32; 2],
    },
    /// An id is not that of a sphere.
    #[error(
        "the id at {} is {found}, but the scene has {spheres} sphere{}; ids count them from 0 in the order of the input",
        at(*pixel),
        if *spheres == 1 { "" } else { "s" }
    )]
    Id {
        /// Column and row.
        pixel: [u32; 2],
        /// The id.
        found: u32,
        /// The number of spheres.
        spheres: usize,
    },
    /// A depth of a hit is not a distance.
    #[error(
        "the depth at {} is {found}, but its id is that of a sphere; the depth of a hit must be finite and at least 0",
        at(*pixel)
    )]
    Depth {
        /// Column and row.
        pixel: [u32; 2],
        /// The depth.
        found: f64,
    },
    /// A normal of a hit is not finite.
    #[error("the normal at {} is {found:?}; it must be finite", at(*pixel))]
    Normal {
        /// Column and row.
        pixel: [u32; 2],
        /// The normal.
        found: [f64; 3],
    },
    /// A ray does not start at a finite point.
    #[error("the ray at {} starts at {found:?}; coordinates must be finite", at(*pixel))]
    Origin {
        /// Column and row.
        pixel: [u32; 2],
        /// Where the ray starts.
        found: [f64; 3],
    },
    /// A direction does not have unit length.
    #[error(
        "the direction of the ray at {} has the length {length}, but must have unit length within 1e-6; divide \
         directions by their lengths",
        at(*pixel)
    )]
    Direction {
        /// Column and row.
        pixel: [u32; 2],
        /// The length of the direction.
        length: f64,
    },
    /// There is no axis along which depths could be measured.
    #[error("depths along an axis need a camera with a plane (pinhole, orthographic or thin-lens)")]
    NoAxis,
    /// The limit of k is not a positive number.
    #[error("the limit {found} must be greater than 0 and finite")]
    Limit {
        /// The limit.
        found: f64,
    },
}

/// A pixel in words.
fn at([column, row]: [u32; 2]) -> String {
    format!("pixel ({column}, {row})")
}

impl Answers<'_> {
    /// Column and row of a pixel.
    pub(super) fn pixel(&self, index: usize) -> [u32; 2] {
        let width = self.size[0].max(1) as usize;
        // The sides of a picture are u32.
        [(index % width) as u32, (index / width) as u32]
    }

    /// The largest k that an honest f32 renderer needs: see the [module](super).
    pub(super) fn limit(&self, rays: Rays<'_>) -> f64 {
        let for_camera = if matches!(rays, Rays::View(_)) { FOR_CAMERAS } else { 0.0 };
        let for_normals = if self.normals.is_some() { FOR_NORMALS } else { 0.0 };
        OF_GIVEN_RAYS + for_camera + for_normals
    }

    /// Whether the answers can be judged; every number is looked at.
    pub(super) fn check(&self, scene: &Scene, rays: Rays<'_>) -> Result<(), ConformanceError> {
        let size = self.size;
        let count = u64::from(size[0]) * u64::from(size[1]);
        let has = |what, found: usize| match found as u64 == count {
            true => Ok(()),
            false => Err(ConformanceError::Count { what, found, size }),
        };
        has("ids", self.ids.len())?;
        self.depths.map_or(Ok(()), |depths| has("depths", depths.len()))?;
        self.normals.map_or(Ok(()), |normals| has("normals", normals.len()))?;
        match rays {
            Rays::View(view) => {
                let view = [view.film.width(), view.film.height()];
                if view != size {
                    return Err(ConformanceError::Size { found: size, view });
                }
            }
            Rays::Given(rays) => {
                has("rays", rays.len())?;
                (0..).zip(rays).try_for_each(|(index, ray)| self.check_ray(index, ray))?;
            }
        }
        if self.depths.is_some() && self.depth_kind == DepthKind::AlongAxis && rays.axis().is_none()
        {
            return Err(ConformanceError::NoAxis);
        }
        self.check_numbers(scene.len())
    }

    fn check_ray(
        &self,
        index: usize,
        Ray { origin, direction }: &Ray,
    ) -> Result<(), ConformanceError> {
        let length = direction.length();
        if !origin.is_finite() {
            let found = origin.to_array();
            return Err(ConformanceError::Origin { pixel: self.pixel(index), found });
        }
        if (length - 1.0).abs() <= LENGTH_ERROR {
            return Ok(());
        }
        Err(ConformanceError::Direction { pixel: self.pixel(index), length })
    }

    fn check_numbers(&self, spheres: usize) -> Result<(), ConformanceError> {
        for (index, id) in self.ids.iter().enumerate().filter(|(_, id)| **id != NO_ID) {
            let pixel = || self.pixel(index);
            if *id as usize >= spheres {
                return Err(ConformanceError::Id { pixel: pixel(), found: *id, spheres });
            }
            if let Some(depths) = self.depths
                && !(depths[index].is_finite() && depths[index] >= 0.0)
            {
                return Err(ConformanceError::Depth { pixel: pixel(), found: depths[index] });
            }
            if let Some(normals) = self.normals
                && !DVec3::from(normals[index]).is_finite()
            {
                return Err(ConformanceError::Normal { pixel: pixel(), found: normals[index] });
            }
        }
        Ok(())
    }
}

impl Rays<'_> {
    /// The unit vector along which a camera with a plane measures depth.
    pub(super) fn axis(self) -> Option<DVec3> {
        let Self::View(view) = self else { return None };
        let vectors = view.camera.vectors();
        let axis = vectors.up.cross(vectors.right).normalize_or_zero();
        let along = if axis.dot(vectors.forward) < 0.0 { -axis } else { axis };
        view.camera.kind().is_linear().then_some(along)
    }
}
