//! Violations: results of a device that no conforming device may give.

use std::fmt;

use super::hit::LegalHits;
use super::recording::NO_HIT;
use super::rounding::Interval;
use crate::image::NO_ID;

/// A result that is not legal, and the legal results.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// Column and row of the pixel, from the top left.
    pub pixel: [u32; 2],
    /// What is wrong.
    pub kind: ViolationKind,
}

/// The kind of violation at a pixel.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ViolationKind {
    /// No ray was traced, although the ray of the pixel hits the scene's box.
    NotTraced,
    /// A component of the ray's direction is not legal.
    Direction {
        /// The axis: 0, 1 or 2.
        axis: usize,
        /// The value on the device.
        found: f32,
        /// The legal values.
        legal: Interval,
    },
    /// A component of the ray's origin is not legal.
    Origin {
        /// The axis: 0, 1 or 2.
        axis: usize,
        /// The value on the device.
        found: f32,
        /// The legal values.
        legal: Interval,
    },
    /// The ray's distance from the camera is not legal.
    Distance {
        /// The value on the device.
        found: f32,
        /// The legal values.
        legal: Interval,
    },
    /// The nearest sphere, or its distance, is not legal.
    Hit {
        /// The sphere that the device found; [`NO_ID`] for a miss.
        id: u32,
        /// Distance of the hit along the ray.
        t: f32,
        /// The legal answers.
        legal: LegalHits,
    },
    /// The distance of a miss is not [`NO_HIT`](super::NO_HIT).
    MissDistance {
        /// The value on the device.
        found: f32,
    },
    /// The id in the picture differs from that of the hit.
    Id {
        /// The id in the picture.
        found: u32,
        /// The id of the hit.
        traced: u32,
    },
    /// The depth in the picture is not legal.
    Depth {
        /// The value in the picture.
        found: f32,
        /// The legal values.
        legal: Interval,
    },
    /// The normal in the picture is not legal.
    Normal {
        /// The value in the picture.
        found: [f32; 3],
        /// The exact normal.
        exact: [f64; 3],
        /// The largest legal distance from the exact normal, and deviation from unit length.
        error: f64,
    },
    /// A component of the linear colour in the picture is not legal.
    Color {
        /// The channel: 0 is red, 1 green, 2 blue.
        channel: usize,
        /// The value in the picture.
        found: f32,
        /// The legal values.
        legal: Interval,
    },
    /// A violation in the picture of [`Headless::render`](crate::gpu::Headless::render), at a pixel that differs from
    /// the recording; distances of hits are from the camera.
    Rendered(Box<ViolationKind>),
}

impl ViolationKind {
    /// The name of the stage with the illegal result.
    #[must_use]
    pub fn stage(&self) -> &'static str {
        match self {
            Self::NotTraced => "cull",
            Self::Direction { .. } | Self::Origin { .. } | Self::Distance { .. } => "camera",
            Self::Hit { .. } | Self::MissDistance { .. } => "hit",
            Self::Id { .. } => "id",
            Self::Depth { .. } => "depth",
            Self::Normal { .. } => "normal",
            Self::Color { .. } => "color",
            Self::Rendered(_) => "render",
        }
    }
}

impl fmt::Display for Violation {
    /// Writes the violation on one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [i, j] = self.pixel;
        write!(f, "pixel ({i}, {j}), {}: {}", self.kind.stage(), self.kind)
    }
}

/// The name of a channel of a colour, from 0 for red to 3 for alpha.
pub(super) fn channel_name(channel: usize) -> &'static str {
    ["red", "green", "blue", "alpha"].get(channel).copied().unwrap_or("a channel")
}

impl fmt::Display for ViolationKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const AXES: [&str; 3] = ["x", "y", "z"];
        match self {
            Self::NotTraced => f.write_str("no ray was traced, although it hits the scene's box"),
            Self::Direction { axis, found, legal } => {
                write!(f, "the direction's {} is {found:?}; legal is {legal}", AXES[*axis])
            }
            Self::Origin { axis, found, legal } => {
                write!(f, "the origin's {} is {found:?}; legal is {legal}", AXES[*axis])
            }
            Self::Distance { found, legal } => {
                write!(f, "the origin's distance is {found:?}; legal is {legal}")
            }
            Self::Hit { id: NO_ID, legal, .. } => write!(f, "a miss; legal is {legal}"),
            Self::Hit { id, t, legal } => write!(f, "sphere {id} at {t:?}; legal is {legal}"),
            Self::MissDistance { found } => write!(f, "a miss at {found:?}; legal is {NO_HIT:?}"),
            Self::Id { found, traced } => {
                write!(f, "the picture has {}; {} was found", name(*found), name(*traced))
            }
            Self::Depth { found, legal } => write!(f, "{found:?}; legal is {legal}"),
            Self::Normal { found, exact, error } => {
                let [x, y, z] = exact;
                write!(
                    f,
                    "{found:?}; legal is what is within {error:.3e} of [{x:.9}, {y:.9}, {z:.9}] and of \
                     unit length"
                )
            }
            Self::Color { channel, found, legal } => {
                write!(f, "{} is {found:?}; legal is {legal}", channel_name(*channel))
            }
            Self::Rendered(kind) => write!(f, "{}: {kind}", kind.stage()),
        }
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { low, high } = self;
        if low.to_bits() == high.to_bits() {
            // The number is written like the f32 that it is.
            write!(f, "{:?}", *low as f32)
        } else {
            write!(f, "[{low:.10e}, {high:.10e}]")
        }
    }
}

impl fmt::Display for LegalHits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut answers: Vec<String> = Vec::new();
        for hit in &self.spheres {
            let sides = [hit.near, hit.far].into_iter().flatten();
            answers.extend(sides.map(|side| format!("sphere {} at {side}", hit.id)));
        }
        if self.miss {
            answers.push("a miss".to_owned());
        }
        f.write_str(&answers.join(", or "))?;
        if self.spheres.len() > 1 && self.limit.is_finite() {
            write!(f, ", but none beyond {:.10e}", self.limit)?;
        }
        Ok(())
    }
}

/// A hit or a miss in words.
fn name(id: u32) -> String {
    if id == NO_ID { "a miss".to_owned() } else { format!("sphere {id}") }
}
