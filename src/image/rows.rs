//! Rows of an image that can be written independently.

use std::ops::Range;
use std::slice::ChunksMut;

use super::{Image, NO_ID, Pixel};

/// One row of an image, borrowed for writing. Layers that were not requested are `None`.
pub(crate) struct RowMut<'a> {
    pub(crate) color: &'a mut [[f32; 3]],
    pub(crate) alpha: Option<&'a mut [f32]>,
    pub(crate) depth: Option<&'a mut [f32]>,
    pub(crate) normal: Option<&'a mut [[f32; 3]]>,
    pub(crate) position: Option<&'a mut [[f32; 3]]>,
    pub(crate) albedo: Option<&'a mut [[f32; 3]]>,
    pub(crate) id: Option<&'a mut [u32]>,
    pub(crate) samples: Option<&'a mut [u32]>,
    pub(crate) variance: Option<&'a mut [f32]>,
}

impl RowMut<'_> {
    /// The coverage of a pixel with a single ray: 1 for a hit, 0 for a miss.
    pub(crate) fn coverage(id: u32) -> f32 {
        if id == NO_ID { 0.0 } else { 1.0 }
    }

    /// Whether there is a layer that [`RowMut::set`] fills and [`RowMut::set_averages`] does not.
    pub(crate) fn has_data(&self) -> bool {
        let vectors = self.normal.is_some() || self.position.is_some();
        vectors || self.depth.is_some() || self.id.is_some()
    }

    /// Stores the result of the pixel's only ray.
    pub(crate) fn set(&mut self, column: usize, pixel: &Pixel) {
        self.color[column] = pixel.color;
        put(&mut self.alpha, column, Self::coverage(pixel.id));
        put(&mut self.depth, column, pixel.depth);
        put(&mut self.normal, column, pixel.normal);
        put(&mut self.position, column, pixel.position);
        put(&mut self.albedo, column, pixel.albedo);
        put(&mut self.id, column, pixel.id);
        put(&mut self.samples, column, 1);
        put(&mut self.variance, column, 0.0);
    }

    /// Stores the averages of a pixel's samples.
    pub(crate) fn set_averages(&mut self, column: usize, averages: &Averages) {
        self.color[column] = averages.color;
        put(&mut self.alpha, column, averages.alpha);
        put(&mut self.albedo, column, averages.albedo);
        put(&mut self.samples, column, averages.samples);
        put(&mut self.variance, column, averages.variance);
    }
}

/// Averages over the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Averages {
    pub(crate) color: [f32; 3],
    pub(crate) alpha: f32,
    pub(crate) albedo: [f32; 3],
    /// The number of samples.
    pub(crate) samples: u32,
    /// The variance of the mean luminance.
    pub(crate) variance: f32,
}

fn put<T>(layer: &mut Option<&mut [T]>, column: usize, value: T) {
    if let Some(layer) = layer {
        layer[column] = value;
    }
}

impl Image {
    /// A range of rows, from top to bottom, each of which can be written independently.
    pub(crate) fn rows_mut(&mut self, rows: Range<usize>) -> Vec<RowMut<'_>> {
        let width = self.width as usize;
        let pixels = rows.start * width..rows.end * width;
        let mut alpha = cut(&mut self.alpha, &pixels, width);
        let mut depth = cut(&mut self.depth, &pixels, width);
        let mut normal = cut(&mut self.normal, &pixels, width);
        let mut position = cut(&mut self.position, &pixels, width);
        let mut albedo = cut(&mut self.albedo, &pixels, width);
        let mut id = cut(&mut self.id, &pixels, width);
        let mut samples = cut(&mut self.samples, &pixels, width);
        let mut variance = cut(&mut self.variance, &pixels, width);
        self.color[pixels]
            .chunks_mut(width)
            .map(|color| RowMut {
                color,
                alpha: next(&mut alpha),
                depth: next(&mut depth),
                normal: next(&mut normal),
                position: next(&mut position),
                albedo: next(&mut albedo),
                id: next(&mut id),
                samples: next(&mut samples),
                variance: next(&mut variance),
            })
            .collect()
    }
}

type Rows<'a, T> = Option<ChunksMut<'a, T>>;

fn cut<'a, T>(layer: &'a mut Option<Vec<T>>, pixels: &Range<usize>, width: usize) -> Rows<'a, T> {
    layer.as_mut().map(|layer| layer[pixels.clone()].chunks_mut(width))
}

fn next<'a, T>(rows: &mut Rows<'a, T>) -> Option<&'a mut [T]> {
    rows.as_mut().and_then(Iterator::next)
}
