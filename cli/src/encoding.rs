//! The flags for writing the picture. They take precedence over the keys of a scene file.

use clap::{Args, ValueEnum};

use super::failure::Failure;
use super::picture::PictureFormat;
use pinhole::image::encoding::{Bits, Encoding};
use pinhole::image::tone::ToneCurve;

/// Flags for writing the picture. [`EncodingFlags`] checks them.
#[derive(Debug, Args)]
pub(super) struct EncodingArgs {
    /// Bits per channel of a PNG, 8 or 16 [default: the scene's, or 8]
    #[arg(long, value_name = "N")]
    bits: Option<u32>,
    /// Make the background transparent: write RGBA, with alpha from the spheres [default: the scene's, or false]
    #[arg(
        long,
        value_name = "BOOL",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "true"
    )]
    transparent: Option<bool>,
    /// Exposure of a PNG in stops from -32 to 32; each stop doubles the brightness [default: the scene's, or 0]
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    exposure: Option<f32>,
    /// Tone curve of a PNG, which brings light that is brighter than white into range [default: the scene's, or none]
    #[arg(long, value_enum)]
    tone: Option<Tone>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Tone {
    /// No curve: brighter light is clipped
    None,
    /// A curve like that of film, for red, green and blue separately
    Filmic,
    /// AgX: strong colors turn white
    Agx,
}

impl From<Tone> for ToneCurve {
    fn from(tone: Tone) -> Self {
        match tone {
            Tone::None => Self::None,
            Tone::Filmic => Self::Filmic,
            Tone::Agx => Self::Agx,
        }
    }
}

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
