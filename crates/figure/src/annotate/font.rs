//! The embedded font: the widths of texts, and their coverage of pixels.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, GlyphId, PxScale, point};

/// A part of Open Sans; see `font/README.md`.
static FONT: LazyLock<Option<FontRef<'static>>> =
    LazyLock::new(|| FontRef::try_from_slice(include_bytes!("font/OpenSans-subset.ttf")).ok());

/// Half the height of digits and capital letters, relative to the size of the text.
pub(super) const HALF_CAPITAL: f32 = 0.357;

/// The size of raised and lowered digits, relative to that of the text.
const SMALL: f32 = 0.64;

/// The glyph for a character: another character, which may be smaller and moved up.
struct ScaledGlyph {
    glyph: char,
    scale: f32,
    /// Distance by which the glyph is moved up, relative to the size of the text.
    up: f32,
}

impl ScaledGlyph {
    fn of(c: char) -> Self {
        let digit = |zero: u32| char::from_digit(u32::from(c) - zero, 10);
        let (small, up) = match c {
            '⁰' | '⁴'..='⁹' => (digit(0x2070), 0.36),
            '¹' => (Some('1'), 0.36),
            '²' => (Some('2'), 0.36),
            '³' => (Some('3'), 0.36),
            '⁺' => (Some('+'), 0.36),
            '⁻' => (Some('−'), 0.36),
            '₀'..='₉' => (digit(0x2080), -0.12),
            _ => (None, 0.0),
        };
        match small {
            Some(glyph) => Self { glyph, scale: SMALL, up },
            // Control characters would be drawn as boxes. Line breaks do not reach this function.
            None => Self { glyph: if c.is_control() { ' ' } else { c }, scale: 1.0, up: 0.0 },
        }
    }
}

/// The characters of a text that the embedded font lacks, each once; they are drawn as boxes.
#[must_use]
pub fn missing_characters(text: &str) -> Vec<char> {
    let mut missing = Vec::new();
    let Some(font) = FONT.as_ref() else { return missing };
    for c in text.chars() {
        if font.glyph_id(ScaledGlyph::of(c).glyph) == GlyphId(0) && !missing.contains(&c) {
            missing.push(c);
        }
    }
    missing
}

/// The width of one line of text in pixels; `em` is the size of the text.
pub(super) fn width(text: &str, em: f32) -> f32 {
    let Some(font) = FONT.as_ref() else { return 0.0 };
    let units = font.units_per_em().unwrap_or(1.0);
    let advance = |c| {
        let ScaledGlyph { glyph, scale, .. } = ScaledGlyph::of(c);
        font.h_advance_unscaled(font.glyph_id(glyph)) * scale
    };
    text.chars().map(advance).sum::<f32>() * em / units
}

/// Draws one line of text by calling `cover` with pixels and their coverage. `x` is the start of the text, and
/// `baseline` the line on which letters stand.
pub(super) fn draw(text: &str, [x, baseline]: [f32; 2], em: f32, mut cover: impl FnMut(i64, i64, f32)) {
    let Some(font) = FONT.as_ref() else { return };
    let units = font.units_per_em().unwrap_or(1.0);
    let mut x = x;
    for c in text.chars() {
        let ScaledGlyph { glyph, scale, up } = ScaledGlyph::of(c);
        let id = font.glyph_id(glyph);
        // `ab_glyph` scales by the height of a line.
        let height = PxScale::from(em * scale * font.height_unscaled() / units);
        let placed = id.with_scale_and_position(height, point(x, baseline - up * em));
        x += font.h_advance_unscaled(id) * scale * em / units;
        if let Some(outlined) = font.outline_glyph(placed) {
            let bounds = outlined.px_bounds();
            let (left, top) = (bounds.min.x as i64, bounds.min.y as i64);
            outlined.draw(|x, y, coverage| cover(left + i64::from(x), top + i64::from(y), coverage));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_what_legends_of_the_sciences_need() {
        assert!(FONT.is_some());
        let text = "AZaz09 µÅ·²³⁰⁴⁹⁻₀₉−×±°αωΩΔσäéñß‰√∞≤≥…“”";
        assert_eq!(missing_characters(text), []);
        assert_eq!(missing_characters("a水b水🙂"), ['水', '🙂']);
    }

    #[test]
    fn digits_have_one_width_and_texts_scale() {
        let widths = ["0", "1", "8"].map(|digit| width(digit, 20.0));
        assert!(widths.iter().all(|w| (w - widths[0]).abs() < 1e-4), "{widths:?}");
        assert!((width("10⁻³", 40.0) - 2.0 * width("10⁻³", 20.0)).abs() < 1e-3);
        assert!(width("10³", 20.0) < width("103", 20.0));
    }

    /// Capital letters stand on the baseline and have twice the height `HALF_CAPITAL`.
    #[test]
    fn capitals_stand_on_the_baseline() {
        let (mut top, mut bottom) = (i64::MAX, i64::MIN);
        draw("H", [3.0, 100.0], 100.0, |_, y, coverage| {
            if coverage > 0.5 {
                (top, bottom) = (top.min(y), bottom.max(y));
            }
        });
        assert_eq!(bottom, 99);
        assert!((100 - top - (200.0 * HALF_CAPITAL) as i64).abs() <= 1, "{top}");
    }
}
