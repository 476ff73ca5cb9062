//! Spheres, checked once and then immutable.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use crate::bounds::Bounds;
use crate::color::LinearRgb;
use crate::material::Finish;
#[cfg(feature = "run-file")]
use crate::math::MAX_LENGTH;
use crate::parallel;
use crate::sphere::{self, Sphere, SphereError};

/// Spheres in the scene's own frame: an f64 origin, and f32 offsets from it.
///
/// The frame is the world's own unless the data lies farther from the world's origin, along an axis, than
/// it is wide; then the scene's origin is the middle of the data, so that f32 offsets keep its shape.
/// Both the GPU and the CPU reference see the same f32 numbers.
#[derive(Clone, Debug)]
pub struct Scene {
    origin: DVec3,
    spheres: Vec<[f32; 4]>,
    colors: Arc<SceneColors>,
    bounds: Option<Bounds>,
}

/// The colours and finishes of a scene's spheres; shared with those who need nothing else of it.
#[derive(Clone, Debug)]
pub(crate) struct SceneColors {
    palette: Vec<LinearRgb>,
    /// Of each place in the palette.
    finishes: Vec<Finish>,
    /// Of each sphere, its place in the palette; `None` if all have the first colour.
    indices: Option<Vec<u32>>,
}

impl SceneColors {
    /// All spheres have one.
    pub(crate) fn one(color: LinearRgb) -> Self {
        Self { palette: vec![color], finishes: vec![Finish::default()], indices: None }
    }

    pub(crate) fn palette(&self) -> &[LinearRgb] {
        &self.palette
    }

    pub(crate) fn finishes(&self) -> &[Finish] {
        &self.finishes
    }

    pub(crate) fn indices(&self) -> Option<&[u32]> {
        self.indices.as_deref()
    }

    /// The colour of a sphere, by its index in input order; `None` if there is no such sphere, but where all
    /// have one colour.
    #[cfg(feature = "gpu")]
    pub(crate) fn of(&self, id: u32) -> Option<LinearRgb> {
        let place = match &self.indices {
            Some(indices) => *indices.get(id as usize)?,
            None => 0,
        };
        self.palette.get(place as usize).copied()
    }
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
        let colors = Arc::new(palette(spheres));
        Ok(Self { origin, spheres: narrow, colors, bounds })
    }

    /// As [`Scene::new`], of many spheres (x, y, z, radius) of one colour. They are kept as they are, and
    /// not copied; only those far from the world's origin are moved, in place.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn from_f32(mut spheres: Vec<[f32; 4]>, color: LinearRgb) -> Result<Self, SceneError> {
        let bounds = bounds_of_checked(&spheres, |s| s.map(f64::from))?;
        let origin = bounds.map_or(DVec3::ZERO, frame_origin);
        if origin != DVec3::ZERO {
            parallel::for_each_mut(&mut spheres, |s| *s = moved(s.map(f64::from), origin));
        }
        Ok(Self { origin, spheres, colors: Arc::new(SceneColors::one(color)), bounds })
    }

    /// As [`Scene::from_f32`], of spheres whose coordinates need f64.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn from_f64(spheres: &[[f64; 4]], color: LinearRgb) -> Result<Self, SceneError> {
        let bounds = bounds_of_checked(spheres, |s| *s)?;
        let origin = bounds.map_or(DVec3::ZERO, frame_origin);
        let spheres = narrowed(spheres, |s| *s, origin)?;
        Ok(Self { origin, spheres, colors: Arc::new(SceneColors::one(color)), bounds })
    }

    #[cfg(feature = "gpu")]
    fn of_one_color(
        origin: DVec3,
        spheres: Vec<[f32; 4]>,
        color: LinearRgb,
        bounds: Option<Bounds>,
    ) -> Self {
        Self { origin, spheres, colors: Arc::new(SceneColors::one(color)), bounds }
    }

    /// The same spheres, all of one finish.
    #[must_use]
    pub fn with_finish(mut self, finish: Finish) -> Self {
        Arc::make_mut(&mut self.colors).finishes.fill(finish);
        self
    }

    /// The opaque spheres in the same frame; `None` if that is all of them.
    #[cfg(feature = "gpu")]
    pub(crate) fn opaque(&self) -> Option<Self> {
        if self.finishes().iter().all(|finish| finish.opacity >= 1.0) {
            return None;
        }
        let is_opaque = |id: &usize| self.finish(*id as u32).opacity >= 1.0;
        let spheres: Vec<[f32; 4]> =
            (0..self.len()).filter(is_opaque).map(|id| self.spheres[id]).collect();
        let in_world = |[x, y, z, radius]: [f64; 4]| {
            Bounds::of_sphere(self.origin + DVec3::new(x, y, z), radius)
        };
        let bounds = spheres.iter().map(|s| in_world(s.map(f64::from))).reduce(Bounds::union);
        Some(Self::of_one_color(self.origin, spheres, LinearRgb::WHITE, bounds))
    }

    /// A scene from all that another consisted of, to the bit, except that bounds are those of the f32 numbers.
    ///
    /// # Errors
    /// As [`Scene::new`]; if the origin is out of range; if a sphere has no colour.
    #[cfg(feature = "run-file")]
    pub(crate) fn from_parts(
        origin: DVec3,
        spheres: Vec<[f32; 4]>,
        palette: Vec<LinearRgb>,
        color_indices: Option<Vec<u32>>,
    ) -> Result<Self, SceneError> {
        // False for NaN as well.
        if !origin.abs().cmple(DVec3::splat(MAX_LENGTH)).all() {
            return Err(SceneError::Origin { origin });
        }
        let colors = palette.len();
        let without_color = match &color_indices {
            None => (colors == 0).then_some(0),
            Some(places) => {
                let bad = places.iter().position(|place| *place as usize >= colors);
                bad.or((places.len() < spheres.len()).then_some(places.len()))
            }
        };
        if let Some(index) = without_color.filter(|index| *index < spheres.len()) {
            return Err(SceneError::Color { index, colors });
        }
        // In its frame: what rounding the offset adds is no reason to refuse a sphere at the very edge.
        let in_frame = |sphere: &[f32; 4]| {
            let [x, y, z, radius] = sphere.map(f64::from);
            [x * FRAME_SLACK, y * FRAME_SLACK, z * FRAME_SLACK, radius]
        };
        bounds_of_checked(&spheres, in_frame)?;
        let in_world =
            |[x, y, z, radius]: [f64; 4]| Bounds::of_sphere(origin + DVec3::new(x, y, z), radius);
        let bounds = spheres.iter().map(|s| in_world(s.map(f64::from))).reduce(Bounds::union);
        let finishes = vec![Finish::default(); palette.len()];
        let colors = Arc::new(SceneColors { palette, finishes, indices: color_indices });
        Ok(Self { origin, spheres, colors, bounds })
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
        self.colors.palette[self.place_in_palette(id)]
    }

    /// The finish of a sphere, by its index in input order.
    ///
    /// # Panics
    /// If there is no such sphere.
    #[must_use]
    pub fn finish(&self, id: u32) -> Finish {
        assert!((id as usize) < self.spheres.len(), "there is no sphere {id}");
        self.colors.finishes[self.place_in_palette(id)]
    }

    fn place_in_palette(&self, id: u32) -> usize {
        self.colors.indices.as_ref().map_or(0, |indices| indices[id as usize] as usize)
    }

    /// Every colour that occurs with every finish that it has, once; at least one if there is a sphere.
    #[must_use]
    pub fn palette(&self) -> &[LinearRgb] {
        &self.colors.palette
    }

    /// The finish of each place in the palette.
    #[must_use]
    pub fn finishes(&self) -> &[Finish] {
        &self.colors.finishes
    }

    /// Of every sphere, in input order, the place of its colour in the palette; `None` if all have the
    /// first.
    #[must_use]
    pub fn color_indices(&self) -> Option<&[u32]> {
        self.colors.indices.as_deref()
    }

    pub(crate) fn colors(&self) -> &Arc<SceneColors> {
        &self.colors
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

/// Offsets are shorter than this times them by no more than rounding.
#[cfg(feature = "run-file")]
const FRAME_SLACK: f64 = 1.0 - 1.0 / (1 << 20) as f64;

fn f64_parts(sphere: &Sphere) -> [f64; 4] {
    let [x, y, z] = sphere.center;
    [x, y, z, sphere.radius]
}

/// Checks how many there are and every one of them, and finds the box of all.
fn bounds_of_checked<T: Sync>(
    spheres: &[T],
    parts: impl Fn(&T) -> [f64; 4] + Sync,
) -> Result<Option<Bounds>, SceneError> {
    if spheres.len() >= u32::MAX as usize {
        return Err(SceneError::TooMany { count: spheres.len() });
    }
    let of_chunk = |first: usize, chunk: &[T]| {
        let mut bounds: Option<Bounds> = None;
        for (place, item) in chunk.iter().enumerate() {
            let sphere @ [x, y, z, radius] = parts(item);
            sphere::check(sphere)
                .map_err(|error| SceneError::Sphere { index: first + place, error })?;
            let of_sphere = Bounds::of_sphere(DVec3::new(x, y, z), radius);
            bounds = Some(bounds.map_or(of_sphere, |bounds| bounds.union(of_sphere)));
        }
        Ok(bounds)
    };
    // The chunks' answers come in input order, so that the first bad sphere is the one that is named.
    let chunks: Result<Vec<_>, _> = parallel::map_chunks(spheres, of_chunk).into_iter().collect();
    Ok(chunks?.into_iter().flatten().reduce(Bounds::union))
}

/// The spheres in a frame, in f32.
fn narrowed<T: Sync>(
    spheres: &[T],
    parts: impl Fn(&T) -> [f64; 4] + Sync,
    origin: DVec3,
) -> Result<Vec<[f32; 4]>, SceneError> {
    parallel::try_map(spheres.len(), |i| moved(parts(&spheres[i]), origin))
        .map_err(|_| SceneError::Memory { count: spheres.len() })
}

/// One sphere in a frame, in f32.
fn moved([x, y, z, radius]: [f64; 4], origin: DVec3) -> [f32; 4] {
    let offset = (DVec3::new(x, y, z) - origin).as_vec3();
    [offset.x, offset.y, offset.z, radius as f32]
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

/// Every colour and finish once, in the order of first use, and the place of each sphere's; `None` if there is but
/// one.
fn palette(spheres: &[Sphere]) -> SceneColors {
    let (mut palette, mut finishes) = (Vec::new(), Vec::new());
    let mut places = HashMap::new();
    let indices: Vec<u32> = spheres
        .iter()
        .map(|Sphere { color, finish, .. }| {
            let key = (color.to_array().map(f32::to_bits), finish.bits());
            *places.entry(key).or_insert_with(|| {
                palette.push(*color);
                finishes.push(*finish);
                // No more than spheres, which are fewer than 2³².
                palette.len() as u32 - 1
            })
        })
        .collect();
    let several = palette.len() > 1;
    SceneColors { palette, finishes, indices: several.then_some(indices) }
}
