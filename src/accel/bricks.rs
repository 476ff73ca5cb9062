//! Building the bricks of a planned structure one after the other, so that not all of them have to be in memory.

use std::collections::VecDeque;
use std::ops::Range;

use glam::Vec3;

use super::brick::{Accel, Brick, Index, QueryBoxes};
#[cfg(feature = "gpu")]
use super::brick_bounds::BrickBounds;
use super::divide::divide;
use super::grid_build::{BuiltGrid, build_grid};
use super::outliers::Margins;
use super::plan::AccelPlan;
use super::structure::Structure;
use super::wide_tree::WideTree;

/// The bricks of a planned structure. Each is built when it is asked for; until then only the ids of its spheres are
/// kept, in 4 bytes each.
#[derive(Debug)]
pub struct Bricks<'a> {
    plan: &'a AccelPlan,
    spheres: &'a [[f32; 4]],
    parts: VecDeque<Part>,
    may_part_equals: bool,
}

/// The spheres of a brick that has not been built.
#[derive(Clone, Debug)]
enum Part {
    /// Consecutive spheres in input order.
    Range(Range<usize>),
    /// The indices of the spheres in input order, in ascending order.
    Ids(Vec<u32>),
}

impl AccelPlan {
    /// Divides the spheres, which must be those of the plan, into the planned bricks. There is at least one, which may
    /// be empty.
    #[must_use]
    pub fn bricks<'a>(&'a self, spheres: &'a [[f32; 4]]) -> Bricks<'a> {
        let count = spheres.len();
        let per_brick = count.div_ceil(self.brick_count).max(1);
        let (mut parts, may_part_equals): (VecDeque<Part>, bool) = match self.structure {
            // Without a structure, bricks are consecutive spheres in the order of ids.
            Structure::List => {
                let ranges = (0..count).step_by(per_brick);
                let parts = ranges.map(|first| Part::Range(first..(first + per_brick).min(count)));
                (parts.collect(), self.brick_count > 1)
            }
            _ => {
                let divided = divide(spheres, self.brick_count);
                let parts = divided.parts.into_iter().filter(|ids| !ids.is_empty());
                (parts.map(Part::Ids).collect(), divided.may_part_equals)
            }
        };
        // Kernels need at least one brick.
        if parts.is_empty() {
            parts.push_back(Part::Range(0..0));
        }
        Bricks { plan: self, spheres, parts, may_part_equals }
    }

    /// Builds the planned structure; `spheres` must be those of the plan. [`AccelPlan::bricks`] needs less memory.
    #[must_use]
    pub fn build(&self, spheres: &[[f32; 4]]) -> Accel {
        let bricks = self.bricks(spheres);
        let ((min, max), may_part_equals) = (bricks.bounds(), bricks.may_part_equals());
        let bricks: Vec<Brick> = bricks.collect();
        let structure = self.structure.with_nested(bricks.iter().any(Brick::is_nested));
        Accel { structure, bricks, min, max, may_part_equals }
    }
}

impl Bricks<'_> {
    /// Returns the bounding box of all spheres of the plan in the scene's frame, inflated as that of
    /// [`Accel::bounds`].
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.plan.statistics.inflated_bounds()
    }

    /// The planned structure. Where it is a grid, some cells of some bricks may have grids of their own.
    #[must_use]
    pub fn structure(&self) -> Structure {
        self.plan.structure
    }

    /// Whether spheres with the same centre may be in different bricks.
    #[must_use]
    pub fn may_part_equals(&self) -> bool {
        self.may_part_equals
    }

    fn build_part(&self, part: Part) -> Brick {
        let Self { plan, spheres, .. } = *self;
        let margin = plan.statistics.margin();
        let ids = match part {
            Part::Ids(ids) => ids,
            // The number of spheres fits into u32.
            Part::Range(range) => (range.start as u32..range.end as u32).collect(),
        };
        match plan.structure {
            Structure::List => {
                let spheres = ids.iter().map(|id| spheres[*id as usize]).collect();
                Brick { index: Index::List, spheres, ids }
            }
            Structure::Grid | Structure::NestedGrid => {
                let BuiltGrid { grid, spheres, ids } =
                    build_grid(spheres, &ids, margin, plan.budget);
                Brick { index: Index::Grid(grid), spheres, ids }
            }
            Structure::WideTree => {
                let own: Vec<[f32; 4]> = ids.iter().map(|id| spheres[*id as usize]).collect();
                let margins = Margins { all: margin, crowd: plan.crowd };
                let tree = WideTree::build_with(&own, margins);
                Brick {
                    spheres: tree.ids().iter().map(|index| own[*index as usize]).collect(),
                    ids: tree.ids().iter().map(|index| ids[*index as usize]).collect(),
                    index: Index::WideTree(tree),
                }
            }
            Structure::RayQuery => {
                let spheres: Vec<[f32; 4]> = ids.iter().map(|id| spheres[*id as usize]).collect();
                let boxes = QueryBoxes::of(&spheres, plan.box_margin * margin);
                Brick { index: Index::RayQuery(boxes), spheres, ids }
            }
        }
    }
}

#[cfg(feature = "gpu")]
impl Bricks<'_> {
    /// The boxes of the bricks that have not been built, in order.
    pub(crate) fn boxes(&self) -> Vec<BrickBounds> {
        let bounds = |part: &Part| match part {
            Part::Range(range) => BrickBounds::of_spheres(&self.spheres[range.clone()]),
            Part::Ids(ids) => BrickBounds::of_ids(self.spheres, ids),
        };
        self.parts.iter().map(bounds).collect()
    }

    /// Keeps the bricks with these numbers, in this order. Those that were built before have no number.
    pub(crate) fn keep(&mut self, numbers: &[usize]) {
        let mut parts: Vec<Option<Part>> = self.parts.drain(..).map(Some).collect();
        let kept = numbers.iter().filter_map(|number| parts.get_mut(*number)?.take());
        self.parts = kept.collect();
    }

    /// Leaves out the next brick.
    pub(crate) fn leave_out(&mut self) {
        self.parts.pop_front();
    }
}

impl Iterator for Bricks<'_> {
    type Item = Brick;

    fn next(&mut self) -> Option<Brick> {
        let part = self.parts.pop_front()?;
        Some(self.build_part(part))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.parts.len(), Some(self.parts.len()))
    }
}

impl ExactSizeIterator for Bricks<'_> {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::AccelChoice;

    #[test]
    fn bricks_one_by_one_are_those_of_all() {
        let mut rng = fastrand::Rng::with_seed(3);
        let spheres: Vec<[f32; 4]> =
            (0..2000).map(|_| [rng.f32(), rng.f32(), rng.f32(), 0.01]).collect();
        for (choice, bytes) in
            [(AccelChoice::List, 4096), (AccelChoice::Tree, 4096), (AccelChoice::Grid, 1 << 17)]
        {
            let plan = AccelPlan::new(&spheres, choice, bytes);
            let (all, one_by_one) = (plan.build(&spheres), plan.bricks(&spheres));
            let count = one_by_one.len();
            assert!(count > 1 && count == all.bricks().len(), "{choice}");
            assert_eq!(one_by_one.bounds(), all.bounds());
            for (number, (one, other)) in one_by_one.zip(all.bricks()).enumerate() {
                assert_eq!((&one.ids, &one.spheres), (&other.ids, &other.spheres), "{number}");
            }
        }
        let plan = AccelPlan::new(&[], AccelChoice::Auto, 4096);
        assert_eq!(plan.build(&[]).bricks().len(), 1);
        assert_eq!(plan.bricks(&[]).map(|brick| brick.ids.len()).collect::<Vec<_>>(), [0]);
    }

    #[cfg(feature = "gpu")]
    #[test]
    fn some_bricks_in_another_order() {
        let spheres: Vec<[f32; 4]> = (0..1000).map(|i| [i as f32, 0.0, 0.0, 0.4]).collect();
        let plan = AccelPlan::new(&spheres, AccelChoice::Tree, 16 * 150);
        let all = plan.build(&spheres);
        let mut bricks = plan.bricks(&spheres);
        let boxes = bricks.boxes();
        for (bounds, brick) in boxes.iter().zip(all.bricks()) {
            assert_eq!(*bounds, BrickBounds::of_spheres(&brick.spheres));
        }
        bricks.keep(&[4, 0, 2]);
        assert_eq!(bricks.next().unwrap().ids, all.bricks()[4].ids);
        bricks.leave_out();
        assert_eq!(bricks.next().unwrap().ids, all.bricks()[2].ids);
        assert!(bricks.next().is_none());
    }
}
