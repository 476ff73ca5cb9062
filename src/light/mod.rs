//! Everything that illuminates a scene: lights, sky and ground. Also two tables that all renderers share: the
//! probabilities with which emissive spheres are sampled, and the energy that rough surfaces keep.

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
