//! Rough reflection: microfacet normals with the GGX distribution (Trowbridge and Reitz), and shadowing after Smith.
//! Directions are in a frame with the surface normal as z.

use glam::DVec3;

use crate::cpu::light::maps::disk;

/// A distribution of microfacet normals; the number is α, the square of the roughness.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ggx(f64);

impl Ggx {
    pub(super) fn of_roughness(roughness: f32) -> Self {
        Self(f64::from(roughness) * f64::from(roughness))
    }

    /// Smith's Λ at a cosine.
    fn lambda(self, cosine: f64) -> f64 {
        let square = cosine * cosine;
        0.5 * ((1.0 + self.0 * self.0 * (1.0 - square) / square).sqrt() - 1.0)
    }

    /// The fraction of microfacets that are visible from a direction.
    pub(super) fn g1(self, cosine: f64) -> f64 {
        1.0 / (1.0 + self.lambda(cosine))
    }

    /// The fraction of microfacets that are visible from two directions on the same side.
    pub(super) fn g2(self, out: f64, into: f64) -> f64 {
        1.0 / (1.0 + self.lambda(out) + self.lambda(into))
    }

    fn density_of_normals(self, h: DVec3) -> f64 {
        let square = self.0 * self.0;
        let t = (h.x * h.x + h.y * h.y) / square + h.z * h.z;
        1.0 / (std::f64::consts::PI * square * t * t)
    }

    /// The reflection of a white rough mirror, D G2/(4 cos cos), without the cosine factor of `into`.
    pub(super) fn reflection(self, out: DVec3, into: DVec3) -> f64 {
        let h = half(out, into);
        self.density_of_normals(h) * self.g2(out.z, into.z) / (4.0 * out.z * into.z)
    }

    /// The density of directions that are reflected at normals from [`Ggx::visible_normal`].
    pub(super) fn reflection_density(self, out: DVec3, into: DVec3) -> f64 {
        self.g1(out.z) * self.density_of_normals(half(out, into)) / (4.0 * out.z)
    }

    /// A random microfacet normal, with the density of normals that are visible from `out`.
    ///
    /// E. Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018.
    pub(super) fn visible_normal(self, out: DVec3, u: [u32; 2]) -> DVec3 {
        let alpha = self.0;
        let stretched = DVec3::new(alpha * out.x, alpha * out.y, out.z).normalize_or(DVec3::Z);
        let square = stretched.x * stretched.x + stretched.y * stretched.y;
        let first = if square > 1e-12 {
            DVec3::new(-stretched.y, stretched.x, 0.0) / square.sqrt()
        } else {
            DVec3::X
        };
        let second = stretched.cross(first);
        let spot = disk(u);
        let s = 0.5 * (1.0 + stretched.z);
        let y = (1.0 - s) * (1.0 - spot.x * spot.x).max(0.0).sqrt() + s * spot.y;
        let z = (1.0 - spot.x * spot.x - y * y).max(0.0).sqrt();
        let normal = spot.x * first + y * second + z * stretched;
        DVec3::new(alpha * normal.x, alpha * normal.y, normal.z.max(1e-6)).normalize_or(DVec3::Z)
    }
}

/// The half vector of two directions on the same side.
pub(super) fn half(out: DVec3, into: DVec3) -> DVec3 {
    (out + into).normalize_or(DVec3::Z)
}

/// A direction reflected at a normal.
pub(super) fn mirrored(out: DVec3, h: DVec3) -> DVec3 {
    2.0 * out.dot(h) * h - out
}
