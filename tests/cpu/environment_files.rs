//! Tests of reading environment maps from files, and of refusing other files.

use std::io::Cursor;

use exr::image::write::layers::WritableLayers;
use exr::meta::attribute::EnvironmentMap;
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    SpecificChannels, WritableImage, f16,
};
use pinhole::Environment;
use pinhole::load::environment::{MAX_TEXELS, read};
use pinhole::load::{LoadError, LoadErrorKind};

fn message(bytes: &[u8]) -> String {
    read(bytes).unwrap_err().to_string()
}

/// A file without run-length encoding.
fn flat_hdr(header: &str, pixels: &[[u8; 4]]) -> Vec<u8> {
    [header.as_bytes(), pixels.as_flattened()].concat()
}

const HEADER: &str = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2.0\n\n-Y 1 +X 2\n";

/// Each component is its byte over 256, times 2 to the power of the last byte less 128.
#[test]
fn radiance_of_known_bytes() {
    for header in
        [HEADER, &HEADER.replace("RADIANCE", "RGBE"), &HEADER.replace("EXPOSURE", "# EXP")]
    {
        let map = read(&flat_hdr(header, &[[128, 64, 32, 129], [255, 0, 1, 138]])).unwrap();
        assert_eq!([map.width(), map.height()], [2, 1]);
        assert_eq!(map.texels(), [[1.0, 0.5, 0.25], [1020.0, 0.0, 4.0]]);
    }
}

fn texels(width: usize, height: usize) -> Vec<[f32; 3]> {
    let mut random = fastrand::Rng::with_seed(4);
    // These numbers fit exactly into f16, and nearly into RGBE.
    (0..width * height)
        .map(|_| [0; 3].map(|_: i32| f32::from(random.u8(..)) / 16.0 + 0.25))
        .collect()
}

fn hdr(width: usize, height: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let pixels: Vec<_> = texels(width, height).into_iter().map(image::Rgb).collect();
    image::codecs::hdr::HdrEncoder::new(&mut bytes).encode(&pixels, width, height).unwrap();
    bytes
}

#[test]
fn radiance_in_runs() {
    // Short lines are not run-length encoded.
    for [width, height] in [[100, 3], [5, 7], [1, 1]] {
        let map = read(&hdr(width, height)).unwrap();
        assert_eq!([map.width() as usize, map.height() as usize], [width, height]);
        for (found, expected) in map.texels().iter().zip(texels(width, height)) {
            let largest = expected.iter().copied().fold(0.0, f32::max);
            for (found, expected) in found.iter().zip(expected) {
                // The precision is eight bits of the largest component.
                assert!((found - expected).abs() <= largest / 128.0, "{found}, {expected}");
            }
        }
    }
}

fn written<'a, Layers: WritableLayers<'a>>(image: &'a Image<Layers>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn exr_of(
    [width, height]: [usize; 2],
    texels: &[[f32; 3]],
    compression: Compression,
    attributes: LayerAttributes,
) -> Vec<u8> {
    let channels = SpecificChannels::rgb(|at: exr::prelude::Vec2<usize>| {
        let [red, green, blue] = texels[at.y() * width + at.x()];
        (red, green, blue)
    });
    let encoding = Encoding { compression, ..Encoding::FAST_LOSSLESS };
    written(&Image::from_layer(Layer::new((width, height), attributes, encoding, channels)))
}

fn exr(width: usize, height: usize, compression: Compression) -> Vec<u8> {
    exr_of([width, height], &texels(width, height), compression, LayerAttributes::default())
}

const COMPRESSIONS: [Compression; 6] = [
    Compression::Uncompressed,
    Compression::RLE,
    Compression::ZIP1,
    Compression::ZIP16,
    Compression::PIZ,
    Compression::PXR24,
];

#[test]
fn exr_of_every_compression() {
    for compression in COMPRESSIONS {
        for [width, height] in [[40, 37], [1, 1]] {
            let map = read(&exr(width, height, compression)).unwrap();
            assert_eq!([map.width() as usize, map.height() as usize], [width, height]);
            // PXR24 keeps 24 bits, which are enough for these numbers.
            assert_eq!(map.texels(), texels(width, height), "{compression:?}");
        }
    }
}

#[test]
fn exr_of_halves_and_other_channels() {
    let channel = |name: &str, value: f32| {
        AnyChannel::new(name, FlatSamples::F16(vec![f16::from_f32(value); 6]))
    };
    let channels = vec![
        channel("A", 0.5),
        channel("B", 3.0),
        channel("G", 2.0),
        channel("R", 1.0),
        channel("Z", f32::INFINITY),
    ];
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let map = read(&written(&Image::from_channels((3, 2), channels))).unwrap();
    assert_eq!(map.texels(), [[1.0, 2.0, 3.0]; 6]);
}

#[test]
fn exr_without_colour_lists_its_channels() {
    let channel = |name| AnyChannel::new(name, FlatSamples::F32(vec![1.0; 4]));
    let channels = ["R", "Y", "diffuse.G"].map(channel);
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let error = read(&written(&Image::from_channels((2, 2), channels))).unwrap_err();
    assert_eq!(
        error.to_string(),
        "no part of the OpenEXR file has the channels R, G and B, which are needed; \
         the first part has R, Y, diffuse.G"
    );
}

#[test]
fn a_cube_map_is_refused() {
    let attributes =
        LayerAttributes { environment_map: Some(EnvironmentMap::Cube), ..Default::default() };
    let bytes = exr_of([1, 6], &texels(1, 6), Compression::RLE, attributes);
    let error = read(&bytes).unwrap_err();
    assert!(error.to_string().contains("cube"), "{error}");
    let attributes = LayerAttributes {
        environment_map: Some(EnvironmentMap::LatitudeLongitude),
        ..Default::default()
    };
    assert!(read(&exr_of([1, 6], &texels(1, 6), Compression::RLE, attributes)).is_ok());
}

/// The decoder of B44 panics on damaged files.
#[test]
fn lossy_blocks_are_not_read() {
    for compression in [Compression::B44, Compression::B44A] {
        let error = read(&exr(4, 4, compression)).unwrap_err();
        assert!(error.to_string().contains("B44"), "{error}");
    }
}

#[test]
fn texels_that_are_not_a_valid_radiance_are_named() {
    for bad in [f32::NAN, -1.0, f32::INFINITY] {
        let mut texels = texels(5, 4);
        texels[13][1] = bad;
        let bytes = exr_of([5, 4], &texels, Compression::ZIP16, LayerAttributes::default());
        assert!(message(&bytes).contains("column 3 of row 2"), "{}", message(&bytes));
    }
    // 255/256 · 2¹²⁷.
    let error = message(&flat_hdr(HEADER, &[[9, 1, 1, 128], [255, 0, 0, 255]]));
    assert!(error.contains("column 1 of row 0"), "{error}");
}

#[test]
fn files_that_are_not_environment_maps() {
    for bytes in [&b""[..], b"#", b"v/1", b"\x89PNG\r\n", b"P6\n1 1\n255\n"] {
        assert_eq!(
            message(bytes),
            "this is neither a Radiance HDR nor an OpenEXR file; convert the image to one of them"
        );
    }
    let is_format = |bytes: &[u8], word: &str| {
        let message = message(bytes);
        let start = "the Radiance HDR file is damaged or of a kind that cannot be read: ";
        assert!(message.starts_with(start) && message.contains(word), "{message}");
        assert!(!message.contains('\n'), "{message}");
    };
    is_format(&flat_hdr(&HEADER.replace("rgbe", "xyze"), &[[0; 4]; 2]), "xyze");
    is_format(&flat_hdr(&HEADER.replace("-Y 1 +X 2", "+X 2 -Y 1"), &[[0; 4]; 2]), "rientation");
    is_format(&flat_hdr(&HEADER.replace("+X 2", "+X many"), &[[0; 4]; 2]), "width");
    let empty = flat_hdr(&HEADER.replace("+X 2", "+X 0"), &[]);
    assert!(message(&empty).contains("0×1"), "{}", message(&empty));
}

#[test]
fn large_maps_are_refused_before_they_are_read() {
    let width = u32::MAX;
    let bytes = flat_hdr(&HEADER.replace("+X 2", &format!("+X {width}")), &[[0; 4]; 2]);
    assert_eq!(
        message(&bytes),
        format!(
            "the image has 4294967295×1 texels, more than the limit of {MAX_TEXELS}; use a smaller image"
        )
    );
    // A size that a file may have, but for which this file is too short.
    let bytes = flat_hdr(&HEADER.replace("+X 2", "+X 10000000"), &[[9; 4]; 2]);
    assert_eq!(read(&bytes).unwrap_err().kind, LoadErrorKind::CutOff);
    // The data window of an OpenEXR file, of which maxima are the last two.
    let mut bytes = exr(4, 4, Compression::Uncompressed);
    let name = b"dataWindow\0box2i\0\x10\0\0\0";
    let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len();
    bytes[at + 8..at + 12].copy_from_slice(&0x0fff_ffff_i32.to_le_bytes());
    assert!(message(&bytes).starts_with("the image has 268435456×4 texels, more than"));
}

/// Reads a file; whatever is in it, the file is read or refused without a panic.
fn survives(bytes: &[u8]) -> Result<Environment, LoadError> {
    let result = read(bytes);
    if let Err(error) = &result {
        assert!(!error.to_string().contains('\n'), "{error}");
    }
    result
}

fn samples() -> Vec<Vec<u8>> {
    let mut samples: Vec<_> = COMPRESSIONS.map(|compression| exr(3, 18, compression)).into();
    samples.extend([hdr(40, 5), hdr(5, 5), flat_hdr(HEADER, &[[9; 4]; 2])]);
    samples
}

#[test]
fn truncated_files_say_so() {
    for bytes in samples() {
        for length in 12..bytes.len() {
            match survives(&bytes[..length]) {
                Err(LoadError { kind: LoadErrorKind::CutOff, message, .. }) => {
                    assert!(message.contains(&format!("after {length} bytes")), "{message}");
                }
                other => panic!("{length} of {}: {other:?}", bytes.len()),
            }
        }
        assert!(survives(&bytes).is_ok());
    }
}

#[test]
fn damaged_files_do_not_panic() {
    let mut random = fastrand::Rng::with_seed(8);
    for bytes in samples() {
        for place in 0..bytes.len() {
            for change in [0x80, random.u8(1..)] {
                let mut damaged = bytes.clone();
                damaged[place] ^= change;
                let _ = survives(&damaged);
            }
        }
    }
}

#[test]
fn noise_does_not_panic() {
    let mut random = fastrand::Rng::with_seed(9);
    for _ in 0..2000 {
        let noise: Vec<u8> = (0..random.usize(..300)).map(|_| random.u8(..)).collect();
        let _ = survives(&[b"#?", &noise[..]].concat());
        let _ = survives(&[HEADER.replace("+X 2", "+X 20").as_bytes(), &noise].concat());
        let _ = survives(&[&[0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0][..], &noise].concat());
    }
    // Markers of runs of no pixels, which multiply what follows.
    let markers = [&[[7; 4]; 1][..], &[[1, 1, 1, 0]; 30]].concat();
    assert!(survives(&flat_hdr(HEADER, &markers)).is_err());
}
