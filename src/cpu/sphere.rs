//! The intersection of a ray and a sphere, in f64.

use glam::DVec3;

use crate::geometry::ray::Ray;

/// The distance to the sphere's first point in front of the ray's origin, and the unit normal there, which points away
/// from the centre. `None` for a miss.
///
/// If the ray starts inside the sphere or on its surface, the first point is on the far side. The distance follows from
/// Pythagoras: the foot point of the centre on the ray lies at the distance `b`, and half the chord is √(r² − |centre −
/// foot|²). A tangent ray hits. A ray that starts on the surface and only leaves the sphere does not.
///
/// The normal is computed from the same right triangle, not from the hit point. For a small sphere far away, the
/// rounding error of the hit point exceeds the radius.
///
/// Inlined, so that callers that need only the distance do not compute the normal.
#[inline(always)]
pub(super) fn intersect(ray: &Ray, center: DVec3, radius: f64) -> Option<(f64, DVec3)> {
    let to_center = center - ray.origin;
    let b = to_center.dot(ray.direction);
    let foot_to_center = to_center - b * ray.direction;
    let half_chord_squared = radius * radius - foot_to_center.length_squared();
    if half_chord_squared < 0.0 {
        return None;
    }
    // The product of the distances to both sides. It is positive outside and zero on the surface.
    let c = to_center.length_squared() - radius * radius;
    let half_chord = half_chord_squared.sqrt();
    let from_foot = if c > 0.0 { -half_chord } else { half_chord };
    // t is b + from_foot. If the two would cancel, t follows from (b + from_foot)(b − from_foot) = c.
    let t = if b * from_foot >= 0.0 { b + from_foot } else { c / (b - from_foot) };
    (t > 0.0).then(|| (t, (from_foot * ray.direction - foot_to_center) / radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along_z(x: f64, z: f64) -> Ray {
        Ray { origin: DVec3::new(x, 0.0, z), direction: DVec3::Z }
    }

    #[test]
    fn known_answers() {
        let near = Some(-DVec3::Z);
        let far = Some(DVec3::Z);
        for (case, ray, t, normal) in [
            ("from outside: the near side", along_z(0.0, -5.0), Some(3.0), near),
            ("from the centre: the far side", along_z(0.0, 0.0), Some(2.0), far),
            ("from inside: the far side", along_z(0.0, 1.0), Some(1.0), far),
            ("behind", along_z(0.0, 5.0), None, None),
            ("beside", along_z(2.5, -5.0), None, None),
            ("tangent", along_z(2.0, -5.0), Some(5.0), Some(DVec3::X)),
            ("leaving from the surface", along_z(0.0, 2.0), None, None),
            ("entering from the surface: the far side", along_z(0.0, -2.0), Some(4.0), far),
        ] {
            let hit = intersect(&ray, DVec3::ZERO, 2.0);
            assert_eq!(hit.map(|h| h.0), t, "{case}");
            assert_eq!(hit.map(|h| h.1), normal, "{case}");
        }
    }

    /// Tests random directions, because rounding errors are small along the axes.
    #[test]
    fn from_the_surface_only_the_far_side_is_hit() {
        let mut random = fastrand::Rng::with_seed(16);
        for _ in 0..10_000 {
            let direction = DVec3::from([0; 3].map(|_| random.f64() - 0.5)).normalize_or(DVec3::X);
            let ray = Ray { origin: DVec3::X, direction };
            match intersect(&ray, DVec3::ZERO, 1.0) {
                Some((t, _)) => {
                    // Half the chord is a square root, so its error grows towards the tangent.
                    let bound = 1e-15 / direction.x.abs();
                    assert!((t + 2.0 * direction.x).abs() < bound, "{direction}: {t}");
                }
                None => assert!(direction.x > -1e-7, "{direction}"),
            }
        }
    }

    /// If the eye is on the surface, up to rounding, and the ray is along the surface, `c` and half the chord consist
    /// of rounding errors only. But such a flat ray cuts only a short chord off the sphere: √(8 · 2⁻⁵³) is 3 · 10⁻⁸.
    #[test]
    fn along_the_surface_no_hit_is_far() {
        let mut random = fastrand::Rng::with_seed(17);
        let mut hits = 0;
        for _ in 0..100_000 {
            let outward = DVec3::from([0; 3].map(|_| random.f64() - 0.5)).normalize_or(DVec3::X);
            let tilt = outward * (random.f64() - 0.5) * 2e-11;
            let direction = outward.any_orthonormal_vector() + tilt;
            let ray = Ray { origin: outward, direction };
            if let Some((t, _)) = intersect(&ray, DVec3::ZERO, 1.0) {
                assert!(t <= 1e-7, "{outward}: {t}");
                hits += 1;
            }
        }
        assert!(hits > 1000, "{hits}");
    }

    #[test]
    fn a_far_and_tiny_sphere_has_a_unit_normal() {
        let (_, normal) = intersect(&along_z(0.0, -1.0), DVec3::ZERO, 1e-16).unwrap();
        assert!((normal.length() - 1.0).abs() < 1e-12, "{normal}");
    }
}
