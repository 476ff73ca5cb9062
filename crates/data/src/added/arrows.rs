//! Arrows that show a vector of each sphere, such as forces or velocities.

use glam::DVec3;

use super::shapes::{AddError, AddedShapes, ArrowKey, Look, between};
use crate::column::vector;
use crate::load::Dataset;
use pinhole::image::color::LinearRgb;
use pinhole::internals::text::one_line;
use pinhole::scene::cone::{Caps, Cone, ConeError};

/// The choice of arrows.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Arrows {
    /// The name of the vector, such as `forces` for the columns `forces.x`, `forces.y` and `forces.z`.
    pub vector: String,
    /// The length of an arrow, in scene units, for a vector of length 1. If it is not given, 95 of 100 arrows are at
    /// most 1.5 times as long as the median distance to the nearest sphere.
    pub scale: Option<f64>,
    /// The radius of a shaft in scene units; if it is not given, 0.08 of that distance.
    pub radius: Option<f64>,
    /// The colour; by default [`Arrows::COLOR`].
    pub color: LinearRgb,
    /// The length of the shortest vector that has an arrow.
    pub min: f64,
    /// True if the middle of an arrow, and not its start, is at the centre of its sphere.
    pub is_centered: bool,
}

/// The length of long arrows, as a factor of the distance between spheres.
const LENGTH: f64 = 1.5;

/// The share of vectors that are not longer than those.
const SHARE: f64 = 0.95;

/// The radius of a shaft, as a factor of the distance between spheres.
const RADIUS: f64 = 0.08;

/// The radius and the length of a head, as factors of the radius of the shaft. Shorter arrows have only a head, which
/// keeps its proportions.
const HEAD: [f64; 2] = [2.2, 5.0];

/// Arrows that are shorter than this factor of the radius of a shaft cannot be seen, and are left out.
const LEAST: f64 = 1e-3;

impl Arrows {
    /// The default colour in 8-bit sRGB: a green that few elements, maps and backgrounds have.
    pub const COLOR: [u8; 3] = [0x16, 0x9c, 0x54];

    /// Arrows of a vector.
    #[must_use]
    pub fn new(vector: impl Into<String>) -> Self {
        let color = LinearRgb::from_srgb8(Self::COLOR);
        Self { vector: vector.into(), scale: None, radius: None, color, min: 0.0, is_centered: false }
    }

    pub(super) fn add(
        &self,
        data: &Dataset,
        is_drawn: impl Fn(usize) -> bool,
        added: &mut AddedShapes,
    ) -> Result<(), AddError> {
        let no_vector = |error| AddError(format!("`arrows`: {error}"));
        let (name, [x, y, z]) = vector(&self.vector, &data.spheres, &data.columns).map_err(no_vector)?;
        let name = one_line(name);
        let all = x.iter().zip(y).zip(z).map(|((x, y), z)| DVec3::new(*x, *y, *z));
        let known: Vec<(usize, DVec3, f64)> = all
            .enumerate()
            .map(|(index, vector)| (index, vector, vector.length()))
            .filter(|(.., length)| length.is_finite())
            .collect();
        let unknown = data.spheres.len() - known.len();
        if unknown > 0 {
            added.notes.push(format!(
                "{unknown} of {} spheres have no arrow: their {name} is not a number",
                data.spheres.len()
            ));
        }
        let distance = data.spacing();
        let scale = match self.scale {
            Some(scale) => scale,
            None => {
                let mut lengths: Vec<f64> = known.iter().map(|(.., length)| *length).filter(|l| *l > 0.0).collect();
                let place = (SHARE * lengths.len() as f64) as usize;
                if place >= lengths.len() {
                    added.notes.push(format!("there are no arrows: no sphere has a {name} that is longer than 0"));
                    return Ok(());
                }
                let (_, long, _) = lengths.select_nth_unstable_by(place, f64::total_cmp);
                LENGTH * distance / *long
            }
        };
        let radius = self.radius.unwrap_or(RADIUS * distance);
        let is_shown = |length: f64| length >= self.min && scale * length >= LEAST * radius;
        for (index, vector, length) in
            known.into_iter().filter(|(index, _, length)| is_shown(*length) && is_drawn(*index))
        {
            let [x, y, z, _] = data.spheres.at(index);
            let (center, direction, length) = (DVec3::new(x, y, z), vector / length, scale * length);
            let before = if self.is_centered { 0.5 * length } else { 0.0 };
            let start = center - before * direction;
            added.push_arrow([start, start + length * direction], radius, self.color).map_err(|error| {
                AddError(format!(
                    "`arrows`: the arrow of sphere {index} cannot be drawn: {error}; choose another scale or radius, such \
                     as --arrows {name},scale={scale:.4},radius={radius:.4}"
                ))
            })?;
        }
        added.arrow_key = Some(ArrowKey { name, scale, color: self.color });
        Ok(())
    }
}

impl AddedShapes {
    /// Adds an arrow between two points: a shaft and a head.
    fn push_arrow(&mut self, [start, end]: [DVec3; 2], radius: f64, color: LinearRgb) -> Result<(), ConeError> {
        let length = start.distance(end);
        let size = (length / (HEAD[1] * radius)).min(1.0) * radius;
        let neck = end - HEAD[1] * size * ((end - start) / length);
        if length > HEAD[1] * radius {
            self.push(between([start, neck], radius).with_caps(Caps::First), Look::of_color(color))?;
        }
        let head = Cone::new(neck.to_array(), end.to_array(), [HEAD[0] * size, 0.0]);
        self.push(head.with_caps(Caps::First), Look::of_color(color))
    }
}
