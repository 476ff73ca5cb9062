//! The encoding of a picture by writers: bits, transparency, exposure and tone curve.

use crate::image::color::LinearRgb;
use crate::image::tone::ToneCurve;
use crate::image::{Layer, LayerSet};

/// The number of bits of each sample of a PNG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Bits {
    /// 256 steps for each channel.
    #[default]
    Eight,
    /// 65536 steps for each channel.
    Sixteen,
}

impl Bits {
    /// The variant for a number of bits.
    ///
    /// # Errors
    /// Returns an error if `bits` is neither 8 nor 16.
    pub fn new(bits: u32) -> Result<Self, EncodingError> {
        match bits {
            8 => Ok(Self::Eight),
            16 => Ok(Self::Sixteen),
            _ => Err(EncodingError(format!("`bits` is {bits}; it must be 8 or 16"))),
        }
    }

    /// The number of bits.
    #[must_use]
    pub const fn count(self) -> u32 {
        8 * self.bytes() as u32
    }

    /// The number of bytes of a sample.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Eight => 1,
            Self::Sixteen => 2,
        }
    }

    /// The sample of full light.
    #[must_use]
    pub const fn white(self) -> u32 {
        (1 << self.count()) - 1
    }
}

/// The encoding of a picture in a file. Exposure, tone curve and bits apply to PNG. EXR stores the light unchanged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoding {
    /// The number of bits of each sample.
    pub bits: Bits,
    /// Whether the picture has an alpha channel in place of the background.
    ///
    /// For a transparent picture, render with [`RenderSettings::is_transparent`](crate::RenderSettings::is_transparent)
    /// and the layer alpha. The background then adds nothing, and the colour layer is premultiplied by alpha.
    pub transparent: bool,
    exposure: f32,
    /// The tone curve, which is applied after the exposure.
    pub tone: ToneCurve,
    /// The background that the exposure and the tone curve do not change. They apply only to objects in front of it.
    /// `None` applies them to the whole picture, as for a visible sky.
    pub background: Option<LinearRgb>,
    dots_per_inch: Option<f32>,
}

/// The reason why a parameter of an encoding is not valid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct EncodingError(String);

impl Encoding {
    /// The largest number of stops by which a picture can be made brighter or darker.
    pub const MAX_EXPOSURE: f32 = 32.0;

    /// The encoding with light multiplied by 2 to the power of `stops`.
    ///
    /// # Errors
    /// Returns an error if `stops` is not within ± [`Encoding::MAX_EXPOSURE`].
    pub fn with_exposure(self, stops: f32) -> Result<Self, EncodingError> {
        // The comparison is false for NaN as well.
        if stops.abs() <= Self::MAX_EXPOSURE {
            Ok(Self { exposure: stops, ..self })
        } else {
            let most = Self::MAX_EXPOSURE;
            let range = format!("it must lie between -{most} and {most}");
            Err(EncodingError(format!("`exposure` is {stops} stops; {range}")))
        }
    }

    /// The layers that an encoded picture needs. Alpha is one of them if the picture is transparent, or if its
    /// background must be distinguished from objects in front of it.
    #[must_use]
    pub fn layers(&self) -> LayerSet {
        let needs_alpha = self.transparent || self.kept_background().is_some();
        if needs_alpha { LayerSet::COLOR.with(Layer::Alpha) } else { LayerSet::COLOR }
    }

    /// The background, if exposure or tone curve would change it.
    #[must_use]
    pub fn kept_background(&self) -> Option<LinearRgb> {
        let is_changed = self.exposure != 0.0 || self.tone != ToneCurve::None;
        self.background.filter(|_| is_changed && !self.transparent)
    }

    /// Converts a pixel to linear light of a display like [`Encoding::display`], but does not change the background,
    /// whose share of the pixel is 1 − alpha.
    #[must_use]
    pub fn display_over(&self, linear: [f32; 3], alpha: f32, background: LinearRgb) -> [f32; 3] {
        let behind = background.to_array().map(|c| c * (1.0 - alpha));
        if alpha <= 0.0 {
            return behind;
        }
        let in_front = std::array::from_fn(|i| ((linear[i] - behind[i]) / alpha).max(0.0));
        let shown = self.display(in_front);
        std::array::from_fn(|i| alpha * shown[i].clamp(0.0, 1.0) + behind[i])
    }

    /// The encoding with the number of pixels per inch for printing. It is written to PNG files and changes no
    /// pixel.
    ///
    /// # Errors
    /// Returns an error if the number does not lie between 1 and 100,000.
    pub fn with_dots_per_inch(self, dots_per_inch: Option<f32>) -> Result<Self, EncodingError> {
        match dots_per_inch {
            Some(dots_per_inch) if !(1.0..=1e5).contains(&dots_per_inch) => {
                Err(EncodingError(format!("`dpi` is {dots_per_inch}; it must lie between 1 and 100000 dots per inch")))
            }
            dots_per_inch => Ok(Self { dots_per_inch, ..self }),
        }
    }

    /// The number of pixels per inch for printing, if it was set.
    #[must_use]
    pub fn dots_per_inch(&self) -> Option<f32> {
        self.dots_per_inch
    }

    /// The exposure in stops. Positive values make the picture brighter.
    #[must_use]
    pub fn exposure(&self) -> f32 {
        self.exposure
    }

    /// Converts linear light of the scene, not premultiplied, to linear light of a display. Exposure comes first, then
    /// the tone curve. Values may still exceed 1; the transfer function clamps them.
    #[must_use]
    pub fn display(&self, linear: [f32; 3]) -> [f32; 3] {
        let gain = self.exposure.exp2();
        self.tone.apply(linear.map(|x| x * gain))
    }

    /// The smallest and the largest light of a display for scene light between the ends of a range.
    pub(crate) fn display_range(&self, ends: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
        let gain = self.exposure.exp2();
        self.tone.range(ends.map(|linear| linear.map(|x| x * gain)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_is_a_factor_of_two() {
        let exposed = |stops: f32| {
            let encoding = Encoding::default().with_exposure(stops).unwrap();
            encoding.display([0.1, 0.2, 3.0]).map(f32::to_bits)
        };
        assert_eq!(exposed(0.0), [0.1_f32, 0.2, 3.0].map(f32::to_bits));
        assert_eq!(exposed(1.0), [0.2_f32, 0.4, 6.0].map(f32::to_bits));
        assert_eq!(exposed(-2.0), [0.025_f32, 0.05, 0.75].map(f32::to_bits));
    }

    #[test]
    fn what_is_out_of_range_is_named() {
        for stops in [32.5, -1e9, f32::NAN, f32::INFINITY] {
            let error = Encoding::default().with_exposure(stops).unwrap_err().to_string();
            assert_eq!(error, format!("`exposure` is {stops} stops; it must lie between -32 and 32"));
        }
        let error = Bits::new(12).unwrap_err().to_string();
        assert_eq!(error, "`bits` is 12; it must be 8 or 16");
    }
}
