//! Placeholder.
/// Placeholder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelFilter {
    /// Placeholder.
    Box,
    /// Placeholder.
    #[default]
    BlackmanHarris,
}
