//! Legends: what colours mean.

use super::legend_categories::{categories, in_lines};
use super::legend_scale::{horizontal, vertical};
use super::position::{Anchor, Position};
use super::shape::Block;
use crate::color_by::{ColorKey, KeyKind};

/// What the colours of a picture mean: a bar with ticks for a scale, or a list of categories. At the middle of the top or
/// of the bottom it lies, elsewhere it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// What the colours mean.
    pub key: ColorKey,
    /// The title; without one it is the name of the column. It may be empty, and may have several lines.
    pub title: Option<String>,
    /// Where the legend lies.
    pub position: Position,
}

impl Legend {
    /// A legend in the middle of the right side, with the name of the column as title.
    #[must_use]
    pub fn new(key: ColorKey) -> Self {
        Self { key, title: None, position: Position::RIGHT }
    }

    /// The title as it is shown.
    #[must_use]
    pub fn title(&self) -> &str {
        self.title.as_deref().unwrap_or(&self.key.title)
    }

    pub(super) fn block(&self, em: f32, size: [u32; 2]) -> Block {
        let lies = matches!(self.position, Position::Anchor(Anchor::Top | Anchor::Bottom));
        let (title, missing) = (self.title(), self.key.missing);
        let size = size.map(|side| side as f32);
        match (&self.key.kind, lies) {
            (KeyKind::Scale(scale), false) => vertical(scale, title, missing, em, size),
            (KeyKind::Scale(scale), true) => horizontal(scale, title, missing, em, size),
            (KeyKind::Categories(list), false) => categories(list, title, missing, em, size),
            (KeyKind::Categories(list), true) => in_lines(list, title, missing, em, size),
        }
    }
}
