//! Spheres, checked once: where they are, and apart from that what they look like.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use crate::geometry::bounds::Bounds;
#[cfg(feature = "run-file")]
use crate::geometry::math::MAX_LENGTH;
use crate::image::color::LinearRgb;
use crate::parallel;
use crate::scene::material::SurfaceProperties;
use crate::scene::sphere::{Sphere, SphereError};
use crate::scene::sphere_array::SphereArray;
use frame::{bounds_of_checked, f64_parts, frame_origin, moved, narrowed};

mod appearance;
mod checked;
mod color_map;
mod duplicates;
mod frame;
pub mod material;
mod material_table;
pub mod sphere;
pub mod sphere_array;
mod update;

#[cfg(feature = "gpu")]
pub(crate) use appearance::alpha_of;
pub use appearance::{Appearance, Colors};
pub(crate) use checked::SceneAppearance;
pub use color_map::{ColorMap, ColorMapError};
pub(crate) use duplicates::Duplicates;
pub use update::{Centers, NewColors, SceneUpdate, UpdateError};

/// Spheres in the scene's own frame: an f64 origin, and f32 offsets from it; and what they look like.
///
/// The frame is the world's own unless the data lies farther from the world's origin, along an axis, than
/// it is wide; then the scene's origin is the middle of the data, so that f32 offsets keep its shape.
/// Both the GPU and the CPU reference see the same f32 numbers.
#[derive(Clone, Debug)]
pub struct Scene {
    origin: DVec3,
    spheres: Vec<[f32; 4]>,
    /// Shared with those who need nothing else of the scene.
    appearance: Arc<SceneAppearance>,
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
    /// There is no memory for so many.
    #[error("there is no memory for {count} spheres; they need {} bytes", count * 16)]
    Memory {
        /// How many were given.
        count: usize,
    },
    /// The frame's origin is NaN, infinite or too far away.
    #[error("its origin {:?} is not finite, or too far away", origin.to_array())]
    Origin {
        /// The origin as given.
        origin: DVec3,
    },
    /// A sphere has no colour.
    #[error("sphere {index} has no color; the palette has {colors}")]
    Color {
        /// Index in input order.
        index: usize,
        /// How many colours there are.
        colors: usize,
    },
    /// The index of a sphere's surface properties is out of range.
    #[error("the surface index of sphere {index} is out of range; there are {surfaces} surfaces")]
    SurfaceProperties {
        /// Index in input order.
        index: usize,
        /// How many surface properties there are.
        surfaces: usize,
    },
    /// A sphere has the number NaN, for which a colour map has no colour.
    #[error("sphere {index} has the number NaN, which has no color")]
    Scalar {
        /// Index in input order.
        index: usize,
    },
    /// Something that every sphere has one of is there for fewer or more of them.
    #[error(
        "{}: there are {found} for {spheres} spheres",
        if found < spheres { format!("sphere {found} has no {what}") } else { format!("{what} {spheres} has no sphere") }
    )]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        spheres: usize,
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
        let bounds = bounds_of_checked(spheres, f64_parts)?;
        let origin = bounds.map_or(DVec3::ZERO, frame_origin);
        let narrow = narrowed(spheres, f64_parts, origin)?;
        Ok(Self::in_frame(origin, narrow, appearance_of(spheres), bounds))
    }

    /// A scene of spheres, and of what they look like. Neither is copied, but for spheres in f64; only spheres far
    /// from the world's origin are moved, in place.
    ///
    /// # Errors
    /// As [`Scene::new`]; as [`Appearance::check`].
    pub fn from_parts(points: SphereArray, appearance: Appearance) -> Result<Self, SceneError> {
        let count = points.len();
        let (origin, spheres, bounds) = match points {
            SphereArray::F32(mut spheres) => {
                let bounds = bounds_of_checked(&spheres, |s| s.map(f64::from))?;
                let origin = bounds.map_or(DVec3::ZERO, frame_origin);
                if origin != DVec3::ZERO {
                    parallel::for_each_mut(&mut spheres, |s| *s = moved(s.map(f64::from), origin));
                }
                (origin, spheres, bounds)
            }
            SphereArray::F64(spheres) => {
                let bounds = bounds_of_checked(&spheres, |s| *s)?;
                let origin = bounds.map_or(DVec3::ZERO, frame_origin);
                (origin, narrowed(&spheres, |s| *s, origin)?, bounds)
            }
        };
        appearance.check(count)?;
        Ok(Self::in_frame(origin, spheres, appearance, bounds))
    }

    /// As [`Scene::new`], of many spheres (x, y, z, radius) of one colour. They are kept as they are, and
    /// not copied; only those far from the world's origin are moved, in place.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn from_f32(spheres: Vec<[f32; 4]>, color: LinearRgb) -> Result<Self, SceneError> {
        Self::from_parts(SphereArray::F32(spheres), color.into())
    }

    /// As [`Scene::from_f32`], of spheres whose coordinates need f64.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn from_f64(spheres: &[[f64; 4]], color: LinearRgb) -> Result<Self, SceneError> {
        let bounds = bounds_of_checked(spheres, |s| *s)?;
        let origin = bounds.map_or(DVec3::ZERO, frame_origin);
        let spheres = narrowed(spheres, |s| *s, origin)?;
        Ok(Self::in_frame(origin, spheres, color.into(), bounds))
    }

    /// Of what has been checked.
    fn in_frame(
        origin: DVec3,
        spheres: Vec<[f32; 4]>,
        appearance: Appearance,
        bounds: Option<Bounds>,
    ) -> Self {
        let appearance = Arc::new(SceneAppearance::new(appearance, spheres.len()));
        Self { origin, spheres, appearance, bounds }
    }

    /// The same spheres, all with the same surface properties.
    #[must_use]
    pub fn with_surface(mut self, surface: SurfaceProperties) -> Self {
        let appearance = Arc::unwrap_or_clone(self.appearance).into_inner().with_surface(surface);
        self.appearance = Arc::new(SceneAppearance::new(appearance, self.spheres.len()));
        self
    }

    /// The opaque spheres in the same frame; `None` if that is all of them.
    #[cfg(feature = "gpu")]
    pub(crate) fn opaque(&self) -> Option<Self> {
        if self.appearance.is_opaque() {
            return None;
        }
        let spheres: Vec<[f32; 4]> =
            self.opaque_ids().map(|id| self.spheres[id as usize]).collect();
        let bounds = frame::bounds_in_frame(self.origin, &spheres);
        Some(Self::in_frame(self.origin, spheres, LinearRgb::WHITE.into(), bounds))
    }

    /// Indices of the opaque spheres, in their order.
    #[cfg(feature = "gpu")]
    pub(crate) fn opaque_ids(&self) -> impl Iterator<Item = u32> {
        (0..self.len() as u32).filter(|id| self.surface(*id).opacity >= 1.0)
    }

    /// A scene from all that another consisted of, to the bit, except that bounds are those of the f32 numbers.
    ///
    /// # Errors
    /// As [`Scene::from_parts`]; if the origin is out of range.
    #[cfg(feature = "run-file")]
    pub(crate) fn from_frame(
        origin: DVec3,
        spheres: Vec<[f32; 4]>,
        appearance: Appearance,
    ) -> Result<Self, SceneError> {
        // False for NaN as well.
        if !origin.abs().cmple(DVec3::splat(MAX_LENGTH)).all() {
            return Err(SceneError::Origin { origin });
        }
        appearance.check(spheres.len())?;
        bounds_of_checked(&spheres, frame::slackened)?;
        let bounds = frame::bounds_in_frame(origin, &spheres);
        Ok(Self::in_frame(origin, spheres, appearance, bounds))
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

    /// What the spheres look like.
    #[must_use]
    pub fn appearance(&self) -> &Appearance {
        &self.appearance
    }

    /// The same, with what follows from it.
    pub(crate) fn checked_appearance(&self) -> &Arc<SceneAppearance> {
        &self.appearance
    }

    /// The colour of a sphere, by its index in input order.
    ///
    /// # Panics
    /// If there is no such sphere.
    #[must_use]
    pub fn color(&self, id: u32) -> LinearRgb {
        assert!((id as usize) < self.spheres.len(), "there is no sphere {id}");
        self.appearance.color_of(id)
    }

    /// The surface properties of a sphere, by its index in input order. The opacity is theirs times the alpha of the
    /// sphere's colour.
    ///
    /// # Panics
    /// If there is no such sphere.
    #[must_use]
    pub fn surface(&self, id: u32) -> SurfaceProperties {
        assert!((id as usize) < self.spheres.len(), "there is no sphere {id}");
        self.appearance.surface_of(id)
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

impl SphereArray {
    /// A scene of these spheres, all of one colour.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn scene(self, color: LinearRgb) -> Result<Scene, SceneError> {
        Scene::from_parts(self, color.into())
    }
}

/// Every colour and all surface properties once, in the order of first use, and their indices for each sphere.
fn appearance_of(spheres: &[Sphere]) -> Appearance {
    let colors = Colors::of_palette(distinct(spheres, |sphere| keyed(sphere.color)));
    let (surfaces, surface_indices) =
        distinct(spheres, |sphere| (sphere.surface, sphere.surface.bits()));
    let surfaces = if surfaces.is_empty() { vec![SurfaceProperties::default()] } else { surfaces };
    Appearance::new(colors).with(surfaces, surface_indices)
}

impl Colors {
    /// Every colour once, in the order of first use, and the index of each sphere's.
    pub(crate) fn distinct(colors: &[LinearRgb]) -> Self {
        Self::of_palette(distinct(colors, |color| keyed(*color)))
    }

    fn of_palette((palette, indices): (Vec<LinearRgb>, Option<Vec<u32>>)) -> Self {
        match (&palette[..], indices) {
            (_, Some(indices)) => Self::Palette { palette, indices },
            ([color], None) => Self::One(*color),
            (_, None) => Self::One(LinearRgb::WHITE),
        }
    }
}

fn keyed(color: LinearRgb) -> (LinearRgb, [u32; 3]) {
    (color, color.to_array().map(f32::to_bits))
}

/// Everything that spheres have, once, and for each sphere an index into it; `None` if there is but one.
fn distinct<S, T, K: Eq + std::hash::Hash>(
    spheres: &[S],
    of: impl Fn(&S) -> (T, K),
) -> (Vec<T>, Option<Vec<u32>>) {
    let mut all = Vec::new();
    let mut indices = HashMap::new();
    let indices: Vec<u32> = spheres
        .iter()
        .map(|sphere| {
            let (one, key) = of(sphere);
            *indices.entry(key).or_insert_with(|| {
                all.push(one);
                // No more than spheres, which are fewer than 2³².
                all.len() as u32 - 1
            })
        })
        .collect();
    let several = all.len() > 1;
    (all, several.then_some(indices))
}
