//! What a device answered that no conforming one may.

use std::fmt;

use super::hit::LegalHits;
use super::recording::NO_HIT;
use super::rounding::Interval;
use crate::image::NO_ID;

/// An answer that is not legal, and what would be.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// Column and row of the pixel, from the upper left.
    pub pixel: [u32; 2],
    /// What is wrong.
    pub kind: ViolationKind,
}

/// What is wrong with a pixel.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ViolationKind {
    /// The device was told to leave out a pixel whose ray meets the scene's box.
    NotTraced,
    /// A component of the ray's direction.
    Direction {
        /// 0, 1 or 2.
        axis: usize,
        /// What the device had.
        found: f32,
        /// What it may have.
        legal: Interval,
    },
    /// A component of the ray's origin.
    Origin {
        /// 0, 1 or 2.
        axis: usize,
        /// What the device had.
        found: f32,
        /// What it may have.
        legal: Interval,
    },
    /// The ray's distance from the camera.
    Distance {
        /// What the device had.
        found: f32,
        /// What it may have.
        legal: Interval,
    },
    /// The nearest sphere, or how far away it is.
    Hit {
        /// The sphere that the device found; [`NO_ID`] for none.
        id: u32,
        /// Its distance along the ray.
        t: f32,
        /// What it may answer.
        legal: LegalHits,
    },
    /// The distance of a miss, which must be [`NO_HIT`](super::NO_HIT).
    MissDistance {
        /// What the device answered.
        found: f32,
    },
    /// The id in the picture is not the id that was found.
    Id {
        /// The one in the picture.
        found: u32,
        /// The one that was found.
        traced: u32,
    },
    /// The depth in the picture.
    Depth {
        /// What the picture has.
        found: f32,
        /// What it may have.
        legal: Interval,
    },
    /// The normal in the picture.
    Normal {
        /// What the picture has.
        found: [f32; 3],
        /// The exact one.
        exact: [f64; 3],
        /// How far it may be from that; its length, from one.
        error: f64,
    },
    /// A component of the linear colour in the picture.
    Color {
        /// 0 is red, 1 green, 2 blue.
        channel: usize,
        /// What the picture has.
        found: f32,
        /// What it may have.
        legal: Interval,
    },
    /// Something in the picture of [`Headless::render`](crate::gpu::Headless::render), where that is not the
    /// recording's; of a hit, distances are from the camera.
    Rendered(Box<ViolationKind>),
}

impl ViolationKind {
    /// The stage that went wrong, in a word.
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
    /// On one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [i, j] = self.pixel;
        write!(f, "pixel ({i}, {j}), {}: {}", self.kind.stage(), self.kind)
    }
}

impl fmt::Display for ViolationKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const AXES: [&str; 3] = ["x", "y", "z"];
        const CHANNELS: [&str; 3] = ["red", "green", "blue"];
        match self {
            Self::NotTraced => f.write_str("no ray was traced, although it meets the scene's box"),
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
                write!(f, "{} is {found:?}; legal is {legal}", CHANNELS[*channel])
            }
            Self::Rendered(kind) => write!(f, "{}: {kind}", kind.stage()),
        }
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { low, high } = self;
        if low.to_bits() == high.to_bits() {
            // As the f32 that it was.
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
            let walls = [hit.near, hit.far].into_iter().flatten();
            answers.extend(walls.map(|wall| format!("sphere {} at {wall}", hit.id)));
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

/// An id in words.
fn name(id: u32) -> String {
    if id == NO_ID { "a miss".to_owned() } else { format!("sphere {id}") }
}
