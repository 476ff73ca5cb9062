//! What a sphere's surface does with light. Its colour is the sphere's own.

use crate::range::RangeError;

/// What a surface does with light that meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Material {
    /// Lambert's law, and on top of it a share of light that is reflected as by a rough mirror.
    Lambert {
        /// The share that the lobe reflects, whatever the colour: 0 to 1.
        specular: f32,
        /// Of the lobe: 0.02 to 1.
        roughness: f32,
    },
    /// A rough metal (GGX); the colour is what it reflects at normal incidence.
    Conductor {
        /// 0.02 to 1.
        roughness: f32,
    },
    /// Glass, smooth or rough. Light that goes through it is absorbed (Beer's law).
    Dielectric {
        /// Index of refraction, relative to what is around: 1 to 4.
        ior: f32,
        /// 0 (smooth), or 0.02 to 1.
        roughness: f32,
        /// After this distance inside, in scene units, white light has the sphere's colour; `None` absorbs
        /// nothing.
        attenuation_distance: Option<f32>,
    },
    /// A lamp: sends out the sphere's colour times this, on both sides, and reflects nothing.
    Emissive {
        /// What the colour is multiplied by: at least 0.
        strength: f32,
    },
}

impl Default for Material {
    /// Lambert's law alone.
    fn default() -> Self {
        Self::Lambert { specular: 0.0, roughness: 0.3 }
    }
}

/// A material, and how much of what is behind it a surface hides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceProperties {
    /// What the surface does with light.
    pub material: Material,
    /// Of each surface crossing, so that a ray through a sphere meets it twice: 0 (clear) to 1.
    pub opacity: f32,
}

impl Default for SurfaceProperties {
    fn default() -> Self {
        Self { material: Material::default(), opacity: 1.0 }
    }
}

/// The smallest roughness that is not smooth.
pub const MIN_ROUGHNESS: f32 = 0.02;

impl SurfaceProperties {
    /// Whether every parameter is in its range.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self) -> Result<(), RangeError> {
        let within = |parameter, value: f32, [low, high]: [f32; 2], range| {
            RangeError::unless_within(parameter, value.into(), [low.into(), high.into()], range)
        };
        let rough = |value| within("roughness", value, [MIN_ROUGHNESS, 1.0], "from 0.02 to 1");
        within("opacity", self.opacity, [0.0, 1.0], "from 0 to 1")?;
        match self.material {
            Material::Lambert { specular, roughness } => {
                within("specular", specular, [0.0, 1.0], "from 0 to 1")?;
                rough(roughness)?;
            }
            Material::Conductor { roughness } => {
                rough(roughness)?;
            }
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
            Material::Emissive { strength } => {
                within("strength", strength, [0.0, 1e6], "from 0 to 1e6")?;
            }
        }
        Ok(())
    }

    /// As bits, to tell them apart.
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
