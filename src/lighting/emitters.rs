//! Stub.
use crate::scene::Scene;
/// Stub.
#[derive(Debug)]
pub struct Emitters;
impl Emitters {
    pub(crate) fn of(_: &Scene) -> Self {
        Self
    }
    pub(crate) fn ids(&self) -> &[u32] {
        &[]
    }
    pub(crate) fn last_choice(&self, _: usize) -> u32 {
        0
    }
    pub(crate) fn probability_of(&self, _: usize) -> f64 {
        0.0
    }
}
