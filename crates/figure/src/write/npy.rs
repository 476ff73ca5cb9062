//! Writes layers as NumPy arrays (`.npy`).

use std::io;

use npyz::{AutoSerialize, WriterBuilder};

use pinhole::image::{Image, Layer};

/// Encodes a layer as an `.npy` file. Its shape is (height, width) or (height, width, 3) in C order, with row 0 at the
/// top. Its type is float32, or uint32 for ids and numbers of samples.
///
/// # Errors
/// Returns an error if the image was rendered without this layer.
pub fn encode(image: &Image, layer: Layer) -> Result<Vec<u8>, NpyError> {
    let (height, width) = (u64::from(image.height()), u64::from(image.width()));
    let vectors = |values: &[[f32; 3]]| array(values.as_flattened(), &[height, width, 3]);
    let numbers = |values: &[f32]| array(values, &[height, width]);
    let counts = |values: &[u32]| array(values, &[height, width]);
    let bytes = match layer {
        Layer::Color => Some(vectors(image.color())),
        Layer::Alpha => image.alpha().map(numbers),
        Layer::Depth => image.depth().map(numbers),
        Layer::Normal => image.normal().map(vectors),
        Layer::Position => image.position().map(vectors),
        Layer::Albedo => image.albedo().map(vectors),
        Layer::Id => image.id().map(counts),
        Layer::Samples => image.samples().map(counts),
        Layer::Variance => image.variance().map(numbers),
    };
    bytes.ok_or(NpyError::MissingLayer { layer })?.map_err(|error| NpyError::Encoder { message: error.to_string() })
}

/// An error of encoding a layer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NpyError {
    /// The image was rendered without this layer.
    #[error("the picture has no layer {layer}; ask for this layer when rendering")]
    MissingLayer {
        /// The layer that is missing.
        layer: Layer,
    },
    /// The encoder failed.
    #[error("the layer cannot be written as .npy: {message}")]
    Encoder {
        /// The message of the encoder.
        message: String,
    },
}

fn array<T: AutoSerialize + Copy>(values: &[T], shape: &[u64]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(size_of_val(values) + 128);
    let mut writer = npyz::WriteOptions::new().default_dtype().shape(shape).writer(&mut bytes).begin_nd()?;
    writer.extend(values.iter().copied())?;
    writer.finish()?;
    Ok(bytes)
}
