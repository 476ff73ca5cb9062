//! The arrow of a legend, which shows how long an arrow of the picture is for a round number.

use super::canvas::{Block, LINE, Paint};
use super::font;
use super::place::Position;
use super::scale_bar::number;
use super::ticks::round_down;
use pinhole_data::added::ArrowKey;

/// An arrow with the length of those that show a round number.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyArrow {
    /// The position of the arrow.
    pub position: Position,
    /// The name of the vector.
    pub name: String,
    /// The colour in 8-bit sRGB.
    pub color: [u8; 3],
    value: f64,
    pixels: f64,
}

/// The length of a head and half of its width, relative to the size of text.
const HEAD: [f32; 2] = [0.7, 0.3];

impl KeyArrow {
    /// The arrow of a picture that is `width` pixels wide, where a length of 1 takes `pixels_per_unit` pixels. It is
    /// at most an eighth as long. `None` if no number has an arrow of such a length.
    #[must_use]
    pub fn new(key: &ArrowKey, pixels_per_unit: f64, width: u32) -> Option<Self> {
        let pixels_per_value = key.scale * pixels_per_unit;
        let longest = f64::from(width) / 8.0 / pixels_per_value;
        let value = (longest.is_normal() && longest > 0.0).then(|| round_down(longest))?;
        Some(Self {
            position: Position::RIGHT,
            name: key.name.clone(),
            color: key.color.to_srgb8(),
            value,
            pixels: value * pixels_per_value,
        })
    }

    /// The longest arrow of a picture that is `width` pixels wide, with a long number, for the room that it needs.
    pub(super) fn longest(name: &str, width: u32) -> Self {
        let (color, pixels) = ([0; 3], f64::from(width) / 8.0);
        Self { position: Position::RIGHT, name: name.to_owned(), color, value: 2e-9, pixels }
    }

    /// The number that the arrow shows.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The length in pixels.
    #[must_use]
    pub fn pixels(&self) -> f64 {
        self.pixels
    }

    pub(super) fn block(&self, em: f32) -> Block {
        let mut block = Block::default();
        let text = format!("{} {}", self.name, number(self.value));
        block.text(&text, [0.0, 0.95 * em], em);
        let (end, middle) = (self.pixels as f32, (LINE + 0.1 + HEAD[1]) * em);
        let paint = Paint::Color(self.color);
        let [head, half] = HEAD.map(|factor| factor * em.min(end / HEAD[0]));
        let line = (0.12 * em).max(1.0);
        block.rect([0.0, middle - 0.5 * line, end - head, middle + 0.5 * line], paint);
        // The head is made of thin columns, whose edges are blended.
        let columns = head.ceil().max(1.0);
        for column in 0..columns as u32 {
            let [from, to] = [column, column + 1].map(|place| place as f32 / columns);
            let high = half * (1.0 - 0.5 * (from + to));
            let left = end - head;
            block.rect([left + from * head, middle - high, left + to * head, middle + high], paint);
        }
        block.width = font::width(&text, em).max(end);
        block.height = middle + half;
        block
    }
}
