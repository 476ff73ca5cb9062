//! Legends, scale bars, axes and labels, drawn over an encoded picture.
//!
//! Annotations are drawn on the samples of a PNG, after exposure and tone curve, so that neither changes them: the bar
//! of a legend has exactly the colours of the map. Light does make spheres brighter or darker than the bar; with flat
//! shading they have its colours. Nothing is ever drawn on layers of data and EXR pictures.
//!
//! ```
//! use pinhole_figure::annotate::{Annotation, Annotations, Canvas, Label, Position};
//! use pinhole::image::encoding::Bits;
//!
//! let mut rgb = vec![255; 3 * 200 * 100];
//! let mut canvas = Canvas::new([200, 100], 3, Bits::Eight, &mut rgb).unwrap();
//! let label = Label { text: "t = 5 µs".to_owned(), position: Position::TOP_LEFT };
//! Annotations::default().with(Annotation::Label(label)).draw(&mut canvas);
//! assert!(rgb.iter().any(|sample| *sample < 128));
//! ```

mod axes;
mod canvas;
mod font;
mod key_arrow;
mod legend;
mod legend_scale;
mod place;
mod plan;
mod scale_bar;
mod ticks;

use pinhole::image::encoding::Encoding;

pub use axes::Axes;
pub use canvas::Canvas;
pub use font::missing_characters;
pub use key_arrow::KeyArrow;
pub use legend::Legend;
pub use place::{Anchor, Panel, Position, PositionError};
pub use plan::{AnnotationError, AnnotationPlan, AxesPlan, LegendPlan, ScaleBarPlan, TextPlan};
pub use scale_bar::{ScaleBar, ScaleBarError, pixels_per_unit};

use canvas::Block;
use place::{GAP, PADDING, origin};

/// An annotation of a picture.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Annotation {
    /// The meaning of colours.
    Legend(Legend),
    /// The length of the arrows of a vector.
    KeyArrow(KeyArrow),
    /// The size of a length in the picture.
    ScaleBar(ScaleBar),
    /// The directions of x, y and z.
    Axes(Axes),
    /// A text.
    Label(Label),
}

/// All annotations of a picture. Those with the same [`Anchor`] are stacked in this order.
#[derive(Clone, Debug, PartialEq)]
pub struct Annotations {
    /// The annotations.
    pub items: Vec<Annotation>,
    /// The size of text relative to the default, which is 1/36 of the picture's height and at least 10 pixels.
    pub text_scale: f32,
    /// The colour of text and lines in 8-bit sRGB. Without one, it is black or white, whichever is easier to read.
    pub color: Option<[u8; 3]>,
    /// Whether panels lie behind annotations.
    pub panel: Panel,
}

impl Default for Annotations {
    fn default() -> Self {
        Self { items: Vec::new(), text_scale: 1.0, color: None, panel: Panel::Auto }
    }
}

impl Annotations {
    /// The smallest and the largest [`Annotations::text_scale`].
    pub const TEXT_SCALES: [f64; 2] = [0.2, 10.0];

    /// Returns these annotations with one more.
    #[must_use]
    pub fn with(mut self, item: Annotation) -> Self {
        self.items.push(item);
        self
    }

    /// Returns true if there are no annotations.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// The texts that the user chose, for a search for characters that the font lacks; see [`missing_characters`].
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.items.iter().map(|item| match item {
            Annotation::Legend(legend) => legend.title(),
            Annotation::KeyArrow(arrow) => &arrow.name,
            Annotation::ScaleBar(bar) => &bar.unit,
            Annotation::Axes(_) => "",
            Annotation::Label(label) => &label.text,
        })
    }

    /// Draws the annotations over a picture.
    pub fn draw(&self, canvas: &mut Canvas<'_>) {
        let size = canvas.size();
        place::draw(&self.blocks(size), self.em(size), self.color, self.panel, canvas);
    }

    /// Draws the annotations over the samples of a picture of this size with an encoding: RGB or RGBA, row by row from the
    /// top. Does nothing if there are not as many samples.
    pub fn draw_over(&self, size: [u32; 2], encoding: &Encoding, samples: &mut [u8]) {
        let channels = if encoding.transparent { 4 } else { 3 };
        if let Some(mut canvas) = Canvas::new(size, channels, encoding.bits, samples) {
            self.draw(&mut canvas);
        }
    }

    fn blocks(&self, size: [u32; 2]) -> Vec<(Position, Block)> {
        let em = self.em(size);
        let block = |item: &Annotation| match item {
            Annotation::Legend(legend) => (legend.position, legend.block(em, size)),
            Annotation::KeyArrow(arrow) => (arrow.position, arrow.block(em)),
            Annotation::ScaleBar(bar) => (bar.position, bar.block(em)),
            Annotation::Axes(axes) => (axes.position, axes.block(em)),
            Annotation::Label(label) => (label.position, label.block(em)),
        };
        self.items.iter().map(block).collect()
    }

    /// The size of text in pixels. The letter M is about 0.7 of it high.
    fn em(&self, [width, height]: [u32; 2]) -> f32 {
        let [low, high] = Self::TEXT_SCALES.map(|scale| scale as f32);
        let scale = if self.text_scale.is_nan() { 1.0 } else { self.text_scale.clamp(low, high) };
        // The text of a picture that is much higher than wide must fit its width.
        let height = (height as f32).min(1.5 * width as f32);
        scale * (height / 36.0).max(10.0)
    }
}

impl Annotations {
    /// The part of a picture of this size in pixels that must stay free so that nothing lies under the legend, its colours
    /// and its arrow: on the left, right, bottom and top, as fractions of the width and the height. Only the side with
    /// the smallest part is free. All are 0 if this part is larger than `most`, or if there is no legend.
    pub(crate) fn room_of_legend(&self, [width, height]: [u32; 2], most: f64) -> [f64; 4] {
        let none = [0.0; 4];
        let is_legend = |item: &Annotation| matches!(item, Annotation::Legend(_) | Annotation::KeyArrow(_));
        let em = self.em([width, height]);
        let blocks = self.blocks([width, height]);
        let around = f64::from((PADDING + GAP) * em) + 1.0;
        let sides_of = |index: usize| {
            let [left, top] = origin(&blocks, index, em, [width, height]).map(|place| place as f64);
            let block = &blocks[index].1;
            let [width, height] = [width, height].map(f64::from);
            [
                (left + f64::from(block.width) + around) / width,
                (width - left + around) / width,
                (height - top + around) / height,
                (top + f64::from(block.height) + around) / height,
            ]
        };
        let parts = (0..self.items.len()).filter(|index| is_legend(&self.items[*index])).map(sides_of);
        let Some(sides) = parts.reduce(|a, b| std::array::from_fn(|side| a[side].max(b[side]))) else { return none };
        let least = (0..4).min_by(|a, b| sides[*a].total_cmp(&sides[*b]));
        match least.filter(|side| sides[*side] <= most) {
            Some(side) => std::array::from_fn(|i| if i == side { sides[i] } else { 0.0 }),
            None => none,
        }
    }
}

/// A text at a place of the picture. It may have several lines.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct Label {
    /// The text.
    pub text: String,
    /// The position of the text.
    #[serde(default = "Position::top_left")]
    pub position: Position,
}

impl Label {
    fn block(&self, em: f32) -> Block {
        let mut block = Block::default();
        // Labels are somewhat larger than the numbers of a legend.
        block.lines(&self.text, 1.15 * em);
        block
    }
}
