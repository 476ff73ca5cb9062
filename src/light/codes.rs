//! Codes of materials, lights and states of paths on a device. The renderer writes them and the checker reads them. A
//! test compares them with the constants of the same names in `shaders`.

use crate::light::LightKind;
use crate::scene::material::Material;

/// Kinds of materials.
pub(crate) mod material {
    pub(crate) const LAMBERT: u32 = 0;
    pub(crate) const CONDUCTOR: u32 = 1;
    pub(crate) const DIELECTRIC: u32 = 2;
    pub(crate) const EMISSIVE: u32 = 3;
}

/// Kinds of lights.
pub(crate) mod lamp {
    pub(crate) const HEAD: u32 = 0;
    pub(crate) const DIRECTIONAL: u32 = 1;
    pub(crate) const POINT: u32 = 2;
    pub(crate) const SPHERE: u32 = 3;
}

/// Methods of light sampling.
pub(crate) mod sampling {
    pub(crate) const CHANCE: u32 = 0;
    pub(crate) const DIRECT: u32 = 1;
    pub(crate) const MULTIPLE: u32 = 2;
}

/// Flags of a lighting, which are added.
pub(crate) mod lighting {
    pub(crate) const TRANSPARENT: u32 = 1;
    pub(crate) const SKY_SEEN: u32 = 2;
    pub(crate) const SHADOWS: u32 = 4;
    pub(crate) const GROUND: u32 = 8;
    pub(crate) const CATCHER: u32 = 16;
}

/// Flags of a path, which are added.
pub(crate) mod path {
    pub(crate) const ALIVE: u32 = 1;
    pub(crate) const INSIDE: u32 = 2;
    pub(crate) const ON_GROUND: u32 = 4;
    pub(crate) const BACK: u32 = 16;
    pub(crate) const FULL: u32 = 32;
    pub(crate) const SCATTERED: u32 = 64;
}

pub(crate) fn of_material(material: &Material) -> u32 {
    match material {
        Material::Lambert { .. } => material::LAMBERT,
        Material::Conductor { .. } => material::CONDUCTOR,
        Material::Dielectric { .. } => material::DIELECTRIC,
        Material::Emissive { .. } => material::EMISSIVE,
    }
}

pub(crate) fn of_light(light: &LightKind) -> u32 {
    match light {
        LightKind::Head { .. } => lamp::HEAD,
        LightKind::Directional { .. } => lamp::DIRECTIONAL,
        LightKind::Point { .. } => lamp::POINT,
        LightKind::Sphere { .. } => lamp::SPHERE,
    }
}
