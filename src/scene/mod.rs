//! Scenes: spheres, cones and cylinders that have been checked, and their appearance.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use crate::geometry::bounds::Bounds;
use crate::geometry::math::MAX_LENGTH;
use crate::geometry::subject::{Subject, WholeSubject};
use crate::image::color::LinearRgb;
use crate::parallel;
use crate::scene::cone::{Cone, ConeError};
use crate::scene::material::{Material, SurfaceProperties};
use crate::scene::sphere::Sphere;
use crate::scene::sphere_array::SphereArray;
use frame::{
    bounds_of_checked, bounds_of_cones, check_count, cones_in_frame, f64_parts, frame_origin, in_own_frame, moved,
};

mod appearance;
mod color_map;
pub mod cone;
mod duplicates;
mod error;
mod focus;
mod frame;
mod ghosts;
pub mod material;
mod shared;
pub mod sphere;
pub mod sphere_array;
pub mod tube;
mod update;

pub use crate::geometry::cone::ConeInFrame;
pub(crate) use appearance::SceneAppearance;
#[cfg(feature = "gpu")]
pub(crate) use appearance::alpha_of;
pub use appearance::{Appearance, Colors};
pub use color_map::{ColorMap, ColorMapError};
pub(crate) use duplicates::Duplicates;
pub use error::SceneError;
pub use frame::SceneExtent;
pub(crate) use shared::{Shape, SharedShapes};
pub use update::{Centers, NewColors, SceneUpdate, UpdateError};

/// Spheres, cones and cylinders in the frame of the scene, which is an f64 origin with f32 offsets, and their appearance.
///
/// The frame is that of the world unless the centre of the data is farther from the world's origin, along an axis, than
/// the longest side of the data's bounding box. Along such an axis, the origin is that centre, so that f32 offsets
/// preserve the shape of the data. The GPU and the CPU reference see the same f32 numbers.
#[derive(Clone, Debug)]
pub struct Scene {
    origin: DVec3,
    /// Shared with a device's copy, which draws smooth pictures from them.
    shapes: Arc<SharedShapes>,
    /// Shared with users that need nothing else of the scene.
    appearance: Arc<SceneAppearance>,
    bounds: Option<Bounds>,
    /// The number of added spheres, which come after the spheres of the data.
    added: usize,
    /// The scene that this is a part of, if other spheres are not in memory.
    whole: Option<SceneExtent>,
    /// The spheres that a camera frames in the place of all shapes, and their box.
    focus: Option<Arc<(Vec<[f32; 4]>, Bounds)>>,
    ghosts: Option<Arc<Self>>,
}

impl Scene {
    /// Checks the spheres and moves them into the frame of the scene. A scene may be empty.
    ///
    /// # Errors
    /// Returns an error if a centre or radius is out of range (the error names the first such sphere in input order),
    /// or if there are too many spheres.
    pub fn new(spheres: &[Sphere]) -> Result<Self, SceneError> {
        let (origin, narrow, bounds) = in_own_frame(spheres, f64_parts, |bounds| bounds)?;
        Ok(Self::in_frame(
            origin,
            (narrow, Vec::new()),
            appearance_of(spheres, |sphere| (sphere.color, sphere.surface)),
            bounds,
        ))
    }

    /// A scene from spheres and their appearance. Arrays are not copied, except for spheres in f64. Spheres far from
    /// the world's origin are moved in place.
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::new`] and [`Appearance::check`].
    pub fn from_parts(array: SphereArray, appearance: Appearance) -> Result<Self, SceneError> {
        Self::from_shapes(array, &[], appearance)
    }

    /// A scene from spheres, cones and cylinders, and their appearance. The ids of the cones come after those of the
    /// spheres, and so do their colours and surface properties.
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::from_parts`], and an error if a cone is out of range, which names the first such
    /// cone in input order, or emissive.
    pub fn from_shapes(array: SphereArray, cones: &[Cone], appearance: Appearance) -> Result<Self, SceneError> {
        let count = array.len() + cones.len();
        let of_cones = bounds_of_cones(cones)?;
        let with_cones = |bounds: Option<Bounds>| match (bounds, of_cones) {
            (Some(bounds), Some(of_cones)) => Some(bounds.union(of_cones)),
            (bounds, of_cones) => bounds.or(of_cones),
        };
        let (origin, spheres, bounds) = match array {
            SphereArray::F32(mut spheres) => {
                let bounds = with_cones(bounds_of_checked(&spheres, |s| s.map(f64::from))?);
                let origin = bounds.map_or(DVec3::ZERO, frame_origin);
                if origin != DVec3::ZERO {
                    parallel::for_each_mut(&mut spheres, |s| *s = moved(s.map(f64::from), origin));
                }
                (origin, spheres, bounds)
            }
            SphereArray::F64(spheres) => in_own_frame(&spheres, |s| *s, with_cones)?,
        };
        check_count(count)?;
        appearance.check(count)?;
        let cones = cones_in_frame(cones, origin)?;
        let scene = Self::in_frame(origin, (spheres, cones), appearance, bounds);
        scene.check_cones()?;
        Ok(scene)
    }

    /// Returns an error if a cone is emissive: the ways in which light is sampled know spheres.
    fn check_cones(&self) -> Result<(), SceneError> {
        let is_emissive = |index: &usize| {
            let surface = self.appearance.surface_of((self.len() + index) as u32);
            matches!(surface.material, Material::Emissive { .. })
        };
        if !self.appearance.surfaces().iter().any(|of| matches!(of.material, Material::Emissive { .. })) {
            return Ok(());
        }
        match (0..self.cones().len()).find(is_emissive) {
            Some(index) => Err(SceneError::Cone { index, error: ConeError::emissive() }),
            None => Ok(()),
        }
    }

    /// A scene from spheres (x, y, z, radius) in f32, all of one colour. The array is not copied. Spheres far from the
    /// world's origin are moved in place.
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::new`].
    pub fn from_f32(spheres: Vec<[f32; 4]>, color: LinearRgb) -> Result<Self, SceneError> {
        Self::from_parts(SphereArray::F32(spheres), color.into())
    }

    /// A scene from spheres (x, y, z, radius) in f64, all of one colour.
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::new`].
    pub fn from_f64(spheres: &[[f64; 4]], color: LinearRgb) -> Result<Self, SceneError> {
        let (origin, spheres, bounds) = in_own_frame(spheres, |s| *s, |bounds| bounds)?;
        Ok(Self::in_frame(origin, (spheres, Vec::new()), color.into(), bounds))
    }

    /// Some spheres of a larger scene, in input order and in its frame. If pictures of parts by primary rays are merged
    /// by [`NearestPicture`](crate::render::NearestPicture), the result is that of the whole on the same device, to
    /// the bit. Integrators with light need all spheres.
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::from_parts`], and an error if a sphere is outside the whole scene.
    pub fn part(whole: SceneExtent, spheres: Vec<[f32; 4]>, appearance: Appearance) -> Result<Self, SceneError> {
        let origin = whole.origin();
        check_origin(origin)?;
        bounds_of_checked(&spheres, frame::slackened)?;
        appearance.check(spheres.len())?;
        if let Some(index) = spheres.iter().position(|sphere| !whole.contains(*sphere)) {
            return Err(SceneError::Invalid(format!(
                "sphere {index} is outside of the scene that it should be a part of"
            )));
        }
        let scene = Self::in_frame(origin, (spheres, Vec::new()), appearance, Some(whole.bounds));
        Ok(Self { whole: Some(whole), ..scene })
    }

    /// The scene that this is a part of. `None` if all spheres are here.
    #[must_use]
    pub fn whole(&self) -> Option<SceneExtent> {
        self.whole
    }

    /// A scene from an origin, shapes, appearance and bounds that have been checked.
    fn in_frame(
        origin: DVec3,
        (spheres, cones): (Vec<[f32; 4]>, Vec<ConeInFrame>),
        appearance: Appearance,
        bounds: Option<Bounds>,
    ) -> Self {
        let shapes = Arc::new(SharedShapes::new(spheres, cones));
        let appearance = Arc::new(SceneAppearance::new(appearance, shapes.len()));
        Self { origin, shapes, appearance, bounds, added: 0, whole: None, focus: None, ghosts: None }
    }

    /// The shapes, all with these surface properties.
    #[must_use]
    pub fn with_surface(mut self, surface: SurfaceProperties) -> Self {
        let appearance = Arc::unwrap_or_clone(self.appearance).appearance.with_surface(surface);
        self.appearance = Arc::new(SceneAppearance::new(appearance, self.shapes.len()));
        self
    }

    /// The scene whose last `count` spheres were added to those of the data, such as the edges of a cell. They do
    /// not affect choices based on the data, such as the mean radius and the flat axis.
    #[must_use]
    pub fn with_added(mut self, count: usize) -> Self {
        self.added = count.min(self.len());
        self
    }

    /// The number of added spheres, which come last; see [`Scene::with_added`].
    #[must_use]
    pub fn added(&self) -> usize {
        self.added
    }

    /// Whether all spheres are opaque.
    pub(crate) fn is_opaque(&self) -> bool {
        self.appearance.is_opaque()
    }

    /// A scene of only the opaque shapes in the same frame. `None` if all are opaque.
    #[cfg(feature = "gpu")]
    pub(crate) fn opaque(&self) -> Option<Self> {
        if self.appearance.is_opaque() {
            return None;
        }
        let count = self.len() as u32;
        let (spheres, cones): (Vec<u32>, Vec<u32>) = self.opaque_ids().partition(|id| *id < count);
        let spheres: Vec<[f32; 4]> = spheres.into_iter().map(|id| self.spheres()[id as usize]).collect();
        let cones: Vec<ConeInFrame> = cones.into_iter().map(|id| self.cones()[(id - count) as usize]).collect();
        let scene = Self::in_frame(self.origin, (spheres, cones), LinearRgb::WHITE.into(), None);
        Some(Self { bounds: scene.shapes.bounds(self.origin), ..scene })
    }

    /// The indices of the opaque shapes, in ascending order.
    pub(crate) fn opaque_ids(&self) -> impl Iterator<Item = u32> {
        (0..self.shape_count() as u32).filter(|id| self.surface(*id).opacity >= 1.0)
    }

    /// Restores a scene from its parts, to the bit, except that the bounds are computed from the f32 numbers.
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::from_shapes`], and an error if the origin is out of range.
    #[cfg(feature = "run-file")]
    pub(crate) fn from_frame(
        origin: DVec3,
        (spheres, cones): (Vec<[f32; 4]>, Vec<ConeInFrame>),
        appearance: Appearance,
    ) -> Result<Self, SceneError> {
        check_origin(origin)?;
        let count = spheres.len() + cones.len();
        check_count(count)?;
        appearance.check(count)?;
        bounds_of_checked(&spheres, frame::slackened)?;
        frame::check_cones_in_frame(&cones)?;
        let mut scene = Self::in_frame(origin, (spheres, cones), appearance, None);
        scene.bounds = scene.shapes.bounds(origin);
        scene.check_cones()?;
        Ok(scene)
    }

    /// The origin of the scene's frame in world space.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The spheres in input order: centre (x, y, z) in the frame of the scene, and radius.
    #[must_use]
    pub fn spheres(&self) -> &[[f32; 4]] {
        &self.shapes.spheres
    }

    /// The cones and cylinders in input order, in the frame of the scene. The ids of the first follow those of the spheres.
    #[must_use]
    pub fn cones(&self) -> &[ConeInFrame] {
        &self.shapes.cones
    }

    /// The number of spheres, cones and cylinders. Ids are below it.
    #[must_use]
    pub fn shape_count(&self) -> usize {
        self.shapes.len()
    }

    /// The shapes, which stay the same if the scene is updated.
    pub(crate) fn shared_shapes(&self) -> &Arc<SharedShapes> {
        &self.shapes
    }

    /// The appearance of the spheres.
    #[must_use]
    pub fn appearance(&self) -> &Appearance {
        &self.appearance
    }

    /// The appearance of the spheres, with derived data.
    pub(crate) fn checked_appearance(&self) -> &Arc<SceneAppearance> {
        &self.appearance
    }

    /// The colour of a shape, by its id, which is the index in input order.
    ///
    /// # Panics
    /// Panics if there is no such shape.
    #[must_use]
    pub fn color(&self, id: u32) -> LinearRgb {
        assert!((id as usize) < self.shape_count(), "there is no shape {id}");
        self.appearance.color_of(id)
    }

    /// The surface properties of a shape, by its id. The opacity includes the alpha of the shape's colour.
    ///
    /// # Panics
    /// Panics if there is no such shape.
    #[must_use]
    pub fn surface(&self, id: u32) -> SurfaceProperties {
        assert!((id as usize) < self.shape_count(), "there is no shape {id}");
        self.appearance.surface_of(id)
    }

    /// The bounding box of all shapes in world space. `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// The box that a camera should show, which is that of all shapes, or a unit cube if there are none.
    #[must_use]
    pub fn bounds_to_frame(&self) -> Bounds {
        self.bounds.unwrap_or(Bounds::of_sphere(self.origin, 0.5))
    }

    /// The subject that a camera should frame: all shapes or those of [`Scene::with_focus`], or a unit cube if there are
    /// none.
    #[must_use]
    pub fn subject(&self) -> Subject<'_> {
        if let Some((spheres, bounds)) = self.focus.as_deref() {
            return Subject::spheres(self.origin, spheres, *bounds);
        }
        let subject = Subject::spheres(self.origin, self.spheres(), self.bounds_to_frame()).with_cones(self.cones());
        match &self.whole {
            Some(whole) => subject.with_whole(WholeSubject {
                mean_radius: whole.mean_radius(),
                centers: [whole.center_min.to_array(), whole.center_max.to_array()],
            }),
            None => subject.with_added(self.added),
        }
    }

    /// The number of spheres.
    #[must_use]
    pub fn len(&self) -> usize {
        self.spheres().len()
    }

    /// Returns true if the scene has no shapes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.shape_count() == 0
    }
}

/// Returns an error for the origin of a frame that is NaN, infinite or too far away.
fn check_origin(origin: DVec3) -> Result<(), SceneError> {
    if origin.abs().cmple(DVec3::splat(MAX_LENGTH)).all() {
        return Ok(());
    }
    let range = format!("every coordinate must be finite and at most {MAX_LENGTH:e} in size");
    let origin = origin.to_array();
    Err(SceneError::Invalid(format!("its origin {origin:?} is out of range; {range}")))
}

impl SphereArray {
    /// A scene of these spheres, all of one colour.
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::new`].
    pub fn scene(self, color: LinearRgb) -> Result<Scene, SceneError> {
        Scene::from_parts(self, color.into())
    }
}

impl Appearance {
    /// The distinct colours and surface properties, in the order of first use, and their indices for each shape.
    #[must_use]
    pub fn distinct(looks: &[(LinearRgb, SurfaceProperties)]) -> Self {
        appearance_of(looks, |look| *look)
    }
}

fn appearance_of<S>(shapes: &[S], look: impl Fn(&S) -> (LinearRgb, SurfaceProperties)) -> Appearance {
    let colors = Colors::of_palette(distinct(shapes, |shape| keyed(look(shape).0)));
    let surface_of = |shape: &S| look(shape).1;
    let (surfaces, surface_indices) = distinct(shapes, |shape| (surface_of(shape), surface_of(shape).bits()));
    let surfaces = if surfaces.is_empty() { vec![SurfaceProperties::default()] } else { surfaces };
    Appearance::new(colors).with(surfaces, surface_indices)
}

impl Colors {
    /// The distinct colours, in the order of first use, and the index of each sphere's colour.
    #[must_use]
    pub fn distinct(colors: &[LinearRgb]) -> Self {
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

/// The distinct properties of the spheres, in the order of first use, and for each sphere an index into them. The
/// indices are `None` if there is at most one property.
fn distinct<S, T, K: Eq + std::hash::Hash>(spheres: &[S], of: impl Fn(&S) -> (T, K)) -> (Vec<T>, Option<Vec<u32>>) {
    let mut all = Vec::new();
    let mut indices = HashMap::new();
    let indices: Vec<u32> = spheres
        .iter()
        .map(|sphere| {
            let (one, key) = of(sphere);
            *indices.entry(key).or_insert_with(|| {
                all.push(one);
                // There are no more entries than spheres, which are fewer than 2³².
                all.len() as u32 - 1
            })
        })
        .collect();
    let several = all.len() > 1;
    (all, several.then_some(indices))
}
