//! The structures in which rays of the CPU find spheres.

use std::ops::Range;

use glam::DVec3;

use crate::accel::grid::Grid;
use crate::accel::wide_tree::WideTree;
use crate::accel::wide_tree_visit::BoxRay;
use crate::accel::{AccelPlan, Index};
use crate::geometry::ray::Ray;
use crate::parallel::try_map;
use crate::scene::{Scene, SceneError};

/// An 8-wide tree without a margin.
#[derive(Debug)]
pub(super) struct TreeIndex {
    pub(super) tree: WideTree,
    /// Two opposite corners of a box around all spheres.
    pub(super) corners: Option<[DVec3; 2]>,
    /// The spheres in the order of the tree.
    spheres: Vec<[f32; 4]>,
}

impl TreeIndex {
    pub(super) fn new(scene: &Scene) -> Result<Self, SceneError> {
        let all = scene.spheres();
        let tree = WideTree::build(all, 0.0);
        let spheres = try_map(all.len(), |i| all[tree.ids()[i] as usize])
            .map_err(|_| SceneError::Memory { count: all.len() })?;
        let corners = tree.corners();
        Ok(Self { tree, corners, spheres })
    }

    /// Calls `offer` as [`super::SearchStructure`] does. Returns whether no sphere is left out.
    #[inline]
    pub(super) fn visit(
        &self,
        ray: &Ray,
        limit: f64,
        offer: &mut impl FnMut(u32, [f32; 4]) -> f64,
    ) -> bool {
        let boxes = self.corners.and_then(|c| BoxRay::new(ray.origin, ray.direction, c));
        let Some(boxes) = boxes else { return false };
        let mut left = limit;
        self.tree.visit(&boxes, limit, |range: Range<usize>| {
            for (id, sphere) in self.tree.ids()[range.clone()].iter().zip(&self.spheres[range]) {
                left = offer(*id, *sphere);
                if left < 0.0 {
                    break;
                }
            }
            left
        });
        true
    }
}

/// A grid.
#[derive(Debug)]
pub(super) struct GridIndex {
    grid: Grid,
    /// The spheres and their ids in the order that the grid refers to.
    spheres: Vec<[f32; 4]>,
    ids: Vec<u32>,
}

impl GridIndex {
    /// Builds the grid of a plan; `None` if the plan is not of one grid.
    pub(super) fn new(plan: &AccelPlan, scene: &Scene) -> Option<Self> {
        let brick = plan.bricks(scene.spheres()).next().filter(|_| plan.brick_count == 1)?;
        let Index::Grid(grid) = brick.index else { return None };
        Some(Self { grid, spheres: brick.spheres, ids: brick.ids })
    }

    /// Calls `offer` as [`super::SearchStructure`] does. Returns whether no sphere is left out.
    #[inline]
    pub(super) fn visit(
        &self,
        ray: &Ray,
        limit: f64,
        offer: &mut impl FnMut(u32, [f32; 4]) -> f64,
    ) -> bool {
        let Some(along) = self.grid.ray(ray.origin, ray.direction) else { return false };
        self.grid.visit(&along, limit, |at| offer(self.ids[at], self.spheres[at]));
        true
    }
}
