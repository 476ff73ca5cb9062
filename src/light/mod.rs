//! What shines on a scene: lights, sky and ground, and numbers that all renderers share: which emissive sphere is
//! sampled, and what rough surfaces lose.

pub(crate) mod codes;
pub mod emitters;
pub mod energy;
pub mod environment;
mod ground;
mod kinds;
mod sky;

pub use emitters::Emitters;
pub use ground::Ground;
pub use kinds::{Light, LightFrame, LightKind};
pub use sky::{Sky, SkyLight};
