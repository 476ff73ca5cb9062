//! The curves along which lines are drawn, and how much of a pixel they cover.
//!
//! Places are counted in halves of a pixel: the centre of pixel (i, j) of a window is (2i, 2j). So one of the two numbers of the
//! middle of an edge is odd, and both are odd at a corner where four pixels meet.

use super::super::rounding::{Interval, PAD, U};
use super::edges::{Given, NONE};

/// The relative error of one rounding: the host, other than a device, rounds to nearest.
const ROUNDED: f64 = 0.5 * U;

/// How often a curve is smoothed.
const PASSES: i32 = 8;

/// Two neighbours on a curve are at most this far apart, in pixels: in a straight row of pixels at first, and nearer ever
/// after, since a mean of points is not farther from another mean than the points were.
const APART: f64 = 1.0;

/// How far from a line, in pixels, what is in the picture may decide about it: as many edges as there are passes, by as
/// many halves of a pixel may a point have moved, and some more pixels in which it is decided where curves end.
const AROUND: usize = PASSES as usize + PASSES as usize / 2 + 4;

/// A part of a picture: its first column and row, and those behind its last.
pub(super) type Window = [[usize; 2]; 2];

/// The middle of an edge between two pixels on which there may be a line.
pub(super) struct Edge {
    /// In halves of a pixel from the first pixel of the window.
    place: [usize; 2],
    /// The strengths that its line may have.
    pub(super) strengths: Vec<Interval>,
}

/// A part of a curve.
struct Piece {
    ends: [[f64; 2]; 2],
    strength: Interval,
}

/// The point of a curve.
#[derive(Clone, Copy)]
struct Point {
    at: [f64; 2],
    strength: Interval,
}

/// What is at the end of an edge.
enum Meeting {
    /// No other edge, or the border of the window.
    Nothing,
    /// Another edge.
    One(usize),
    /// Several, in this corner.
    Several([f64; 2]),
}

/// The edges of a picture around some of its pixels.
pub(super) struct Edges {
    window: Window,
    pub(super) all: Vec<Edge>,
}

impl Edges {
    /// All edges that have to do with lines of this width in some pixels.
    pub(super) fn around(given: &Given<'_>, pixels: Window, width: f64) -> Self {
        let far = AROUND + (0.5 * width + APART).ceil() as usize;
        let [first, end] = pixels;
        let start: [usize; 2] = std::array::from_fn(|k| first[k].saturating_sub(far));
        let end: [usize; 2] = std::array::from_fn(|k| (end[k] + far).min(given.size[k]));
        let mut all = Vec::new();
        for j in start[1]..end[1] {
            for i in start[0]..end[0] {
                let doubled = [2 * (i - start[0]), 2 * (j - start[1])];
                for (other, place) in [
                    ([i + 1, j], [doubled[0] + 1, doubled[1]]),
                    ([i, j + 1], [doubled[0], doubled[1] + 1]),
                ] {
                    if other[0] < end[0] && other[1] < end[1] {
                        let strengths = given.strengths([i, j], other);
                        if !strengths.is_empty() {
                            all.push(Edge { place, strengths });
                        }
                    }
                }
            }
        }
        Self { window: [start, end], all }
    }

    /// Each pixel's share of lines along these edges; `chosen` is the index of each one's strength.
    pub(super) fn shares(&self, chosen: &[usize], pixels: Window, width: f64) -> Vec<Interval> {
        let [first, end] = pixels;
        let columns = end[0] - first[0];
        let mut shares = vec![NONE; columns * (end[1] - first[1])];
        let pieces = Curves::new(self, chosen).pieces();
        let largest = self.window[1][0].max(self.window[1][1]) as f64;
        let reach = 0.5 * width + 0.5;
        // Both ends are off by the drift. Which of the pixels are near a piece, and where on it the point is that is nearest
        // to one, takes three roundings of coordinates; the rest are fewer than 16 of lengths up to twice the reach.
        let error = PAD
            * (2.0_f64.sqrt() * drift(largest)
                + ROUNDED * (3.0 * largest + 16.0 * (2.0 * reach + APART)));
        for Piece { ends: [a, b], strength } in pieces {
            let range = |k: usize| {
                let far = reach + error;
                let low = (a[k].min(b[k]) - far).ceil().max(0.0) as usize;
                let high = (a[k].max(b[k]) + far).floor().max(-1.0) + 1.0;
                low.max(first[k])..(high as usize).min(end[k])
            };
            for j in range(1) {
                for i in range(0) {
                    let distance = distance([i as f64, j as f64], a, b);
                    let covered = |error: f64| (reach - distance + error).clamp(0.0, 1.0);
                    let here = &mut shares[(j - first[1]) * columns + i - first[0]];
                    let low = strength.low * covered(-error) * (1.0 - PAD * U);
                    let high = strength.high * covered(error) * (1.0 + PAD * U);
                    *here = Interval { low: here.low.max(low), high: here.high.max(high.min(1.0)) };
                }
            }
        }
        shares
    }
}

/// How far the f32 coordinates of a smoothed point, of which none is larger than this, may be from the exact ones.
///
/// After n passes they are multiples of 2^(−1−2n), and as long as f32 has them all, nothing is rounded. Then a pass rounds
/// twice, by half of what is between two numbers: the sum of both neighbours, which is twice as large and of which a quarter
/// counts, and the mean.
fn drift(largest: f64) -> f64 {
    let spacing = 2.0_f64.powf(largest.max(1.0).log2().ceil()) * U;
    let rounded = (1..=PASSES).filter(|pass| 2.0_f64.powi(-1 - 2 * pass) < spacing);
    rounded.count() as f64 * 0.75 * spacing
}

/// The distance of a point from a piece of a curve.
fn distance(point: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let difference = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let product = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
    let along = difference(b, a);
    let (from_a, from_b) = (difference(point, a), difference(point, b));
    if product(from_a, along) <= 0.0 {
        return from_a[0].hypot(from_a[1]);
    }
    if product(from_b, along) >= 0.0 {
        return from_b[0].hypot(from_b[1]);
    }
    // Beside the piece: the height of the triangle.
    (from_a[0] * along[1] - from_a[1] * along[0]).abs() / along[0].hypot(along[1])
}

/// The curves through edges that are there.
struct Curves {
    window: Window,
    /// The number of places in a row of the window.
    row: usize,
    rows: usize,
    places: Vec<[usize; 2]>,
    points: Vec<Point>,
    /// The point at each place, or a number behind the last.
    at: Vec<usize>,
}

impl Curves {
    fn new(Edges { window, all }: &Edges, chosen: &[usize]) -> Self {
        let [start, end] = *window;
        let [row, rows] = std::array::from_fn(|k| 2 * (end[k] - start[k]));
        let mut curves = Self {
            window: *window,
            row,
            rows,
            places: Vec::new(),
            points: Vec::new(),
            at: vec![usize::MAX; row * rows],
        };
        for (edge, chosen) in all.iter().zip(chosen) {
            let strength = edge.strengths[*chosen];
            if strength != NONE {
                curves.at[edge.place[1] * row + edge.place[0]] = curves.points.len();
                curves.places.push(edge.place);
                curves.points.push(Point { at: curves.point(edge.place), strength });
            }
        }
        curves
    }

    /// A place in pixels of the picture.
    fn point(&self, place: [usize; 2]) -> [f64; 2] {
        std::array::from_fn(|k| self.window[0][k] as f64 + 0.5 * place[k] as f64)
    }

    /// What meets an edge at its two ends.
    fn meetings(&self, edge: usize) -> [Meeting; 2] {
        let place = self.places[edge];
        // The line between two pixels side by side runs up and down.
        let along = usize::from(place[0] % 2 == 1);
        [false, true].map(|is_after| {
            let mut corner = place;
            corner[along] = match (is_after, place[along]) {
                (false, 0) => return Meeting::Nothing,
                (false, at) => at - 1,
                (true, at) => at + 1,
            };
            self.meeting(edge, corner)
        })
    }

    fn meeting(&self, edge: usize, [x, y]: [usize; 2]) -> Meeting {
        // A window of n pixels has corners up to place 2n - 3.
        if x + 1 >= self.row - 1 || y + 1 >= self.rows - 1 {
            return Meeting::Nothing;
        }
        let places = [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
        let there = places.map(|[x, y]| self.at[y * self.row + x]);
        let mut others = there.into_iter().filter(|point| *point != usize::MAX && *point != edge);
        match (others.next(), others.next()) {
            (None, _) => Meeting::Nothing,
            (Some(other), None) => Meeting::One(other),
            (Some(_), Some(_)) => Meeting::Several(self.point([x, y])),
        }
    }

    /// Smooths the curves, and cuts them at their points.
    ///
    /// In each pass, a point between two others moves half of the way to the middle between them, and so does its
    /// strength. Ends stay.
    fn pieces(mut self) -> Vec<Piece> {
        let meetings: Vec<[Meeting; 2]> =
            (0..self.points.len()).map(|edge| self.meetings(edge)).collect();
        for _ in 0..PASSES {
            let before = self.points.clone();
            for (edge, ends) in meetings.iter().enumerate() {
                if let [Meeting::One(a), Meeting::One(b)] = ends {
                    let [here, a, b] = [edge, *a, *b].map(|other| before[other]);
                    let mean = |here: f64, a: f64, b: f64| 0.5 * here + 0.25 * (a + b);
                    self.points[edge] = Point {
                        at: std::array::from_fn(|k| mean(here.at[k], a.at[k], b.at[k])),
                        strength: Interval {
                            low: mean(here.strength.low, a.strength.low, b.strength.low),
                            high: mean(here.strength.high, a.strength.high, b.strength.high),
                        },
                    };
                }
            }
        }
        // Strengths are not above 1, so that each pass rounds them by at most twice 2⁻²³.
        let rounded = |Interval { low, high }: Interval| {
            let error = f64::from(2 * PASSES) * PAD * U;
            Interval { low: (low - error).max(0.0), high: (high + error).min(1.0) }
        };
        let mut pieces = Vec::new();
        for (edge, ends) in meetings.iter().enumerate() {
            let Point { at: here, strength } = self.points[edge];
            let mut is_alone = true;
            for end in ends {
                let (there, strength) = match end {
                    Meeting::Nothing => continue,
                    Meeting::One(other) => {
                        let Point { at, strength: Interval { low, high } } = self.points[*other];
                        let (low, high) = (low.min(strength.low), high.min(strength.high));
                        (at, Interval { low, high })
                    }
                    Meeting::Several(corner) => (*corner, strength),
                };
                is_alone = false;
                pieces.push(Piece { ends: [here, there], strength: rounded(strength) });
            }
            if is_alone {
                pieces.push(Piece { ends: [here; 2], strength: rounded(strength) });
            }
        }
        pieces
    }
}
