//! Maps from random numbers to points and directions, and linear colours in f64.

use glam::{DVec2, DVec3};

use crate::camera::sampling::unit;
use crate::geometry::math::{concentric_disk, wide};
use crate::image::color::{LUMINANCE, LinearRgb};

pub(super) fn rgb(color: LinearRgb) -> DVec3 {
    wide(color.to_array())
}

/// Relative luminance of a linear colour with the Rec. 709 primaries.
pub(super) fn luminance(color: DVec3) -> f64 {
    color.dot(DVec3::from(LUMINANCE))
}

/// A point that is uniformly distributed in the unit disk.
pub(super) fn disk(u: [u32; 2]) -> DVec2 {
    concentric_disk(DVec2::from(u.map(unit)))
}

/// A tangent frame: two unit vectors that form a right-handed frame with a third.
///
/// T. Duff, J. Burgess, P. Christensen, C. Hery, A. Kensler, M. Liani and R. Villemin, "Building an Orthonormal
/// Basis, Revisited", JCGT 6(1), 2017.
#[derive(Clone, Copy, Debug)]
pub(super) struct TangentFrame([DVec3; 3]);

impl TangentFrame {
    pub(super) fn around(n: DVec3) -> Self {
        let s = if n.z >= 0.0 { 1.0 } else { -1.0 };
        let a = -1.0 / (s + n.z);
        let b = n.x * n.y * a;
        let first = DVec3::new(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
        let second = DVec3::new(b, s + n.y * n.y * a, -n.y);
        Self([first, second, n])
    }

    pub(super) fn to_scene(self, local: DVec3) -> DVec3 {
        let Self([x, y, z]) = self;
        local.x * x + local.y * y + local.z * z
    }

    pub(super) fn to_local(self, v: DVec3) -> DVec3 {
        DVec3::from(self.0.map(|axis| axis.dot(v)))
    }
}

/// A random direction around +z, with a density proportional to its cosine.
pub(super) fn cosine(u: [u32; 2]) -> DVec3 {
    let spot = disk(u);
    spot.extend((1.0 - spot.length_squared()).max(0.0).sqrt())
}

/// A random direction in a cone around +z, uniformly distributed. `k` is 1 minus the cosine of the half-angle. The
/// value 2 means all directions.
pub(super) fn cone(u: [u32; 2], k: f64) -> DVec3 {
    let spot = disk(u);
    let q = spot.length_squared() * k;
    (spot * (k * (2.0 - q)).sqrt()).extend(1.0 - q)
}

/// The density per steradian of [`cone`].
pub(super) fn cone_density(k: f64) -> f64 {
    1.0 / (std::f64::consts::TAU * k)
}

/// The versine of an angle: 1 minus its cosine, without cancellation.
pub(super) fn versine(radians: f64) -> f64 {
    2.0 * (0.5 * radians).sin().powi(2)
}

/// The parameter `k` of [`cone`] for the cone that a sphere fills at a distance from its centre. `None` from inside.
pub(super) fn cone_of_sphere(radius: f64, distance: f64) -> Option<f64> {
    let sine = radius / distance;
    (sine < 1.0).then(|| sine * sine / (1.0 + (1.0 - sine * sine).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> impl Iterator<Item = [u32; 2]> {
        let at = |i: u32| (i << 24) + (1 << 23);
        (0..256).flat_map(move |i| (0..256).map(move |j| [at(i), at(j)]))
    }

    #[test]
    fn frames_are_right_handed_and_turn_back() {
        for u in grid() {
            let n = cone(u, 2.0);
            let frame = TangentFrame::around(n);
            let TangentFrame([x, y, z]) = frame;
            assert!((x.cross(y) - z).length() < 1e-14, "{n}");
            assert!((x.length() - 1.0).abs() < 1e-14 && (y.length() - 1.0).abs() < 1e-14, "{n}");
            let v = DVec3::new(0.1, -0.7, 0.3);
            assert!((frame.to_local(frame.to_scene(v)) - v).length() < 1e-15);
        }
    }

    /// Compares means over all directions of each distribution with integrals computed by hand.
    #[test]
    fn directions_have_the_moments_of_their_densities() {
        let mean = |f: &dyn Fn([u32; 2]) -> f64| grid().map(f).sum::<f64>() / 65536.0;
        for k in [1e-3, 0.3, 1.0, 2.0] {
            for u in grid() {
                let w = cone(u, k);
                assert!((w.length() - 1.0).abs() < 1e-14 && w.z >= 1.0 - k);
            }
            assert!((mean(&|u| cone(u, k).z) - (1.0 - 0.5 * k)).abs() < 5e-5 * k);
            // The mean of z² is (1 − (1 − k)³)/(3k).
            let square = (1.0 - (1.0 - k).powi(3)) / (3.0 * k);
            assert!((mean(&|u| cone(u, k).z.powi(2)) - square).abs() < 5e-5 * k);
        }
        assert!((mean(&|u| cosine(u).z) - 2.0 / 3.0).abs() < 3e-4);
        assert!((mean(&|u| cosine(u).z.powi(2)) - 0.5).abs() < 3e-4);
        assert!(mean(&|u| cosine(u).x).abs() < 1e-12);
    }

    #[test]
    fn the_cone_of_a_sphere() {
        assert_eq!(cone_of_sphere(1.0, 1.0), None);
        assert_eq!(cone_of_sphere(1.0, 0.5), None);
        let k = cone_of_sphere(1.0, 2.0).unwrap();
        assert!((k - (1.0 - 0.75_f64.sqrt())).abs() < 1e-15);
        let far = cone_of_sphere(1.0, 1e8).unwrap();
        assert!((far / 0.5e-16 - 1.0).abs() < 1e-12);
        assert!((versine(1e-8) / 0.5e-16 - 1.0).abs() < 1e-12);
    }
}
