//! Ghosts: shapes that are seen faintly around those of a scene.

use std::sync::Arc;

use super::Scene;

impl Scene {
    /// The scene with ghosts: another scene, whose picture is drawn faintly over that of this one where it is nearer; see
    /// [`Image::with_ghosts`](crate::Image::with_ghosts). Rays of this scene do not meet them.
    #[must_use]
    pub fn with_ghosts(mut self, ghosts: Self) -> Self {
        self.ghosts = (ghosts.shape_count() > 0).then(|| Arc::new(ghosts));
        self
    }

    /// The ghosts; `None` if there are none.
    #[must_use]
    pub fn ghosts(&self) -> Option<&Self> {
        self.ghosts.as_deref()
    }
}
