//! Materials, which say how a sphere's surface responds to light. The colour belongs to the sphere.

use crate::range::RangeError;

/// The way in which a surface responds to light that hits it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Material {
    /// A diffuse surface (Lambert's law), with an optional glossy lobe on top.
    Lambert {
        /// The fraction of light that the glossy lobe reflects, for any colour: 0 to 1.
        #[serde(default)]
        specular: f32,
        /// Roughness of the glossy lobe: 0.02 to 1.
        #[serde(default = "of_gloss")]
        roughness: f32,
    },
    /// A rough metal (GGX). The sphere's colour is its reflectance at normal incidence.
    Conductor {
        /// Roughness: 0.02 to 1.
        #[serde(default = "of_metal")]
        roughness: f32,
    },
    /// Glass, smooth or rough. Light that passes through it can be absorbed (Beer's law).
    Dielectric {
        /// Index of refraction relative to the surroundings: 1 to 4.
        #[serde(default = "of_glass")]
        ior: f32,
        /// Roughness: 0 (smooth), or 0.02 to 1.
        #[serde(default)]
        roughness: f32,
        /// The distance inside the sphere, in scene units, after which white light has the sphere's colour. `None` for
        /// no absorption.
        attenuation_distance: Option<f32>,
    },
    /// A light source, which emits the sphere's colour times `strength` on both sides, and reflects nothing.
    Emissive {
        /// The factor that multiplies the colour: 0 to 10⁶.
        #[serde(default = "one")]
        strength: f32,
    },
}

const fn of_gloss() -> f32 {
    0.3
}

const fn of_metal() -> f32 {
    0.2
}

const fn of_glass() -> f32 {
    1.5
}

const fn one() -> f32 {
    1.0
}

impl Default for Material {
    /// A diffuse surface without a glossy lobe.
    fn default() -> Self {
        Self::Lambert { specular: 0.0, roughness: of_gloss() }
    }
}

/// A material, and the opacity of the surface.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct SurfaceProperties {
    /// The surface's response to light.
    #[serde(flatten)]
    pub material: Material,
    /// Opacity of each surface crossing, from 0 (clear) to 1 (opaque). It counts twice for a ray through a sphere.
    #[serde(default = "one")]
    pub opacity: f32,
}

impl Default for SurfaceProperties {
    fn default() -> Self {
        Self { material: Material::default(), opacity: 1.0 }
    }
}

/// The smallest roughness of a surface that is not smooth.
pub const MIN_ROUGHNESS: f32 = 0.02;

impl SurfaceProperties {
    /// Checks that every parameter is in its range.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range. The error names the first such parameter.
    pub fn check(&self) -> Result<(), RangeError> {
        let within = |parameter, value: f32, [low, high]: [f32; 2], range| {
            RangeError::unless_within(parameter, value.into(), [low.into(), high.into()], range).map(drop)
        };
        let rough = |value| within("roughness", value, [MIN_ROUGHNESS, 1.0], "from 0.02 to 1");
        within("opacity", self.opacity, [0.0, 1.0], "from 0 to 1")?;
        match self.material {
            Material::Lambert { specular, roughness } => {
                within("specular", specular, [0.0, 1.0], "from 0 to 1")?;
                rough(roughness)?;
            }
            Material::Conductor { roughness } => rough(roughness)?,
            Material::Dielectric { ior, roughness, attenuation_distance } => {
                within("ior", ior, [1.0, 4.0], "from 1 to 4")?;
                if roughness != 0.0 {
                    let range = "0, or from 0.02 to 1";
                    within("roughness", roughness, [MIN_ROUGHNESS, 1.0], range)?;
                }
                if let Some(distance) = attenuation_distance {
                    let range = "from 1e-16 to 1e16";
                    within("attenuation_distance", distance, [1e-16, 1e16], range)?;
                }
            }
            Material::Emissive { strength } => within("strength", strength, [0.0, 1e6], "from 0 to 1e6")?,
        }
        Ok(())
    }

    /// The bits of all parameters. Only equal properties have equal bits.
    pub(crate) fn bits(&self) -> [u32; 5] {
        let [kind, a, b, c] = match self.material {
            Material::Lambert { specular, roughness } => [0.0, specular, roughness, 0.0],
            Material::Conductor { roughness } => [1.0, roughness, 0.0, 0.0],
            Material::Dielectric { ior, roughness, attenuation_distance } => {
                [2.0, ior, roughness, attenuation_distance.unwrap_or(0.0)]
            }
            Material::Emissive { strength } => [3.0, strength, 0.0, 0.0],
        };
        [kind, a, b, c, self.opacity].map(f32::to_bits)
    }
}
