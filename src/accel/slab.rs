//! Rays prepared for box tests, and why no box test loses a sphere. The WGSL twin is `shaders/accel/slab.wgsl`.
//!
//! # The margin
//! The result of a tree must equal that of testing every sphere, to the bit, although both the sphere test and the box
//! test have rounding errors. Boxes are therefore those of spheres inflated by a margin m, which the host sets to 2⁻¹⁸
//! D, where D is the diagonal of the scene's box and every ray starts in that box. In units of u = 2⁻²⁴ D, m is 64. Let
//! L be the vector from the ray's origin o to the centre, |L| ≤ D, and r the radius, r ≤ D/2:
//!
//! 1. *A ray that hits according to the test comes within r + 11 u of the centre.* The foot vector f is off by at
//!    most 1 u from L, 4 u from b, 3 u from the direction's length and 2 u from its own product and
//!    difference; the rounding of its square and of r² moves the decision by 1 u.
//! 2. *The point P = o + t d that the test reports is as near, or o lies in the box.* From t = b − h, P is at
//!    √(|f|² + h²) from the centre, and h = √(r² − f²) was computed from the same f: the large error of h near
//!    a tangent is along the tangent. b adds 5 u. From t = c/(b + h), c is off by δ ≤ 6 u |L|. If o is
//!    more than m/2 outside the sphere, δ is small compared with c. Either b + h ≥ |L|/2, and t is off by 12 u; or
//!    r > 0.8 |L|, and |P − centre|², which changes by at most 3 δ, puts P off by 3 δ/(2 r) < 12 u. If not,
//!    the inflated box contains o with m/2 to spare, and its entry is 0, which is less than any t. The same
//!    holds for hits from inside, and where rounding alone puts a hit in front of o.
//! 3. *The box test moves a plane by at most 8 u.* (plane − o) · 1/d has three roundings, q · step + start
//!    three more, each relative to a length of at most 2 D, and an error of t along the axis i is one
//!    of `d_i` times that in space. Components of the direction below [`SMALLEST_COMPONENT`] are replaced by
//!    it, which bends a ray by 2⁻⁴⁰ D at most.
//!
//! The sum is less than 40 u: if the sphere test gives t, then the box test of every box around the sphere
//! gives an entry that is not beyond its exit and not beyond t. A box is left out only if its entry is
//! *greater* than the nearest distance, so that equal distances are compared by id. The rest of the margin
//! serves rays that start up to half a diagonal outside the scene's box.
//!
//! # Smaller margins
//! In an 8-wide tree of a scene with outliers (`outliers.rs`), spheres inside the box of the crowd have the margin of that
//! box, 2⁻¹⁸ D' with the crowd's diagonal D'. A ray whose origin is F from the farthest point of that box widens all boxes
//! by w = 2⁻¹⁸ F − 2⁻¹⁸ D', if that is more than 0. For such a sphere, |L| ≤ F and r ≤ D'/2, so that 1 and 2 hold with the
//! larger of F and D' instead of D; what boxes are wider is at least 64 u of it. In 3, a plane is moved by 8 u of that
//! length, 1 u more for the sum with w, and by the errors that grow with the node: the node's grid starts up to its side
//! W outside of the crowd's box, and its planes are up to 2 W from there, so that three roundings of W, three of 2 W and
//! one of 3 W add less than 12 · 2⁻²⁴ W. Children's boxes are wider by [`NODE_PART`] W, which is more. Other spheres have the
//! scene's margin, and all boxes around them contain it.
//!
//! These are the errors of a device that rounds to nearest, as all tested devices do. If a result may be either
//! neighbour, as WGSL allows, and a quotient is off by 2.5 ULP, the same sum is 80 u or more, so this is not a proof
//! for such devices; the largest error that a search of such cases found is 38 u.

use glam::Vec3;

use super::outliers::NearRays;
use super::query::RayF32;

/// The smallest magnitude of a direction's component in box tests; smaller components are replaced by it, with their
/// sign. WGSL has no infinities, and with lengths up to 2⁵⁹ the distance to a plane stays below 2¹⁰⁰.
pub const SMALLEST_COMPONENT: f32 = 1.0 / (1_u64 << 40) as f32;

/// By how much the box of a child is wider than what it contains, as a part of each side of its node's grid.
pub(super) const NODE_PART: f64 = 1.0 / (1 << 19) as f64;

/// The origin of a ray, and the reciprocals of its direction's components.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlabRay {
    pub(super) origin: Vec3,
    pub(super) inverse: Vec3,
    /// By how much boxes are wider for this ray than they are.
    pub(super) wider: f32,
}

/// The reciprocal of each component of a direction. The WGSL twin is the function in `shaders/scene/enter.wgsl`.
pub(super) fn inverse_direction(direction: Vec3) -> Vec3 {
    let size = direction.abs().max(Vec3::splat(SMALLEST_COMPONENT));
    1.0 / Vec3::select(direction.cmpge(Vec3::ZERO), size, -size)
}

impl SlabRay {
    pub(super) fn new(ray: &RayF32) -> Self {
        Self { origin: ray.origin, inverse: inverse_direction(ray.direction), wider: 0.0 }
    }

    /// A ray for a tree whose margins may be smaller than that of the scene.
    pub(super) fn for_tree(ray: &RayF32, near: &NearRays) -> Self {
        Self { wider: near.widening(ray.origin), ..Self::new(ray) }
    }

    /// The octant of the direction: bit i is set if the direction is negative along axis i.
    pub(super) fn octant(&self) -> u32 {
        let bit = |axis: usize| u32::from(self.inverse[axis] < 0.0) << axis;
        bit(0) | bit(1) | bit(2)
    }
}
