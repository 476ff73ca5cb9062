//! Placeholder.
/// Placeholder.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment;
impl Environment {
    /// Placeholder.
    #[must_use]
    pub fn radiance(&self, _direction: glam::DVec3) -> [f64; 3] {
        [0.0; 3]
    }
}
