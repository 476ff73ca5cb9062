//! What an annotation consists of, before it has a place and a colour.

use super::canvas::Canvas;
use super::font;

/// The colour of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    /// That of text, which depends on what lies behind.
    Ink,
    /// A colour in 8-bit sRGB.
    Color([u8; 3]),
}

/// A part of an annotation. Coordinates are pixels from its top left corner.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// A rectangle: left, top, right, bottom.
    Rect { rect: [f32; 4], paint: Paint },
    /// A bar of whole pixels, with a colour for each row from the top.
    Rows { left: i64, top: i64, width: i64, colors: Vec<[u8; 3]> },
    /// A bar of whole pixels, with a colour for each column from the left.
    Columns { left: i64, top: i64, height: i64, colors: Vec<[u8; 3]> },
    /// A disk.
    Disk { center: [f32; 2], radius: f32, paint: Paint },
    /// One line of text, from the start of its baseline.
    Text { text: String, at: [f32; 2], em: f32 },
}

/// The width of lines for this size of text.
pub(super) fn line_width(em: f32) -> f32 {
    (em / 14.0).round().max(1.0)
}

/// An annotation with its size.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Block {
    pub(super) width: f32,
    pub(super) height: f32,
    pub(super) shapes: Vec<Shape>,
}

impl Block {
    /// Adds one line of text, and makes the block as wide as it.
    pub(super) fn text(&mut self, text: impl Into<String>, at: [f32; 2], em: f32) {
        let text = text.into();
        self.width = self.width.max(at[0] + font::width(&text, em));
        self.shapes.push(Shape::Text { text, at, em });
    }

    /// Adds the lines of a text below the block.
    pub(super) fn lines(&mut self, text: &str, em: f32) {
        for line in text.lines() {
            self.text(line, [0.0, self.height + 0.95 * em], em);
            self.height += LINE * em;
        }
    }

    /// Adds a rectangle.
    pub(super) fn rect(&mut self, rect: [f32; 4], paint: Paint) {
        self.shapes.push(Shape::Rect { rect, paint });
    }

    /// Adds a line around a rectangle, outside of it, with this width.
    pub(super) fn frame(&mut self, [left, top, right, bottom]: [f32; 4], line: f32) {
        let (l, t, r, b) = (left - line, top - line, right + line, bottom + line);
        for rect in
            [[l, t, r, top], [l, bottom, r, b], [l, top, left, bottom], [right, top, r, bottom]]
        {
            self.rect(rect, Paint::Ink);
        }
    }

    /// Draws the block with its top left corner at a pixel.
    pub(super) fn draw(&self, [left, top]: [i64; 2], ink: [u8; 3], canvas: &mut Canvas<'_>) {
        let (dx, dy) = (left as f32, top as f32);
        let color = |paint: &Paint| match paint {
            Paint::Ink => ink,
            Paint::Color(color) => *color,
        };
        for shape in &self.shapes {
            match shape {
                Shape::Rect { rect: [l, t, r, b], paint } => {
                    fill([l + dx, t + dy, r + dx, b + dy], color(paint), 1.0, canvas);
                }
                Shape::Rows { left: l, top: t, width, colors } => {
                    for (row, color) in colors.iter().enumerate() {
                        for column in 0..*width {
                            canvas.blend(left + l + column, top + t + row as i64, *color, 1.0);
                        }
                    }
                }
                Shape::Columns { left: l, top: t, height, colors } => {
                    for (column, color) in colors.iter().enumerate() {
                        for row in 0..*height {
                            canvas.blend(left + l + column as i64, top + t + row, *color, 1.0);
                        }
                    }
                }
                Shape::Disk { center: [x, y], radius, paint } => {
                    disk([x + dx, y + dy], *radius, color(paint), canvas);
                }
                Shape::Text { text, at: [x, y], em } => {
                    // A baseline between two rows of pixels keeps letters sharp.
                    font::draw(text, [x + dx, (y + dy).round()], *em, |x, y, coverage| {
                        canvas.blend(x, y, ink, coverage);
                    });
                }
            }
        }
    }
}

/// The distance between baselines, relative to the size of the text.
pub(super) const LINE: f32 = 1.35;

/// The pixels that a rectangle touches, cut to the canvas: columns and rows, the last ones excluded.
fn pixels([left, top, right, bottom]: [f32; 4], canvas: &Canvas<'_>) -> [i64; 4] {
    let [width, height] = canvas.size().map(i64::from);
    [
        (left.floor() as i64).max(0),
        (top.floor() as i64).max(0),
        (right.ceil() as i64).min(width),
        (bottom.ceil() as i64).min(height),
    ]
}

/// Fills a rectangle; pixels that it covers in part are blended.
pub(super) fn fill(rect: [f32; 4], color: [u8; 3], opacity: f32, canvas: &mut Canvas<'_>) {
    let [left, top, right, bottom] = pixels(rect, canvas);
    let part = |low: f32, high: f32, pixel: i64| {
        (high.min(pixel as f32 + 1.0) - low.max(pixel as f32)).clamp(0.0, 1.0)
    };
    for y in top..bottom {
        for x in left..right {
            let coverage = part(rect[0], rect[2], x) * part(rect[1], rect[3], y);
            canvas.blend(x, y, color, coverage * opacity);
        }
    }
}

/// Fills a disk; the coverage of its edge is that of a straight edge.
fn disk([x, y]: [f32; 2], radius: f32, color: [u8; 3], canvas: &mut Canvas<'_>) {
    let reach = radius + 1.0;
    let [left, top, right, bottom] = pixels([x - reach, y - reach, x + reach, y + reach], canvas);
    for row in top..bottom {
        for column in left..right {
            let (dx, dy) = (column as f32 + 0.5 - x, row as f32 + 0.5 - y);
            let coverage = (radius + 0.5 - dx.hypot(dy)).clamp(0.0, 1.0);
            canvas.blend(column, row, color, coverage);
        }
    }
}
