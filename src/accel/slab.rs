//! Why no box test misses a hit sphere, and the constants of the proof. The WGSL twin is `shaders/accel/slab.wgsl`.
//!
//! # The margin
//! The result of a tree must equal that of testing every sphere, to the bit, although both the sphere test and the box
//! test have rounding errors. So boxes are made for spheres inflated by a margin m. The host sets m to 2⁻¹⁷ D. Here D
//! is the diagonal of the scene's box, and every ray starts in that box. In units of u = 2⁻²⁴ D, m is 128. A device may
//! do what WGSL allows (`src/verify/rounding.rs`): a result is either neighbour of the exact value, off by 2 u for a
//! length of D; a quotient is off by 7 u and a root by 10 u; products and sums may be fused, and sums taken in any
//! order. Let L be the vector from the ray's origin o to the centre, and r the radius; |L| + r ≤ D, because the sphere
//! is in the box. Let the direction d be of length 1 + ε; |ε| ≤ 11 · 2⁻²³ (half of three roundings of its square; a
//! root, a reciprocal and a product). Squares of errors are left out; all of them together are less than 1 u.
//!
//! 1. *A ray that hits according to the test comes within r + 9 u of the centre.* Rounding L, b d and their difference
//!    moves the foot vector f by 2 u and 3 u. The errors of b and ε move it along the ray, across f, so that |f| only
//!    grows. The sum of four squares decides, and moves the decision by 4 · 2⁻²³ r, which is 4 u.
//! 2. *The point P that the test reports at the distance t is within r + 51 u, or o lies in the box.* Let h be the half
//!    chord. The large error of h near a tangent is that of 1. All other errors are along the ray; one of e moves P
//!    away from the surface by e h/r. They are:
//!    * From outside, t = c/(b + h): c is off by (6 + 4 r²/|L|²) 2⁻²³ |L|², for L and four squares; b by 4 · 2⁻²³ |L|; h
//!      by 16 · 2⁻²³ h, for the root and ε; the quotient and its divisor by 4.5 · 2⁻²³ t. Together the most is
//!      14.5 · 2⁻²³ |L|, towards the centre of a small sphere, which is 29 u; where b + h is small, so is h/r. With 9 u of
//!      1, less than 39 u. That is so for all o that are more than m/2 outside of the sphere. If o is nearer, the
//!      inflated box contains it with m/2 to spare, and its entry is 0, which is less than any t.
//!    * From inside with b ≥ 0, t = b + h: ε(2 b + h) for the length of d, which is 33 u; 4 u for b, 5 u for the root, 2 u
//!      for the sum, and of 1 no more than 7 u, because |L| ≤ r. Together 51 u.
//!    * From inside with b < 0, t = c/(b − h): by the same terms as from outside, less than 33 u.
//!
//!    The sign of c is wrong only if o is within 10 u of the surface, in the box. The same holds where rounding alone puts
//!    a hit in front of o.
//! 3. *The box test moves a plane by at most 17 u.* (plane − o) · 1/d has a difference, a product and the reciprocal:
//!    5.5 · 2⁻²³ of a length of at most D. The planes of wide nodes, q · step + start, have five roundings and the
//!    reciprocal: 8.5 · 2⁻²³ D. An error of t along the axis i is one of `d_i` times that in space. Components of the
//!    direction below [`SMALLEST_COMPONENT`] are replaced by it, which bends a ray by 2⁻⁴⁰ D at most.
//!
//! The sum is 68 u: if the sphere test gives t, then the box test of every box around the sphere gives an entry that is
//! not beyond its exit and not beyond t. A box is left out only if its entry is *greater* than the nearest distance, so
//! that equal distances are compared by id. The rest of the margin serves rays that start up to half a diagonal outside
//! the scene's box, whose errors are half as large again. `tests/cpu/box_margin.rs` searches for the largest error; it
//! finds 22 u.
//!
//! # Smaller margins
//! In an 8-wide tree of a scene with outliers (`statistics.rs`), spheres inside the box of the crowd have the margin of
//! that box, 2⁻¹⁷ D' with the crowd's diagonal D'. A ray whose origin is F from the farthest point of that box widens
//! all boxes by w = 2⁻¹⁷ F − 2⁻¹⁷ D', if that is more than 0. For such a sphere, |L| + r ≤ F or r ≤ D'/2, so that 1 and
//! 2 hold with the larger of F and D' instead of D; the extra width of boxes is at least 128 u of it. In 3, a plane is
//! moved by 17 u of that length, 2 u more for the sum with w, and by the errors that grow with the node. The node's
//! grid starts up to its side W outside of the crowd's box, its planes are less than 1.01 W from there and up to 1.01 W
//! outside of the box. So three roundings of W, two of 1.01 W, and one and the reciprocal of 1.01 W add less than 20 ·
//! 2⁻²⁴ W. Children's boxes are wider by [`NODE_PART`] W, which is more. Other spheres have the scene's margin, and all
//! boxes around them contain it.

/// The smallest magnitude of a direction's component in box tests. Smaller components are replaced by it, with their
/// sign. WGSL has no infinities, and with lengths up to 2⁵⁹ the distance to a plane stays below 2¹⁰⁰.
pub const SMALLEST_COMPONENT: f32 = 1.0 / (1_u64 << 40) as f32;

/// Extra width of a child's box on each side, as a fraction of that side of its node's grid.
pub(super) const NODE_PART: f64 = 1.0 / (1 << 19) as f64;
