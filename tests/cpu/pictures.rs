//! Pictures as files: PNG of every kind, EXR, and arrays, read back by other code.

use std::io::Cursor;

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, Text};
use npyz::NpyFile;
use pinhole::image::color;
use pinhole::image::encoding::{Bits, Encoding};
use pinhole::image::{Layer, NO_ID};
use pinhole::write::exr::ExrError;
use pinhole::write::{exr as exr_file, npy, png as png_file};
use pinhole::{Image, LayerSet, LinearRgb, ToneCurve};

use crate::support::View;

/// Three spheres with all layers, over black, as a transparent picture wants it.
fn picture() -> Image {
    let mut view = View::three_spheres();
    view.film = pinhole::Film::new(61, 47).unwrap();
    view.settings.background = LinearRgb::BLACK;
    view.reference()
}

/// A row of colours and nothing else.
fn row(colors: &[[f32; 3]]) -> Image {
    let pixels = colors.len();
    let (zeros, vectors) = (vec![0.0; pixels], vec![[0.0; 3]; pixels]);
    let size = [pixels as u32, 1];
    Image::from_layers(size, colors.to_vec(), zeros, vectors, vec![0; pixels]).unwrap()
}

/// Colour type and depth in words, and the samples.
fn decoded(file: &[u8]) -> (String, Vec<u8>) {
    let mut reader = png::Decoder::new(Cursor::new(file)).read_info().unwrap();
    assert!(reader.info().srgb.is_some(), "it says that it is sRGB");
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut samples).unwrap();
    (format!("{:?} {:?}", info.color_type, info.bit_depth), samples)
}

fn decoded16(file: &[u8]) -> Vec<u16> {
    let samples = decoded(file).1;
    samples.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect()
}

#[test]
fn without_more_a_png_is_eight_bits_of_srgb() {
    let image = picture();
    let (kind, samples) = decoded(&png_file::encode(&image, &Encoding::default()).unwrap());
    assert_eq!(kind, "Rgb Eight");
    let expected: Vec<u8> = image.color().iter().flat_map(|rgb| color::to_srgb8(*rgb)).collect();
    assert_eq!(samples, expected);
}

#[test]
fn sixteen_bits_tell_apart_what_eight_do_not() {
    let encoding = Encoding::default().with_bits(Bits::Sixteen);
    let red = LinearRgb::from_srgb8([255, 128, 1]).to_array();
    let image = row(&[red, [0.5; 3], [0.5001; 3], [9.0, -1.0, f32::NAN]]);
    let file = png_file::encode(&image, &encoding).unwrap();
    assert_eq!(decoded(&file).0, "Rgb Sixteen");
    let samples = decoded16(&file);
    assert_eq!(samples[..3], [65535, 128 * 257, 257]);
    assert_eq!(samples[3], 48192, "of IEC 61966-2-1, by hand");
    assert!(samples[6] > samples[3] && samples[6] - samples[3] < 10, "{samples:?}");
    assert_eq!(samples[9..], [65535, 0, 0]);
}

#[test]
fn a_transparent_png_is_not_premultiplied() {
    let image = picture();
    for bits in [Bits::Eight, Bits::Sixteen] {
        let encoding = Encoding::default().with_transparent(true).with_bits(bits);
        let file = png_file::encode(&image, &encoding).unwrap();
        let (kind, samples) = decoded(&file);
        let size = if bits == Bits::Eight { 1 } else { 2 };
        assert_eq!(kind, if size == 1 { "Rgba Eight" } else { "Rgba Sixteen" });
        for (pixel, id) in samples.chunks_exact(4 * size).zip(image.id().unwrap()) {
            let expected = match id {
                0 => [0xff, 0, 0, 0xff],
                1 => [0, 0x80, 0, 0xff],
                2 => [0, 0, 0xff, 0xff],
                _ => [0; 4],
            };
            let expected: Vec<u8> = expected.iter().flat_map(|byte| vec![*byte; size]).collect();
            assert_eq!(pixel, expected, "sphere {id}");
        }
    }
    let opaque = row(&[[0.5; 3]]);
    let refused = png_file::encode(&opaque, &Encoding::default().with_transparent(true));
    assert!(refused.unwrap_err().to_string().contains("alpha"));
}

#[test]
fn exposure_comes_before_the_tone_curve_and_both_before_srgb() {
    let colors = [[0.05, 0.2, 0.7], [3.0, 0.0, 40.0]];
    for tone in ToneCurve::ALL.iter().copied() {
        let encoding = Encoding::default().with_tone(tone).with_exposure(-1.5).unwrap();
        let gain = 2_f32.powf(-1.5);
        let (_, samples) = decoded(&png_file::encode(&row(&colors), &encoding).unwrap());
        for (pixel, rgb) in samples.chunks_exact(3).zip(colors) {
            let expected = color::to_srgb8(tone.apply(rgb.map(|x| x * gain)));
            assert_eq!(pixel, expected, "{tone:?}");
        }
    }
}

/// A file's channels by name, and its attributes.
struct Exr {
    channels: Vec<(String, FlatSamples)>,
    software: Option<String>,
    adapter: Option<String>,
}

fn written(
    image: &Image,
    layers: LayerSet,
    encoding: Encoding,
    adapter: Option<&str>,
) -> Result<Exr, ExrError> {
    let mut file = Vec::new();
    let remarks = exr_file::Remarks { adapter, ..exr_file::Remarks::default() };
    exr_file::write(image, layers, &encoding, remarks, Cursor::new(&mut file))?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(file))
        .unwrap();
    let layer = image.layer_data;
    assert_eq!(layer.encoding.compression, exr::prelude::Compression::ZIP16);
    let attributes = layer.attributes;
    let adapter = attributes.other.get(&Text::from("adapter")).map(|value| match value {
        exr::prelude::AttributeValue::Text(text) => text.to_string(),
        other => panic!("{other:?}"),
    });
    Ok(Exr {
        channels: layer
            .channel_data
            .list
            .into_iter()
            .map(|channel| (channel.name.to_string(), channel.sample_data))
            .collect(),
        software: attributes.software_name.map(|name| name.to_string()),
        adapter,
    })
}

impl Exr {
    fn names(&self) -> Vec<&str> {
        self.channels.iter().map(|(name, _)| name.as_str()).collect()
    }

    fn samples(&self, name: &str) -> &FlatSamples {
        &self.channels.iter().find(|(channel, _)| channel == name).unwrap().1
    }

    fn numbers(&self, name: &str) -> Vec<u32> {
        match self.samples(name) {
            FlatSamples::F32(samples) => samples.iter().map(|x| x.to_bits()).collect(),
            other => panic!("{name}: {other:?}"),
        }
    }

    fn counts(&self, name: &str) -> Vec<u32> {
        match self.samples(name) {
            FlatSamples::U32(samples) => samples.clone(),
            other => panic!("{name}: {other:?}"),
        }
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|x| x.to_bits()).collect()
}

fn component(values: &[[f32; 3]], place: usize) -> Vec<u32> {
    values.iter().map(|vector| vector[place].to_bits()).collect()
}

#[test]
fn an_exr_holds_every_number_of_every_layer() {
    let image = picture();
    let transparent = Encoding::default().with_transparent(true);
    let exr = written(&image, LayerSet::ALL, transparent, Some("A GPU™ (Å)")).unwrap();
    assert_eq!(
        exr.names(),
        [
            "A", "B", "G", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "R", "Z", "albedo.B",
            "albedo.G", "albedo.R", "coverage", "id", "samples", "variance"
        ]
    );
    for (place, axis) in ["X", "Y", "Z"].iter().enumerate() {
        assert_eq!(exr.numbers(&format!("N.{axis}")), component(image.normal().unwrap(), place));
        assert_eq!(exr.numbers(&format!("P.{axis}")), component(image.position().unwrap(), place));
    }
    for (place, name) in ["R", "G", "B"].iter().enumerate() {
        assert_eq!(exr.numbers(name), component(image.color(), place));
        let albedo = component(image.albedo().unwrap(), place);
        assert_eq!(exr.numbers(&format!("albedo.{name}")), albedo);
    }
    assert_eq!(exr.numbers("A"), bits(image.alpha().unwrap()));
    assert_eq!(exr.numbers("coverage"), bits(image.alpha().unwrap()));
    assert_eq!(exr.numbers("Z"), bits(image.depth().unwrap()));
    assert_eq!(exr.numbers("Z")[0], f32::INFINITY.to_bits());
    assert_eq!(exr.numbers("variance"), bits(image.variance().unwrap()));
    assert_eq!(exr.counts("id"), image.id().unwrap());
    assert_eq!(exr.counts("id")[0], NO_ID);
    assert_eq!(exr.counts("samples"), vec![1; 61 * 47]);
    assert_eq!(exr.software.as_deref(), Some(concat!("pinhole ", env!("CARGO_PKG_VERSION"))));
    assert_eq!(exr.adapter.as_deref(), Some("A GPU? (Å)"));
}

/// Ids beyond what f32 holds, and light beyond what half does.
#[test]
fn an_exr_rounds_nothing() {
    let ids = vec![0, 16_777_217, 4_294_967_294, NO_ID];
    let colors = vec![[1e-30, 70_000.0, 1.000_000_1]; 4];
    let depths = vec![f32::MIN_POSITIVE, 0.1, 1e30, f32::INFINITY];
    let normals = vec![[0.0; 3]; 4];
    let image = Image::from_layers([4, 1], colors.clone(), depths.clone(), normals, ids.clone());
    let exr = written(&image.unwrap(), LayerSet::DATA, Encoding::default(), None).unwrap();
    assert_eq!(exr.counts("id"), ids);
    assert_eq!(exr.numbers("Z"), bits(&depths));
    for (place, name) in ["R", "G", "B"].iter().enumerate() {
        assert_eq!(exr.numbers(name), component(&colors, place));
    }
    assert_eq!(exr.numbers("A"), bits(&[1.0; 4]), "it is not transparent");
    assert_eq!(exr.adapter, None);
}

#[test]
fn an_exr_holds_what_is_asked_for() {
    let image = picture();
    let exr = written(&image, LayerSet::COLOR, Encoding::default(), None).unwrap();
    assert_eq!(exr.names(), ["A", "B", "G", "R"]);
    let layers = LayerSet::COLOR.with(Layer::Depth);
    let exr = written(&image, layers, Encoding::default(), None).unwrap();
    assert_eq!(exr.names(), ["A", "B", "G", "R", "Z"]);

    let without = row(&[[0.5; 3]]);
    let layers = LayerSet::COLOR.with(Layer::Variance);
    let refused = written(&without, layers, Encoding::default(), None);
    assert!(matches!(refused, Err(ExrError::MissingLayer { layer: Layer::Variance })));
    let transparent = Encoding::default().with_transparent(true);
    let refused = written(&without, LayerSet::COLOR, transparent, None);
    assert!(matches!(refused, Err(ExrError::MissingLayer { layer: Layer::Alpha })));
    let nothing = Image::new(0, 0, LayerSet::COLOR).unwrap();
    assert!(written(&nothing, LayerSet::COLOR, Encoding::default(), None).is_err());
}

/// Takes so many bytes and no more.
struct Full(Cursor<Vec<u8>>, usize);

impl std::io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let end = self.0.position() as usize + bytes.len();
        if end > self.1 {
            return Err(std::io::ErrorKind::StorageFull.into());
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.0.flush()
    }
}

impl std::io::Seek for Full {
    fn seek(&mut self, to: std::io::SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

/// Wherever it fails, with a buffer in between or without.
#[test]
fn a_sink_that_fails_is_an_error() {
    let image = picture();
    let encoding = Encoding::default();
    let mut whole = Cursor::new(Vec::new());
    exr_file::write(&image, LayerSet::ALL, &encoding, exr_file::Remarks::default(), &mut whole)
        .unwrap();
    let size = whole.into_inner().len();
    for room in [0, 3, 100, size / 2, size - 1] {
        for buffered in [false, true] {
            let full = Full(Cursor::new(Vec::new()), room);
            let written = match buffered {
                true => {
                    let full = std::io::BufWriter::new(full);
                    exr_file::write(
                        &image,
                        LayerSet::ALL,
                        &encoding,
                        exr_file::Remarks::default(),
                        full,
                    )
                }
                false => exr_file::write(
                    &image,
                    LayerSet::ALL,
                    &encoding,
                    exr_file::Remarks::default(),
                    full,
                ),
            };
            let kind = match written {
                Err(ExrError::Sink(error)) => error.kind(),
                other => panic!("{room}: {other:?}"),
            };
            assert_eq!(kind, std::io::ErrorKind::StorageFull, "{room}");
        }
    }
}

#[test]
fn every_layer_is_an_array() {
    let image = picture();
    for layer in LayerSet::ALL.iter() {
        let bytes = npy::encode(&image, layer).unwrap();
        let file = NpyFile::new(&bytes[..]).unwrap();
        let is_vector = layer.bytes_per_pixel() == 12;
        let shape: &[u64] = if is_vector { &[47, 61, 3] } else { &[47, 61] };
        assert_eq!(file.shape(), shape, "{layer}");
        let is_count = matches!(layer, Layer::Id | Layer::Samples);
        assert_eq!(file.dtype().descr(), if is_count { "'<u4'" } else { "'<f4'" }, "{layer}");
    }
    let read = |layer| {
        let bytes = npy::encode(&image, layer).unwrap();
        bits(&NpyFile::new(&bytes[..]).unwrap().into_vec::<f32>().unwrap())
    };
    assert_eq!(read(Layer::Alpha), bits(image.alpha().unwrap()));
    assert_eq!(read(Layer::Variance), bits(image.variance().unwrap()));
    assert_eq!(read(Layer::Position), bits(image.position().unwrap().as_flattened()));
    assert_eq!(read(Layer::Albedo), bits(image.albedo().unwrap().as_flattened()));
    let missing = npy::encode(&row(&[[0.0; 3]]), Layer::Samples).unwrap_err().to_string();
    assert!(missing.contains("no layer samples"), "{missing}");
}
