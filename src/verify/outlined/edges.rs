//! Between which pixels there are lines, and how strong they are.

use super::super::rounding::{Interval, PAD, U, gamma};
use crate::image::{Image, NO_ID};
use crate::render::Outline;

/// No line.
pub(super) const NONE: Interval = Interval { low: 0.0, high: 0.0 };

/// A line at its strongest.
const FULL: Interval = Interval { low: 1.0, high: 1.0 };

/// A strength of which nothing is known but that there is a line.
const ANY: Interval = Interval { low: 0.0, high: 1.0 };

/// How far the cosine of an angle may be from the exact one: a few ULP of 1, as no library of mathematics is worse.
const OF_COSINE: f64 = 4.0 * U;

/// The layers of a picture, and what makes a line in them.
pub(super) struct Given<'a> {
    pub(super) size: [usize; 2],
    ids: &'a [u32],
    depths: &'a [f32],
    normals: &'a [[f32; 3]],
    /// The cosine below which normals make a line.
    cosine: Interval,
    /// The jump that makes a line, as a fraction of the depth.
    jump: f64,
}

impl<'a> Given<'a> {
    /// `None` if a layer is missing.
    pub(super) fn of(image: &'a Image, outline: &Outline) -> Option<Self> {
        Some(Self {
            size: [image.width() as usize, image.height() as usize],
            ids: image.id()?,
            depths: image.depth()?,
            normals: image.normal()?,
            cosine: Interval::around(f64::from(outline.angle).cos(), OF_COSINE),
            jump: outline.depth.into(),
        })
    }

    /// The strengths that the line between two pixels may have; the list is empty if there surely is none, and
    /// has [`NONE`] if there may be none.
    pub(super) fn strengths(&self, a: [usize; 2], b: [usize; 2]) -> Vec<Interval> {
        let [a, b] = [a, b].map(|[i, j]| j * self.size[0] + i);
        let [id, other] = [self.ids[a], self.ids[b]];
        if id == other {
            return Vec::new();
        }
        // A shape beside which nothing is hit has a silhouette.
        if id == NO_ID || other == NO_ID {
            return vec![FULL];
        }
        let products: [f64; 3] =
            std::array::from_fn(|k| f64::from(self.normals[a][k]) * f64::from(self.normals[b][k]));
        let size: f64 = products.iter().map(|product| product.abs()).sum();
        let cosine = Interval::around(products.iter().sum(), PAD * gamma(3) * size);
        if cosine.high < self.cosine.low {
            return vec![FULL];
        }
        let by_jump = self.by_jump(self.depths[a].into(), self.depths[b].into());
        if cosine.low >= self.cosine.high {
            return by_jump;
        }
        // The angle may be large enough, or not.
        let mut all = vec![FULL];
        match by_jump.is_empty() {
            true => all.push(NONE),
            false => all.extend(by_jump),
        }
        all
    }

    /// The strengths that a line between two surfaces at these depths may have, whose normals make none.
    ///
    /// With a least jump m, a jump d makes a line of strength 2 (d/m − 1), but not more than 1.
    fn by_jump(&self, a: f64, b: f64) -> Vec<Interval> {
        let scaled = |x: f64, up: f64| x * (1.0 + up * PAD * U) + up * f64::from(f32::MIN_POSITIVE);
        let (jump, least) = ((a - b).abs(), self.jump * a.min(b));
        if !jump.is_finite() || !least.is_finite() {
            return vec![NONE, ANY];
        }
        if jump == 0.0 || least < 0.0 {
            // Equal numbers have no difference, however it is rounded. With a depth below zero, a line has a strength below it.
            return Vec::new();
        }
        let jump = Interval { low: jump * (1.0 - PAD * U), high: jump * (1.0 + PAD * U) };
        let least = match least == 0.0 {
            true => NONE,
            false => Interval { low: scaled(least, -1.0).max(0.0), high: scaled(least, 1.0) },
        };
        if jump.high <= least.low {
            return Vec::new();
        }
        // A difference, half of the least jump, and a quotient, all rounded.
        let strength = |jump: f64, least: f64, off: f64| match least > 0.0 {
            true => (2.0 * (jump - least) / least * (1.0 + off)).clamp(0.0, 1.0),
            false => 1.0,
        };
        let off = PAD * gamma(4);
        let strength = Interval {
            low: strength(jump.low, least.high, -off),
            high: strength(jump.high, least.low, off),
        };
        match jump.low > least.high {
            true => vec![strength],
            false => vec![NONE, strength],
        }
    }
}
