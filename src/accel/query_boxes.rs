//! Boxes of spheres, from which a driver builds a structure of its own for ray queries. The kernels are in
//! `shaders/accel/ray_query.wgsl`.
//!
//! Vulkan says of a box only that it is reported if the ray meets it, not how the meeting is rounded. So each box holds
//! its sphere and the margin of trees, which is more than the error of any arithmetic that rounds as WGSL allows
//! (`slab.rs`); whether a driver's own arithmetic is as good is for the certificate to say.

use super::extent::Item;
use super::outliers::Margins;

/// A box for each sphere, in the order of a brick.
#[derive(Clone, Debug, PartialEq)]
pub struct QueryBoxes {
    boxes: Vec<[f32; 6]>,
}

impl QueryBoxes {
    /// The boxes of spheres (centre x, y, z in the scene's frame, radius), inflated by `margin`.
    #[must_use]
    pub fn of(spheres: &[[f32; 4]], margin: f32) -> Self {
        let items = Item::all(spheres, &Margins::one(margin));
        let of_item = |item: &Item| {
            let ([x, y, z], reach) = (item.center, item.reach);
            [x - reach, y - reach, z - reach, x + reach, y + reach, z + reach]
        };
        Self { boxes: items.iter().map(of_item).collect() }
    }

    /// The least coordinates and the greatest of each box.
    #[must_use]
    pub fn boxes(&self) -> &[[f32; 6]] {
        &self.boxes
    }
}
