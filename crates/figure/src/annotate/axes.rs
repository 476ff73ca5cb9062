//! The directions of x, y and z in the picture, as three arrows.

use glam::DVec3;

use super::canvas::{Block, Paint};
use super::font;
use super::place::Position;
use pinhole::camera::View;
use pinhole::camera::film::YAxis;

/// Arrows along x, y and z, as the camera sees their directions. All have the same length in space, without perspective.
#[derive(Clone, Debug, PartialEq)]
pub struct Axes {
    /// The position of the arrows.
    pub position: Position,
    /// The ends of the arrows for x, y and z: to the right, down, and away from the camera. An arrow across the picture has
    /// the length 1.
    ends: [[f32; 3]; 3],
}

/// The names and the colours of the axes in 8-bit sRGB: red, green and blue, as in most programs.
const AXES: [(&str, [u8; 3]); 3] = [("x", [0xd1, 0x3b, 0x3b]), ("y", [0x35, 0x96, 0x3a]), ("z", [0x3f, 0x65, 0xd8])];

/// The length of an arrow, relative to the size of text.
const LENGTH: f32 = 2.4;

/// The length of a head and half of its width, relative to the size of text.
const HEAD: [f32; 2] = [0.8, 0.3];

/// Half of the width of a shaft, relative to the size of text.
const SHAFT: f32 = 0.1;

/// The distance from the end of an arrow to the middle of its name, relative to the size of text.
const NAME: f32 = 0.55;

impl Axes {
    /// The axes of a picture, in its bottom left corner.
    #[must_use]
    pub fn new(view: &View<'_>) -> Self {
        let vectors = view.camera.vectors();
        let [right, up, forward] = [vectors.right, vectors.up, vectors.forward].map(DVec3::normalize_or_zero);
        let down = match view.film.y_axis() {
            YAxis::Up => -up,
            YAxis::Down => up,
        };
        let end = |axis: DVec3| [right, down, forward].map(|direction| axis.dot(direction) as f32);
        Self { position: Position::BOTTOM_LEFT, ends: DVec3::AXES.map(end) }
    }

    pub(super) fn block(&self, em: f32) -> Block {
        let mut block = Block::default();
        let height = 0.7 * em;
        let places = self.ends.map(|[x, y, _]| [x, y].map(|along| LENGTH * em * along));
        // A name stands behind the end of its arrow, or right of the middle if the arrow points at the eye.
        let names = places.map(|[x, y]| {
            let length = x.hypot(y);
            let out = if length > 0.2 * em { [x / length, y / length] } else { [0.7, -0.7] };
            [x + NAME * em * out[0], y + NAME * em * out[1]]
        });
        let low = |axis: usize| names.iter().map(|name| name[axis]).fold(0.0, f32::min) - 0.4 * em;
        let high = |axis: usize| names.iter().map(|name| name[axis]).fold(0.0, f32::max) + 0.4 * em;
        let middle = [-low(0), -low(1)];
        // What is farther away is drawn first.
        let mut order = [0, 1, 2];
        order.sort_by(|a: &usize, b: &usize| self.ends[*b][2].total_cmp(&self.ends[*a][2]));
        for axis in order {
            let ((name, color), [x, y], at) = (AXES[axis], places[axis], names[axis]);
            let length = x.hypot(y);
            let neck = if length > 0.0 { ((length - HEAD[0] * em) / length).max(0.0) } else { 0.0 };
            let point = |part: f32| [middle[0] + part * x, middle[1] + part * y];
            let paint = Paint::Color(color);
            block.line([point(0.0), point(neck)], [SHAFT * em; 2], paint);
            block.line([point(neck), point(1.0)], [HEAD[1] * em, 0.0], paint);
            let left = middle[0] + at[0] - 0.5 * font::width(name, em);
            block.text(name, [left, middle[1] + at[1] + 0.5 * height], em);
        }
        block.width = high(0) - low(0);
        block.height = high(1) - low(1);
        block
    }
}
