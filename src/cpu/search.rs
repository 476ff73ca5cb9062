//! Two ways to find the spheres that rays hit: testing every sphere, or only those that a structure cannot rule out.
//!
//! Both ways apply the same tests in f64 and give the same answers, to the bit. Testing every sphere is the reference,
//! which needs no proof. The proofs that structures miss no sphere are in `accel/wide_tree_visit.rs` and
//! `accel/grid_visit.rs`.

use std::ops::Range;

use glam::DVec3;

use crate::accel::grid::Grid;
use crate::accel::wide_tree::WideTree;
use crate::accel::wide_tree_visit::BoxRay;
use crate::accel::{AccelChoice, AccelPlan, Index, Structure};
use crate::geometry::ray::Ray;
use crate::parallel::try_map;
use crate::scene::{Scene, SceneError};

/// A scene, and the way in which rays find its spheres. Both ways give the same picture.
///
/// A reference to a [`Scene`] stands for [`Search::EverySphere`], and one to a [`SearchStructure`] for
/// [`Search::Structure`].
#[derive(Clone, Copy, Debug)]
pub enum Search<'a> {
    /// Each ray tests every sphere: the reference, for small scenes.
    EverySphere(&'a Scene),
    /// Each ray tests the spheres that the structure cannot rule out.
    Structure(&'a SearchStructure<'a>),
}

impl<'a> From<&'a Scene> for Search<'a> {
    fn from(scene: &'a Scene) -> Self {
        Self::EverySphere(scene)
    }
}

impl<'a> From<&'a SearchStructure<'a>> for Search<'a> {
    fn from(structure: &'a SearchStructure<'a>) -> Self {
        Self::Structure(structure)
    }
}

/// Up to this number of spheres, testing all takes less time than a structure.
const FEW: usize = 16;

/// A structure that skips spheres that a ray cannot hit. The CPU reference becomes fast, and its pictures stay
/// identical. It is a grid if all spheres are opaque and a plan chooses a grid, and otherwise an 8-wide tree.
#[derive(Debug)]
pub struct SearchStructure<'a> {
    scene: &'a Scene,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    /// No structure, for few spheres.
    List,
    Tree(TreeIndex),
    Grid(GridIndex),
}

/// The choice of a structure for a scene, before it is built.
#[derive(Debug)]
pub struct SearchPlan<'a> {
    scene: &'a Scene,
    /// The plan of a grid, if a grid suits the scene.
    grid: Option<AccelPlan>,
}

impl<'a> SearchPlan<'a> {
    /// The largest number of bytes per sphere during the building of a tree. 34 of them remain.
    const TREE_BYTES: u64 = 62;

    /// Plans a structure.
    #[must_use]
    pub fn new(scene: &'a Scene) -> Self {
        let spheres = scene.spheres();
        // A long list of a grid has only the first of equal spheres, but another may be the one that hides a light.
        let grid = (spheres.len() > FEW && scene.is_opaque())
            .then(|| AccelPlan::new(spheres, AccelChoice::Auto, u64::MAX))
            // A walk is limited to one grid.
            .filter(|plan| plan.structure == Structure::Grid && plan.brick_count == 1);
        Self { scene, grid }
    }

    /// The scene of the plan.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The largest number of bytes that building the structure needs, in addition to the scene.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        match &self.grid {
            Some(plan) => plan.host_bytes(),
            None => Self::TREE_BYTES * self.scene.len() as u64,
        }
    }

    /// Builds the structure, on all cores.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory for a copy of the spheres.
    pub fn build(&self) -> Result<SearchStructure<'a>, SceneError> {
        let scene = self.scene;
        let grid = self.grid.as_ref().and_then(|plan| GridIndex::new(plan, scene));
        let kind = match grid {
            _ if scene.len() <= FEW => Kind::List,
            Some(grid) => Kind::Grid(grid),
            None => Kind::Tree(TreeIndex::new(scene)?),
        };
        Ok(SearchStructure { scene, kind })
    }
}

impl<'a> SearchStructure<'a> {
    /// Plans and builds the structure of a scene.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory for a copy of the spheres.
    pub fn new(scene: &'a Scene) -> Result<Self, SceneError> {
        SearchPlan::new(scene).build()
    }

    /// Builds a structure of the given kind, whatever suits the scene.
    #[cfg(test)]
    pub(super) fn of(scene: &'a Scene, structure: Structure) -> Self {
        let kind = match structure {
            Structure::WideTree => Kind::Tree(TreeIndex::new(scene).unwrap()),
            structure => {
                let plan = AccelPlan::of(scene.spheres(), structure, u64::MAX);
                Kind::Grid(GridIndex::new(&plan, scene).unwrap())
            }
        };
        Self { scene, kind }
    }

    /// The scene that the structure searches.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Calls `offer` with every sphere, and its id, that the ray may hit at or before `limit`. The ray is in the
    /// scene's frame. `offer` returns the new limit, or a negative number to end the search.
    #[inline]
    fn visit(&self, ray: &Ray, limit: f64, mut offer: impl FnMut(u32, [f32; 4]) -> f64) {
        let is_done = match &self.kind {
            Kind::List => false,
            Kind::Tree(tree) => tree.visit(ray, limit, &mut offer),
            Kind::Grid(grid) => grid.visit(ray, limit, &mut offer),
        };
        if !is_done {
            for (id, sphere) in (0..).zip(self.scene.spheres()) {
                if offer(id, *sphere) < 0.0 {
                    break;
                }
            }
        }
    }
}

/// The nearest hit that a test accepted.
#[derive(Clone, Copy)]
pub(super) struct NearestHit {
    pub(super) id: u32,
    pub(super) sphere: [f32; 4],
    pub(super) t: f64,
}

impl<'a> Search<'a> {
    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        match self {
            Self::EverySphere(scene) => scene,
            Self::Structure(structure) => structure.scene,
        }
    }

    /// The nearest hit of a ray in the scene's frame. At equal distances, the smallest id wins. `distance` takes a
    /// sphere, and returns the distance of a hit, which is not NaN.
    #[inline]
    pub(super) fn nearest(&self, ray: &Ray, distance: impl Fn([f32; 4]) -> Option<f64>) -> Option<NearestHit> {
        let mut nearest: Option<NearestHit> = None;
        match self {
            Self::EverySphere(scene) => {
                for (id, sphere) in (0..).zip(scene.spheres()) {
                    let Some(t) = distance(*sphere) else { continue };
                    // Ids ascend, so `<` prefers the smaller id at equal distances.
                    if nearest.is_none_or(|nearest| t < nearest.t) {
                        nearest = Some(NearestHit { id, sphere: *sphere, t });
                    }
                }
            }
            Self::Structure(structure) => structure.visit(ray, f64::INFINITY, |id, sphere| {
                if let Some(t) = distance(sphere)
                    && nearest.is_none_or(|nearest| (t, id) < (nearest.t, nearest.id))
                {
                    nearest = Some(NearestHit { id, sphere, t });
                }
                nearest.map_or(f64::INFINITY, |nearest| nearest.t)
            }),
        }
        nearest
    }

    /// Whether `test` is true for any sphere. It may be true only for spheres that the ray hits before `t_max`. The ray
    /// is in the scene's frame.
    #[inline]
    pub(super) fn any(&self, ray: &Ray, t_max: f64, test: impl Fn(u32, [f32; 4]) -> bool) -> bool {
        match self {
            Self::EverySphere(scene) => (0..).zip(scene.spheres()).any(|(id, sphere)| test(id, *sphere)),
            Self::Structure(structure) => {
                let mut is_any = false;
                structure.visit(ray, t_max, |id, sphere| {
                    is_any = is_any || test(id, sphere);
                    if is_any { f64::NEG_INFINITY } else { t_max }
                });
                is_any
            }
        }
    }
}

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
        let spheres =
            try_map(all.len(), |i| all[tree.ids[i] as usize]).map_err(|_| SceneError::Memory { count: all.len() })?;
        let corners = tree.corners();
        Ok(Self { tree, corners, spheres })
    }

    /// Calls `offer` as [`SearchStructure::visit`] does. Returns false if it cannot search for this ray.
    #[inline]
    pub(super) fn visit(&self, ray: &Ray, limit: f64, offer: &mut impl FnMut(u32, [f32; 4]) -> f64) -> bool {
        let boxes = self.corners.and_then(|c| BoxRay::new(ray.origin, ray.direction, c));
        let Some(boxes) = boxes else { return false };
        let mut left = limit;
        self.tree.visit(&boxes, limit, |range: Range<usize>| {
            for (id, sphere) in self.tree.ids[range.clone()].iter().zip(&self.spheres[range]) {
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

/// A grid, with its spheres in the grid's order.
#[derive(Debug)]
pub(super) struct GridIndex {
    grid: Grid,
    /// The spheres, in the order that the grid's references use, and their ids.
    spheres: Vec<[f32; 4]>,
    ids: Vec<u32>,
}

impl GridIndex {
    /// Builds the grid of a plan. Returns `None` if the plan is not for a single grid.
    pub(super) fn new(plan: &AccelPlan, scene: &Scene) -> Option<Self> {
        let brick = plan.bricks(scene.spheres()).next().filter(|_| plan.brick_count == 1)?;
        let Index::Grid(grid) = brick.index else { return None };
        Some(Self { grid, spheres: brick.spheres, ids: brick.ids })
    }

    /// Calls `offer` as [`SearchStructure::visit`] does. Returns false if it cannot search for this ray.
    #[inline]
    pub(super) fn visit(&self, ray: &Ray, limit: f64, offer: &mut impl FnMut(u32, [f32; 4]) -> f64) -> bool {
        let Some(along) = self.grid.ray(ray.origin, ray.direction) else { return false };
        self.grid.visit(&along, limit, |at| offer(self.ids[at], self.spheres[at]));
        true
    }
}
