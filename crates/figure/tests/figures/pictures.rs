//! Pictures in files, read by other code.

use std::io::Cursor;

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, Text};
use npyz::NpyFile;
use pinhole::image::encoding::{Bits, Encoding};
use pinhole::image::{Layer, NO_ID, color};
use pinhole::{Image, LayerSet, LinearRgb, ToneCurve};
use pinhole_figure::read::picture::read;
use pinhole_figure::write::exr::ExrError;
use pinhole_figure::write::{exr as exr_file, npy, png as png_file};

use crate::support::View;

/// Three spheres with all layers, over black, as for a transparent picture.
fn picture() -> Image {
    let mut view = View::three_spheres();
    view.film = pinhole::Film::new(61, 47).unwrap();
    view.settings.background = LinearRgb::BLACK;
    view.reference()
}

/// A picture of one row of colours, without data layers.
fn row(colors: &[[f32; 3]]) -> Image {
    plain([colors.len() as u32, 1], colors.to_vec())
}

/// A picture with colours only. Its data layers are zero.
pub(crate) fn plain(size: [u32; 2], colors: Vec<[f32; 3]>) -> Image {
    let count = colors.len();
    let (zeros, vectors) = (vec![0.0; count], vec![[0.0; 3]; count]);
    Image::from_layers(size, colors, zeros, vectors, vec![0; count]).unwrap()
}

/// The metadata of a PNG file, and the samples.
pub(crate) fn read_png(file: &[u8]) -> (png::Info<'static>, Vec<u8>) {
    let mut reader = png::Decoder::new(Cursor::new(file)).read_info().unwrap();
    assert!(reader.info().srgb.is_some(), "it says that it is sRGB");
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut samples).unwrap();
    (reader.info().clone(), samples)
}

/// Colour type and bit depth in words, and the samples.
fn decoded(file: &[u8]) -> (String, Vec<u8>) {
    let (info, samples) = read_png(file);
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
    let mut encoding = Encoding::default();
    encoding.bits = Bits::Sixteen;
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
        let mut encoding = Encoding::default();
        (encoding.transparent, encoding.bits) = (true, bits);
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
    let mut transparent = Encoding::default();
    transparent.transparent = true;
    let refused = png_file::encode(&opaque, &transparent);
    assert!(refused.unwrap_err().to_string().contains("alpha"));
}

#[test]
fn exposure_comes_before_the_tone_curve_and_both_before_srgb() {
    let colors = [[0.05, 0.2, 0.7], [3.0, 0.0, 40.0]];
    for tone in ToneCurve::ALL.iter().copied() {
        let mut encoding = Encoding::default().with_exposure(-1.5).unwrap();
        encoding.tone = tone;
        let gain = 2_f32.powf(-1.5);
        let (_, samples) = decoded(&png_file::encode(&row(&colors), &encoding).unwrap());
        for (pixel, rgb) in samples.chunks_exact(3).zip(colors) {
            let expected = color::to_srgb8(tone.apply(rgb.map(|x| x * gain)));
            assert_eq!(pixel, expected, "{tone:?}");
        }
    }
}

/// The channels of an EXR file by name, and its attributes.
struct Exr {
    channels: Vec<(String, FlatSamples)>,
    software: Option<String>,
    adapter: Option<String>,
}

fn written(image: &Image, layers: LayerSet, encoding: Encoding, adapter: Option<&str>) -> Result<Exr, ExrError> {
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
    let mut transparent = Encoding::default();
    transparent.transparent = true;
    let exr = written(&image, LayerSet::ALL, transparent, Some("A GPU™ (Å)")).unwrap();
    assert_eq!(
        exr.names(),
        [
            "A", "B", "G", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "R", "Z", "albedo.B", "albedo.G", "albedo.R",
            "coverage", "id", "samples", "variance"
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

/// Ids beyond the range of f32, and light beyond the range of half.
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
    let mut transparent = Encoding::default();
    transparent.transparent = true;
    let refused = written(&without, LayerSet::COLOR, transparent, None);
    assert!(matches!(refused, Err(ExrError::MissingLayer { layer: Layer::Alpha })));
    let nothing = Image::new(0, 0, LayerSet::COLOR).unwrap();
    assert!(written(&nothing, LayerSet::COLOR, Encoding::default(), None).is_err());
}

/// A sink that takes a limited number of bytes.
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

/// A failure at any byte is an error, with or without a buffer in between.
#[test]
fn a_sink_that_fails_is_an_error() {
    let image = picture();
    let encoding = Encoding::default();
    let mut whole = Cursor::new(Vec::new());
    exr_file::write(&image, LayerSet::ALL, &encoding, exr_file::Remarks::default(), &mut whole).unwrap();
    let size = whole.into_inner().len();
    for room in [0, 3, 100, size / 2, size - 1] {
        let (layers, remarks) = (LayerSet::ALL, exr_file::Remarks::default());
        let full = || Full(Cursor::new(Vec::new()), room);
        for written in [
            exr_file::write(&image, layers, &encoding, remarks, full()),
            exr_file::write(&image, layers, &encoding, remarks, std::io::BufWriter::new(full())),
        ] {
            let kind = match written {
                Err(ExrError::Sink(error)) => error.kind(),
                other => panic!("{room}: {other:?}"),
            };
            assert_eq!(kind, std::io::ErrorKind::StorageFull, "{room}");
        }
    }
}

const CERTIFICATE: &str = "the text of a certificate\n";

/// Certified pictures of 6x4 pixels: PNG files of two kinds, and an OpenEXR file.
fn certified() -> [Vec<u8>; 3] {
    let mut deep = Encoding::default().with_dots_per_inch(Some(300.0)).unwrap();
    let [plain_file, deep_file] = [(Bits::Eight, false, 72), (Bits::Sixteen, true, 192)].map(|(bits, clear, count)| {
        (deep.bits, deep.transparent) = (bits, clear);
        let samples: Vec<u8> = (0..count).map(|i: u8| i.wrapping_mul(31) ^ 5).collect();
        png_file::encode_certified([6, 4], &deep, &samples, CERTIFICATE).unwrap()
    });
    let colors = (1..25_u8).map(|i| [f32::from(i) / 7.0, -0.3, f32::from(i % 5) + 0.1]).collect();
    [plain_file, deep_file, exr_bytes(&plain([6, 4], colors), LayerSet::COLOR)]
}

/// A certified OpenEXR file with these layers.
fn exr_bytes(image: &Image, layers: LayerSet) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let remarks = exr_file::Remarks { adapter: Some("a GPU"), certificate: Some(CERTIFICATE) };
    exr_file::write(image, layers, &Encoding::default(), remarks, &mut bytes).unwrap();
    bytes.into_inner()
}

/// The error for a file, which is one line.
fn refusal(bytes: &[u8]) -> String {
    let error = read(bytes).unwrap_err().to_string();
    assert!(!error.contains('\n') && error.len() < 300, "{error}");
    error
}

#[test]
fn no_byte_of_a_certified_file_is_without_meaning() {
    for file in certified() {
        let whole = read(&file).unwrap();
        assert_eq!(whole.certificate.as_deref(), Some(CERTIFICATE));
        for place in 0..file.len() {
            refusal(&file[..place]);
            for flipped in [1, 2, 4, 8, 16, 32, 64, 128, 255] {
                let mut file = file.clone();
                file[place] ^= flipped;
                // The digests of the samples and of the certificate find what is not refused here.
                assert!(read(&file).ok().as_ref() != Some(&whole), "byte {place} xor {flipped}");
            }
        }
        refusal(&[&file[..], &[0]].concat());
    }
}

fn chunk(name: &str, data: &[u8]) -> Vec<u8> {
    let named = [name.as_bytes(), data].concat();
    let mut crc = flate2::Crc::new();
    crc.update(&named);
    [&(data.len() as u32).to_be_bytes()[..], &named, &crc.sum().to_be_bytes()].concat()
}

#[test]
fn a_certified_png_has_only_the_chunks_of_its_writer() {
    let [file, ..] = certified();
    let mut chunks: Vec<Vec<u8>> = Vec::new();
    while let Some(length) = file.get(8 + chunks.concat().len()..).and_then(|rest| rest.first_chunk()) {
        let start = 8 + chunks.concat().len();
        chunks.push(file[start..start + 12 + u32::from_be_bytes(*length) as usize].to_vec());
    }
    let names: Vec<_> = chunks.iter().map(|chunk| str::from_utf8(&chunk[4..8]).unwrap()).collect();
    assert_eq!(names, ["IHDR", "pHYs", "sRGB", "tEXt", "IDAT", "IEND"]);
    // Puts chunks in the place of some.
    let with = |replaced: std::ops::Range<usize>, by: &[Vec<u8>]| {
        let mut chunks = chunks.clone();
        chunks.splice(replaced, by.iter().cloned());
        [&file[..8], &chunks.concat()].concat()
    };
    let (header, samples) = (&chunks[0][8..21], &chunks[4][8..chunks[4].len() - 4]);
    let [first, second] = [&samples[..20], &samples[20..]].map(|half| chunk("IDAT", half));
    assert_eq!(read(&with(4..5, &[first.clone(), second.clone()])).unwrap(), read(&file).unwrap());

    for (place, name, content) in [
        (4, "gAMA", &[0, 0, 0xb1, 0x8f][..]),
        (4, "cHRM", &[0; 32]),
        (4, "iCCP", b"a\0\0"),
        (4, "tRNS", &[0; 6]),
        (4, "eXIf", b"MM\0*"),
        (4, "iTXt", b"a\0\0\0\0\0b"),
        (5, "PLTE", &[0; 6]),
        (5, "tIME", &[7; 7]),
        (5, "ab\u{1b}z", b""),
    ] {
        let error = refusal(&with(place..place, &[chunk(name, content)]));
        let shown = name.as_bytes().escape_ascii();
        let words =
            format!("it has the chunk {shown}, which `pinhole render` does not write, so that viewers may show");
        assert!(error.starts_with(&words), "{error}");
    }
    let control = chunk("fcTL", &[&[0; 4], &header[..8], &[0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0]].concat());
    let frame = chunk("fdAT", &[&[0, 0, 0, 1], samples].concat());
    let animated = [chunk("acTL", &[0, 0, 0, 1, 0, 0, 0, 0]), chunks[4].clone(), control, frame];
    let [interlaced, smaller] = [(12, 1), (7, 3)].map(|(place, byte)| {
        let mut header = header.to_vec();
        header[place] = byte;
        chunk("IHDR", &header)
    });
    for (forged, words) in [
        (with(4..5, &animated), "it has the chunk acTL, which"),
        (with(0..1, &[interlaced]), "its chunk IHDR is not the one"),
        (with(0..1, &[smaller]), "its stream of samples is not as long"),
        (with(1..2, &[chunk("pHYs", &[0, 0, 9, 0, 0, 0, 1, 0, 1])]), "it has the chunk pHYs"),
        (with(1..2, &[chunk("pHYs", &[0, 0, 9, 0, 0, 0, 9, 0, 0])]), "its chunk pHYs is not the one"),
        (with(2..3, &[chunk("sRGB", &[0])]), "its chunk sRGB is not the one"),
        (with(2..3, &[]), "it lacks the chunk sRGB"),
        (with(4..4, &[chunk("tEXt", b"Title\0a")]), "its chunk tEXt is not the one"),
        (with(4..4, &chunks[3..4]), "it has one chunk of"),
        (with(4..5, &[first, chunks[2].clone(), second]), "it has one chunk of"),
        (with(4..5, &[chunk("IDAT", &[samples, &[0]].concat())]), "its stream of samples is not as long"),
        (with(6..6, &chunks[5..]), "data follow its end"),
    ] {
        let error = refusal(&forged);
        assert!(error.starts_with(words), "{error}");
    }
}

#[test]
fn a_certified_exr_has_only_the_bytes_of_its_writer() {
    let [.., file] = certified();
    // The table of rows has 8 bytes for each. The places in it move with what is put before them.
    let table = file.len() - 4 * (8 + 8 + 6 * 16);
    let with = |attribute: &[u8]| {
        let places = file[table..table + 32].as_chunks::<8>().0.iter().map(|place| u64::from_le_bytes(*place));
        let moved: Vec<u8> = places.flat_map(|place| (place + attribute.len() as u64).to_le_bytes()).collect();
        [&file[..8], attribute, &file[8..table], &moved, &file[table + 32..]].concat()
    };
    let name = b"displayWindow\0box2i\0";
    let window = file.windows(name.len()).position(|bytes| bytes == name).unwrap();
    let mut cropped = file.clone();
    cropped[window + name.len() + 4 + 8] = 2;
    let swapped = [&file[..table], &file[table + 8..table + 16], &file[table..table + 8], &file[table + 16..]].concat();
    for (forged, words) in [
        (cropped, "its attribute displayWindow is not the one"),
        (with(b"whiteLuminance\0float\0\x04\0\0\0\0\0\0\0"), "it has the attribute whiteLuminance, which"),
        (with(b"comments\0string\0\x02\0\0\0hi"), "it has the attribute comments, which"),
        (with(&file[window..window + name.len() + 4 + 16]), "it has one attribute of"),
        (swapped, "its rows are stored in another way"),
        (exr_bytes(&picture(), LayerSet::DATA), "its attribute channels is not the one"),
    ] {
        let error = refusal(&forged);
        assert!(error.starts_with(words), "{words}: {error}");
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
