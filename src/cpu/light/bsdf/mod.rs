//! BSDFs: how surfaces scatter light. Directions are in a frame with the normal on the viewer's side as z.

use glam::DVec3;

use super::context::{LightingContext, Surface};
use super::surface_ray::Interaction;
use crate::light::energy::{self, ENTRIES};
use crate::scene::material::Material;
use conductor::Conductor;
use dielectric::Dielectric;
use ggx::Ggx;
use lambert::Lambert;
pub(super) use response::{Response, Scattered};

mod conductor;
mod dielectric;
mod ggx;
mod lambert;
mod response;

/// The smallest cosine of a direction; smaller ones are replaced by it.
const MIN_COSINE: f64 = 1e-6;

/// The BSDF of a surface at a point, for light towards a given direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bsdf {
    out: DVec3,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Lambert(Lambert),
    Conductor(Conductor),
    Dielectric(Dielectric),
}

impl Bsdf {
    /// The BSDF of a surface for light towards the local direction `out`; `None` for an emissive sphere, which does not
    /// scatter light.
    pub(super) fn of(
        context: &LightingContext<'_>,
        interaction: &Interaction,
        out: DVec3,
    ) -> Option<Self> {
        // Clamped so that divisions by the cosine are safe.
        let out = DVec3::new(out.x, out.y, out.z.max(MIN_COSINE));
        let color = context.color(interaction.surface);
        let Surface::Sphere(id) = interaction.surface else {
            return Some(Self { out, kind: Kind::Lambert(Lambert { color, lobe: None }) });
        };
        let energy = |table: usize| energy::lookup(context.energy(id, table), out.z);
        let kind = match context.scene.surface(id).material {
            Material::Lambert { specular, roughness } => {
                let lobe = (specular > 0.0)
                    .then(|| (Ggx::of_roughness(roughness), f64::from(specular), energy(0)));
                Kind::Lambert(Lambert { color, lobe })
            }
            Material::Conductor { roughness } => {
                let ggx = Ggx::of_roughness(roughness);
                Kind::Conductor(Conductor { color, ggx, energy: energy(0) })
            }
            Material::Dielectric { ior, roughness, .. } => {
                let ior = f64::from(ior);
                let eta = if interaction.is_outside { ior } else { 1.0 / ior };
                let rough = (roughness > 0.0).then(|| {
                    let table = if interaction.is_outside { 0 } else { ENTRIES };
                    (Ggx::of_roughness(roughness), energy(table))
                });
                Kind::Dielectric(Dielectric { eta, rough })
            }
            Material::Emissive { .. } => return None,
        };
        Some(Self { out, kind })
    }

    /// The BSDF that the studio integrator uses: metal and glass become matt; Lambert surfaces keep their lobe.
    pub(super) fn in_studio(
        context: &LightingContext<'_>,
        interaction: &Interaction,
        out: DVec3,
    ) -> Option<Self> {
        let bsdf = Self::of(context, interaction, out)?;
        Some(match bsdf.kind {
            Kind::Lambert(_) => bsdf,
            _ => {
                let color = context.color(interaction.surface);
                Self { kind: Kind::Lambert(Lambert { color, lobe: None }), ..bsdf }
            }
        })
    }

    /// The response to light from a direction. `None` for directions from behind, and for glass, whose light comes only
    /// from scattered rays.
    pub(super) fn response(&self, into: DVec3) -> Option<Response> {
        if into.z <= 0.0 {
            return None;
        }
        match &self.kind {
            Kind::Lambert(lambert) => Some(lambert.response(self.out, into)),
            Kind::Conductor(conductor) => Some(conductor.response(self.out, into)),
            Kind::Dielectric(_) => None,
        }
    }

    /// Whether light sampling is useful for this surface.
    pub(super) fn uses_light_sampling(&self) -> bool {
        !matches!(self.kind, Kind::Dielectric(_))
    }

    /// A random scattered direction; `None` if the light is lost.
    pub(super) fn scatter(&self, u: [u32; 2], choice: f64) -> Option<Scattered> {
        match &self.kind {
            Kind::Lambert(lambert) => lambert.scatter(self.out, u, choice),
            Kind::Conductor(conductor) => conductor.scatter(self.out, u),
            Kind::Dielectric(dielectric) => dielectric.scatter(self.out, u, choice),
        }
    }
}

#[cfg(test)]
mod tests;
