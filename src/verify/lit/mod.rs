//! The common parts of the checks of light paths and of studios: recordings, verdicts, and the checks
//! of the parts that their kernels share.
//!
//! A recording contains the state of every path between two dispatches. A ray of a studio is a path that passes through
//! surfaces. Each dispatch is judged separately, from the exact numbers that the device had before it, so that errors
//! do not accumulate. Searches are judged like those of pictures with a single ray for each pixel (`verify/hit.rs`).
//! Kernels that shade are evaluated with intervals, number by number (`verify/number`), once for every combination of
//! decisions that the intervals leave open, such as which side of a sphere is hit, or which point of a light is chosen.

pub(crate) mod certificate;
pub(super) mod check;
mod cone_place;
pub(super) mod film;
pub(super) mod forward;
pub(super) mod judge;
pub(super) mod kernel;
mod legal_picture;
pub(super) mod sampling;
pub(super) mod search;
mod smooth;
pub(super) mod upload;
