//! Places a camera so that it sees the whole of a subject.

use glam::{DVec2, DVec3};

use crate::geometry::basis::OrthonormalBasis;
#[cfg(feature = "scene-file")]
use crate::geometry::bounds::Bounds;
use crate::geometry::subject::Subject;

/// The free part of the picture beside a framed subject if none is given, on each of the two sides that it comes
/// closest to: the subject fills 85 % of the tighter direction.
pub const DEFAULT_MARGIN: f64 = 0.075;

/// The largest margin; with one half, nothing would be left of the picture.
pub(super) const MOST_MARGIN: f64 = 0.45;

/// How much of the picture's half width and half height is left inside a margin.
fn fill(margin: f64) -> f64 {
    1.0 - 2.0 * margin
}

/// The eye, relative to the middle of the subject's box, whose picture of the subject touches the margin on two
/// opposite sides and lies in the middle of the others. `tangents` are the half width and the half height of a view
/// plane at distance 1.
///
/// A sphere appears inside the margin if it lies inside the four planes through the eye and the margin's sides. With
/// the normal n of such a plane, that is n·c + |n|·r ≤ n·e, so the largest n·c + |n|·r of all spheres says exactly how
/// far away the eye e must be.
pub(super) fn perspective_eye(
    subject: &Subject<'_>,
    basis: &OrthonormalBasis,
    tangents: DVec2,
    margin: f64,
) -> DVec3 {
    let tangents = tangents * fill(margin);
    let across = Wedge::new(subject, basis.u(), basis.w(), tangents.x);
    let along = Wedge::new(subject, basis.v(), basis.w(), tangents.y);
    let back = across.back.max(along.back);
    let x = across.aside_at(subject, back);
    let y = along.aside_at(subject, back);
    x * basis.u() + y * basis.v() + back * basis.w()
}

/// Two planes through the eye, to the left and the right of the subject or below and above it, which touch it.
#[derive(Clone, Copy)]
struct Wedge {
    axis: DVec3,
    w: DVec3,
    /// The tangent of the angle between the planes and the direction of view.
    tangent: f64,
    /// Where the eye is along `axis` and along `w`.
    aside: f64,
    back: f64,
}

impl Wedge {
    fn new(subject: &Subject<'_>, axis: DVec3, w: DVec3, tangent: f64) -> Self {
        let [right, left] = subject.supports([axis + tangent * w, -axis + tangent * w]);
        // A camera in front of a box stands straight behind its middle, so that it never stands on a corner.
        let (aside, back) = match subject.is_box() {
            true => (0.0, right.max(left) / tangent),
            false => (0.5 * (right - left), 0.5 * (right + left) / tangent),
        };
        Self { axis, w, tangent, aside, back }
    }

    /// Where an eye that stands `back` must be along the axis, so that the subject appears in the middle: that of
    /// narrower planes which meet there.
    fn aside_at(self, subject: &Subject<'_>, back: f64) -> f64 {
        let precise = 1e-9 * back.abs();
        let at = |cotangent: f64| {
            let wedge = Self::new(subject, self.axis, self.w, 1.0 / cotangent);
            (cotangent, wedge.back - back, wedge.aside)
        };
        let mut low = (1.0 / self.tangent, self.back - back, self.aside);
        if low.1 >= -precise || subject.is_box() {
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

/// The middle of a view plane, relative to the middle of the subject's box, and its half extent, of the given aspect
/// ratio, for parallel rays. The subject lies in front of the plane.
pub(super) fn parallel_extent(
    subject: &Subject<'_>,
    basis: &OrthonormalBasis,
    aspect: f64,
    margin: f64,
) -> (DVec3, DVec2) {
    let (u, v, w) = (basis.u(), basis.v(), basis.w());
    let [right, left, top, bottom, near, far] = subject.supports([u, -u, v, -v, w, -w]);
    let half = 0.5 * DVec2::new(right + left, top + bottom);
    let half_height = half.y.max(half.x / aspect) / fill(margin);
    let middle = 0.5 * ((right - left) * u + (top - bottom) * v);
    // As much room is left in front of the subject as half of its depth.
    let back = near + 0.5 * (near + far);
    (middle + back * w, DVec2::new(half_height * aspect, half_height))
}

/// How far behind the centre of the box an eye must stand so that the bounding sphere of the box lies within a cone of
/// this half angle. If the cone is wider than a half space, this is just outside the bounding sphere.
#[cfg(feature = "scene-file")]
pub(super) fn round_distance(bounds: &Bounds, half_angle: f64) -> f64 {
    /// How much of the picture's radius the bounding sphere may fill.
    const FILL: f64 = 0.95;
    let within = (half_angle * FILL).min(std::f64::consts::FRAC_PI_2);
    0.5 * bounds.size().length() / within.sin()
}
