//! Judges whether the answers of any renderer are right: which sphere, cone or cylinder each pixel shows, at which depth and
//! normal.
//!
//! No renderer in floating-point numbers gives the exact answer to every ray, and this is not a fault: if a ray just
//! touches a sphere, rounding decides. A tolerance for depths and a share of pixels that may differ would hide real
//! faults beside such rays. So answers are judged by *backward stability*, as numerical algorithms are (Higham,
//! *Accuracy and Stability of Numerical Algorithms*, section 1.5): an answer is good if it is the exact answer to a
//! question that differs little from the given question.
//!
//! # Definition
//!
//! Let ε = 2⁻²⁴, half the distance from 1 to the next f32. A sphere with radius r, whose centre is at the vector l from
//! the start of the ray, is *moved by at most k* if its centre, seen from the ray, is at l + δ with
//!
//! |δ| ≤ k ε (max(|l|, r) + s).
//!
//! This is the same as a ray that starts up to k ε |l| elsewhere, or whose direction is turned by up to k ε.
//! For given rays ([`Rays::Given`]) s is 0. For rays that the renderer makes by itself ([`Rays::View`]) s is
//! an eighth of the distance of the camera from the origin of the scene's frame, because the camera's
//! coordinates are rounded too, but not often. (The frame is that of the world, unless the data are far from
//! the world's origin: [`Scene::origin`](crate::Scene::origin). A renderer that narrows coordinates far from
//! zero needs a larger k, and the picture shows it.)
//!
//! An answer is *legal for k* if every sphere can be moved by at most k, each by itself, such that
//!
//! * the claimed sphere is hit, where depths are given at exactly the claimed distance, and where normals are given
//!   with the claimed normal. For normals the move may be another, and s is an eighth of the distance of the ray's start
//!   from the origin of the world, or of the frame if that is farther, for all rays, because the point that is hit has
//!   coordinates there;
//! * no other sphere is hit before that; or, if a miss is claimed, no sphere is hit at all.
//!
//! Each sphere is moved by itself because a renderer tests each sphere by itself, with separate roundings. If one of
//! these conditions holds for some k, it holds for all larger k, so there is a *least k*. All spheres that are moved by
//! at most a fill the ball of radius r + a, and share the ball of radius r − a. So the least move for each condition is
//! the distance of a point from a circle, in closed form (`relative_sphere.rs`). The least k of a pixel is the largest
//! of them. (Without a depth, the nearest position of the claimed sphere also depends on k, and the least k is found by
//! doubling and bisection.) Everything is computed in f64, whose errors are 2⁻²⁹ of one k.
//!
//! A sphere that contains the start of its ray shows its far side. Spheres that are equal to the bit count as one.
//!
//! Cones and cylinders are moved as wholes, too; |l| is then the length of the longer vector to an end of the axis. An error
//! of a normal counts as a move by its length times the radius there, or, on a disc, times the length of the axis. The signed
//! distance from the solid between the discs is a convex function along a ray, from which bounds of all moves follow
//! (`relative_cone.rs`). They are never more than the least moves, so that a right answer is never refused; for cones that
//! are thinner than their move, and near the rims of open ends, they may be less, and such pixels are undecided.
//!
//! # Outcomes
//!
//! For a limit K, a pixel is *violated* if its least k is above K. It is *proved* if every answer that is legal for K
//! names the sphere that the renderer named. Otherwise it is *undecided*: the answer is legal, but other answers are
//! too, as at silhouettes and where spheres touch. A sphere whose radius is smaller than its move, for ids or for normals,
//! is never proved.
//!
//! # What an honest f32 renderer needs
//!
//! Claim: a renderer that is given rays in f32, rounds every sum, product, quotient and root to nearest, fused or in any
//! order, and tests spheres by
//!
//! l = c − o, b = l·d, f = l − b d, q = r² − f·f, h = √q, t = b − h or (l·l − r²)/(b + h),
//!
//! needs, to first order, k ≤ 9 for ids, k ≤ 21 with depths, and k ≤ 27 with normals. Let L = |l| ≥ r (from inside, the same holds with
//! r in place of L), and let ε be the error of one rounding. Terms in ε² are left out.
//!
//! 1. The difference l is off by ε L: a move by 1, in units of ε L.
//! 2. b is off by at most 3 ε L (three roundings of l·d, by Cauchy and Schwarz). This moves f along d, across which it
//!    lies, so that |f| changes only in second order, unless r itself is of the size ε L; then by at most (3 + √2) ε L.
//! 3. The product b d and the difference l − b d add ε |b| and ε |f|, together at most √2 ε L. With 2 these are at most
//!    6 ε L.
//! 4. Rounding f·f changes |f| by 3/2 ε |f|; rounding r² and the difference q has the effect of a radius, or an |f|, that
//!    is off by ε r/2 each. Whether the sphere is hit is decided by the sign of q: 1 + 6 + 3/2 + 1/2 = **9**.
//! 5. The depth: b is off by 3 ε L along the ray; h, given q, by ε h/2 for q and ε h for the root; t by ε L. That is
//!    5.5 ε L along the ray, and a point that is moved by x along the ray is at most x farther from the surface. With the
//!    quotient instead of the difference: l·l − r² is off by at most (3 + 1) ε L², which moves t by 4 ε L²/(b + h), and
//!    the point's distance from the surface by h/r of that; where L ≥ √2 r, b ≥ L/√2 and this is at most 4 √2 ε L; where
//!    L < √2 r, it is at most 2 √2 ε L, because b > h. The sum b + h and the quotient add (3 + 1.5 + 1) ε L. With the
//!    9 of the id: at most 9 + 5.7 + 5.5 < **21**. Each further ULP in roots or quotients adds 2, so that those of WGSL
//!    (2.5 ULP for a quotient, and a root that is as good) need less than 29.
//! 6. The normal (o + t d − c)/r or made unit: the point is off by 21 as above, and by three more roundings of numbers
//!    that are at most L + |o| + r, of which s takes up |o|, the distance from the origin of the coordinates in which the
//!    renderer adds o and t d; making it unit adds 3.5 ε r: less than 21 + 2.5 + 3.5 = **27**.
//! 7. A direction in f32 is of unit length up to 1.5 ε, so that distances and parameters differ by at most 1.5 ε t.
//!
//! So the limit is 24 for given rays ([`OF_GIVEN_RAYS`]), and 8 more if normals are judged ([`FOR_NORMALS`]). A
//! renderer that makes its rays also rounds o, by ε |o|, and may move the ray's start along it, to numbers of at most
//! |o| + 2 L. The limit times s covers |o|, and 2 remain. The renderer also rounds d: for a location x, y it sums x
//! right + y up + forward. The location is off by 3 ε (the quotient, the difference), and each vector, product and sum
//! by ε: 3 (|right| + |up|) + 4 (|x right| + |y up| + |forward|), relative to the length of the sum. Up to a field of
//! view of 90° that is at most 6 + 4 √3 < 13, and normalizing it adds 3.5: together less than 17 + 2. So the limit is
//! 16 more ([`FOR_CAMERAS`]): 21 + 19 = 40. Wider fields of view, and cameras whose angles come from trigonometry with
//! the errors that WGSL allows, may need more.
//!
//! For cones and cylinders the limits are the same, without a derivation. In pictures of 123 scenes that were made to be
//! hard, with 485,000 hits of cones, a device that rounds to nearest needed k of up to 5.4, and one that rounds each step
//! in any legal way up to 20.6, with normals and rays of its own, for which the limit is 48.
//!
//! The quadratic formula of textbooks does not meet these conditions: its b² − 4ac subtracts numbers of the size L²,
//! which loses ε L² from r², so that a small sphere far away is moved by L/r times as much.
//!
//! In practice, so many roundings seldom all add up: Embree and Tachyon needed k below 6
//! (`docs/explain/how-verify-decides.md`).
//!
//! ```
//! use pinhole::camera::{PinholeCamera, Pose};
//! use pinhole::verify::conformance::{Answers, Rays};
//! use pinhole::verify::{Checker, Outcome};
//! use pinhole::{Film, LinearRgb, Scene, View};
//!
//! let scene = Scene::from_f32(vec![[0.0_f32, 0.0, 0.0, 1.0]], LinearRgb::WHITE)?;
//! let pose = Pose::looking_at([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
//! let camera = PinholeCamera::with_vertical_fov(pose, 0.1, 1.0)?;
//! let view = View::new(&camera, Film::new(1, 1)?);
//! // What another renderer found: the sphere 0 at the distance 3.
//! let answers = Answers { size: [1, 1], ids: &[0], depths: Some(&[3.0]), ..Answers::default() };
//! let found = Checker::new(&scene)?.certify_answers(&answers, Rays::View(view), None)?;
//! assert_eq!(found.outcome(), Outcome::Proved, "{found}");
//! let wrong = Answers { depths: Some(&[3.001]), ..answers };
//! let found = Checker::new(&scene)?.certify_answers(&wrong, Rays::View(view), None)?;
//! assert_eq!(found.outcome(), Outcome::Violated, "{found}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answers;
mod moves;
mod pixel;
mod relative;
mod relative_cone;
mod relative_sphere;

pub use answers::{
    Answers, Conformance, ConformanceError, DepthKind, EPSILON, FOR_CAMERAS, FOR_NORMALS, Field, Finding,
    OF_GIVEN_RAYS, Rays, Reason,
};

use answers::{KEPT, refused};
use pixel::PixelCheck;

use super::certificate::Outcome;
use super::checker::Checker;
use crate::parallel::{self, map_parts};

impl Checker<'_> {
    /// Judges the answers of any renderer to exact rays. `at_most` is the limit of k. Without it, the limit is
    /// [`OF_GIVEN_RAYS`], plus [`FOR_CAMERAS`] and [`FOR_NORMALS`] if they apply.
    ///
    /// # Errors
    /// Returns an error if a list has a wrong length, an id is not the index of a sphere, a number is not finite or not
    /// positive where it must be, or if depths along an axis are given without a camera that has one.
    pub fn certify_answers(
        &self,
        answers: &Answers<'_>,
        rays: Rays<'_>,
        at_most: Option<f64>,
    ) -> Result<Conformance, ConformanceError> {
        let at_most = at_most.unwrap_or_else(|| answers.limit(rays));
        if !(at_most > 0.0 && at_most.is_finite()) {
            let message = format!("the limit {at_most} must be greater than 0 and finite");
            return Err(refused(None, message));
        }
        answers.check(self.scene, rays)?;
        let check = PixelCheck {
            scene: self.scene,
            candidates: &self.candidates,
            answers: *answers,
            rays,
            axis: rays.axis(),
            at_most,
        };
        let judged = parallel::map(answers.ids.len(), |index| check.judge(index));
        let (outcomes, least): (Vec<Outcome>, Vec<f32>) = judged.into_iter().unzip();
        let worst = worst_of(&least);
        let mut found = Conformance { size: answers.size, at_most, outcomes, least, worst: Vec::new() };
        let explain = |index: usize| check.explain(index, found.outcomes[index], found.least[index].into());
        found.worst = map_parts(worst, explain);
        Ok(found)
    }
}

/// The pixels with the largest k that is not 0, the largest first, and then by their index.
fn worst_of(least: &[f32]) -> Vec<usize> {
    let mut pixels: Vec<usize> = (0..least.len()).filter(|index| least[*index] > 0.0).collect();
    let order = |a: &usize, b: &usize| least[*b].total_cmp(&least[*a]).then(a.cmp(b));
    if pixels.len() > KEPT {
        pixels.select_nth_unstable_by(KEPT, order);
        pixels.truncate(KEPT);
    }
    pixels.sort_unstable_by(order);
    pixels
}
