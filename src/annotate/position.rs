//! Where an annotation lies in the picture.

use std::str::FromStr;

use crate::text::one_line;

/// A corner, or the middle of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Anchor {
    TopLeft,
    Top,
    TopRight,
    Left,
    Right,
    BottomLeft,
    Bottom,
    BottomRight,
}

impl Anchor {
    /// All anchors.
    pub const ALL: [Self; 8] = [
        Self::TopLeft,
        Self::Top,
        Self::TopRight,
        Self::Left,
        Self::Right,
        Self::BottomLeft,
        Self::Bottom,
        Self::BottomRight,
    ];

    /// The name on the command line and in scene files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::TopLeft => "top-left",
            Self::Top => "top",
            Self::TopRight => "top-right",
            Self::Left => "left",
            Self::Right => "right",
            Self::BottomLeft => "bottom-left",
            Self::Bottom => "bottom",
            Self::BottomRight => "bottom-right",
        }
    }

    /// The fractions of the picture's width and height, from the top left.
    pub(super) const fn fractions(self) -> [f32; 2] {
        match self {
            Self::TopLeft => [0.0, 0.0],
            Self::Top => [0.5, 0.0],
            Self::TopRight => [1.0, 0.0],
            Self::Left => [0.0, 0.5],
            Self::Right => [1.0, 0.5],
            Self::BottomLeft => [0.0, 1.0],
            Self::Bottom => [0.5, 1.0],
            Self::BottomRight => [1.0, 1.0],
        }
    }
}

/// Where an annotation lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Position {
    /// At a corner, or in the middle of a side.
    Anchor(Anchor),
    /// At fractions of the picture's width and height from the top left: `[0, 0]` is the top left corner, `[1, 1]` the
    /// bottom right one. The same fractions of the annotation lie there, so that it is always inside the picture.
    At([f32; 2]),
}

impl Position {
    /// The top left corner.
    pub const TOP_LEFT: Self = Self::Anchor(Anchor::TopLeft);
    /// The middle of the right side.
    pub const RIGHT: Self = Self::Anchor(Anchor::Right);
    /// The bottom left corner.
    pub const BOTTOM_LEFT: Self = Self::Anchor(Anchor::BottomLeft);

    /// A position at fractions of the picture's width and height from the top left.
    ///
    /// # Errors
    /// Returns an error if a fraction does not lie between 0 and 1.
    pub fn at([x, y]: [f32; 2]) -> Result<Self, PositionError> {
        let is_inside = |fraction| (0.0..=1.0).contains(&fraction);
        if is_inside(x) && is_inside(y) {
            return Ok(Self::At([x, y]));
        }
        Err(PositionError { text: format!("{x},{y}") })
    }
}

/// A text is not a position.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is not a position; write top-left, top, top-right, left, right, bottom-left, bottom or bottom-right, or \
     fractions of the width and height from the top left, such as 0.5,0.1"
)]
#[non_exhaustive]
pub struct PositionError {
    /// The text as given.
    pub text: String,
}

impl FromStr for Position {
    type Err = PositionError;

    fn from_str(text: &str) -> Result<Self, PositionError> {
        let name = text.trim();
        if let Some(anchor) = Anchor::ALL.into_iter().find(|anchor| anchor.name() == name) {
            return Ok(Self::Anchor(anchor));
        }
        let pair = name.split_once(',');
        let pair = pair.and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
        let position = pair.and_then(|pair| Self::at(pair).ok());
        position.ok_or_else(|| PositionError { text: one_line(text) })
    }
}
