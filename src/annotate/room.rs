//! The part of a picture that a legend takes.

use super::place::{GAP, PADDING, origin};
use super::{Annotation, Annotations};

impl Annotations {
    /// The part of a picture of this size in pixels that must be free so that nothing lies under the legend: on the
    /// left, the right, the bottom and the top, as fractions of the width and the height. Of the sides the one is free
    /// that takes the smallest part; if that is more than `most`, or if there is no legend, none is.
    #[must_use]
    pub fn room_of_legend(&self, [width, height]: [u32; 2], most: f64) -> [f64; 4] {
        let none = [0.0; 4];
        let is_legend = |item: &Annotation| matches!(item, Annotation::Legend(_));
        let Some(index) = self.items.iter().position(is_legend) else { return none };
        let em = self.em([width, height]);
        let blocks = self.blocks([width, height]);
        let [left, top] = origin(&blocks, index, em, [width, height]).map(|place| place as f64);
        let block = &blocks[index].1;
        let around = f64::from((PADDING + GAP) * em) + 1.0;
        let [width, height] = [width, height].map(f64::from);
        let sides = [
            (left + f64::from(block.width) + around) / width,
            (width - left + around) / width,
            (height - top + around) / height,
            (top + f64::from(block.height) + around) / height,
        ];
        let least = (0..4).min_by(|a, b| sides[*a].total_cmp(&sides[*b]));
        match least.filter(|side| sides[*side] <= most) {
            Some(side) => std::array::from_fn(|i| if i == side { sides[i] } else { 0.0 }),
            None => none,
        }
    }
}
