//! Writes pictures with their data layers as OpenEXR files: one part with scan lines and lossless ZIP compression.
//! Numbers are stored unchanged.
//!
//! | channels | type | layer |
//! | --- | --- | --- |
//! | `R`, `G`, `B` | f32 | color: linear light with the Rec. 709 primaries, no exposure, no tone curve |
//! | `A` | f32 | alpha if the encoding is transparent, where `R`, `G`, `B` are premultiplied by it; otherwise 1 |
//! | `coverage` | f32 | alpha, also if the encoding is not transparent |
//! | `Z` | f32 | depth, along the ray; +∞ for a miss |
//! | `N.X`, `N.Y`, `N.Z` | f32 | normal |
//! | `P.X`, `P.Y`, `P.Z` | f32 | position |
//! | `albedo.R`, `albedo.G`, `albedo.B` | f32 | albedo |
//! | `id` | u32 | id; 4294967295 for a miss |
//! | `samples` | u32 | samples |
//! | `variance` | f32 | variance |
//!
//! The attributes are `software`, and `adapter` if the adapter that rendered is known. A certified picture has its
//! certificate, which names both, in the attribute [`CERTIFICATE`] in their place. It is not compressed, so that each byte
//! of its file can be checked.

use std::io::{self, Seek, Write};

use ::exr::block::lines::LineRefMut;
use ::exr::error::Error;
use ::exr::image::write::WritableImage;
use ::exr::image::write::samples::{SamplesWriter, WritableSamples};
use ::exr::image::{AnyChannel, AnyChannels, Encoding as Storage, Image as ExrImage};
use ::exr::image::{Blocks, Layer as ExrLayer};
use ::exr::math::{RoundingMode, Vec2};
use ::exr::meta::attribute::{AttributeValue, LevelMode, LineOrder, SampleType, Text};
use ::exr::meta::header::{Header, LayerAttributes};
use ::exr::prelude::{Compression, SmallVec};

use pinhole::image::encoding::Encoding;
use pinhole::image::{Image, Layer, LayerSet};

/// The name of the attribute that holds a picture's certificate.
pub const CERTIFICATE: &str = "pinhole-certificate";

/// Texts that a file has beside its picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct Remarks<'a> {
    /// Name of the adapter that rendered, if it is known.
    pub adapter: Option<&'a str>,
    /// The text of the picture's certificate, if it has one.
    pub certificate: Option<&'a str>,
}

/// Writes a picture with colour, alpha and the `layers`. This format uses only the transparency of the encoding.
///
/// The picture is not copied. A few rows at a time go to the sink.
///
/// # Errors
/// Returns an error if the picture was rendered without one of the layers, if the encoding is transparent and the
/// picture has no alpha, or if the sink fails.
pub fn write(
    picture: &Image,
    layers: LayerSet,
    encoding: &Encoding,
    remarks: Remarks<'_>,
    mut sink: impl Write + Seek,
) -> Result<(), ExrError> {
    let size = [picture.width() as usize, picture.height() as usize];
    write_planes(size, planes(picture, layers, encoding.transparent)?, remarks, &mut sink)?;
    Ok(sink.flush()?)
}

/// Encodes a certified picture from the samples of its file: red, green, blue and alpha.
pub(crate) fn encode_certified(size: [usize; 2], pixels: &[[f32; 4]], certificate: &str) -> Result<Vec<u8>, ExrError> {
    let mut bytes = io::Cursor::new(Vec::with_capacity(pixels.len() * 17));
    let remarks = Remarks { adapter: None, certificate: Some(certificate) };
    write_planes(size, components(["R", "G", "B", "A"], pixels), remarks, &mut bytes)?;
    Ok(bytes.into_inner())
}

fn write_planes(
    [width, height]: [usize; 2],
    planes: Vec<Plane<'_>>,
    remarks: Remarks<'_>,
    sink: &mut (impl Write + Seek),
) -> Result<(), ExrError> {
    let mut attributes = LayerAttributes::default();
    let mut add = |name, text| attributes.other.insert(latin(name), AttributeValue::Text(latin(text)));
    let compression = if let Some(certificate) = remarks.certificate {
        add(CERTIFICATE, certificate);
        Compression::Uncompressed
    } else {
        remarks.adapter.map(|adapter| add("adapter", adapter));
        attributes.software_name = Text::new_or_none(concat!("pinhole ", env!("CARGO_PKG_VERSION")));
        Compression::ZIP16
    };
    let storage = Storage { compression, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let channels = planes.into_iter().map(|(name, samples)| AnyChannel {
        name: latin(name),
        sample_data: Channel { samples, width },
        quantize_linearly: false,
        sampling: Vec2(1, 1),
    });
    let channels = AnyChannels::sort(channels.collect());
    let image = ExrImage::from_layer(ExrLayer::new(Vec2(width, height), attributes, storage, channels));
    Ok(image.write().to_buffered(sink)?)
}

/// An error of writing an OpenEXR file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExrError {
    /// The picture was rendered without this layer.
    #[error("the picture has no layer {layer}; ask for this layer when rendering")]
    MissingLayer {
        /// The layer that is missing.
        layer: Layer,
    },
    /// The sink failed.
    #[error(transparent)]
    Sink(#[from] io::Error),
    /// The encoder failed.
    #[error("the picture cannot be written as EXR: {message}")]
    Encoder {
        /// The message of the encoder.
        message: String,
    },
}

impl From<Error> for ExrError {
    fn from(error: Error) -> Self {
        match error {
            Error::Io(error) => Self::Sink(error),
            other => Self::Encoder { message: other.to_string() },
        }
    }
}

/// Converts a text to Latin-1, the only encoding of the format. Other characters become `?`.
fn latin(text: &str) -> Text {
    let bytes: SmallVec<[u8; 24]> = text.chars().map(|c| u8::try_from(c).unwrap_or(b'?')).collect();
    Text::from_bytes_unchecked(bytes)
}

/// The name and the samples of a channel.
type Plane<'a> = (&'static str, Samples<'a>);

fn planes(picture: &Image, layers: LayerSet, transparent: bool) -> Result<Vec<Plane<'_>>, ExrError> {
    let missing = |layer| ExrError::MissingLayer { layer };
    let alpha = match transparent {
        true => numbers(picture.alpha().ok_or(missing(Layer::Alpha))?),
        false => Samples::One,
    };
    let mut planes = vec![("A", alpha)];
    for layer in layers.iter() {
        planes.extend(planes_of(picture, layer).ok_or(missing(layer))?);
    }
    Ok(planes)
}

/// Returns the channels of a layer, or `None` if the picture does not have the layer.
fn planes_of(picture: &Image, layer: Layer) -> Option<Vec<Plane<'_>>> {
    let planes = match layer {
        Layer::Color => components(["R", "G", "B"], picture.color()),
        Layer::Alpha => vec![("coverage", numbers(picture.alpha()?))],
        Layer::Depth => vec![("Z", numbers(picture.depth()?))],
        Layer::Normal => components(["N.X", "N.Y", "N.Z"], picture.normal()?),
        Layer::Position => components(["P.X", "P.Y", "P.Z"], picture.position()?),
        Layer::Albedo => components(["albedo.R", "albedo.G", "albedo.B"], picture.albedo()?),
        Layer::Id => vec![("id", Samples::Counts(picture.id()?))],
        Layer::Samples => vec![("samples", Samples::Counts(picture.samples()?))],
        Layer::Variance => vec![("variance", numbers(picture.variance()?))],
    };
    Some(planes)
}

fn numbers(values: &[f32]) -> Samples<'_> {
    Samples::Numbers { values, step: 1 }
}

fn components<'a, const N: usize>(names: [&'static str; N], values: &'a [[f32; N]]) -> Vec<Plane<'a>> {
    let values = values.as_flattened();
    let samples = |first| Samples::Numbers { values: values.get(first..).unwrap_or_default(), step: N };
    names.into_iter().enumerate().map(|(first, name)| (name, samples(first))).collect()
}

/// The samples of a channel, borrowed from the picture.
#[derive(Clone, Copy)]
enum Samples<'a> {
    /// The number 1 for every pixel.
    One,
    /// The first of every `step` numbers.
    Numbers {
        values: &'a [f32],
        step: usize,
    },
    Counts(&'a [u32]),
}

/// The samples of a channel and the width of the picture.
#[derive(Clone, Copy)]
struct Channel<'a> {
    samples: Samples<'a>,
    width: usize,
}

impl<'s, 'a: 's> WritableSamples<'s> for Channel<'a> {
    type Writer = Self;

    fn sample_type(&self) -> SampleType {
        match self.samples {
            Samples::Counts(_) => SampleType::U32,
            _ => SampleType::F32,
        }
    }

    fn infer_level_modes(&self) -> (LevelMode, RoundingMode) {
        (LevelMode::Singular, RoundingMode::Down)
    }

    fn create_samples_writer(&'s self, _: &Header) -> Self {
        *self
    }
}

impl SamplesWriter for Channel<'_> {
    fn extract_line(&self, line: LineRefMut<'_>) {
        let Vec2(x, y) = line.location.position;
        let start = y * self.width + x;
        // Writing cannot fail, because the line's memory has the length of its samples.
        let _ = match self.samples {
            Samples::One => line.write_samples(|_| 1.0_f32),
            Samples::Numbers { values, step } => line.write_samples(|i| values[(start + i) * step]),
            Samples::Counts(values) => line.write_samples(|i| values[start + i]),
        };
    }
}
