//! The intersection of a ray and a cone, in f64.

use glam::DVec3;

use crate::geometry::cone::ConeInFrame;
use crate::geometry::ray::Ray;

/// A crossing of the line of a ray and the surface of a cone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// The distance from the ray's origin, which is negative behind it.
    pub(crate) t: f64,
    /// The unit normal, which points away from the axis, or from the other end. `None` at an open end.
    pub(crate) normal: Option<DVec3>,
}

/// The distance to the cone's first point in front of the ray's origin, and the unit normal there, which points out of the
/// cone. `None` for a miss.
#[must_use]
pub fn intersect(ray: &Ray, cone: &ConeInFrame) -> Option<(f64, DVec3)> {
    crossings(ray, cone)?.into_iter().filter(|crossing| crossing.t > 0.0).find_map(|hit| Some((hit.t, hit.normal?)))
}

/// The crossings at which the line of a ray enters the cone and leaves it.
///
/// The side and the discs enclose a convex body, so a ray enters once and leaves once: after it has entered both the
/// infinite cone, whose points have |p|² ≤ r², where p is the vector from the axis and r the radius there, and the slab
/// between the planes of the discs, and before it leaves one of them. Crossings of open discs are no hits. Distances are
/// computed from the point of the ray that is nearest to the middle of the axis, so that a distant origin costs no digits.
pub(crate) fn crossings(ray: &Ray, cone: &ConeInFrame) -> Option<[Crossing; 2]> {
    let ([start, end], [first, second]) = (cone.ends(), cone.radii());
    let length = (end - start).length();
    let axis = (end - start) / length;
    let slope = (second - first) / length;
    let foot = (0.5 * (start + end) - ray.origin).dot(ray.direction);
    let from_start = ray.at(foot) - start;
    let [height, rise] = [from_start, ray.direction].map(|v| v.dot(axis));
    let [away, aside] = [from_start - height * axis, ray.direction - rise * axis];
    let (radius, growth) = (first + slope * height, slope * rise);
    // |away + s aside|² = (radius + s growth)².
    let a = aside.length_squared() - growth * growth;
    let half_b = away.dot(aside) - radius * growth;
    let c = away.length_squared() - radius * radius;
    let discriminant = half_b * half_b - a * c;
    let sum = -(half_b + discriminant.max(0.0).sqrt().copysign(half_b));
    let (one, two) = (sum / a, if sum == 0.0 { 0.0 } else { c / sum });
    let side = if a == 0.0 && half_b == 0.0 {
        (c <= 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY])
    } else if a >= 0.0 {
        (discriminant >= 0.0).then_some([one.min(two), one.max(two)])
    } else if growth > 0.0 {
        // Steeper than the side: only one half of the cone has a radius that is not negative.
        Some([one.max(two), f64::INFINITY])
    } else {
        Some([f64::NEG_INFINITY, one.min(two)])
    };
    let side = side?;
    let outward = |s: f64| {
        let outward = away + s * aside - slope * (radius + s * growth) * axis;
        outward.normalize_or(-slope.signum() * axis)
    };
    let [start_closed, end_closed] = cone.are_closed();
    let planes = [(-height / rise, -axis, start_closed), ((length - height) / rise, axis, end_closed)];
    let [below, above] = if rise < 0.0 { [planes[1], planes[0]] } else { planes };
    let slab = if rise == 0.0 && (0.0..=length).contains(&height) {
        [f64::NEG_INFINITY, f64::INFINITY]
    } else {
        [below.0, above.0]
    };
    let (enters, leaves) = (side[0].max(slab[0]), side[1].min(slab[1]));
    if enters > leaves {
        return None;
    }
    let entry = if slab[0] > side[0] { below.2.then_some(below.1) } else { Some(outward(enters)) };
    let exit = if slab[1] < side[1] { above.2.then_some(above.1) } else { Some(outward(leaves)) };
    Some([(enters, entry), (leaves, exit)].map(|(s, normal)| Crossing { t: foot + s, normal }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::math::unit;

    fn from(x: f64, y: f64, z: f64, direction: DVec3) -> Ray {
        Ray { origin: DVec3::new(x, y, z), direction: unit(direction).unwrap() }
    }

    #[test]
    fn known_answers() {
        let cylinder = ConeInFrame { start: [0.0; 3], first_radius: 1.0, end: [0.0, 0.0, 4.0], second_radius: 1.0 };
        let open = ConeInFrame { first_radius: -1.0, second_radius: -1.0, ..cylinder };
        let pointed = ConeInFrame { first_radius: 2.0, second_radius: 0.0, ..cylinder };
        let slanted = unit(DVec3::new(2.0, 0.0, 1.0)).unwrap();
        for (case, cone, ray, t, normal) in [
            ("the side", cylinder, from(5.0, 0.0, 1.0, -DVec3::X), 4.0, DVec3::X),
            ("from inside", cylinder, from(0.0, 0.0, 1.0, DVec3::Y), 1.0, DVec3::Y),
            ("the first disc, along the axis", cylinder, from(0.5, 0.0, -3.0, DVec3::Z), 3.0, -DVec3::Z),
            ("the second disc, from inside", cylinder, from(0.5, 0.0, 1.0, DVec3::Z), 3.0, DVec3::Z),
            (
                "through an open end, aslant",
                open,
                from(0.0, 0.0, 5.0, DVec3::new(0.5, 0.0, -1.0)),
                5_f64.sqrt(),
                DVec3::X,
            ),
            ("a cone's side", pointed, from(5.0, 0.0, 2.0, -DVec3::X), 4.0, slanted),
            ("a cone's disc", pointed, from(1.5, 0.0, -1.0, DVec3::Z), 1.0, -DVec3::Z),
            ("a cone from its tip", pointed, from(0.5, 0.0, 9.0, -DVec3::Z), 6.0, slanted),
        ] {
            let (found, outward) = intersect(&ray, &cone).unwrap();
            assert!((found - t).abs() < 1e-14, "{case}: {found}");
            assert!((outward - normal).length() < 1e-14, "{case}: {outward}");
        }
        for (case, cone, ray) in [
            ("beside", cylinder, from(5.0, 1.1, 1.0, -DVec3::X)),
            ("beyond the end", cylinder, from(5.0, 0.0, 4.1, -DVec3::X)),
            ("behind", cylinder, from(5.0, 0.0, 1.0, DVec3::X)),
            ("through both open ends", open, from(0.5, 0.0, -3.0, DVec3::Z)),
            ("the cone's other half", pointed, from(5.0, 0.0, 6.0, -DVec3::X)),
        ] {
            assert_eq!(intersect(&ray, &cone), None, "{case}");
        }
    }
}
