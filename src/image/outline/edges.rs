//! Edges between pixels as smooth curves.

use std::ops::Range;

use glam::Vec2;

/// How often the curves are smoothed. Each time, a point moves towards the middle of its neighbours, so that stairs of
/// some pixels become straight.
pub(super) const PASSES: usize = 8;

/// An edge between two pixels: a point of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Point {
    /// In pixels; the centre of the first pixel is (0, 0).
    at: Vec2,
    /// How strong the line is here, from 0 to 1; 0 where there is no edge.
    strength: f32,
}

/// The edges between the pixels of some rows. Two edges that meet at the corner of four pixels are neighbours. Where more
/// than two meet, curves end.
pub(super) struct Edges {
    width: usize,
    rows: Range<usize>,
    /// The edge between each pixel and the one on its right, row by row, and then those between each pixel and the one
    /// below it.
    points: Vec<Point>,
}

/// What a curve does at the corner of four pixels.
#[derive(Clone, Copy)]
enum Next {
    /// There is no other edge.
    Nothing,
    /// One other edge continues it.
    Edge(usize),
    /// Several other edges meet it at this corner.
    Corner(Vec2),
}

impl Edges {
    /// Finds all edges of some rows; `strength` tells how strong the one between two pixels is, by their indices.
    pub(super) fn find(
        width: usize,
        rows: Range<usize>,
        strength: impl Fn(usize, usize) -> f32,
    ) -> Self {
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

    /// The two corners of pixels at which an edge ends, each by the column and the row (in these rows) of the pixel on
    /// its upper left; `None` at the border.
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

    /// What follows an edge at a corner.
    fn next(&self, index: usize, [i, j]: [usize; 2]) -> Next {
        let count = self.width * self.rows.len();
        let at = j * self.width + i;
        let around = [at, at + self.width, count + at, count + at + 1];
        let mut others = around
            .into_iter()
            .filter(|other| *other != index && self.points[*other].strength > 0.0);
        match (others.next(), others.next()) {
            (None, _) => Next::Nothing,
            (Some(other), None) => Next::Edge(other),
            (Some(_), Some(_)) => {
                Next::Corner(Vec2::new(i as f32 + 0.5, (self.rows.start + j) as f32 + 0.5))
            }
        }
    }

    /// The same edges as smooth curves.
    pub(super) fn smoothed(mut self) -> Self {
        let drawn: Vec<usize> =
            (0..self.points.len()).filter(|index| self.points[*index].strength > 0.0).collect();
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
            let moved: Vec<Point> =
                inner.iter().map(|(index, both)| self.mean(*index, *both)).collect();
            for ((index, _), point) in inner.iter().zip(moved) {
                self.points[*index] = point;
            }
        }
        self
    }

    /// A point half-way between where it is and the middle of its neighbours.
    fn mean(&self, index: usize, both: [usize; 2]) -> Point {
        let (here, [a, b]) = (self.points[index], both.map(|other| self.points[other]));
        Point {
            at: 0.5 * here.at + 0.25 * (a.at + b.at),
            strength: 0.5 * here.strength + 0.25 * (a.strength + b.strength),
        }
    }

    /// How much of each pixel of some rows is covered by lines of this width along the curves.
    pub(super) fn covered(&self, rows: Range<usize>, width: f32) -> Vec<f32> {
        let mut covered = vec![0.0_f32; self.width * rows.len()];
        // The largest distance in pixels, from the middle of a line, that it touches.
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
    let t = if length_squared > 0.0 {
        ((point - a).dot(along) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance(a + t * along)
}
