//! Glass, smooth or rough.

use glam::DVec3;

use super::Scattered;
use super::ggx::{Ggx, mirrored};

/// Glass; `eta` is the index of refraction where light goes to, relative to where it comes from, and `rough` the
/// distribution of normals and the energy that they keep.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dielectric {
    pub(super) eta: f64,
    pub(super) rough: Option<(Ggx, f64)>,
}

impl Dielectric {
    pub(super) fn scatter(&self, out: DVec3, u: [u32; 2], choice: f64) -> Option<Scattered> {
        let h = self.rough.map_or(DVec3::Z, |(ggx, _)| ggx.visible_normal(out, u));
        let cosine = out.dot(h);
        let (reflected, inside) = fresnel(cosine, self.eta);
        let is_reflected = choice < reflected;
        let direction = if is_reflected {
            mirrored(out, h)
        } else {
            -out / self.eta + (cosine / self.eta - inside) * h
        };
        let goes_where_it_should = if is_reflected { direction.z > 0.0 } else { direction.z < 0.0 };
        if !goes_where_it_should {
            return None;
        }
        let weight = self.rough.map_or(1.0, |(ggx, energy)| ggx.g1(direction.z.abs()) / energy);
        Some(Scattered { direction, weight: DVec3::splat(weight), density: None })
    }
}

/// The share of unpolarised light that is reflected, and the cosine of what is refracted (Fresnel's equations).
fn fresnel(cosine: f64, eta: f64) -> (f64, f64) {
    let sine_squared = (1.0 - cosine * cosine) / (eta * eta);
    if sine_squared >= 1.0 {
        return (1.0, 0.0);
    }
    let inside = (1.0 - sine_squared).sqrt();
    let parallel = (eta * cosine - inside) / (eta * cosine + inside);
    let perpendicular = (cosine - eta * inside) / (cosine + eta * inside);
    (0.5 * (parallel * parallel + perpendicular * perpendicular), inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fresnel_on_paper() {
        let (straight, _) = fresnel(1.0, 1.5);
        assert!((straight - 0.04).abs() < 1e-15);
        assert!(fresnel(0.0, 1.5).0 >= 1.0);
        // Brewster's angle: only light that is polarised across is reflected, ((η² − 1)/(η² + 1))² of it.
        let (brewster, inside) = fresnel(1.0 / 3.25_f64.sqrt(), 1.5);
        assert!((brewster - 0.5 * (1.25_f64 / 3.25).powi(2)).abs() < 1e-15, "{brewster}");
        // The same way back.
        let (back, _) = fresnel(inside, 1.0 / 1.5);
        assert!((back - brewster).abs() < 1e-15);
        // Total reflection beyond sin = 2/3.
        assert!(fresnel((1.0 - 0.45_f64).sqrt(), 1.0 / 1.5).0 >= 1.0);
        assert!(fresnel((1.0 - 0.44_f64).sqrt(), 1.0 / 1.5).0 < 1.0);
        // Nothing where there is no boundary.
        assert!(fresnel(0.3, 1.0).0 < 1e-30);
    }
}
