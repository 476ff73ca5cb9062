//! How rays find spheres: by testing every sphere, or only those that a tree cannot rule out.
//!
//! Both ways apply the same tests in f64 and have the same answers, to the bit. Testing every sphere is the reference,
//! which needs no proof. That the tree leaves out no sphere is proved in `accel/wide_tree_visit.rs`.

use std::ops::Range;

use glam::DVec3;

use crate::accel::wide_tree::WideTree;
use crate::accel::wide_tree_visit::BoxRay;
use crate::geometry::ray::Ray;
use crate::parallel::try_map;
use crate::scene::{Scene, SceneError};

/// A scene, and how rays find its spheres. The picture does not depend on it.
///
/// A reference to a [`Scene`] stands for [`Search::EverySphere`], and one to a [`SearchTree`] for [`Search::Tree`].
#[derive(Clone, Copy, Debug)]
pub enum Search<'a> {
    /// Each ray tests every sphere: the reference, for small scenes.
    EverySphere(&'a Scene),
    /// Each ray tests the spheres whose boxes it meets.
    Tree(&'a SearchTree<'a>),
}

impl<'a> From<&'a Scene> for Search<'a> {
    fn from(scene: &'a Scene) -> Self {
        Self::EverySphere(scene)
    }
}

impl<'a> From<&'a SearchTree<'a>> for Search<'a> {
    fn from(tree: &'a SearchTree<'a>) -> Self {
        Self::Tree(tree)
    }
}

/// The number of spheres up to which testing all takes less time than the tree.
const FEW: usize = 16;

/// A tree over the spheres of a scene, which makes the CPU reference fast and changes none of its pictures.
///
/// It takes about 30 bytes for each sphere, at most 34, and 28 more while it is built.
#[derive(Debug)]
pub struct SearchTree<'a> {
    scene: &'a Scene,
    pub(super) tree: WideTree,
    /// Two opposite corners of a box around all spheres; `None` if there are few.
    pub(super) corners: Option<[DVec3; 2]>,
    /// The spheres in the order of the tree.
    pub(super) spheres: Vec<[f32; 4]>,
}

impl<'a> SearchTree<'a> {
    /// The most bytes for each sphere while a tree is built.
    pub const BYTES_PER_SPHERE: u64 = 62;

    /// Builds the tree of a scene, on all cores with the feature `parallel`.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory for a copy of the spheres.
    pub fn new(scene: &'a Scene) -> Result<Self, SceneError> {
        let all = scene.spheres();
        let tree = WideTree::build(all, 0.0);
        let spheres = try_map(all.len(), |i| all[tree.ids()[i] as usize])
            .map_err(|_| SceneError::Memory { count: all.len() })?;
        let corners = tree.corners().filter(|_| all.len() > FEW);
        Ok(Self { scene, tree, corners, spheres })
    }

    /// The scene of which this is the tree.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Calls `offer` with every sphere that the ray, which is in the scene's frame, may hit at or before `limit`, and
    /// its id. The return value of `offer` is the new limit, below zero to end the search.
    #[inline]
    fn visit(&self, ray: &Ray, limit: f64, mut offer: impl FnMut(u32, [f32; 4]) -> f64) {
        let mut left = limit;
        let mut offer_range = |range: Range<usize>| {
            for (id, sphere) in self.tree.ids()[range.clone()].iter().zip(&self.spheres[range]) {
                left = offer(*id, *sphere);
                if left < 0.0 {
                    break;
                }
            }
            left
        };
        let boxes = self.corners.and_then(|c| BoxRay::new(ray.origin, ray.direction, c));
        match boxes {
            Some(boxes) => self.tree.visit(&boxes, limit, offer_range),
            None => {
                offer_range(0..self.spheres.len());
            }
        }
    }
}

/// The nearest of the spheres that a test accepted.
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
            Self::Tree(tree) => tree.scene,
        }
    }

    /// The nearest hit of a ray in the scene's frame; of several at the same distance, that with the smallest id.
    /// `distance` gets a sphere, and returns the distance of a hit, which is not NaN.
    #[inline]
    pub(super) fn nearest(
        &self,
        ray: &Ray,
        distance: impl Fn([f32; 4]) -> Option<f64>,
    ) -> Option<NearestHit> {
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
            Self::Tree(tree) => tree.visit(ray, f64::INFINITY, |id, sphere| {
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

    /// Whether `test` is true of any sphere. It may be true only of spheres that the ray, which is in the scene's
    /// frame, hits before `t_max`.
    #[inline]
    pub(super) fn any(&self, ray: &Ray, t_max: f64, test: impl Fn(u32, [f32; 4]) -> bool) -> bool {
        match self {
            Self::EverySphere(scene) => {
                (0..).zip(scene.spheres()).any(|(id, sphere)| test(id, *sphere))
            }
            Self::Tree(tree) => {
                let mut is_any = false;
                tree.visit(ray, t_max, |id, sphere| {
                    is_any = is_any || test(id, sphere);
                    if is_any { f64::NEG_INFINITY } else { t_max }
                });
                is_any
            }
        }
    }
}
