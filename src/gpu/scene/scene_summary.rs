//! A summary of a scene: the data, besides its buffers, that pictures need after the host's scene was dropped. Also the
//! ids by which kernels identify shapes.

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec3;

use crate::gpu::shader::Constant;
use crate::image::color::LinearRgb;
use crate::light::emitters::{EmissiveSphere, Emitters};
use crate::scene::{Duplicates, Scene, SceneAppearance, SharedShapes};

/// Palette, surfaces and emissive spheres of a scene.
#[derive(Debug)]
pub(crate) struct SceneSummary {
    /// Origin of the scene's frame, in world space.
    pub(crate) origin: DVec3,
    pub(crate) appearance: Arc<SceneAppearance>,
    /// The shapes, from which smooth pictures are drawn.
    pub(crate) shapes: Arc<SharedShapes>,
    pub(crate) emitters: Emitters,
    /// The spheres of `emitters`, in the same order.
    pub(crate) emissive: Vec<EmissiveSphere>,
}

impl SceneSummary {
    /// Size of an emissive sphere in bytes.
    pub(crate) const BYTES_PER_EMITTER: u64 = 8 + size_of::<EmissiveSphere>() as u64;

    pub(crate) fn of(scene: &Scene) -> Self {
        let emitters = Emitters::of(scene);
        Self {
            origin: scene.origin(),
            appearance: Arc::clone(scene.checked_appearance()),
            shapes: Arc::clone(scene.shared_shapes()),
            emissive: EmissiveSphere::all(scene, &emitters),
            emitters,
        }
    }

    /// The summary for a structure of occluders, whose appearance is never used.
    pub(crate) fn of_occluders(scene: &Scene) -> Self {
        Self {
            origin: scene.origin(),
            appearance: Arc::new(SceneAppearance::new(LinearRgb::WHITE.into(), 0)),
            shapes: Arc::default(),
            emitters: Emitters::default(),
            emissive: Vec::new(),
        }
    }

    /// Whether every sphere is opaque.
    pub(crate) fn is_opaque(&self) -> bool {
        self.appearance.is_opaque()
    }
}

/// How a ray that starts on a shape excludes this shape from its search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum ExcludeBy {
    /// By the shape's index in the structure, if no equal shape is in another brick. This costs nothing for each test.
    Index,
    /// By the shape's id. This costs one memory access for each test.
    Id,
}

impl ExcludeBy {
    /// All variants.
    pub(crate) const ALL: [Self; 2] = [Self::Index, Self::Id];

    pub(crate) fn constant(self) -> Constant {
        ("EXCLUDES_BY_ID", u32::from(self == Self::Id))
    }
}

/// The ids of the shapes of a structure, and how rays exclude the shape on which they start.
#[derive(Clone, Debug)]
pub(crate) struct ShapeIds {
    /// The id of every shape that the structure was built from; `None` if every shape's id is its index.
    ids: Option<Vec<u32>>,
    pub(crate) exclude_by: ExcludeBy,
}

impl ShapeIds {
    /// The ids for a structure of all shapes. Equal ones may be in different bricks if `may_split_duplicates`.
    pub(crate) fn of_all(scene: &Scene, may_split_duplicates: bool) -> Self {
        // If equal shapes are always in the same brick, their indices in the structure suffice.
        let ids = may_split_duplicates.then(|| firsts(scene)).flatten();
        let exclude_by = if ids.is_some() { ExcludeBy::Id } else { ExcludeBy::Index };
        Self { ids, exclude_by }
    }

    /// The ids for a structure of the opaque shapes only: their indices among all shapes.
    pub(crate) fn of_opaque(scene: &Scene) -> Self {
        let firsts = firsts(scene);
        let first_of = |id: u32| firsts.as_ref().map_or(id, |firsts| firsts[id as usize]);
        Self { ids: Some(scene.opaque_ids().map(first_of).collect()), exclude_by: ExcludeBy::Id }
    }

    /// The ids of shapes with the given indices in the input of the structure.
    pub(crate) fn of<'a>(&self, numbers: &'a [u32]) -> Cow<'a, [u32]> {
        match &self.ids {
            None => numbers.into(),
            Some(ids) => numbers.iter().map(|number| ids[*number as usize]).collect(),
        }
    }
}

/// For every shape, the index of the first one equal to it. `None` if there are no equal ones.
fn firsts(scene: &Scene) -> Option<Vec<u32>> {
    let of_spheres = Duplicates::of(scene.spheres());
    let of_cones = Duplicates::of(bytemuck::cast_slice::<_, [f32; 8]>(scene.cones()));
    let count = scene.len() as u32;
    let first_of = |id: u32| match id.checked_sub(count) {
        None => of_spheres.first_of(id),
        Some(cone) => count + of_cones.first_of(cone),
    };
    let has_equals = of_spheres.are_some() || of_cones.are_some();
    has_equals.then(|| (0..scene.shape_count() as u32).map(first_of).collect())
}
