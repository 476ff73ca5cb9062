//! Reads the table `[output]`, which tells how the picture is encoded.

use serde::Deserialize;
use toml::Spanned;

use super::{Lines, SceneFileError};
use crate::image::encoding::{Bits, Encoding, EncodingError};
use crate::image::tone::ToneCurve;

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct OutputTable {
    exposure: Option<Spanned<f32>>,
    tone: ToneCurve,
    transparent: bool,
    bits: Option<Spanned<u32>>,
    dpi: Option<Spanned<f32>>,
}

impl OutputTable {
    pub(super) fn encoding(self, lines: &Lines<'_>) -> Result<Encoding, SceneFileError> {
        let span = |start| move |error: EncodingError| lines.span(start).error(error);
        let mut encoding =
            Encoding::default().with_tone(self.tone).with_transparent(self.transparent);
        if let Some(exposure) = self.exposure {
            let start = exposure.span().start;
            encoding = encoding.with_exposure(exposure.into_inner()).map_err(span(start))?;
        }
        if let Some(bits) = self.bits {
            let start = bits.span().start;
            encoding = encoding.with_bits(Bits::new(bits.into_inner()).map_err(span(start))?);
        }
        if let Some(dpi) = self.dpi {
            let start = dpi.span().start;
            encoding = encoding.with_dots_per_inch(Some(dpi.into_inner())).map_err(span(start))?;
        }
        Ok(encoding)
    }
}
