//! Pictures: layers as NumPy arrays, and files.

use std::io::Cursor;

use numpy::{Element, IntoPyArray, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use pinhole::image::encoding::Bits;
use pinhole::image::{Image, Layer};
use pinhole::{Encoding, LayerSet};
use pinhole_figure::annotate::Annotations;
use pinhole_figure::write::{exr, npy, png};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::fault::{Fault, Outcome};
use crate::worker;

/// A picture with its layers, and its encoding.
#[pyclass(frozen, module = "pinhole._pinhole")]
pub(crate) struct Picture {
    pub(crate) image: Image,
    pub(crate) encoding: Encoding,
    pub(crate) annotations: Annotations,
    /// The name of the adapter that rendered; None if the CPU did.
    #[pyo3(get)]
    pub(crate) adapter: Option<String>,
    /// The requested layers, which EXR files contain.
    pub(crate) layers: LayerSet,
    /// Notes for the user, one line each.
    #[pyo3(get)]
    pub(crate) notes: Vec<String>,
}

#[pymethods]
impl Picture {
    /// Width in pixels.
    #[getter]
    fn width(&self) -> u32 {
        self.image.width()
    }

    /// Height in pixels.
    #[getter]
    fn height(&self) -> u32 {
        self.image.height()
    }

    /// The names of the picture's layers.
    fn layer_names(&self) -> Vec<&'static str> {
        self.image.layers().iter().map(Layer::name).collect()
    }

    /// A layer as a new array; None if the picture lacks it.
    fn layer<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        let layer: Layer = name.parse().map_err(Fault::input)?;
        let image = &self.image;
        Ok(match layer {
            Layer::Color => Some(self.vectors(py, image.color())?),
            Layer::Normal => image.normal().map(|layer| self.vectors(py, layer)).transpose()?,
            Layer::Position => image.position().map(|layer| self.vectors(py, layer)).transpose()?,
            Layer::Albedo => image.albedo().map(|layer| self.vectors(py, layer)).transpose()?,
            Layer::Alpha => image.alpha().map(|layer| self.numbers(py, layer)).transpose()?,
            Layer::Depth => image.depth().map(|layer| self.numbers(py, layer)).transpose()?,
            Layer::Variance => image.variance().map(|layer| self.numbers(py, layer)).transpose()?,
            Layer::Id => image.id().map(|layer| self.numbers(py, layer)).transpose()?,
            Layer::Samples => image.samples().map(|layer| self.numbers(py, layer)).transpose()?,
        })
    }

    /// The encoded picture with its annotations: uint8 of shape (height, width, 3), or 4 channels if it is transparent.
    fn rgb8<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (this, of_thread) = (slf.get(), slf.clone().unbind());
        let mut encoding = this.encoding;
        encoding.bits = Bits::Eight;
        let channels = if encoding.transparent { 4 } else { 3 };
        let samples = worker::run(py, None, move |_| {
            let Self { image, annotations, .. } = of_thread.get();
            png::samples_annotated(image, &encoding, annotations).map_err(Fault::input)
        })?;
        this.shaped(py, samples, Some(channels))
    }

    /// The bytes of a PNG file.
    fn png<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let this = slf.clone().unbind();
        let bytes = worker::run(py, None, move |_| {
            let Self { image, encoding, annotations, .. } = this.get();
            png::encode_annotated(image, encoding, annotations).map_err(Fault::input)
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The bytes of an OpenEXR file with the requested layers.
    fn exr<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let this = slf.clone().unbind();
        let bytes = worker::run(py, None, move |_| this.get().exr_bytes())?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The bytes of an .npy file of a layer.
    fn npy<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyBytes>> {
        let layer: Layer = name.parse().map_err(Fault::input)?;
        let bytes = npy::encode(&self.image, layer).map_err(Fault::input)?;
        Ok(PyBytes::new(py, &bytes))
    }
}

/// A PNG file of sRGB pixels: uint8 of shape (height, width, 3), or 4 channels with alpha.
#[pyfunction]
pub(crate) fn png_of<'py>(py: Python<'py>, pixels: PyReadonlyArray3<'py, u8>) -> PyResult<Bound<'py, PyBytes>> {
    let [height, width, channels] = *pixels.shape() else {
        return Err(Fault::Internal("pixels have three axes".to_owned()).into());
    };
    let side = |side: usize| u32::try_from(side).map_err(Fault::input);
    let size = [side(width)?, side(height)?];
    // Samples are in the order of rows, whatever the strides are.
    let samples: Vec<u8> = pixels.as_array().iter().copied().collect();
    let bytes = worker::run(py, None, move |_| {
        let encoded = if channels == 4 { png::encode_rgba8(size, &samples) } else { png::encode_rgb8(size, &samples) };
        encoded.map_err(Fault::input)
    })?;
    Ok(PyBytes::new(py, &bytes))
}

impl Picture {
    fn exr_bytes(&self) -> Outcome<Vec<u8>> {
        let mut sink = Cursor::new(Vec::new());
        let remarks = exr::Remarks { adapter: self.adapter.as_deref(), ..exr::Remarks::default() };
        exr::write(&self.image, self.layers, &self.encoding, remarks, &mut sink).map_err(Fault::input)?;
        Ok(sink.into_inner())
    }

    fn vectors<'py>(&self, py: Python<'py>, layer: &[[f32; 3]]) -> PyResult<Bound<'py, PyAny>> {
        self.shaped(py, layer.as_flattened().to_vec(), Some(3))
    }

    fn numbers<'py, T: Element + Copy>(&self, py: Python<'py>, layer: &[T]) -> PyResult<Bound<'py, PyAny>> {
        self.shaped(py, layer.to_vec(), None)
    }

    /// An array of shape (height, width) or (height, width, channels).
    fn shaped<'py, T: Element>(
        &self,
        py: Python<'py>,
        values: Vec<T>,
        channels: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let array = values.into_pyarray(py);
        let (height, width) = (self.image.height() as usize, self.image.width() as usize);
        match channels {
            Some(channels) => Ok(array.reshape([height, width, channels])?.into_any()),
            None => Ok(array.reshape([height, width])?.into_any()),
        }
    }
}
