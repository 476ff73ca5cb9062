//! Framing: placing a camera so that it sees the whole of a subject.

use glam::{DVec2, DVec3};

use crate::geometry::basis::OrthonormalBasis;
use crate::geometry::bounds::Bounds;
use crate::geometry::subject::Subject;

/// The default free part of the picture on each of the two sides that the subject comes closest to. The subject fills
/// 85 % of the tighter direction.
pub const DEFAULT_MARGIN: f64 = 0.075;

/// The largest margin. With one half, nothing would be left of the picture.
pub(super) const MOST_MARGIN: f64 = 0.45;

/// The middle and the half extent of the part of the film that frames a subject, in relative locations from −1 to 1.
fn window(subject: &Subject<'_>, margin: f64) -> [DVec2; 2] {
    let [left, right, low, high] = subject.free_sides().map(|side| 2.0 * side.max(margin));
    let middle = 0.5 * DVec2::new(left - right, low - high);
    let half = DVec2::ONE - 0.5 * DVec2::new(left + right, low + high);
    [middle, half]
}

/// The eye from which the subject touches the margin on two opposite sides and lies in the middle of the others,
/// relative to the middle of the subject's box. `tangents` are the half width and the half height of a view plane at
/// distance 1.
///
/// A sphere appears inside the margin if it lies inside the four planes through the eye and the margin's sides. If n is
/// the normal of such a plane, that means n·c + |n|·r ≤ n·e. So the largest n·c + |n|·r of all spheres gives the exact
/// distance of the eye e.
pub(super) fn perspective_eye(subject: &Subject<'_>, basis: &OrthonormalBasis, tangents: DVec2, margin: f64) -> DVec3 {
    let [middle, half] = window(subject, margin).map(|location| location * tangents);
    let outer = subject.outer_spheres();
    let subject = &subject.with_spheres(&outer);
    let across = Wedge::new(subject, basis.u(), basis.w(), middle.x, half.x);
    let along = Wedge::new(subject, basis.v(), basis.w(), middle.y, half.y);
    let back = across.back.max(along.back);
    let x = across.aside_at(subject, back);
    let y = along.aside_at(subject, back);
    x * basis.u() + y * basis.v() + back * basis.w()
}

/// Two planes through the eye that touch the subject on its left and right, or below and above it.
#[derive(Clone, Copy)]
struct Wedge {
    axis: DVec3,
    w: DVec3,
    /// The tangent of the angle between the direction of view and the plane halfway between the two planes.
    middle: f64,
    /// Half of the distance between the planes on a view plane at distance 1.
    half: f64,
    /// The position of the eye along `axis` and along `w`.
    aside: f64,
    back: f64,
}

impl Wedge {
    fn new(subject: &Subject<'_>, axis: DVec3, w: DVec3, middle: f64, half: f64) -> Self {
        let [high, low] = [half + middle, half - middle];
        let [right, left] = subject.supports([axis + high * w, -axis + low * w]);
        // A camera in front of a box stands straight behind the box's middle, so that it never stands on a corner.
        let (aside, back) = match subject.is_box() {
            true => {
                let back = right.max(left) / half;
                (-middle * back, back)
            }
            false => {
                let back = 0.5 * (right + left) / half;
                (0.5 * (right - left) - middle * back, back)
            }
        };
        Self { axis, w, middle, half, aside, back }
    }

    /// The position along the axis of an eye at the distance `back` that sees the subject in the middle. It is the
    /// `aside` of the wedge whose smaller `half` gives it this `back`.
    fn aside_at(self, subject: &Subject<'_>, back: f64) -> f64 {
        let precise = 1e-9 * back.abs();
        let at = |cotangent: f64| {
            let wedge = Self::new(subject, self.axis, self.w, self.middle, 1.0 / cotangent);
            (cotangent, wedge.back - back, wedge.aside)
        };
        let mut low = (1.0 / self.half, self.back - back, self.aside);
        if subject.is_box() {
            return -self.middle * back;
        }
        if low.1 >= -precise {
            return self.aside;
        }
        let mut high = at(2.0 * low.0);
        for _ in 0..60 {
            if high.1 >= 0.0 {
                break;
            }
            low = high;
            high = at(2.0 * high.0);
        }
        // The distance grows almost linearly with the cotangent, so a false position (the Illinois method, M. Dowell
        // and P. Jarratt, BIT 11, 1971) needs few steps.
        for _ in 0..40 {
            if high.1.abs() <= precise {
                break;
            }
            let cotangent = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let next = at(cotangent);
            if next.1 * high.1 < 0.0 {
                low = high;
            } else {
                low.1 *= 0.5;
            }
            high = next;
        }
        high.2
    }
}

/// The middle and the half extent of the view plane that frames a subject for parallel rays, with the given aspect
/// ratio. The middle is relative to that of the subject's box. The subject lies in front of the plane.
pub(super) fn parallel_extent(
    subject: &Subject<'_>,
    basis: &OrthonormalBasis,
    aspect: f64,
    margin: f64,
) -> (DVec3, DVec2) {
    let (u, v, w) = (basis.u(), basis.v(), basis.w());
    let [right, left, top, bottom, near, far] = subject.supports([u, -u, v, -v, w, -w]);
    let half = 0.5 * DVec2::new(right + left, top + bottom);
    let [middle, free] = window(subject, margin);
    let half_height = (half.y / free.y).max(half.x / aspect / free.x);
    let half_extent = DVec2::new(half_height * aspect, half_height);
    // The middle of the view plane relative to that of the subject.
    let aside = -middle * half_extent;
    let middle = (0.5 * (right - left) + aside.x) * u + (0.5 * (top - bottom) + aside.y) * v;
    // Leaves half of the subject's depth free in front of the subject.
    let back = near + 0.5 * (near + far);
    (middle + back * w, half_extent)
}

/// The distance of an eye behind the centre of the box at which the bounding sphere of the box lies within a cone of
/// the given half angle. If the cone is wider than a half space, the eye is just outside the bounding sphere.
pub(super) fn round_distance(bounds: &Bounds, half_angle: f64) -> f64 {
    /// The largest fraction of the picture's radius that the bounding sphere fills.
    const FILL: f64 = 0.95;
    let within = (half_angle * FILL).min(std::f64::consts::FRAC_PI_2);
    0.5 * bounds.size().length() / within.sin()
}
