//! The flags for writing the picture. They take precedence over the keys of a scene file.

use super::args::{EncodingArgs, Tone};
use super::failure::Failure;
use super::picture::PictureFormat;
use pinhole::image::encoding::{Bits, Encoding};
use pinhole::image::tone::ToneCurve;

/// The flags that were given, checked.
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
                "{flag} applies only to PNG; an EXR file stores the light unchanged in 32 bits; remove {flag}"
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

    /// Applies the flags to the encoding of a scene. Flags take precedence.
    pub(super) fn apply_to(self, scene: Encoding) -> Encoding {
        let encoding = scene
            .with_bits(self.bits.unwrap_or(scene.bits()))
            .with_transparent(self.transparent.unwrap_or(scene.transparent()))
            .with_tone(self.tone.unwrap_or(scene.tone()));
        // Both exposures were checked, so this does not fail.
        encoding.with_exposure(self.exposure.unwrap_or(scene.exposure())).unwrap_or(encoding)
    }
}
