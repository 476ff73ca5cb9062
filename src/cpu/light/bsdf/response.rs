//! What a BSDF answers.

use glam::DVec3;

/// The BSDF's value for light from a direction, without the cosine factor, and the density with which the direction is
/// sampled.
#[derive(Clone, Copy, Debug)]
pub(in crate::cpu::light) struct Response {
    pub(in crate::cpu::light) value: DVec3,
    pub(in crate::cpu::light) density: f64,
}

/// A direction chosen at random by a BSDF.
#[derive(Clone, Copy, Debug)]
pub(in crate::cpu::light) struct Scattered {
    /// On the other side of the surface if its z is negative.
    pub(in crate::cpu::light) direction: DVec3,
    pub(in crate::cpu::light) weight: DVec3,
    /// Density per steradian; `None` if light sampling cannot choose the direction.
    pub(in crate::cpu::light) density: Option<f64>,
}
