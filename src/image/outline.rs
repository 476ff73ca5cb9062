//! Outlines: lines around shapes, which are found from the data layers of a picture.

mod edges;

use crate::image::{Image, Layer, LayerSet, NO_ID};
use crate::parallel;
use crate::render::Outline;
use edges::Edges;

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
/// Edges between pixels are stairs; the line follows the smooth curve through them, and how much of a pixel it covers
/// follows from its distance to that curve. A picture that lacks one of
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

/// The number of rows whose edges are held at a time.
const BAND: usize = 128;

/// The fraction of each pixel that outlines cover; `None` if a layer is missing.
fn coverage(image: &Image, outline: &Outline) -> Option<Vec<f32>> {
    let layers = Layers { ids: image.id()?, depths: image.depth()?, normals: image.normal()? };
    let [width, height] = [image.width() as usize, image.height() as usize];
    let bands = parallel::map_parts(parallel::ranges(height, BAND), |rows| {
        // What is farther away than this reaches no row of the band.
        let halo = edges::PASSES + (0.5 * outline.width).ceil() as usize + 2;
        let around = rows.start.saturating_sub(halo)..(rows.end + halo).min(height);
        let strength = |a: usize, b: usize| strength(layers.spot(a), layers.spot(b), outline);
        Edges::find(width, around, strength).smoothed().covered(rows, outline.width)
    });
    Some(bands.concat())
}

/// The layers from which edges are found.
struct Layers<'a> {
    ids: &'a [u32],
    depths: &'a [f32],
    normals: &'a [[f32; 3]],
}

impl Layers<'_> {
    fn spot(&self, index: usize) -> Spot {
        Spot { id: self.ids[index], depth: self.depths[index], normal: self.normals[index] }
    }
}

/// How strong the line between two pixels is, from 0 to 1. A line fades in over jumps in depth from the least one to
/// half more than it, so that it is not dashed where a jump is about that large.
fn strength(a: Spot, b: Spot, outline: &Outline) -> f32 {
    if a.id == b.id {
        return 0.0;
    }
    if a.id == NO_ID || b.id == NO_ID {
        return 1.0;
    }
    let cosine: f32 = a.normal.iter().zip(b.normal).map(|(x, y)| x * y).sum();
    if cosine < outline.angle.cos() {
        return 1.0;
    }
    let (jump, least) = ((a.depth - b.depth).abs(), outline.depth * a.depth.min(b.depth));
    if jump > least { ((jump - least) / (0.5 * least)).clamp(0.0, 1.0) } else { 0.0 }
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

    /// The line along a slope is equally strong everywhere, and lies where the edge is: a line along the stairs of the
    /// pixels would be up to half a pixel off.
    #[test]
    fn a_line_along_a_slope_has_no_stairs() {
        const SIZE: usize = 60;
        for slope in [0.13_f32, 0.47, 0.88] {
            let edge = |i: usize| 5.21 + slope * i as f32;
            let id = |index: usize| u32::from((index / SIZE) as f32 > edge(index % SIZE));
            let ids: Vec<u32> = (0..SIZE * SIZE).map(id).collect();
            let depths = ids.iter().map(|id| 1.0 + *id as f32).collect();
            let size = [SIZE as u32; 2];
            let normals = vec![[0.0, 0.0, 1.0]; SIZE * SIZE];
            let mut image =
                Image::from_layers(size, vec![[1.0; 3]; SIZE * SIZE], depths, normals, ids)
                    .unwrap();
            draw(&mut image, &Outline { width: 1.2, ..Outline::default() });
            let dark = |i: usize, j: usize| 1.0 - image.color()[j * SIZE + i][0];
            for i in 15..45 {
                let column = || (0..SIZE).map(|j| (j as f32, dark(i, j)));
                let total: f32 = column().map(|(_, dark)| dark).sum();
                let middle = column().map(|(j, dark)| j * dark).sum::<f32>() / total;
                // A line of this width is wider in a column that crosses it at an angle.
                let wanted = 1.2 * slope.hypot(1.0);
                assert!((total - wanted).abs() < 0.25 * wanted, "{slope} {i}: {total}, {wanted}");
                assert!((middle - edge(i)).abs() < 0.3, "{slope} {i}: {middle}, {}", edge(i));
            }
        }
    }

    #[test]
    fn bands_do_not_show() {
        let (width, height) = (40, 3 * BAND + 7);
        let id =
            |index: usize| u32::from((index % width) as f32 > 10.0 + 0.05 * (index / width) as f32);
        let ids: Vec<u32> = (0..width * height).map(id).collect();
        let depths = ids.iter().map(|id| 1.0 + *id as f32).collect();
        let normals = vec![[0.0, 0.0, 1.0]; width * height];
        let colors = vec![[1.0; 3]; width * height];
        let image = Image::from_layers([width as u32, height as u32], colors, depths, normals, ids)
            .unwrap();
        let outline = Outline::default();
        let layers = Layers {
            ids: image.id().unwrap(),
            depths: image.depth().unwrap(),
            normals: image.normal().unwrap(),
        };
        let at_once = Edges::find(width, 0..height, |a, b| {
            strength(layers.spot(a), layers.spot(b), &outline)
        });
        let at_once = at_once.smoothed().covered(0..height, outline.width);
        assert_eq!(coverage(&image, &outline).unwrap(), at_once);
    }
}
