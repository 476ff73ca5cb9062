//! Rough metal, as a BSDF.

use glam::DVec3;

use super::ggx::{Ggx, half, mirrored};
use super::{Response, Scattered};

/// A rough metal. `energy` is the energy that a white metal of its roughness keeps towards the viewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conductor {
    pub(super) color: DVec3,
    pub(super) ggx: Ggx,
    pub(super) energy: f64,
}

impl Conductor {
    /// Reflectance at a microfacet normal: C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering"
    /// (1994).
    fn reflected(&self, cosine: f64) -> DVec3 {
        self.color + (1.0 - self.color) * (1.0 - cosine).clamp(0.0, 1.0).powi(5)
    }

    /// The factor that compensates for light that is scattered several times within the surface, after Turquin.
    fn compensation(&self) -> DVec3 {
        1.0 + self.color * ((1.0 - self.energy) / self.energy)
    }

    pub(super) fn response(&self, out: DVec3, into: DVec3) -> Response {
        let reflected = self.reflected(half(out, into).dot(out));
        Response {
            value: reflected * self.compensation() * self.ggx.reflection(out, into),
            density: self.ggx.reflection_density(out, into),
        }
    }

    pub(super) fn scatter(&self, out: DVec3, u: [u32; 2]) -> Option<Scattered> {
        let h = self.ggx.visible_normal(out, u);
        let direction = mirrored(out, h);
        if direction.z <= 0.0 {
            return None;
        }
        let shadowing = self.ggx.g2(out.z, direction.z) / self.ggx.g1(out.z);
        Some(Scattered {
            direction,
            weight: self.reflected(h.dot(out)) * self.compensation() * shadowing,
            density: Some(self.ggx.reflection_density(out, direction)),
        })
    }
}
