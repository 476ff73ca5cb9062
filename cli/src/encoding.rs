//! Flags that say how the picture is written; each takes the place of a scene's key.

use super::args::{EncodingArgs, Tone};
use super::failure::Failure;
use super::picture::PictureFormat;
use pinhole::image::encoding::{Bits, Encoding};
use pinhole::image::tone::ToneCurve;

/// What was given, checked.
#[derive(Clone, Copy, Debug)]
pub(super) struct EncodingFlags {
    bits: Option<Bits>,
    transparent: Option<bool>,
    exposure: Option<f32>,
    tone: Option<ToneCurve>,
}

impl EncodingFlags {
    pub(super) fn new(args: &EncodingArgs, format: PictureFormat) -> Result<Self, Failure> {
        let EncodingArgs { bits, transparent, exposure, tone } = *args;
        let given = [
            ("--bits", bits.is_some()),
            ("--exposure", exposure.is_some()),
            ("--tone", tone.is_some()),
        ];
        let given = given.into_iter().find(|(_, is_given)| *is_given);
        if let (PictureFormat::Exr, Some((flag, _))) = (format, given) {
            return Err(Failure::usage(format!(
                "{flag} concerns PNG; an EXR file keeps the light as it is, in 32 bits; drop it"
            )));
        }
        if let Some(stops) = exposure {
            let checked = Encoding::default().with_exposure(stops);
            checked.map_err(|error| Failure::usage(format!("--exposure: {error}")))?;
        }
        let bits = bits.map(Bits::new).transpose();
        Ok(Self {
            bits: bits.map_err(|error| Failure::usage(format!("--bits: {error}")))?,
            transparent,
            exposure,
            tone: tone.map(Tone::into),
        })
    }

    /// Flags come before what a scene says.
    pub(super) fn over(self, scene: Encoding) -> Encoding {
        let encoding = scene
            .with_bits(self.bits.unwrap_or(scene.bits()))
            .with_transparent(self.transparent.unwrap_or(scene.transparent()))
            .with_tone(self.tone.unwrap_or(scene.tone()));
        // Both were checked.
        encoding.with_exposure(self.exposure.unwrap_or(scene.exposure())).unwrap_or(encoding)
    }
}
