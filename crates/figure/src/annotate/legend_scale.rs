//! The bar of a scale, with ticks.

use super::canvas::{Block, LINE, Paint, Shape, line_width};
use super::font::{self, HALF_CAPITAL};
use super::ticks::{Ticks, raised};
use crate::color_by::ColorScale;

pub(super) const MISSING: &str = "no value";

/// A vertical bar with its high end at the top, ticks to its right and the title above.
pub(super) fn vertical(
    scale: &ColorScale,
    title: &str,
    missing: Option<[u8; 3]>,
    em: f32,
    [_, height]: [f32; 2],
) -> Block {
    let line = line_width(em);
    let bar_width = (1.1 * em).round();
    let bar_height = (0.45 * height).max(7.0 * em).min(0.8 * height).round().max(1.0);
    let ticks = Ticks::of(scale.scale(), ((bar_height / (2.3 * em)) as usize).clamp(2, 8));
    let mut block = head(title, ticks.exponent, em);
    let top = block.height.round() + line;
    let (left, right) = (line, line + bar_width);
    let rows = bar_height as usize;
    // Row 0 is the top.
    let middle_of = |value: f64| top + (rows - 1 - pixel_at(scale, value, rows)) as f32 + 0.5;
    let mut colors = bar_colors(scale, rows, &ticks);
    colors.reverse();
    let (place, thickness) = ([left as i64, top as i64], bar_width as i64);
    block.shapes.push(Shape::Bar { place, thickness, colors, lies: false });
    block.frame([left, top, right, top + bar_height], line);
    block.width = block.width.max(right + line);
    let text_x = draw_ticks(&mut block, &ticks, right, em, middle_of, false) + 0.35 * em;
    for (value, text) in &ticks.labeled {
        block.text(text, [text_x, middle_of(*value) + HALF_CAPITAL * em], em);
    }
    block.height = top + bar_height + line;
    if let Some(color) = missing {
        let top = (block.height + 0.9 * em).round();
        let bottom = top + em.round();
        block.rect([left, top, right, bottom], Paint::Color(color));
        block.frame([left, top, right, bottom], line);
        let baseline = 0.5 * (top + bottom) + HALF_CAPITAL * em;
        block.text(MISSING, [text_x, baseline], em);
        block.height = bottom + line;
    }
    block
}

/// A horizontal bar with its high end at the right, ticks below and the title above.
pub(super) fn horizontal(
    scale: &ColorScale,
    title: &str,
    missing: Option<[u8; 3]>,
    em: f32,
    [width, _]: [f32; 2],
) -> Block {
    let line = line_width(em);
    let bar_height = (1.1 * em).round();
    let bar_width = (0.4 * width).max(12.0 * em).min(0.75 * width).round().max(1.0);
    // Chooses the most ticks whose texts have room.
    let fits = |ticks: &Ticks| {
        let widths = ticks.labeled.iter().map(|(_, text)| font::width(text, em) + em);
        widths.sum::<f32>() <= bar_width
    };
    let choices = (2..=9).rev().map(|most| Ticks::of(scale.scale(), most));
    let ticks = choices.into_iter().find(fits).unwrap_or_else(|| Ticks::of(scale.scale(), 2));
    let columns = bar_width as usize;
    let column_of = |value: f64| pixel_at(scale, value, columns) as f32;
    // The first and the last text may extend beyond the bar.
    let overhang = |(value, text): &(f64, String)| {
        let half = 0.5 * font::width(text, em);
        (half - column_of(*value)).max(half - (bar_width - column_of(*value))).max(0.0)
    };
    let over = ticks.labeled.iter().map(overhang).fold(line, f32::max).ceil();
    let mut block = Block::default();
    let mut title_block = head(title, ticks.exponent, em);
    for shape in &mut title_block.shapes {
        if let Shape::Text { text, at, em } = shape {
            at[0] = over + 0.5 * (bar_width - font::width(text, *em));
        }
    }
    block.shapes.append(&mut title_block.shapes);
    let top = title_block.height.round() + line;
    let (left, right, bottom) = (over, over + bar_width, top + bar_height);
    let (place, thickness) = ([left as i64, top as i64], bar_height as i64);
    let colors = bar_colors(scale, columns, &ticks);
    block.shapes.push(Shape::Bar { place, thickness, colors, lies: true });
    block.frame([left, top, right, bottom], line);
    block.width = right + over;
    let middle_of = |value: f64| left + column_of(value) + 0.5;
    let baseline = draw_ticks(&mut block, &ticks, bottom, em, middle_of, true) + 1.05 * em;
    for (value, text) in &ticks.labeled {
        let x = middle_of(*value) - 0.5 * font::width(text, em);
        block.text(text, [x, baseline], em);
    }
    block.height = baseline + 0.1 * em;
    if let Some(color) = missing {
        let left = (block.width + 1.2 * em).round();
        let right = left + (1.1 * em).round();
        block.rect([left, top, right, bottom], Paint::Color(color));
        block.frame([left, top, right, bottom], line);
        let half = 0.5 * font::width(MISSING, em);
        let start = (0.5 * (left + right) - half).max(block.width + 0.4 * em);
        block.text(MISSING, [start, baseline], em);
    }
    block
}

/// Draws ticks from an edge of a bar, and returns the end of the long ticks.
fn draw_ticks(block: &mut Block, ticks: &Ticks, edge: f32, em: f32, middle_of: impl Fn(f64) -> f32, lies: bool) -> f32 {
    let line = line_width(em);
    let [short, long] = [0.22, 0.38].map(|length| edge + line + (length * em).round());
    let minor = ticks.minor.iter().map(|value| (value, short));
    for (value, end) in minor.chain(ticks.labeled.iter().map(|(value, _)| (value, long))) {
        let start = (middle_of(*value) - 0.5 * line).round();
        let upright = [edge, start, end, start + line];
        block.rect(if lies { [start, edge, start + line, end] } else { upright }, Paint::Ink);
    }
    long
}

/// The title, and the power of ten by which the numbers below are multiplied.
fn head(title: &str, exponent: i32, em: f32) -> Block {
    let mut block = Block::default();
    block.lines(title, em);
    if exponent != 0 {
        block.lines(&format!("×10{}", raised(exponent)), em);
    }
    if block.height > 0.0 {
        block.height += 0.25 * LINE * em;
    }
    block
}

/// The pixel of a bar that is nearest to a position. Pixels count from the low end; the first is at 0, the last at 1.
fn pixel_of(position: f64, count: usize) -> usize {
    let last = count.saturating_sub(1);
    ((position * last as f64).round() as usize).min(last)
}

/// The pixel of a bar that is nearest to a number.
fn pixel_at(scale: &ColorScale, value: f64, count: usize) -> usize {
    pixel_of(scale.scale().position(value).unwrap_or(0.0), count)
}

/// The colours of a bar from its low end. The first and the last pixel have the colours of the ends. A pixel with a
/// tick has exactly the colour of the tick's number.
fn bar_colors(scale: &ColorScale, count: usize, ticks: &Ticks) -> Vec<[u8; 3]> {
    let position = |pixel: usize| pixel as f64 / count.saturating_sub(1).max(1) as f64;
    let mut colors: Vec<[u8; 3]> = (0..count).map(|pixel| scale.color_at(position(pixel))).collect();
    for value in ticks.labeled.iter().map(|(value, _)| value).chain(&ticks.minor) {
        if let (Some(position), Some(color)) = (scale.scale().position(*value), scale.color(*value)) {
            colors[pixel_of(position, count)] = color;
        }
    }
    colors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::annotate::Canvas;
    use crate::color_by::{MapName, Scale};
    use pinhole::image::encoding::Bits;

    const SIZE: [u32; 2] = [700, 500];

    fn scales() -> Vec<ColorScale> {
        let ranges = [([-3.0, 17.5], false), ([0.0, 1.0], false), ([0.02, 400.0], true)];
        let maps = ["viridis", "vik_r", "okabe-ito"].map(|map| map.parse::<MapName>().unwrap());
        let of = |(range, is_log), map: &MapName| ColorScale::new(Scale::new(range, is_log).unwrap(), map.colors());
        ranges.into_iter().flat_map(|range| maps.iter().map(move |map| of(range, map))).collect()
    }

    /// Draws a block on white with its corner at (20, 10), and returns a function that reads its pixels.
    fn drawn(block: &Block) -> impl Fn(i64, i64) -> [u8; 3] {
        let mut samples = vec![255; (3 * SIZE[0] * SIZE[1]) as usize];
        let mut canvas = Canvas::new(SIZE, 3, Bits::Eight, &mut samples).unwrap();
        block.draw([20, 10], [0; 3], &mut canvas);
        move |x, y| {
            let start = 3 * ((y + 10) * i64::from(SIZE[0]) + x + 20) as usize;
            [samples[start], samples[start + 1], samples[start + 2]]
        }
    }

    /// The left and top edge of the bar, its thickness and its colours.
    fn bar(block: &Block) -> ([i64; 2], i64, &[[u8; 3]]) {
        let bar = block.shapes.iter().find_map(|shape| match shape {
            Shape::Bar { place, thickness, colors, .. } => Some((*place, *thickness, &colors[..])),
            _ => None,
        });
        bar.unwrap()
    }

    /// At every tick, the pixels of the bar have exactly the colour that the map gives for the tick's number, and the
    /// tick is drawn beside them.
    #[test]
    fn at_each_tick_the_bar_has_the_color_of_its_number() {
        let em = 14.0;
        for scale in scales() {
            let block = vertical(&scale, "title", Some([9; 3]), em, SIZE.map(|side| side as f32));
            let pixel = drawn(&block);
            let ([left, top], width, colors) = bar(&block);
            let rows = colors.len();
            assert!((200..400).contains(&rows));
            let ticks = Ticks::of(scale.scale(), (rows as f32 / (2.3 * em)) as usize);
            assert!(ticks.labeled.len() >= 3, "{ticks:?}");
            for (value, _) in &ticks.labeled {
                let position = scale.scale().position(*value).unwrap();
                let row = top + (rows - 1 - pixel_of(position, rows)) as i64;
                let color = scale.color(*value).unwrap();
                assert_eq!(pixel(left, row), color, "{value}");
                assert_eq!(pixel(left + width - 1, row), color, "{value}");
                assert_eq!(pixel(left + width + 2, row), [0; 3], "no tick at {value}");
            }
            assert_eq!(pixel(left, top), scale.color_at(1.0));
            assert_eq!(pixel(left, top + rows as i64 - 1), scale.color_at(0.0));
        }
    }

    #[test]
    fn a_bar_that_lies_has_the_colors_too() {
        for scale in scales() {
            let block = horizontal(&scale, "", None, 14.0, SIZE.map(|side| side as f32));
            let pixel = drawn(&block);
            let ([left, top], _, colors) = bar(&block);
            let columns = colors.len();
            assert_eq!(pixel(left, top), scale.color_at(0.0));
            assert_eq!(pixel(left + columns as i64 - 1, top), scale.color_at(1.0));
            let near = pixel(left + columns as i64 / 2, top);
            assert!(near == scale.color_at(0.5) || columns % 2 == 0);
            assert!(block.width <= SIZE[0] as f32, "{}", block.width);
        }
    }
}
