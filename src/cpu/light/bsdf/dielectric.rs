//! Glass, smooth or rough, as a BSDF.

use glam::DVec3;

use super::Scattered;
use super::ggx::{Ggx, mirrored};

/// Glass. `eta` is the index of refraction on the far side relative to the viewer's side. `rough` is the distribution
/// of normals and the energy that it keeps; `None` for smooth glass.
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

/// The fraction of unpolarised light that is reflected, and the cosine of the refracted direction (Fresnel's
/// equations).
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
        // At Brewster's angle, only light polarised perpendicular to the plane of incidence is reflected: the fraction
        // ((η² − 1)/(η² + 1))² of it.
        let (brewster, inside) = fresnel(1.0 / 3.25_f64.sqrt(), 1.5);
        assert!((brewster - 0.5 * (1.25_f64 / 3.25).powi(2)).abs() < 1e-15, "{brewster}");
        // The reverse direction reflects the same fraction.
        let (back, _) = fresnel(inside, 1.0 / 1.5);
        assert!((back - brewster).abs() < 1e-15);
        // Total reflection occurs beyond sin = 2/3.
        assert!(fresnel((1.0 - 0.45_f64).sqrt(), 1.0 / 1.5).0 >= 1.0);
        assert!(fresnel((1.0 - 0.44_f64).sqrt(), 1.0 / 1.5).0 < 1.0);
        // Without a change of the index, nothing is reflected.
        assert!(fresnel(0.3, 1.0).0 < 1e-30);
    }
}
