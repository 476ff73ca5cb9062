//! The samples of a picture in sRGB, into which annotations are blended, and the shapes of annotations before they have
//! a place and a colour.

use glam::Vec2;

use super::font;
use pinhole::image::encoding::Bits;

/// A picture of RGB or RGBA samples in sRGB, row by row from the top. Alpha is not premultiplied.
#[derive(Debug)]
pub struct Canvas<'a> {
    size: [u32; 2],
    channels: usize,
    bits: Bits,
    samples: &'a mut [u8],
}

impl<'a> Canvas<'a> {
    /// A canvas of this width and height over samples: 3 (RGB) or 4 (RGBA) for each pixel, each of one byte, or of
    /// two with the high byte first. Returns `None` if the number of bytes does not fit.
    #[must_use]
    pub fn new(size: [u32; 2], channels: usize, bits: Bits, samples: &'a mut [u8]) -> Option<Self> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let bytes = pixels * channels as u64 * bits.bytes() as u64;
        let is_right = matches!(channels, 3 | 4) && bytes == samples.len() as u64;
        is_right.then_some(Self { size, channels, bits, samples })
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The brightness of a pixel over white, from 0 to 1: the luma of its encoded components.
    pub(super) fn luma(&self, x: u32, y: u32) -> f32 {
        let Some(start) = self.start(i64::from(x), i64::from(y)) else { return 1.0 };
        let of = |channel| self.sample(start, channel) / 255.0;
        let luma = 0.2126 * of(0) + 0.7152 * of(1) + 0.0722 * of(2);
        if self.channels == 4 { luma * of(3) + 1.0 - of(3) } else { luma }
    }

    /// Blends a colour over a pixel. A `coverage` of 0 changes nothing, and 1 gives exactly this colour. Pixels outside
    /// the canvas are ignored.
    pub(super) fn blend(&mut self, x: i64, y: i64, color: [u8; 3], coverage: f32) {
        let Some(start) = self.start(x, y) else { return };
        if coverage.is_nan() || coverage <= 0.0 {
            return;
        }
        let over = coverage.min(1.0);
        let below = if self.channels == 4 { self.sample(start, 3) / 255.0 } else { 1.0 };
        let alpha = over + below * (1.0 - over);
        for (channel, byte) in color.into_iter().enumerate() {
            let (new, old) = (f32::from(byte), self.sample(start, channel));
            let blended = if over >= 1.0 { new } else { (new * over + old * below * (1.0 - over)) / alpha };
            self.set(start, channel, blended);
        }
        if self.channels == 4 {
            self.set(start, 3, 255.0 * alpha);
        }
    }

    fn start(&self, x: i64, y: i64) -> Option<usize> {
        let [width, height] = self.size.map(i64::from);
        let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
        let pixel = usize::try_from(y * width + x).ok().filter(|_| is_inside)?;
        Some(pixel * self.channels * self.bits.bytes())
    }

    /// Reads a sample on a scale from 0 to 255.
    fn sample(&self, start: usize, channel: usize) -> f32 {
        match self.bits {
            Bits::Eight => self.samples[start + channel].into(),
            Bits::Sixteen => {
                let at = start + 2 * channel;
                f32::from(u16::from_be_bytes([self.samples[at], self.samples[at + 1]])) / 257.0
            }
        }
    }

    fn set(&mut self, start: usize, channel: usize, value: f32) {
        match self.bits {
            Bits::Eight => self.samples[start + channel] = value.round() as u8,
            Bits::Sixteen => {
                let at = start + 2 * channel;
                let bytes = ((257.0 * value).round() as u16).to_be_bytes();
                self.samples[at..at + 2].copy_from_slice(&bytes);
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    /// The colour of text, which depends on the picture behind it.
    Ink,
    /// A colour in 8-bit sRGB.
    Color([u8; 3]),
}

/// A shape of an annotation. Coordinates are pixels from the annotation's top left corner.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// A rectangle: left, top, right, bottom.
    Rect { rect: [f32; 4], paint: Paint },
    /// A bar of whole pixels, with a colour for each row from the top or, if it lies, each column from the left.
    Bar { place: [i64; 2], thickness: i64, colors: Vec<[u8; 3]>, lies: bool },
    /// A disk.
    Disk { center: [f32; 2], radius: f32, paint: Paint },
    /// A line between two points, with half of its width at both.
    Line { ends: [[f32; 2]; 2], widths: [f32; 2], paint: Paint },
    /// One line of text, at the start of its baseline.
    Text { text: String, at: [f32; 2], em: f32 },
}

/// The width of lines beside text of this size.
pub(super) fn line_width(em: f32) -> f32 {
    (em / 14.0).round().max(1.0)
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Block {
    pub(super) width: f32,
    pub(super) height: f32,
    pub(super) shapes: Vec<Shape>,
}

impl Block {
    /// Adds one line of text, and widens the block to hold it.
    pub(super) fn text(&mut self, text: impl Into<String>, at: [f32; 2], em: f32) {
        let text = text.into();
        self.width = self.width.max(at[0] + font::width(&text, em));
        self.shapes.push(Shape::Text { text, at, em });
    }

    pub(super) fn lines(&mut self, text: &str, em: f32) {
        for line in text.lines() {
            self.text(line, [0.0, self.height + 0.95 * em], em);
            self.height += LINE * em;
        }
    }

    pub(super) fn rect(&mut self, rect: [f32; 4], paint: Paint) {
        self.shapes.push(Shape::Rect { rect, paint });
    }

    /// Adds a line with half of its width at both ends.
    pub(super) fn line(&mut self, ends: [[f32; 2]; 2], widths: [f32; 2], paint: Paint) {
        self.shapes.push(Shape::Line { ends, widths, paint });
    }

    /// Adds a frame of this line width around the outside of a rectangle.
    pub(super) fn frame(&mut self, [left, top, right, bottom]: [f32; 4], line: f32) {
        let (l, t, r, b) = (left - line, top - line, right + line, bottom + line);
        for rect in [[l, t, r, top], [l, bottom, r, b], [l, top, left, bottom], [right, top, r, bottom]] {
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
                Shape::Bar { place: [x, y], thickness, colors, lies } => {
                    for (along, color) in (0..).zip(colors) {
                        for across in 0..*thickness {
                            let [i, j] = if *lies { [along, across] } else { [across, along] };
                            canvas.blend(left + x + i, top + y + j, *color, 1.0);
                        }
                    }
                }
                Shape::Disk { center: [x, y], radius, paint } => {
                    disk([x + dx, y + dy], *radius, color(paint), canvas);
                }
                Shape::Line { ends, widths, paint } => {
                    line(ends.map(|[x, y]| [x + dx, y + dy]), *widths, color(paint), canvas);
                }
                Shape::Text { text, at: [x, y], em } => {
                    // The baseline is rounded to an edge between two rows of pixels, which keeps letters sharp.
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

/// The pixels that a rectangle touches within the canvas: left, top, right, bottom, the last two excluded.
fn pixels([left, top, right, bottom]: [f32; 4], canvas: &Canvas<'_>) -> [i64; 4] {
    let [width, height] = canvas.size().map(i64::from);
    [
        (left.floor() as i64).max(0),
        (top.floor() as i64).max(0),
        (right.ceil() as i64).min(width),
        (bottom.ceil() as i64).min(height),
    ]
}

/// Fills a rectangle. Pixels that it covers in part are blended.
pub(super) fn fill(rect: [f32; 4], color: [u8; 3], opacity: f32, canvas: &mut Canvas<'_>) {
    let [left, top, right, bottom] = pixels(rect, canvas);
    let part = |low: f32, high: f32, pixel: i64| (high.min(pixel as f32 + 1.0) - low.max(pixel as f32)).clamp(0.0, 1.0);
    for y in top..bottom {
        for x in left..right {
            let coverage = part(rect[0], rect[2], x) * part(rect[1], rect[3], y);
            canvas.blend(x, y, color, coverage * opacity);
        }
    }
}

/// Fills a disk. Its edge is treated as straight when coverage is computed.
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

/// Draws a line between two points, with half of its width at both. Its edge is treated as straight when coverage is
/// computed, and its ends are flat.
fn line([from, to]: [[f32; 2]; 2], [first, last]: [f32; 2], color: [u8; 3], canvas: &mut Canvas<'_>) {
    let [from, to] = [from, to].map(Vec2::from);
    let (length, along) = ((to - from).length(), (to - from).normalize_or_zero());
    let reach = first.max(last) + 1.0;
    let (low, high) = (from.min(to) - reach, from.max(to) + reach);
    let [left, top, right, bottom] = pixels([low.x, low.y, high.x, high.y], canvas);
    for row in top..bottom {
        for column in left..right {
            let offset = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) - from;
            let at = offset.dot(along);
            let half = first + (last - first) * (at / length.max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
            let across = (half + 0.5 - offset.perp_dot(along).abs()).clamp(0.0, 1.0);
            let between = (at + 0.5).clamp(0.0, 1.0) * (length - at + 0.5).clamp(0.0, 1.0);
            canvas.blend(column, row, color, across * between);
        }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "what is compared is exact")]
mod tests {
    use super::*;

    #[test]
    fn full_coverage_gives_exactly_the_color() {
        let mut eight = vec![7; 3];
        let mut canvas = Canvas::new([1, 1], 3, Bits::Eight, &mut eight).unwrap();
        canvas.blend(0, 0, [1, 128, 255], 1.0);
        canvas.blend(1, 0, [9; 3], 1.0);
        canvas.blend(0, -1, [9; 3], 1.0);
        canvas.blend(0, 0, [9; 3], f32::NAN);
        assert_eq!(eight, [1, 128, 255]);
        let mut sixteen = vec![7; 8];
        let mut canvas = Canvas::new([1, 1], 4, Bits::Sixteen, &mut sixteen).unwrap();
        canvas.blend(0, 0, [1, 128, 255], 1.0);
        assert_eq!(sixteen, [1, 1, 128, 128, 255, 255, 255, 255]);
    }

    #[test]
    fn blending_over_a_clear_pixel_gives_the_color_with_its_coverage_as_alpha() {
        let mut rgba = vec![200, 10, 30, 0];
        let mut canvas = Canvas::new([1, 1], 4, Bits::Eight, &mut rgba).unwrap();
        assert_eq!(canvas.luma(0, 0), 1.0);
        canvas.blend(0, 0, [50, 100, 150], 0.4);
        assert_eq!(rgba, [50, 100, 150, 102]);
        let mut rgb = vec![0, 100, 200];
        let mut canvas = Canvas::new([1, 1], 3, Bits::Eight, &mut rgb).unwrap();
        canvas.blend(0, 0, [100, 100, 100], 0.25);
        assert_eq!(rgb, [25, 100, 175]);
    }

    #[test]
    fn the_number_of_samples_must_be_right() {
        assert!(Canvas::new([2, 2], 3, Bits::Eight, &mut [0; 11]).is_none());
        assert!(Canvas::new([2, 2], 2, Bits::Eight, &mut [0; 8]).is_none());
    }
}
