//! The ids by which kernels identify the shapes of a structure.

use std::borrow::Cow;

use crate::gpu::shader::Constant;
use crate::scene::{Duplicates, Scene};

/// How the shape that a ray starts on is excluded from its search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum ExcludeBy {
    /// By the shape's index in the structure, if no equal shape is in another brick. This costs nothing for each test.
    Index,
    /// By the shape's id. This costs one memory access for each test.
    Id,
}

impl ExcludeBy {
    /// All variants.
    pub(in crate::gpu) const ALL: [Self; 2] = [Self::Index, Self::Id];

    pub(in crate::gpu) fn constant(self) -> Constant {
        ("EXCLUDES_BY_ID", u32::from(self == Self::Id))
    }
}

/// The ids of the spheres of a structure, and the way in which rays exclude the sphere that they start on.
#[derive(Clone, Debug)]
pub(in crate::gpu) struct ShapeIds {
    /// The id of every sphere that the structure was built from; `None` if every sphere's id is its index.
    ids: Option<Vec<u32>>,
    pub(in crate::gpu) exclude_by: ExcludeBy,
}

impl ShapeIds {
    /// The ids for a structure of all spheres. Spheres with the same centre may be in different bricks if
    /// `may_part_equals`.
    pub(in crate::gpu) fn of_all(scene: &Scene, may_part_equals: bool) -> Self {
        // If equal spheres are always in the same brick, their indices in the structure suffice.
        let duplicates = may_part_equals.then(|| Duplicates::of(scene.spheres()));
        let ids = duplicates.and_then(Duplicates::into_firsts);
        let exclude_by = if ids.is_some() { ExcludeBy::Id } else { ExcludeBy::Index };
        Self { ids, exclude_by }
    }

    /// The ids for a structure of the opaque spheres only: their indices among all spheres.
    pub(in crate::gpu) fn of_opaque(scene: &Scene) -> Self {
        let duplicates = Duplicates::of(scene.spheres());
        let ids = scene.opaque_ids().map(|id| duplicates.first_of(id)).collect();
        Self { ids: Some(ids), exclude_by: ExcludeBy::Id }
    }

    /// The ids of spheres that are given by their indices in the input of the structure.
    pub(in crate::gpu) fn of<'a>(&self, numbers: &'a [u32]) -> Cow<'a, [u32]> {
        match &self.ids {
            None => numbers.into(),
            Some(ids) => numbers.iter().map(|number| ids[*number as usize]).collect(),
        }
    }
}
