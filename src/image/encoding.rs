//! How a picture is written: what is asked of writers beside the picture itself.

use crate::image::tone::ToneCurve;

/// How many bits a sample of a PNG has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Bits {
    /// 256 steps.
    #[default]
    Eight,
    /// 65536 steps.
    Sixteen,
}

impl Bits {
    /// From the number.
    ///
    /// # Errors
    /// If it is neither 8 nor 16.
    pub fn new(bits: u32) -> Result<Self, EncodingError> {
        match bits {
            8 => Ok(Self::Eight),
            16 => Ok(Self::Sixteen),
            _ => Err(EncodingError::Bits { bits }),
        }
    }
}

/// How a picture is written. Exposure, tone curve and bits concern PNG; EXR keeps the light as it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoding {
    bits: Bits,
    transparent: bool,
    exposure: f32,
    tone: ToneCurve,
}

/// Why there is no such encoding.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EncodingError {
    /// The exposure is out of range.
    #[error(
        "`exposure` is {stops} stops; it must lie between -{} and {}",
        Encoding::MAX_EXPOSURE,
        Encoding::MAX_EXPOSURE
    )]
    Exposure {
        /// Stops as given.
        stops: f32,
    },
    /// No PNG has so many bits.
    #[error("`bits` is {bits}; it must be 8 or 16")]
    Bits {
        /// Bits as given.
        bits: u32,
    },
}

impl Encoding {
    /// The most stops by which a picture is made brighter or darker.
    pub const MAX_EXPOSURE: f32 = 32.0;

    /// The same with other bits for each sample.
    #[must_use]
    pub fn with_bits(self, bits: Bits) -> Self {
        Self { bits, ..self }
    }

    /// The same, transparent where no sphere is or not.
    ///
    /// Render a transparent picture with
    /// [`RenderSettings::is_transparent`](crate::RenderSettings::is_transparent), so that what no sphere covers adds
    /// nothing and the layer of colour is premultiplied by that of alpha, which must be there.
    #[must_use]
    pub fn with_transparent(self, transparent: bool) -> Self {
        Self { transparent, ..self }
    }

    /// The same with light multiplied by 2 to the power of `stops`.
    ///
    /// # Errors
    /// If `stops` is not within ± [`Encoding::MAX_EXPOSURE`].
    pub fn with_exposure(self, stops: f32) -> Result<Self, EncodingError> {
        // False for NaN as well.
        if stops.abs() <= Self::MAX_EXPOSURE {
            Ok(Self { exposure: stops, ..self })
        } else {
            Err(EncodingError::Exposure { stops })
        }
    }

    /// The same with another tone curve, which comes after the exposure.
    #[must_use]
    pub fn with_tone(self, tone: ToneCurve) -> Self {
        Self { tone, ..self }
    }

    /// How many bits a sample has.
    #[must_use]
    pub fn bits(&self) -> Bits {
        self.bits
    }

    /// Whether the picture has an alpha channel and no background.
    #[must_use]
    pub fn transparent(&self) -> bool {
        self.transparent
    }

    /// By how many stops the picture is brighter than the scene.
    #[must_use]
    pub fn exposure(&self) -> f32 {
        self.exposure
    }

    /// The tone curve.
    #[must_use]
    pub fn tone(&self) -> ToneCurve {
        self.tone
    }

    /// Linear light of a display, for linear light of the scene that is not premultiplied: exposed, and by the
    /// tone curve. What still exceeds 1 is for the transfer function to cut off.
    #[must_use]
    pub fn display(&self, linear: [f32; 3]) -> [f32; 3] {
        let gain = self.exposure.exp2();
        self.tone.apply(linear.map(|x| x * gain))
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
            assert_eq!(
                error,
                format!("`exposure` is {stops} stops; it must lie between -32 and 32")
            );
        }
        let error = Bits::new(12).unwrap_err().to_string();
        assert_eq!(error, "`bits` is 12; it must be 8 or 16");
    }
}
