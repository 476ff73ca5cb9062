//! What kernels call the shapes of a structure.

use std::borrow::Cow;

use crate::accel::Accel;
use crate::scene::{Duplicates, Scene};

/// How a ray is kept from meeting the shape that it starts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum ExcludeBy {
    /// It knows the shape's place in the structure that it searches, and no equal shape is in another brick. Costs
    /// nothing for each test.
    Index,
    /// It knows the shape's id. A read for each test.
    Id,
}

impl ExcludeBy {
    /// Both.
    pub(in crate::gpu) const ALL: [Self; 2] = [Self::Index, Self::Id];
}

/// By which ids kernels know the spheres of a structure, and rays those that they start on.
#[derive(Clone, Debug)]
pub(in crate::gpu) struct ShapeIds {
    /// Of every sphere that the structure was built of; `None` if that is its index.
    ids: Option<Vec<u32>>,
    pub(in crate::gpu) exclude_by: ExcludeBy,
}

impl ShapeIds {
    /// For a structure of all spheres.
    pub(in crate::gpu) fn of_all(scene: &Scene, accel: &Accel) -> Self {
        // Where equal spheres are in one brick, their places will do.
        let duplicates = accel.may_part_equals().then(|| Duplicates::of(scene.spheres()));
        let ids = duplicates.and_then(Duplicates::into_firsts);
        let exclude_by = if ids.is_some() { ExcludeBy::Id } else { ExcludeBy::Index };
        Self { ids, exclude_by }
    }

    /// For a structure of the opaque spheres alone, by their indices among all.
    pub(in crate::gpu) fn of_opaque(scene: &Scene) -> Self {
        let duplicates = Duplicates::of(scene.spheres());
        let ids = scene.opaque_ids().map(|id| duplicates.first_of(id)).collect();
        Self { ids: Some(ids), exclude_by: ExcludeBy::Id }
    }

    /// What spheres are called that the structure knows by these numbers.
    pub(in crate::gpu) fn of<'a>(&self, numbers: &'a [u32]) -> Cow<'a, [u32]> {
        match &self.ids {
            None => numbers.into(),
            Some(ids) => numbers.iter().map(|number| ids[*number as usize]).collect(),
        }
    }
}
