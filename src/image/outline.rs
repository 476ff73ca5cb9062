//! Outlines: lines around shapes, which are found from the data layers of a picture.

use crate::image::{Image, Layer, LayerSet, NO_ID};
use crate::render::Outline;

/// The layers from which outlines are found.
pub(crate) const LAYERS: LayerSet = LayerSet::DATA.with(Layer::Alpha);

/// The hit at the centre of a pixel.
#[derive(Clone, Copy)]
struct Spot {
    id: u32,
    depth: f32,
    normal: [f32; 3],
}

/// Draws an outline along every edge between two pixels where one sphere hides another or where their normals differ.
/// How much of a pixel the line covers follows from its distance to the nearest edge. A picture that lacks one of
/// [`LAYERS`] is not changed.
pub(crate) fn draw(image: &mut Image, outline: &Outline) {
    let Some(coverage) = coverage(image, outline) else { return };
    let line = outline.color.to_array();
    for (color, share) in image.color_mut().iter_mut().zip(&coverage) {
        for (c, line) in color.iter_mut().zip(line) {
            *c += share * (line - *c);
        }
    }
    if let Some(alpha) = image.alpha_mut() {
        for (alpha, share) in alpha.iter_mut().zip(&coverage) {
            *alpha += share * (1.0 - *alpha);
        }
    }
}

/// The fraction of each pixel that outlines cover; `None` if a layer is missing.
fn coverage(image: &Image, outline: &Outline) -> Option<Vec<f32>> {
    let (ids, depths, normals) = (image.id()?, image.depth()?, image.normal()?);
    let (width, height) = (image.width() as usize, image.height() as usize);
    let spot = |index: usize| Spot { id: ids[index], depth: depths[index], normal: normals[index] };
    let mut covered = vec![0.0_f32; width * height];
    // The largest distance in pixels, from the middle of an edge, that a line touches.
    let reach = 0.5 * outline.width + 0.5;
    let mut cover = |x: f32, y: f32| {
        let from = |center: f32| (center - reach).ceil().max(0.0) as usize;
        let until = |center: f32, end: usize| ((center + reach).floor() as usize + 1).min(end);
        for j in from(y)..until(y, height) {
            for i in from(x)..until(x, width) {
                let distance = (i as f32 - x).hypot(j as f32 - y);
                let share = (reach - distance).clamp(0.0, 1.0);
                let pixel = &mut covered[j * width + i];
                *pixel = pixel.max(share);
            }
        }
    };
    for j in 0..height {
        for i in 0..width {
            let here = spot(j * width + i);
            if i + 1 < width && is_edge(here, spot(j * width + i + 1), outline) {
                cover(i as f32 + 0.5, j as f32);
            }
            if j + 1 < height && is_edge(here, spot((j + 1) * width + i), outline) {
                cover(i as f32, j as f32 + 0.5);
            }
        }
    }
    Some(covered)
}

fn is_edge(a: Spot, b: Spot, outline: &Outline) -> bool {
    if a.id == b.id {
        return false;
    }
    if a.id == NO_ID || b.id == NO_ID {
        return true;
    }
    let cosine: f32 = a.normal.iter().zip(b.normal).map(|(x, y)| x * y).sum();
    (a.depth - b.depth).abs() > outline.depth * a.depth.min(b.depth) || cosine < outline.angle.cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::color::LinearRgb;

    /// A white picture of one row: one sphere on the left, and another on the right that may lie farther away.
    fn row(depths: [f32; 8]) -> Image {
        let ids = (0..8).map(|i| u32::from(i >= 4)).collect();
        let white = vec![[1.0; 3]; 8];
        Image::from_layers([8, 1], white, depths.to_vec(), vec![[0.0, 0.0, 1.0]; 8], ids).unwrap()
    }

    #[test]
    fn a_line_is_as_wide_as_asked_and_lies_on_the_edge() {
        for (width, wanted) in [
            (2.0, [1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
            (3.0, [1.0, 1.0, 0.5, 0.0, 0.0, 0.5, 1.0, 1.0]),
        ] {
            let mut image = row([1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
            draw(&mut image, &Outline { width, ..Outline::default() });
            let found: Vec<f32> = image.color().iter().map(|c| c[0]).collect();
            assert_eq!(found, wanted, "{width}");
        }
    }

    #[test]
    fn where_nothing_is_hidden_there_is_no_line() {
        let mut image = row([1.0; 8]);
        draw(&mut image, &Outline::default());
        assert_eq!(image.color(), [[1.0; 3]; 8]);
        let red = LinearRgb::new([1.0, 0.0, 0.0]).unwrap();
        draw(&mut image, &Outline { depth: 0.0, angle: 0.0, color: red, ..Outline::default() });
        assert_eq!(image.color(), [[1.0; 3]; 8], "equal depths and normals");
    }
}
