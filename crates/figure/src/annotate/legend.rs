//! Legends explain the colours of a picture. Categories are shown as disks of their colours, with their names.

use super::canvas::{Block, LINE, Paint, Shape};
use super::font::{self, HALF_CAPITAL};
use super::legend_scale::{MISSING, horizontal, vertical};
use super::place::{Anchor, Position};
use crate::color_by::{Category, ColorKey, KeyKind};

/// Explains the colours of a picture: a bar with ticks for a scale, or a list of categories. It is horizontal in the
/// middle of the top or bottom of the picture, and vertical elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// The meaning of the colours.
    pub key: ColorKey,
    /// The title; without one it is the name of the column. It may be empty, and may have several lines.
    pub title: Option<String>,
    /// The position of the legend.
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
            (KeyKind::Categories(list), false) => self.categories(list, em, size),
            (KeyKind::Categories(list), true) => self.in_lines(list, em, size),
        }
    }

    /// A list in columns, with the title above.
    fn categories(&self, list: &[Category], em: f32, [width, height]: [f32; 2]) -> Block {
        let (missing, mut block) = (self.key.missing, head(self.title(), em));
        let rows = ((0.8 * height - block.height) / (ROW * em)).max(2.0) as usize;
        let names = list.iter().map(|category| category.name.as_str()).take(rows * MOST_COLUMNS);
        let names = names.chain(missing.map(|_| MISSING));
        let widest = names.map(|name| font::width(name, em)).fold(0.0, f32::max);
        let column = widest + (INDENT + 1.2) * em;
        let columns = ((0.5 * width / column) as usize).clamp(1, MOST_COLUMNS);
        let shown = shown(list, missing, rows * columns);
        let columns = shown.len().div_ceil(rows);
        let rows = shown.len().div_ceil(columns.max(1));
        let top = block.height;
        for (index, item) in shown.iter().enumerate() {
            let x = (index / rows) as f32 * column;
            let y = top + ((index % rows) as f32 + 0.5) * ROW * em;
            row(&mut block, item, [x, y], em);
        }
        block.height = top + rows as f32 * ROW * em;
        block
    }

    /// A list in lines, with the title above.
    fn in_lines(&self, list: &[Category], em: f32, [width, height]: [f32; 2]) -> Block {
        let (missing, mut block) = (self.key.missing, head(self.title(), em));
        let (top, room) = (block.height, 0.85 * width);
        let most_rows = (0.3 * height / (ROW * em)).max(1.0) as usize;
        let item_width = |(name, color): &Entry| {
            font::width(name, em) + if color.is_some() { (INDENT + 1.2) * em } else { 1.2 * em }
        };
        // The loop reduces the entries until they fit into the rows.
        let mut count = list.len() + usize::from(missing.is_some());
        let lines = loop {
            let mut lines: Vec<Vec<Entry>> = vec![Vec::new()];
            let mut used = 0.0;
            for item in shown(list, missing, count) {
                let width = item_width(&item);
                if used > 0.0 && used + width > room {
                    lines.push(Vec::new());
                    used = 0.0;
                }
                used += width;
                lines.last_mut().into_iter().for_each(|line| line.push(item.clone()));
            }
            if lines.len() <= most_rows || count <= 2 {
                break lines;
            }
            count = count.min(lines.len() * 200) * 3 / 4;
        };
        let widths = lines.iter().map(|line| line.iter().map(item_width).sum::<f32>() - 1.2 * em);
        let widths: Vec<f32> = widths.collect();
        let widest = widths.iter().copied().fold(block.width, f32::max);
        for shape in &mut block.shapes {
            if let Shape::Text { text, at, em } = shape {
                at[0] = 0.5 * (widest - font::width(text, *em));
            }
        }
        for (index, (line, line_width)) in lines.iter().zip(&widths).enumerate() {
            let y = top + (index as f32 + 0.5) * ROW * em;
            let mut x = 0.5 * (widest - line_width);
            for item in line {
                row(&mut block, item, [x, y], em);
                x += item_width(item);
            }
        }
        block.width = widest;
        block.height = top + lines.len() as f32 * ROW * em;
        block
    }
}

/// The distance between rows, relative to the size of text.
const ROW: f32 = 1.5;

const MOST_COLUMNS: usize = 3;

/// The radius of a disk, relative to the size of text.
const RADIUS: f32 = 0.46;

/// Distance from the left edge of a disk to its name, relative to the size of text.
const INDENT: f32 = 1.5;

/// A name, and its colour in 8-bit sRGB unless it has none.
type Entry = (String, Option<[u8; 3]>);

/// Returns at most `room` names and colours to show.
fn shown(list: &[Category], missing: Option<[u8; 3]>, room: usize) -> Vec<Entry> {
    let last = missing.map(|color| (MISSING.to_owned(), Some(color)));
    let room = room.max(2);
    let all = list.len() + usize::from(last.is_some());
    let kept = if all <= room { list.len() } else { room - 1 - usize::from(last.is_some()) };
    let named = |category: &Category| {
        let name: String = category.name.chars().take(40).collect();
        (name, Some(category.color))
    };
    let mut rows: Vec<_> = list.iter().take(kept).map(named).collect();
    let hidden = list.len() - kept;
    if hidden > 0 {
        rows.push((format!("and {hidden} more"), None));
    }
    rows.extend(last);
    rows
}

/// Adds a disk with a name; `y` is the middle of its row.
fn row(block: &mut Block, (name, color): &Entry, [x, y]: [f32; 2], em: f32) {
    let baseline = y + HALF_CAPITAL * em;
    match color {
        Some(color) => {
            let center = [x + 0.5 * em, y];
            // A thin outline shows a disk whose colour is like the background.
            let line = (0.06 * em).max(0.6);
            block.shapes.push(Shape::Disk { center, radius: RADIUS * em + line, paint: Paint::Ink });
            let paint = Paint::Color(*color);
            block.shapes.push(Shape::Disk { center, radius: RADIUS * em, paint });
            block.text(name, [x + INDENT * em, baseline], em);
        }
        None => block.text(name, [x, baseline], em),
    }
}

fn head(title: &str, em: f32) -> Block {
    let mut block = Block::default();
    block.lines(title, em);
    if block.height > 0.0 {
        block.height += 0.12 * LINE * em;
    }
    block
}
