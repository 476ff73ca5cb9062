//! BSDFs, which say how surfaces scatter light. Directions are in a frame whose z is the normal on the viewer's side.

use std::f64::consts::PI;

use glam::DVec3;

use super::context::{LightingContext, Surface};
use super::maps::{self, disk};
use super::surface_ray::Interaction;
use crate::light::energy::{self, ENTRIES};
use crate::scene::material::Material;

/// The smallest cosine of a direction. Smaller ones are replaced by it.
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
    /// The BSDF of a surface for light towards the local direction `out`. `None` for an emissive sphere, which does not
    /// scatter light.
    pub(super) fn of(context: &LightingContext<'_>, interaction: &Interaction, out: DVec3) -> Option<Self> {
        // Clamped so that divisions by the cosine are safe.
        let out = DVec3::new(out.x, out.y, out.z.max(MIN_COSINE));
        let color = context.color(interaction.surface);
        let Surface::Shape(id) = interaction.surface else {
            return Some(Self { out, kind: Kind::Lambert(Lambert { color, lobe: None }) });
        };
        let energy = |table: usize| energy::lookup(context.energy(id, table), out.z);
        let kind = match context.scene.surface(id).material {
            Material::Lambert { specular, roughness } => {
                let lobe = (specular > 0.0).then(|| (Ggx::of_roughness(roughness), f64::from(specular), energy(0)));
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

    /// The BSDF that the studio integrator uses. Metal and glass become matt. Lambert surfaces keep their lobe.
    pub(super) fn in_studio(context: &LightingContext<'_>, interaction: &Interaction, out: DVec3) -> Option<Self> {
        let bsdf = Self::of(context, interaction, out)?;
        Some(match bsdf.kind {
            Kind::Lambert(_) => bsdf,
            _ => {
                let color = context.color(interaction.surface);
                Self { kind: Kind::Lambert(Lambert { color, lobe: None }), ..bsdf }
            }
        })
    }

    /// The response to light from a direction. `None` for directions from behind, and for glass, which gets light only
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

    /// Chooses a random scattered direction. `None` if the light is lost.
    pub(super) fn scatter(&self, u: [u32; 2], choice: f64) -> Option<BsdfSample> {
        match &self.kind {
            Kind::Lambert(lambert) => lambert.scatter(self.out, u, choice),
            Kind::Conductor(conductor) => conductor.scatter(self.out, u),
            Kind::Dielectric(dielectric) => dielectric.scatter(self.out, u, choice),
        }
    }
}

/// The BSDF's value for light from a direction, without the cosine factor, and the density with which the direction is
/// sampled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response {
    pub(super) value: DVec3,
    pub(super) density: f64,
}

/// A direction chosen at random by a BSDF.
#[derive(Clone, Copy, Debug)]
pub(super) struct BsdfSample {
    /// The direction. If its z is negative, it is on the other side of the surface.
    pub(super) direction: DVec3,
    pub(super) weight: DVec3,
    /// The density per steradian. `None` if light sampling cannot choose the direction.
    pub(super) density: Option<f64>,
}

/// A matt surface. `lobe` is the distribution of the glossy lobe's normals, the fraction of light that it reflects, and
/// its energy towards the viewer.
#[derive(Clone, Copy, Debug)]
struct Lambert {
    color: DVec3,
    lobe: Option<(Ggx, f64, f64)>,
}

impl Lambert {
    fn share(&self) -> f64 {
        self.lobe.map_or(0.0, |(_, share, _)| share)
    }

    fn response(&self, out: DVec3, into: DVec3) -> Response {
        let share = self.share();
        let mut value = (1.0 - share) / PI * self.color;
        let mut density = (1.0 - share) / PI * into.z;
        if let Some((ggx, share, energy)) = self.lobe {
            value += share * ggx.reflection(out, into) / energy;
            density += share * ggx.reflection_density(out, into);
        }
        Response { value, density }
    }

    fn scatter(&self, out: DVec3, u: [u32; 2], choice: f64) -> Option<BsdfSample> {
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
        Some(BsdfSample { direction, weight, density: Some(density) })
    }
}

/// A rough metal. `energy` is the energy that a white metal of its roughness keeps towards the viewer.
#[derive(Clone, Copy, Debug)]
struct Conductor {
    color: DVec3,
    ggx: Ggx,
    energy: f64,
}

impl Conductor {
    /// Reflectance at a microfacet normal: C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering"
    /// (1994).
    fn reflected(&self, cosine: f64) -> DVec3 {
        self.color + (1.0 - self.color) * (1.0 - cosine).clamp(0.0, 1.0).powi(5)
    }

    /// The factor that compensates for light that is scattered several times within the surface, after E. Turquin.
    fn compensation(&self) -> DVec3 {
        1.0 + self.color * ((1.0 - self.energy) / self.energy)
    }

    fn response(&self, out: DVec3, into: DVec3) -> Response {
        let reflected = self.reflected(half(out, into).dot(out));
        Response {
            value: reflected * self.compensation() * self.ggx.reflection(out, into),
            density: self.ggx.reflection_density(out, into),
        }
    }

    fn scatter(&self, out: DVec3, u: [u32; 2]) -> Option<BsdfSample> {
        let h = self.ggx.visible_normal(out, u);
        let direction = mirrored(out, h);
        if direction.z <= 0.0 {
            return None;
        }
        let shadowing = self.ggx.g2(out.z, direction.z) / self.ggx.g1(out.z);
        Some(BsdfSample {
            direction,
            weight: self.reflected(h.dot(out)) * self.compensation() * shadowing,
            density: Some(self.ggx.reflection_density(out, direction)),
        })
    }
}

/// Glass. `eta` is the index of refraction on the far side relative to the viewer's side. `rough` is the distribution
/// of normals and the energy that it keeps. `None` for smooth glass.
#[derive(Clone, Copy, Debug)]
struct Dielectric {
    eta: f64,
    rough: Option<(Ggx, f64)>,
}

impl Dielectric {
    fn scatter(&self, out: DVec3, u: [u32; 2], choice: f64) -> Option<BsdfSample> {
        let h = self.rough.map_or(DVec3::Z, |(ggx, _)| ggx.visible_normal(out, u));
        let cosine = out.dot(h);
        let (reflected, inside) = fresnel(cosine, self.eta);
        let is_reflected = choice < reflected;
        let direction =
            if is_reflected { mirrored(out, h) } else { -out / self.eta + (cosine / self.eta - inside) * h };
        let goes_where_it_should = if is_reflected { direction.z > 0.0 } else { direction.z < 0.0 };
        if !goes_where_it_should {
            return None;
        }
        let weight = self.rough.map_or(1.0, |(ggx, energy)| ggx.g1(direction.z.abs()) / energy);
        Some(BsdfSample { direction, weight: DVec3::splat(weight), density: None })
    }
}

/// The fraction of unpolarised light that is reflected, and the cosine of the refracted direction, by Fresnel's
/// equations.
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

/// Rough reflection: the GGX distribution of microfacet normals (Trowbridge and Reitz), with shadowing after Smith. The
/// number is α, the square of the roughness.
#[derive(Clone, Copy, Debug)]
struct Ggx(f64);

impl Ggx {
    fn of_roughness(roughness: f32) -> Self {
        Self(f64::from(roughness) * f64::from(roughness))
    }

    /// Smith's function Λ at a cosine.
    fn lambda(self, cosine: f64) -> f64 {
        let square = cosine * cosine;
        0.5 * ((1.0 + self.0 * self.0 * (1.0 - square) / square).sqrt() - 1.0)
    }

    /// The fraction of microfacets that are visible from a direction.
    fn g1(self, cosine: f64) -> f64 {
        1.0 / (1.0 + self.lambda(cosine))
    }

    /// The fraction of microfacets that are visible from two directions on the same side.
    fn g2(self, out: f64, into: f64) -> f64 {
        1.0 / (1.0 + self.lambda(out) + self.lambda(into))
    }

    fn density_of_normals(self, h: DVec3) -> f64 {
        let square = self.0 * self.0;
        let t = (h.x * h.x + h.y * h.y) / square + h.z * h.z;
        1.0 / (PI * square * t * t)
    }

    /// The reflection of a white rough mirror, D G2/(4 cos cos), without the cosine factor of `into`.
    fn reflection(self, out: DVec3, into: DVec3) -> f64 {
        let h = half(out, into);
        self.density_of_normals(h) * self.g2(out.z, into.z) / (4.0 * out.z * into.z)
    }

    /// The density of directions that are reflected at normals from [`Ggx::visible_normal`].
    fn reflection_density(self, out: DVec3, into: DVec3) -> f64 {
        self.g1(out.z) * self.density_of_normals(half(out, into)) / (4.0 * out.z)
    }

    /// A random microfacet normal, with the density of normals that are visible from `out`.
    ///
    /// E. Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018.
    fn visible_normal(self, out: DVec3, u: [u32; 2]) -> DVec3 {
        let alpha = self.0;
        let stretched = DVec3::new(alpha * out.x, alpha * out.y, out.z).normalize_or(DVec3::Z);
        let square = stretched.x * stretched.x + stretched.y * stretched.y;
        let first = if square > 1e-12 { DVec3::new(-stretched.y, stretched.x, 0.0) / square.sqrt() } else { DVec3::X };
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
fn half(out: DVec3, into: DVec3) -> DVec3 {
    (out + into).normalize_or(DVec3::Z)
}

/// A direction reflected at a normal.
fn mirrored(out: DVec3, h: DVec3) -> DVec3 {
    2.0 * out.dot(h) * h - out
}

#[cfg(test)]
mod tests;
