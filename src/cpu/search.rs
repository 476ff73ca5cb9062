//! Two ways to find the shapes that rays hit: testing every shape, or only those that a structure cannot rule out.
//!
//! Both ways apply the same tests in f64 and give the same answers, to the bit. Testing every shape is the reference,
//! which needs no proof. The proofs that structures miss no sphere are in `accel/wide_tree_visit.rs` and
//! `accel/grid_visit.rs`. Cones have a tree of their own, whose boxes hold them with a margin of 2⁻¹⁷ of the scene's
//! diagonal. The errors of a cone's test are far smaller: it counts from the middle of the cone's axis, so that those that
//! grow with the distance of the ray's origin are only those of that vector, as for spheres.

use std::ops::Range;

use glam::DVec3;

use crate::accel::grid::Grid;
use crate::accel::wide_tree::WideTree;
use crate::accel::wide_tree_visit::BoxRay;
use crate::accel::{AccelChoice, AccelPlan, Index, Structure};
use crate::geometry::cone::ConeInFrame;
use crate::geometry::ray::Ray;
use crate::parallel::try_map;
use crate::scene::{Scene, SceneError, Shape};

/// A scene, and the way in which rays find its shapes. Both ways give the same picture.
///
/// A reference to a [`Scene`] stands for [`Search::EveryShape`], and one to a [`SearchStructure`] for
/// [`Search::Structure`].
#[derive(Clone, Copy, Debug)]
pub enum Search<'a> {
    /// Each ray tests every shape: the reference, for small scenes.
    EveryShape(&'a Scene),
    /// Each ray tests the shapes that the structure cannot rule out.
    Structure(&'a SearchStructure<'a>),
}

impl<'a> From<&'a Scene> for Search<'a> {
    fn from(scene: &'a Scene) -> Self {
        Self::EveryShape(scene)
    }
}

impl<'a> From<&'a SearchStructure<'a>> for Search<'a> {
    fn from(structure: &'a SearchStructure<'a>) -> Self {
        Self::Structure(structure)
    }
}

/// Up to this number of spheres, and of cones, testing all takes less time than a structure.
const FEW: usize = 16;

/// A structure that skips shapes that a ray cannot hit. The CPU reference becomes fast, and its pictures stay
/// identical. It is a grid if all spheres are opaque and a plan chooses a grid, and otherwise an 8-wide tree. Cones have an
/// 8-wide tree.
#[derive(Debug)]
pub struct SearchStructure<'a> {
    scene: &'a Scene,
    kind: Kind,
    /// `None` for few cones.
    pub(super) cones: Option<TreeIndex<ConeInFrame>>,
}

#[derive(Debug)]
enum Kind {
    /// No structure, for few spheres.
    List,
    Tree(TreeIndex<[f32; 4]>),
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

    /// The largest number of bytes per cone.
    const CONE_BYTES: u64 = 86;

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
        .saturating_add(Self::CONE_BYTES * self.scene.cones().len() as u64)
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
            None => Kind::Tree(TreeIndex::of_spheres(scene)?),
        };
        let cones = (scene.cones().len() > FEW).then(|| TreeIndex::of_cones(scene)).transpose()?;
        Ok(SearchStructure { scene, kind, cones })
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
            Structure::WideTree => Kind::Tree(TreeIndex::of_spheres(scene).unwrap()),
            structure => {
                let plan = AccelPlan::of(scene.spheres(), structure, u64::MAX);
                Kind::Grid(GridIndex::new(&plan, scene).unwrap())
            }
        };
        Self { scene, kind, cones: None }
    }

    /// The scene that the structure searches.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Calls `offer` with every shape, and its id, that the ray may hit at or before `limit`. The ray is in the
    /// scene's frame. `offer` returns the new limit, or a negative number to end the search.
    #[inline]
    fn visit(&self, ray: &Ray, limit: f64, mut offer: impl FnMut(u32, Shape) -> f64) {
        let mut left = limit;
        let mut offer_sphere = |id, sphere| {
            left = offer(id, Shape::Sphere(sphere));
            left
        };
        let is_done = match &self.kind {
            Kind::List => false,
            Kind::Tree(tree) => tree.visit(ray, limit, &mut offer_sphere),
            Kind::Grid(grid) => grid.visit(ray, limit, &mut offer_sphere),
        };
        if !is_done {
            offer_all(self.scene.spheres(), &mut offer_sphere);
        }
        let (cones, first) = (self.scene.cones(), self.scene.len() as u32);
        if cones.is_empty() || left < 0.0 {
            return;
        }
        let mut offer_cone = |index: u32, cone| offer(first + index, Shape::Cone(cone));
        if !self.cones.as_ref().is_some_and(|tree| tree.visit(ray, left, &mut offer_cone)) {
            offer_all(cones, &mut offer_cone);
        }
    }
}

/// Offers all shapes in order, until one ends the search.
#[inline]
fn offer_all<T: Copy>(all: &[T], offer: &mut impl FnMut(u32, T) -> f64) {
    for (index, shape) in (0..).zip(all) {
        if offer(index, *shape) < 0.0 {
            break;
        }
    }
}

/// The nearest hit that a test accepted.
#[derive(Clone, Copy)]
pub(super) struct NearestHit {
    pub(super) id: u32,
    pub(super) shape: Shape,
    pub(super) t: f64,
}

impl<'a> Search<'a> {
    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        match self {
            Self::EveryShape(scene) => scene,
            Self::Structure(structure) => structure.scene,
        }
    }

    /// The nearest hit of a ray in the scene's frame. At equal distances, the smallest id wins. `distance` takes a
    /// shape, and returns the distance of a hit, which is not NaN.
    #[inline]
    pub(super) fn nearest(&self, ray: &Ray, distance: impl Fn(Shape) -> Option<f64>) -> Option<NearestHit> {
        let mut nearest: Option<NearestHit> = None;
        match self {
            Self::EveryShape(scene) => {
                for (id, shape) in shapes(scene) {
                    let Some(t) = distance(shape) else { continue };
                    // Ids ascend, so `<` prefers the smaller id at equal distances.
                    if nearest.is_none_or(|nearest| t < nearest.t) {
                        nearest = Some(NearestHit { id, shape, t });
                    }
                }
            }
            Self::Structure(structure) => structure.visit(ray, f64::INFINITY, |id, shape| {
                if let Some(t) = distance(shape)
                    && nearest.is_none_or(|nearest| (t, id) < (nearest.t, nearest.id))
                {
                    nearest = Some(NearestHit { id, shape, t });
                }
                nearest.map_or(f64::INFINITY, |nearest| nearest.t)
            }),
        }
        nearest
    }

    /// Returns true if `test` is for any shape. It may be true only for shapes that the ray hits before `t_max`. The ray
    /// is in the scene's frame.
    #[inline]
    pub(super) fn any(&self, ray: &Ray, t_max: f64, test: impl Fn(u32, Shape) -> bool) -> bool {
        match self {
            Self::EveryShape(scene) => shapes(scene).any(|(id, shape)| test(id, shape)),
            Self::Structure(structure) => {
                let mut is_any = false;
                structure.visit(ray, t_max, |id, shape| {
                    is_any = is_any || test(id, shape);
                    if is_any { f64::NEG_INFINITY } else { t_max }
                });
                is_any
            }
        }
    }
}

/// All shapes of a scene, with their ids.
fn shapes(scene: &Scene) -> impl Iterator<Item = (u32, Shape)> {
    let spheres = scene.spheres().iter().map(|sphere| Shape::Sphere(*sphere));
    (0..).zip(spheres.chain(scene.cones().iter().map(|cone| Shape::Cone(*cone))))
}

/// An 8-wide tree of shapes of one kind.
#[derive(Debug)]
pub(super) struct TreeIndex<T> {
    pub(super) tree: WideTree,
    /// Two opposite corners of a box around all shapes.
    pub(super) corners: Option<[DVec3; 2]>,
    /// The shapes in the order of the tree.
    shapes: Vec<T>,
}

impl TreeIndex<[f32; 4]> {
    /// A tree of a scene's spheres, without a margin.
    pub(super) fn of_spheres(scene: &Scene) -> Result<Self, SceneError> {
        Self::new(scene.spheres(), WideTree::build(scene.spheres(), 0.0))
    }
}

impl TreeIndex<ConeInFrame> {
    /// A tree of a scene's cones, with a margin.
    pub(super) fn of_cones(scene: &Scene) -> Result<Self, SceneError> {
        let diagonal = scene.bounds_to_frame().size().length();
        Self::new(scene.cones(), WideTree::of_cones(scene.cones(), (diagonal / f64::from(1 << 17)) as f32))
    }
}

impl<T: Copy + Send + Sync> TreeIndex<T> {
    fn new(all: &[T], tree: WideTree) -> Result<Self, SceneError> {
        let shapes =
            try_map(all.len(), |i| all[tree.ids[i] as usize]).map_err(|_| SceneError::Memory { count: all.len() })?;
        let corners = tree.corners();
        Ok(Self { tree, corners, shapes })
    }

    /// Calls `offer` as [`SearchStructure::visit`] does. Returns false if it cannot search for this ray.
    #[inline]
    pub(super) fn visit(&self, ray: &Ray, limit: f64, offer: &mut impl FnMut(u32, T) -> f64) -> bool {
        let boxes = self.corners.and_then(|c| BoxRay::new(ray.origin, ray.direction, c));
        let Some(boxes) = boxes else { return false };
        let mut left = limit;
        self.tree.visit(&boxes, limit, |range: Range<usize>| {
            for (id, shape) in self.tree.ids[range.clone()].iter().zip(&self.shapes[range]) {
                left = offer(*id, *shape);
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
