//! Places of annotations in the picture, and colours that are readable there.

use std::str::FromStr;

use super::canvas::{Block, Canvas, fill};
use pinhole::internals::text::one_line;

/// The distance from the edges of the picture, relative to the size of text.
const MARGIN: f32 = 1.2;

/// The distance between annotations of one corner, relative to the size of text.
pub(super) const GAP: f32 = 0.9;

/// Distance by which a panel extends beyond its annotation, relative to the size of text.
pub(super) const PADDING: f32 = 0.6;

const PANEL_OPACITY: f32 = 0.8;

const BLACK: [u8; 3] = [0; 3];
const WHITE: [u8; 3] = [255; 3];

/// Whether a translucent panel lies behind an annotation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Panel {
    /// A panel where the picture behind is too mixed for black or white text.
    #[default]
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

/// Places and draws all blocks. Without `color`, each gets black or white, whichever is readable.
pub(super) fn draw(
    blocks: &[(Position, Block)],
    em: f32,
    color: Option<[u8; 3]>,
    panel: Panel,
    canvas: &mut Canvas<'_>,
) {
    for (index, (_, block)) in blocks.iter().enumerate() {
        let origin = origin(blocks, index, em, canvas.size());
        draw_block(block, origin, em, color, panel, canvas);
    }
}

/// The top left corner of a block in whole pixels.
pub(super) fn origin(blocks: &[(Position, Block)], index: usize, em: f32, [width, height]: [u32; 2]) -> [i64; 2] {
    let (margin, gap) = (MARGIN * em, GAP * em);
    let [width, height] = [width as f32, height as f32];
    let (position, block) = &blocks[index];
    let [fx, fy] = match position {
        Position::Anchor(anchor) => anchor.fractions(),
        Position::At(fractions) => *fractions,
    };
    let x = margin + fx * (width - 2.0 * margin - block.width);
    let heights = |blocks: &[(Position, Block)]| {
        let here = blocks.iter().filter(|(other, _)| other == position);
        here.map(|(_, block)| block.height + gap).sum::<f32>()
    };
    let y = match position {
        Position::At(_) => margin + fy * (height - 2.0 * margin - block.height),
        Position::Anchor(Anchor::BottomLeft | Anchor::Bottom | Anchor::BottomRight) => {
            height - margin - heights(&blocks[..index]) - block.height
        }
        Position::Anchor(_) => {
            let all = heights(blocks) - gap;
            margin + fy * (height - 2.0 * margin - all) + heights(&blocks[..index])
        }
    };
    // A block that is too large for the picture is cut at its right and bottom.
    [x, y].map(|place| place.max(0.0).round() as i64)
}

fn draw_block(block: &Block, origin: [i64; 2], em: f32, color: Option<[u8; 3]>, panel: Panel, canvas: &mut Canvas<'_>) {
    let (left, top, padding) = (origin[0] as f32, origin[1] as f32, (PADDING * em).round());
    let behind =
        [left - padding, top - padding, (left + block.width + padding).ceil(), (top + block.height + padding).ceil()];
    let lumas = lumas(behind, canvas);
    let mean = lumas.iter().sum::<f32>() / lumas.len().max(1) as f32;
    // Black or white is easy to read on light or dark grounds. A middle grey counts as light.
    let ink = color.unwrap_or(if mean < 0.45 { WHITE } else { BLACK });
    let ink_luma = (0.2126 * f32::from(ink[0]) + 0.7152 * f32::from(ink[1]) + 0.0722 * f32::from(ink[2])) / 255.0;
    let unreadable = lumas.iter().filter(|luma| (*luma - ink_luma).abs() < 0.4).count();
    let has_panel = match panel {
        Panel::Always => true,
        Panel::Never => false,
        Panel::Auto => unreadable * 50 > lumas.len(),
    };
    if has_panel {
        let panel = if ink_luma > 0.5 { BLACK } else { WHITE };
        fill(behind, panel, PANEL_OPACITY, canvas);
    }
    block.draw(origin, ink, canvas);
}

/// The lumas of the pixels behind an annotation, or of every n-th pixel if there are many.
fn lumas([left, top, right, bottom]: [f32; 4], canvas: &Canvas<'_>) -> Vec<f32> {
    let [width, height] = canvas.size();
    let clamped = |x: f32, most: u32| (x.max(0.0) as u32).min(most);
    let (columns, rows) = (clamped(left, width)..clamped(right, width), clamped(top, height)..clamped(bottom, height));
    let pixels = columns.len() as f32 * rows.len() as f32;
    let step = (pixels / 40_000.0).sqrt().ceil().max(1.0) as usize;
    let mut lumas = Vec::new();
    for y in rows.step_by(step) {
        lumas.extend(columns.clone().step_by(step).map(|x| canvas.luma(x, y)));
    }
    lumas
}

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
        self.row().0
    }

    /// The position as fractions of the picture's width and height, from the top left.
    const fn fractions(self) -> [f32; 2] {
        self.row().1
    }

    const fn row(self) -> (&'static str, [f32; 2]) {
        match self {
            Self::TopLeft => ("top-left", [0.0, 0.0]),
            Self::Top => ("top", [0.5, 0.0]),
            Self::TopRight => ("top-right", [1.0, 0.0]),
            Self::Left => ("left", [0.0, 0.5]),
            Self::Right => ("right", [1.0, 0.5]),
            Self::BottomLeft => ("bottom-left", [0.0, 1.0]),
            Self::Bottom => ("bottom", [0.5, 1.0]),
            Self::BottomRight => ("bottom-right", [1.0, 1.0]),
        }
    }
}

/// The position of an annotation.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(try_from = "PositionValue", into = "PositionValue")]
pub enum Position {
    /// At a corner, or in the middle of a side.
    Anchor(Anchor),
    /// At fractions of the picture's width and height from the top left: `[0, 0]` is the top left corner, `[1, 1]` the
    /// bottom right one. The same fractions of the annotation lie there, so that the annotation is always inside.
    At([f32; 2]),
}

impl Position {
    /// The top left corner.
    pub const TOP_LEFT: Self = Self::Anchor(Anchor::TopLeft);

    pub(super) const fn top_left() -> Self {
        Self::TOP_LEFT
    }

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

/// The error of a text that is not a position.
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

/// A position as a file gives it.
#[derive(serde::Deserialize, serde::Serialize)]
#[serde(untagged, expecting = "expected a position in quotes such as \"top-left\", or two fractions [x, y]")]
enum PositionValue {
    Name(String),
    At([f32; 2]),
}

impl TryFrom<PositionValue> for Position {
    type Error = PositionError;

    fn try_from(value: PositionValue) -> Result<Self, PositionError> {
        match value {
            PositionValue::Name(name) => name.parse(),
            PositionValue::At(fractions) => Self::at(fractions),
        }
    }
}

impl From<Position> for PositionValue {
    fn from(position: Position) -> Self {
        match position {
            Position::Anchor(anchor) => Self::Name(anchor.name().to_owned()),
            Position::At(fractions) => Self::At(fractions),
        }
    }
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
