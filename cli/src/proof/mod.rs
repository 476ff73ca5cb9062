//! The proofs: of pictures of a device, of pictures that were written, of answers of other renderers, and of devices.

pub(crate) mod certified;
pub(crate) mod certify;
#[cfg(feature = "gpu")]
pub(crate) mod quick_test;
pub(crate) mod render_certified;
#[cfg(feature = "gpu")]
pub(crate) mod self_test;
pub(crate) mod verify;
