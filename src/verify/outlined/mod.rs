//! The check of outlines: what the lines that are drawn into a finished picture may make of its colour and alpha.
//!
//! Lines are drawn by the host and not by the device, from the layers of a picture: the id, depth and normal of each
//! pixel. The checker follows the same rules in f64, by itself:
//!
//! 1. Between two pixels next to each other is a line if they see different shapes, and one of them sees none, or the
//!    angle between the normals is large, or the jump in depth is. A line fades in over jumps from the least one to half
//!    more than it (`edges`).
//! 2. The middles of such edges are points of curves. Two edges that meet alone at a corner of pixels are neighbours; where
//!    several meet, curves end. Eight times, each point between two others moves half-way to the middle between them
//!    (`curves`).
//! 3. A line covers of a pixel what is nearer to the curve than half of its width and half a pixel, but not more than 1, by
//!    its strength. Of several lines the one counts that covers most.
//! 4. That share of the pixel takes the colour of the line, and of what is transparent it becomes opaque.
//!
//! The host rounds to nearest. What that leaves open in f64, such as whether a jump is as large as the least one, may go
//! either way. That changes curves as far away as they are smoothed, so that a part of the picture is followed once with each
//! combination of what is open, and one of them must explain all of its pixels.

mod curves;
mod edges;

use super::outcome::Outcome;
use super::rounding::{FLUSH, Interval, PAD, U};
use super::violation::channel_name;
use crate::image::Image;
use crate::parallel::{map_parts, ranges};
use crate::render::Outline;
use curves::{Edges, Window};
use edges::{Given, NONE};

/// The sides of the parts of a picture that are followed at once.
const SIDE: usize = 32;

/// The largest number of combinations of what is open in a part.
const COMBINATIONS: usize = 64;

/// The largest number of violations that are kept; all are counted.
const KEPT: usize = 100;

/// The widest interval of a share about which something is said.
const WIDEST: f64 = 0.05;

/// A picture lacks one of the layers from which outlines are found: depth, normal and id.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("outlines need the layers `depth`, `normal` and `id`; ask the renderer for them")]
pub struct MissingData;

/// A pixel to which no drawing of the outlines leads.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct OutlineViolation {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// Red, green, blue or alpha, from 0 on.
    pub channel: usize,
    /// What the picture with outlines has.
    pub found: f32,
    /// What is legal.
    pub legal: Interval,
    /// The fraction of the pixel that lines may cover.
    pub share: Interval,
}

/// Whether outlines were drawn as their settings say.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct OutlineCertificate {
    /// The number of pixels.
    pub pixels: u64,
    /// The number of pixels that a line may touch.
    pub touched: u64,
    /// The number of pixels of which lines may cover more or less, because decisions are open.
    pub open: u64,
    /// The number of pixels whose bounds are so wide that they say little.
    pub undecided: u64,
    /// The number of pixels that are not legal.
    pub violation_count: u64,
    /// The first of them, in the order of pixels.
    pub violations: Vec<OutlineViolation>,
    /// The widest share of a pixel that is not undecided.
    pub widest: f64,
}

impl OutlineCertificate {
    /// The outcome of the picture: of the pixels that lines touch, if there are any.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let all = if self.touched > 0 { self.touched } else { self.pixels };
        Outcome::of(self.violation_count > 0, self.undecided, all)
    }

    fn join(&mut self, other: Self) {
        let Self { pixels, touched, open, undecided, violation_count, violations, widest } = other;
        self.pixels += pixels;
        self.touched += touched;
        self.open += open;
        self.undecided += undecided;
        self.violation_count += violation_count;
        self.violations.extend(violations);
        self.violations.truncate(KEPT);
        self.widest = self.widest.max(widest);
    }
}

impl std::fmt::Display for OutlineViolation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { pixel: [i, j], channel, found, legal: Interval { low, high }, share } = self;
        let name = channel_name(*channel);
        write!(
            f,
            "pixel ({i}, {j}): {name} is {found:e}, but {low:e} to {high:e} are legal, as lines cover {:.6} to {:.6} \
             of it",
            share.low, share.high
        )
    }
}

/// Judges what became of a picture when outlines were drawn.
///
/// # Errors
/// Returns an error if the picture before lacks depth, normal or id.
pub fn certify(
    before: &Image,
    after: &Image,
    outline: &Outline,
) -> Result<OutlineCertificate, MissingData> {
    let given = Given::of(before, outline).ok_or(MissingData)?;
    let [columns, rows] = given.size.map(|side| ranges(side, SIDE));
    let judge = Judge { given, before, after, outline };
    let parts = map_parts(rows, |rows| {
        let mut strip = OutlineCertificate::default();
        for columns in &columns {
            let mut part = judge.part([[columns.start, rows.start], [columns.end, rows.end]]);
            // Those of the parts before were in the same rows.
            part.violations.append(&mut strip.violations);
            part.violations.sort_by_key(|violation| [violation.pixel[1], violation.pixel[0]]);
            strip.join(part);
        }
        strip
    });
    let mut certificate = OutlineCertificate::default();
    parts.into_iter().for_each(|part| certificate.join(part));
    Ok(certificate)
}

struct Judge<'a> {
    given: Given<'a>,
    before: &'a Image,
    after: &'a Image,
    outline: &'a Outline,
}

impl Judge<'_> {
    /// Judges a part of the picture.
    fn part(&self, pixels: Window) -> OutlineCertificate {
        let width = f64::from(self.outline.width);
        let edges = Edges::around(&self.given, pixels, width);
        let counts: Vec<usize> = edges.all.iter().map(|edge| edge.strengths.len()).collect();
        let product =
            counts.iter().try_fold(1, |product: usize, count| product.checked_mul(*count));
        let all = match product {
            Some(all) if all <= COMBINATIONS => all,
            _ => return self.undecided(pixels),
        };
        let mut best: Option<(OutlineCertificate, Vec<Interval>)> = None;
        let mut hull: Vec<Interval> = Vec::new();
        for number in 0..all {
            let mut rest = number;
            let chosen = counts.iter().map(|count| {
                let chosen = rest % count;
                rest /= count;
                chosen
            });
            let shares = edges.shares(&chosen.collect::<Vec<_>>(), pixels, width);
            match hull.is_empty() {
                true => hull.clone_from(&shares),
                false => hull.iter_mut().zip(&shares).for_each(|(all, one)| *all = all.union(*one)),
            }
            let found = self.judged(pixels, &shares);
            let is_better = |(other, _): &(OutlineCertificate, _)| {
                found.violation_count < other.violation_count
            };
            if best.as_ref().is_none_or(is_better) {
                best = Some((found, shares));
            }
        }
        let (mut found, shares) = best.unwrap_or_default();
        for (share, one) in hull.into_iter().zip(shares) {
            let width = share.high - share.low;
            found.touched += u64::from(share.high > 0.0);
            found.open += u64::from(share != one);
            match width > WIDEST {
                true => found.undecided += 1,
                false => found.widest = found.widest.max(width),
            }
        }
        found
    }

    /// A part in which more is open than can be followed.
    fn undecided(&self, [first, end]: Window) -> OutlineCertificate {
        let pixels = ((end[0] - first[0]) * (end[1] - first[1])) as u64;
        OutlineCertificate {
            pixels,
            touched: pixels,
            open: pixels,
            undecided: pixels,
            ..OutlineCertificate::default()
        }
    }

    /// Judges pixels of which lines cover these shares.
    fn judged(&self, [first, end]: Window, shares: &[Interval]) -> OutlineCertificate {
        let mut certificate = OutlineCertificate::default();
        let rows = (first[1]..end[1]).flat_map(|j| (first[0]..end[0]).map(move |i| [i, j]));
        for ([i, j], share) in rows.zip(shares) {
            let index = j * self.given.size[0] + i;
            certificate.pixels += 1;
            if let Some((channel, found, legal)) = self.illegal(index, *share) {
                certificate.violation_count += 1;
                if certificate.violations.len() < KEPT {
                    let (pixel, share) = ([i as u32, j as u32], *share);
                    let violation = OutlineViolation { pixel, channel, found, legal, share };
                    certificate.violations.push(violation);
                }
            }
        }
        certificate
    }

    /// The first channel of a pixel that is not legal, what it is and what is legal.
    fn illegal(&self, index: usize, share: Interval) -> Option<(usize, f32, Interval)> {
        let Self { before, after, outline, .. } = self;
        // A picture of another size is not legal anywhere.
        let is_same = (before.width(), before.height()) == (after.width(), after.height());
        let line = outline.color.to_array();
        let color = before.color().get(index).copied().unwrap_or([f32::NAN; 3]);
        let drawn = after.color().get(index).copied().unwrap_or([f32::NAN; 3]);
        let mut channels: Vec<[f32; 3]> = (0..3).map(|k| [color[k], line[k], drawn[k]]).collect();
        if let Some(alpha) = before.alpha().and_then(|alpha| alpha.get(index)) {
            let drawn = after.alpha().and_then(|alpha| alpha.get(index)).copied();
            channels.push([*alpha, 1.0, drawn.unwrap_or(f32::NAN)]);
        }
        channels.into_iter().enumerate().find_map(|(channel, [color, line, found])| {
            let legal = mixed(color.into(), line.into(), share);
            // What is not a number stays none.
            let is_legal = match color.is_finite() {
                true => legal.contains(found.into()),
                false => !found.is_finite(),
            };
            (!(is_same && is_legal)).then_some((channel, found, legal))
        })
    }
}

/// What becomes of a number if a share of it is mixed with that of a line: c + s (l − c).
fn mixed(color: f64, line: f64, share: Interval) -> Interval {
    if share == NONE {
        return Interval { low: color, high: color };
    }
    let ends = [share.low, share.high].map(|share| color + share * (line - color));
    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    // A difference, a product and a sum.
    let error = PAD * U * (2.5 * share.high * (line - color).abs() + low.abs().max(high.abs()));
    Interval { low: low - error - FLUSH, high: high + error + FLUSH }
}
