//! Writes layers and spheres as NumPy arrays (`.npy`).

use std::io::{self, BufWriter, Write};

use npyz::{AutoSerialize, WriterBuilder};

use crate::image::{Image, Layer};

/// A layer as an `.npy` file: shape (H, W) or (H, W, 3), float32, or uint32 for ids and numbers of samples; C
/// order, row 0 at the top.
///
/// # Errors
/// If the image was rendered without this layer.
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
    bytes
        .ok_or(NpyError::MissingLayer { layer })?
        .map_err(|error| NpyError::Encoder { message: error.to_string() })
}

/// Writes spheres as an `.npy` file: shape (n, 4), float32, C order.
///
/// # Errors
/// Those of the sink.
pub fn write_spheres(spheres: &[[f32; 4]], sink: impl Write) -> io::Result<()> {
    let mut sink = BufWriter::new(sink);
    let shape = [spheres.len() as u64, 4];
    let options = npyz::WriteOptions::new().default_dtype().shape(&shape);
    let mut writer = options.writer(&mut sink).begin_nd()?;
    writer.extend(spheres.as_flattened().iter().copied())?;
    writer.finish()?;
    sink.flush()
}

/// Why a layer cannot be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NpyError {
    /// It is not part of the image.
    #[error("the image has no layer {layer}; ask for it when rendering")]
    MissingLayer {
        /// Which layer.
        layer: Layer,
    },
    /// The encoder's reason.
    #[error("the layer cannot be written as npy: {message}")]
    Encoder {
        /// The reason.
        message: String,
    },
}

fn array<T: AutoSerialize + Copy>(values: &[T], shape: &[u64]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(size_of_val(values) + 128);
    let mut writer =
        npyz::WriteOptions::new().default_dtype().shape(shape).writer(&mut bytes).begin_nd()?;
    writer.extend(values.iter().copied())?;
    writer.finish()?;
    Ok(bytes)
}
