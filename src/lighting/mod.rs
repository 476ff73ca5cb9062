//! What shines on a scene: lights, sky and ground, and numbers that all renderers share: which emissive sphere is
//! sampled, and what rough surfaces lose.

pub mod emitters;
pub mod energy;
mod ground;
mod light;
mod sky;

pub use emitters::Emitters;
pub use ground::Ground;
pub use light::{Light, LightFrame, LightKind};
pub use sky::{Sky, SkyLight};
