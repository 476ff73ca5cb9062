//! Scale bars show the size of a length in the picture.

use glam::DVec3;

use super::canvas::{Block, LINE, Paint};
use super::font;
use super::place::Position;
use super::ticks::round_down;
use crate::color_by::number::short;
use pinhole::camera::View;

/// A bar with the length of a round number of scene units.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleBar {
    /// The position of the bar.
    pub position: Position,
    /// The unit of a length in the scene, such as Å; it may be empty.
    pub unit: String,
    length: f64,
    pixels: f64,
}

/// The reason why there is no scale bar, on one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ScaleBarError(String);

/// The number of pixels that a length of 1 across the picture takes at the depth of `point`. For an orthographic camera
/// it does not depend on the point. A camera with a lens has the scale of the ray through the centre of its lens.
///
/// # Errors
/// Returns an error if the camera bends straight lines, or if it does not see the point.
pub fn pixels_per_unit(view: &View<'_>, point: DVec3) -> Result<f64, ScaleBarError> {
    let kind = view.camera.kind();
    if !kind.is_linear() {
        return Err(ScaleBarError(format!(
            "a scale bar has no meaning for the camera `{}`, whose pictures have another scale everywhere; choose a \
             pinhole or an orthographic camera",
            kind.name()
        )));
    }
    let vectors = view.camera.vectors();
    // Any length gives the same quotient; this one loses few digits.
    let across = 0.5 * vectors.right * (point - vectors.origin).length().max(1.0) / vectors.forward.length().max(1.0);
    let behind = || {
        let what = "a scale bar has no meaning here, because the middle of the scene lies behind the camera";
        ScaleBarError(what.to_owned())
    };
    let at = |point| view.camera.location_of(point).ok_or_else(behind);
    let step = at(point + across)? - at(point - across)?;
    let pixels = 0.5 * f64::from(view.film.width()) * step.x / (2.0 * across.length());
    if pixels.is_finite() && pixels > 0.0 { Ok(pixels) } else { Err(behind()) }
}

impl ScaleBar {
    /// A scale bar in the bottom left corner of a picture that is `width` pixels wide, where a length of 1
    /// takes `pixels_per_unit` pixels. The default `length` is a round number, about a sixth of the width.
    ///
    /// # Errors
    /// Returns an error if the length is not a positive number, or too long or too short to be seen.
    pub fn new(
        pixels_per_unit: f64,
        length: Option<f64>,
        unit: impl Into<String>,
        width: u32,
    ) -> Result<Self, ScaleBarError> {
        let fitting = round_down(f64::from(width) / 4.0 / pixels_per_unit);
        let length = length.unwrap_or(fitting);
        if !(length.is_finite() && length > 0.0) {
            return Err(ScaleBarError(format!(
                "the length of a scale bar is {}; it must be finite and greater than 0",
                short(length)
            )));
        }
        let pixels = length * pixels_per_unit;
        if !(2.0..=0.9 * f64::from(width)).contains(&pixels) {
            return Err(ScaleBarError(format!(
                "a scale bar of {} would be {} pixels long in a picture that is {width} pixels wide; choose a length near \
                 {}, or none",
                short(length),
                short(pixels),
                short(fitting)
            )));
        }
        Ok(Self { position: Position::BOTTOM_LEFT, unit: unit.into(), length, pixels })
    }

    /// The length in scene units.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The length in pixels.
    #[must_use]
    pub fn pixels(&self) -> f64 {
        self.pixels
    }

    /// The text at the bar: the length and the unit.
    #[must_use]
    pub fn text(&self) -> String {
        format!("{} {}", number(self.length), self.unit).trim_end().to_owned()
    }

    pub(super) fn block(&self, em: f32) -> Block {
        let mut block = Block::default();
        let (text, bar) = (self.text(), self.pixels as f32);
        let text_width = font::width(&text, em);
        let width = text_width.max(bar);
        block.text(text, [0.5 * (width - text_width), 0.95 * em], em);
        let (top, left) = ((LINE * em).round(), 0.5 * (width - bar));
        let bottom = top + (0.26 * em).round().max(2.0);
        block.rect([left, top, left + bar, bottom], Paint::Ink);
        block.width = width;
        block.height = bottom;
        block
    }
}

/// A number of an annotation, such as 2·10⁷.
pub(super) fn number(value: f64) -> String {
    let text = short(value);
    match text.split_once('e') {
        Some(("1", exponent)) => format!("10{}", raised(exponent)),
        Some((digits, exponent)) => format!("{digits}·10{}", raised(exponent)),
        None => text,
    }
}

fn raised(exponent: &str) -> String {
    exponent.parse().map_or_else(|_| exponent.to_owned(), super::ticks::raised)
}
