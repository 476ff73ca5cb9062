//! Proofs for pictures from a device, for written pictures, for answers of other renderers, and for devices.

pub(crate) mod certified;
pub(crate) mod certify;
#[cfg(feature = "gpu")]
pub(crate) mod quick_test;
pub(crate) mod render_certified;
mod scene_report;
#[cfg(feature = "gpu")]
pub(crate) mod self_test;
pub(crate) mod verify;
#[cfg(feature = "gpu")]
pub(crate) mod witness;
