//! Outlines: lines around shapes, drawn from the data layers of a picture.

use std::f32::consts::PI;
use std::ops::Range;

use glam::Vec2;

use crate::image::color::LinearRgb;
use crate::image::{Image, Layer, LayerSet, NO_ID};
use crate::parallel;
use crate::range::RangeError;

/// Lines at edges of the data layers, where the depth jumps or the normal changes between spheres.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Outline {
    /// Width of the outline in pixels: 0.5 to 64, and in a file 0 for none.
    pub width: f32,
    /// Colour of the outline.
    pub color: LinearRgb,
    /// The smallest jump in depth that makes an outline, as a fraction of the depth. At least 0.
    pub depth: f32,
    /// The smallest angle between normals that makes an outline: 0 to π, and in a file 0 to 180 degrees.
    #[serde(with = "crate::exact::degrees")]
    pub angle: f32,
}

impl Outline {
    /// Thin dark lines at jumps in depth, and no lines between surfaces that meet.
    #[must_use]
    pub fn thin() -> Self {
        Self { width: 1.2, color: LinearRgb::from_srgb8([0x34, 0x3a, 0x46]), depth: 0.01, angle: PI }
    }

    /// The layers that drawing them needs.
    pub(crate) fn layers(&self) -> LayerSet {
        let layers = LayerSet::COLOR.with(Layer::Alpha).with(Layer::Depth).with(Layer::Id);
        if self.angle < PI { layers.with(Layer::Normal) } else { layers }
    }

    /// Checks that every number is in its range.
    ///
    /// # Errors
    /// Returns an error if a number is out of range. The error names the first one.
    pub fn check(&self) -> Result<(), RangeError> {
        let within = RangeError::unless_within;
        within("width", self.width.into(), [0.5, 64.0], "from 0.5 to 64 pixels")?;
        within("depth", self.depth.into(), [0.0, 1e6], "0 or more")?;
        within("angle", self.angle.into(), [0.0, f64::from(PI) + 1e-6], "from 0 to 180 degrees").map(drop)
    }
}

impl Default for Outline {
    fn default() -> Self {
        Self { width: 2.0, color: LinearRgb::BLACK, depth: 0.01, angle: 0.6 }
    }
}

/// The hit at the centre of a pixel.
#[derive(Clone, Copy)]
struct Spot {
    id: u32,
    depth: f32,
    normal: [f32; 3],
}

impl Spot {
    fn is_nearer_than(self, other: Self) -> bool {
        self.id != NO_ID && (other.id == NO_ID || self.depth <= other.depth)
    }
}

/// Draws an outline along every edge between two pixels where one sphere hides another or their normals differ. Edges
/// between pixels form stairs, so the line follows a smooth curve through them. The distance of a pixel from that curve
/// gives the fraction that the line covers. Lines around things that are hardly wider than them are [faint](left_along).
/// A picture that lacks one of [`Outline::layers`] does not change.
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

/// The number of rows whose edges are computed at a time.
const BAND: usize = 128;

/// The fraction of each pixel that outlines cover. `None` if a layer is missing.
fn coverage(image: &Image, outline: &Outline) -> Option<Vec<f32>> {
    let size = [image.width() as usize, image.height() as usize];
    Some(coverage_by(size, outline.width, strengths(image, outline)?))
}

/// The strength of the line between two pixels of a picture, by their indices. `None` if a layer is missing.
fn strengths(image: &Image, outline: &Outline) -> Option<impl Fn(usize, usize) -> f32 + Sync> {
    let (ids, depths, normals) = (image.id()?, image.depth()?, image.normal());
    if normals.is_none() && outline.layers().contains(Layer::Normal) {
        return None;
    }
    let normal = move |index: usize| normals.map_or([0.0; 3], |normals| normals[index]);
    let spot = move |index: usize| Spot { id: ids[index], depth: depths[index], normal: normal(index) };
    let size = [image.width() as usize, image.height() as usize];
    Some(move |a, b| {
        let strength_of = |a: usize, b: usize| strength(spot(a), spot(b), outline);
        let is_nearer = |a: usize, b: usize| spot(a).is_nearer_than(spot(b));
        let full = strength_of(a, b);
        if full <= 0.0 {
            return full;
        }
        let edge = if is_nearer(a, b) { [a, b] } else { [b, a] };
        let extent =
            extent(size, edge, outline.width, |from, to| match (strength_of(from, to) > 0.0, is_nearer(from, to)) {
                (false, _) => Step::Within,
                (true, true) => Step::Off,
                (true, false) => Step::Behind,
            });
        full * left_along(extent, outline.width)
    })
}

/// A step from a pixel of a thing to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// To the same thing.
    Within,
    /// Off the thing, to what lies behind it.
    Off,
    /// To what hides the thing.
    Behind,
}

/// The number of pixels that a thing covers in the direction away from its edge, which is given by the pixel of the thing
/// and the one beyond the edge. At most [`wide`], which stands for more too, and for what is hidden or outside.
pub(crate) fn extent(
    [columns, height]: [usize; 2],
    [mut at, mut before]: [usize; 2],
    width: f32,
    step: impl Fn(usize, usize) -> Step,
) -> usize {
    let most = wide(width);
    for count in 1..most {
        let along = |at: usize, before: usize, size: usize| (2 * at).checked_sub(before).filter(|next| *next < size);
        let column = along(at % columns, before % columns, columns);
        let (Some(i), Some(j)) = (column, along(at / columns, before / columns, height)) else { return most };
        let next = j * columns + i;
        match step(at, next) {
            Step::Within => (before, at) = (at, next),
            Step::Off => return count,
            Step::Behind => return most,
        }
    }
    most
}

/// The number of pixels from which on a thing is wide, so that lines around it have their full strength.
fn wide(width: f32) -> usize {
    (7.5 * width).ceil() as usize
}

/// The fraction of its strength that a line keeps along a thing of this [extent]. The two lines at the sides of a thing as
/// wide as them would cover it, with gaps where pixels form stairs. It is never 0, so that curves do not end there.
pub(crate) fn left_along(extent: usize, width: f32) -> f32 {
    ((extent as f32 / width - 3.5) / 4.0).clamp(0.03, 1.0)
}

/// The distance along each axis, in pixels, beyond which an edge does not reach a pixel.
pub(crate) fn halo(width: f32) -> usize {
    PASSES + (0.5 * width).ceil() as usize + 2
}

/// The distance along each axis, in pixels, beyond which what is hit has no effect on the lines in a pixel.
pub(crate) fn reach(width: f32) -> usize {
    halo(width) + wide(width)
}

/// The fraction of each pixel that lines of this width cover, given the strength of the line between two pixels.
pub(crate) fn coverage_by(
    [columns, height]: [usize; 2],
    width: f32,
    strength: impl Fn(usize, usize) -> f32 + Sync,
) -> Vec<f32> {
    let bands = parallel::map_parts(parallel::ranges(height, BAND), |rows| {
        let halo = halo(width);
        let around = rows.start.saturating_sub(halo)..(rows.end + halo).min(height);
        Edges::find(columns, around, &strength).smoothed().covered(rows, width)
    });
    bands.concat()
}

/// A line fades in along this many times the smallest jump in depth: it is faint within things, and strong between them.
pub(crate) const FADE: f32 = 2.0;

/// The strength of the line between two pixels, from 0 to 1.
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
    if jump > least { ((jump - least) / (FADE * least)).clamp(0.0, 1.0) } else { 0.0 }
}

/// The number of smoothing passes of the curves. In each pass, a point moves towards the middle of its neighbours, so
/// that stairs of some pixels become straight.
const PASSES: usize = 8;

/// A point of a curve, which is an edge between two pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Point {
    /// The position in pixels. The centre of the first pixel is (0, 0).
    at: Vec2,
    /// The strength of the line here, from 0 to 1. It is 0 where there is no edge.
    strength: f32,
}

/// The edges between the pixels of some rows. Two edges that meet at the corner of four pixels are neighbours. If more
/// than two meet, the curves end there.
struct Edges {
    width: usize,
    rows: Range<usize>,
    /// The edge between each pixel and its right neighbour, row by row. Then the edge between each pixel and the one
    /// below it.
    points: Vec<Point>,
}

/// The continuation of a curve at the corner of four pixels.
#[derive(Clone, Copy)]
enum Next {
    /// The curve ends. There is no other edge.
    Nothing,
    /// One other edge continues the curve.
    Edge(usize),
    /// Several other edges meet the curve at this corner.
    Corner(Vec2),
}

impl Edges {
    /// Finds all edges of some rows. `strength` gives the strength of the line between two pixels, by their indices.
    fn find(width: usize, rows: Range<usize>, strength: impl Fn(usize, usize) -> f32) -> Self {
        let count = width * rows.len();
        let point = |index: usize| {
            let is_below = index >= count;
            let [i, j] = [index % count % width, rows.start + index % count / width];
            let other = if is_below { [i, j + 1] } else { [i + 1, j] };
            if other[0] >= width || other[1] >= rows.end {
                return Point::default();
            }
            let [a, b] = [[i, j], other].map(|[i, j]| Vec2::new(i as f32, j as f32));
            let strength = strength(j * width + i, other[1] * width + other[0]);
            Point { at: 0.5 * (a + b), strength }
        };
        Self { width, points: (0..2 * count).map(point).collect(), rows: rows.clone() }
    }

    /// The two corners of pixels at which an edge ends. Each is given by the column and the row (in these rows) of the
    /// pixel on its upper left. `None` at the border.
    fn corners(&self, index: usize) -> [Option<[usize; 2]>; 2] {
        let count = self.width * self.rows.len();
        let [i, j] = [index % count % self.width, index % count / self.width];
        let corner = |i: Option<usize>, j: Option<usize>| {
            let (i, j) = (i?, j?);
            (i + 1 < self.width && j + 1 < self.rows.len()).then_some([i, j])
        };
        if index < count {
            [corner(Some(i), j.checked_sub(1)), corner(Some(i), Some(j))]
        } else {
            [corner(i.checked_sub(1), Some(j)), corner(Some(i), Some(j))]
        }
    }

    /// The continuation of an edge at a corner.
    fn next(&self, index: usize, [i, j]: [usize; 2]) -> Next {
        let count = self.width * self.rows.len();
        let at = j * self.width + i;
        let around = [at, at + self.width, count + at, count + at + 1];
        let mut others = around.into_iter().filter(|other| *other != index && self.points[*other].strength > 0.0);
        match (others.next(), others.next()) {
            (None, _) => Next::Nothing,
            (Some(other), None) => Next::Edge(other),
            (Some(_), Some(_)) => Next::Corner(Vec2::new(i as f32 + 0.5, (self.rows.start + j) as f32 + 0.5)),
        }
    }

    /// Returns the same edges as smooth curves.
    fn smoothed(mut self) -> Self {
        let drawn: Vec<usize> = (0..self.points.len()).filter(|index| self.points[*index].strength > 0.0).collect();
        let neighbors = |index: usize| {
            let both = self.corners(index).map(|corner| match self.next(index, corner?) {
                Next::Edge(other) => Some(other),
                Next::Nothing | Next::Corner(_) => None,
            });
            Some([both[0]?, both[1]?])
        };
        let inner: Vec<(usize, [usize; 2])> =
            drawn.iter().filter_map(|index| Some((*index, neighbors(*index)?))).collect();
        for _ in 0..PASSES {
            let moved: Vec<Point> = inner.iter().map(|(index, both)| self.mean(*index, *both)).collect();
            for ((index, _), point) in inner.iter().zip(moved) {
                self.points[*index] = point;
            }
        }
        self
    }

    /// A point half-way between its position and the middle of its neighbours.
    fn mean(&self, index: usize, both: [usize; 2]) -> Point {
        let (here, [a, b]) = (self.points[index], both.map(|other| self.points[other]));
        Point {
            at: 0.5 * here.at + 0.25 * (a.at + b.at),
            strength: 0.5 * here.strength + 0.25 * (a.strength + b.strength),
        }
    }

    /// The fraction of each pixel of some rows that lines of the given width along the curves cover.
    fn covered(&self, rows: Range<usize>, width: f32) -> Vec<f32> {
        let mut covered = vec![0.0_f32; self.width * rows.len()];
        // The largest distance in pixels from the middle of a line at which the line touches a pixel.
        let reach = 0.5 * width + 0.5;
        let mut draw = |a: Vec2, b: Vec2, strength: f32| {
            let (low, high) = (a.min(b) - reach, a.max(b) + reach);
            let from = |low: f32, first: usize| (low.ceil().max(0.0) as usize).max(first);
            let until = |high: f32, end: usize| ((high.floor() + 1.0).max(0.0) as usize).min(end);
            for j in from(low.y, rows.start)..until(high.y, rows.end) {
                for i in from(low.x, 0)..until(high.x, self.width) {
                    let distance = distance(Vec2::new(i as f32, j as f32), a, b);
                    let share = strength * (reach - distance).clamp(0.0, 1.0);
                    let pixel = &mut covered[(j - rows.start) * self.width + i];
                    *pixel = pixel.max(share);
                }
            }
        };
        for (index, point) in self.points.iter().enumerate() {
            if point.strength <= 0.0 {
                continue;
            }
            let mut is_alone = true;
            for corner in self.corners(index).into_iter().flatten() {
                match self.next(index, corner) {
                    Next::Nothing => continue,
                    Next::Edge(other) => {
                        let other = self.points[other];
                        draw(point.at, other.at, point.strength.min(other.strength));
                    }
                    Next::Corner(corner) => draw(point.at, corner, point.strength),
                }
                is_alone = false;
            }
            if is_alone {
                draw(point.at, point.at, point.strength);
            }
        }
        covered
    }
}

/// The distance of a point from a line segment.
fn distance(point: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 { ((point - a).dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    point.distance(a + t * along)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A white picture of two spheres at the given depths. `is_second` tells which pixels, by index, show the second.
    fn two([width, height]: [usize; 2], depths: [f32; 2], is_second: impl Fn(usize) -> bool) -> Image {
        let ids: Vec<u32> = (0..width * height).map(|at| u32::from(is_second(at))).collect();
        let depths = ids.iter().map(|id| depths[*id as usize]).collect();
        let [colors, normals] = [[1.0; 3], [0.0, 0.0, 1.0]].map(|v| vec![v; width * height]);
        Image::from_layers([width as u32, height as u32], colors, depths, normals, ids).unwrap()
    }

    #[test]
    fn a_line_is_as_wide_as_asked_and_lies_on_the_edge() {
        for (width, wanted) in
            [(2.0, [1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0]), (3.0, [1.0, 1.0, 0.5, 0.0, 0.0, 0.5, 1.0, 1.0])]
        {
            let mut image = two([8, 1], [1.0, 2.0], |i| i >= 4);
            draw(&mut image, &Outline { width, ..Outline::default() });
            let found: Vec<f32> = image.color().iter().map(|c| c[0]).collect();
            assert_eq!(found, wanted, "{width}");
        }
    }

    #[test]
    fn where_nothing_is_hidden_there_is_no_line() {
        let mut image = two([8, 1], [1.0; 2], |i| i >= 4);
        draw(&mut image, &Outline::default());
        assert_eq!(image.color(), [[1.0; 3]; 8]);
        let red = LinearRgb::new([1.0, 0.0, 0.0]).unwrap();
        draw(&mut image, &Outline { depth: 0.0, angle: 0.0, color: red, ..Outline::default() });
        assert_eq!(image.color(), [[1.0; 3]; 8], "equal depths and normals");
    }

    /// The line along a slope has the same strength everywhere, and lies at the edge. A line along the stairs of the
    /// pixels would be up to half a pixel off.
    #[test]
    fn a_line_along_a_slope_has_no_stairs() {
        const SIZE: usize = 60;
        for slope in [0.13_f32, 0.47, 0.88] {
            let edge = |i: usize| 5.21 + slope * i as f32;
            let is_below = |index: usize| (index / SIZE) as f32 > edge(index % SIZE);
            let mut image = two([SIZE; 2], [1.0, 2.0], is_below);
            draw(&mut image, &Outline { width: 1.2, ..Outline::default() });
            let dark = |i: usize, j: usize| 1.0 - image.color()[j * SIZE + i][0];
            for i in 15..45 {
                let column = || (0..SIZE).map(|j| (j as f32, dark(i, j)));
                let total: f32 = column().map(|(_, dark)| dark).sum();
                let middle = column().map(|(j, dark)| j * dark).sum::<f32>() / total;
                // In a column that crosses it at an angle, a line of this width is wider.
                let wanted = 1.2 * slope.hypot(1.0);
                assert!((total - wanted).abs() < 0.25 * wanted, "{slope} {i}: {total}, {wanted}");
                assert!((middle - edge(i)).abs() < 0.3, "{slope} {i}: {middle}, {}", edge(i));
            }
        }
    }

    #[test]
    fn bands_do_not_show() {
        let (width, height) = (40, 3 * BAND + 7);
        let image =
            two([width, height], [1.0, 2.0], |index| (index % width) as f32 > 10.0 + 0.05 * (index / width) as f32);
        let outline = Outline::default();
        let at_once = Edges::find(width, 0..height, strengths(&image, &outline).unwrap());
        let at_once = at_once.smoothed().covered(0..height, outline.width);
        assert_eq!(coverage(&image, &outline).unwrap(), at_once);
    }
}
