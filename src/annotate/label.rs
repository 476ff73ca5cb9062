//! Labels: texts at a place of the picture.

use super::position::Position;
use super::shape::Block;

/// A text at a place of the picture. It may have several lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The text.
    pub text: String,
    /// Where it lies.
    pub position: Position,
}

impl Label {
    pub(super) fn block(&self, em: f32) -> Block {
        let mut block = Block::default();
        // Somewhat larger than the numbers of a legend.
        block.lines(&self.text, 1.15 * em);
        block
    }
}
