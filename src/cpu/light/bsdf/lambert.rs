//! A Lambert surface with an optional glossy lobe, as a BSDF.

use std::f64::consts::PI;

use glam::DVec3;

use super::ggx::{Ggx, mirrored};
use super::{Response, Scattered};
use crate::cpu::light::maps;

/// A matt surface. `lobe` is the distribution of the glossy lobe's normals, the fraction of light that it reflects, and
/// its energy towards the viewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lambert {
    pub(super) color: DVec3,
    pub(super) lobe: Option<(Ggx, f64, f64)>,
}

impl Lambert {
    fn share(&self) -> f64 {
        self.lobe.map_or(0.0, |(_, share, _)| share)
    }

    pub(super) fn response(&self, out: DVec3, into: DVec3) -> Response {
        let share = self.share();
        let mut value = (1.0 - share) / PI * self.color;
        let mut density = (1.0 - share) / PI * into.z;
        if let Some((ggx, share, energy)) = self.lobe {
            value += share * ggx.reflection(out, into) / energy;
            density += share * ggx.reflection_density(out, into);
        }
        Response { value, density }
    }

    pub(super) fn scatter(&self, out: DVec3, u: [u32; 2], choice: f64) -> Option<Scattered> {
        let direction = match self.lobe {
            Some((ggx, share, _)) if choice < share => mirrored(out, ggx.visible_normal(out, u)),
            _ => maps::cosine(u),
        };
        if direction.z <= 0.0 {
            return None;
        }
        let Response { value, density } = self.response(out, direction);
        // Without a lobe, the weight is exactly the colour.
        let weight = if self.lobe.is_some() { value * direction.z / density } else { self.color };
        Some(Scattered { direction, weight, density: Some(density) })
    }
}
