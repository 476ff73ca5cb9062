//! Environment maps: the places of their texels, their sampling, and their files.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::io::Cursor;

use exr::image::write::layers::WritableLayers;
use exr::meta::attribute::EnvironmentMap;
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, SpecificChannels,
    WritableImage, f16,
};
use pinhole::Environment;
use pinhole::glam::DVec3;
use pinhole::light::environment::{MAX_RADIANCE, MAX_SIZE};
use pinhole_data::load::{LoadError, LoadErrorKind};
use pinhole_figure::read::environment::{MAX_TEXELS, read};

use crate::support::maps::{AS_IT_IS, direction, random_map};

#[test]
fn directions_have_their_texels() {
    let texels = (0..32).map(|i| [i as f32, 0.0, 0.0]).collect();
    let map = Environment::new(8, 4, texels).unwrap();
    let at = |d: [f64; 3], rotation| map.radiance(DVec3::from(d), rotation)[0];
    // Left and right of the middle, and above and below it.
    assert_eq!(at([-0.1, 0.1, -1.0], AS_IT_IS), 11.0);
    assert_eq!(at([0.1, 0.1, -1.0], AS_IT_IS), 12.0);
    assert_eq!(at([0.1, -0.1, -1.0], AS_IT_IS), 20.0);
    // To the right, behind, to the left.
    assert_eq!(at([1.0, 0.1, 0.1], AS_IT_IS), 14.0);
    assert_eq!(at([0.1, 0.1, 1.0], AS_IT_IS), 15.0);
    assert_eq!(at([-0.1, 0.1, 1.0], AS_IT_IS), 8.0);
    assert_eq!(at([-1.0, 0.1, 0.1], AS_IT_IS), 9.0);
    // Poles are in the middle, for any signs of zeros.
    for (y, row) in [(1.0, 0.0), (-1.0, 3.0)] {
        for x in [0.0, -0.0] {
            for z in [0.0, -0.0] {
                assert_eq!(at([x, y, z], AS_IT_IS), 8.0 * row + 4.0);
            }
        }
    }
    // Behind, neither left nor right.
    assert_eq!(at([0.0, 0.1, 1.0], AS_IT_IS), at([-0.0, 0.1, 1.0], AS_IT_IS));
    // A quarter turn from +z to +x brings the front, −z, to the left.
    let rotation = Environment::rotation(FRAC_PI_2);
    assert_eq!(at([-1.0, 0.1, -0.1], rotation), 12.0);
    assert_eq!(at([1.0, 0.1, 0.1], rotation), 8.0);
}

/// The solid angle of a texel, without the formula of the library.
fn solid_angle(map: &Environment, row: u32) -> f64 {
    let edge = |row: u32| (PI * f64::from(row) / f64::from(map.height())).cos();
    TAU / f64::from(map.width()) * (edge(row) - edge(row + 1))
}

/// A direction within a texel, at fractions of its sides.
fn within(map: &Environment, [column, row]: [u32; 2], [along, down]: [f64; 2]) -> DVec3 {
    direction((f64::from(column) + along) / f64::from(map.width()), (f64::from(row) + down) / f64::from(map.height()))
}

fn places(map: &Environment) -> impl Iterator<Item = [u32; 2]> {
    let (width, height) = (map.width(), map.height());
    (0..height).flat_map(move |row| (0..width).map(move |column| [column, row]))
}

#[test]
fn densities_add_up_to_one_and_follow_the_light() {
    for (seed, size) in [[1, 1], [16, 8], [7, 13], [1, 64], [200, 1], [512, 256]].iter().enumerate() {
        let map = random_map(seed as u64, *size);
        let luminance = |texel: [u32; 2]| {
            let [red, green, blue] = map.radiance(within(&map, texel, [0.5; 2]), AS_IT_IS);
            0.2126 * red + 0.7152 * green + 0.0722 * blue
        };
        let power = |texel: [u32; 2]| luminance(texel) * solid_angle(&map, texel[1]);
        let row = |row| (0..size[0]).map(|column| power([column, row])).sum::<f64>();
        let rows: Vec<_> = (0..size[1]).map(row).collect();
        let total: f64 = rows.iter().sum();
        let mut sum = 0.0;
        for texel in places(&map) {
            let density = map.density(within(&map, texel, [0.3, 0.6]), AS_IT_IS);
            sum += density * solid_angle(&map, texel[1]);
            assert_eq!(density > 0.0, luminance(texel) > 0.0, "{size:?}, {texel:?}");
            // One share of 2²⁴ for each, and rounding by as much, for columns and rows.
            let probability = density * solid_angle(&map, texel[1]);
            let shares = f64::from(2 * (size[0] + size[1])) / f64::from(1 << 24);
            let expected = power(texel) / total;
            let row = rows[texel[1] as usize] / total;
            let bound = shares * expected + 2.0 * (row + 1.0) / f64::from(1 << 24);
            assert!((probability - expected).abs() <= bound, "{size:?}, {texel:?}: {probability}");
        }
        assert!((sum - 1.0).abs() < 1e-9, "{size:?}: {sum}");
    }
}

#[test]
fn sampled_directions_have_the_density_that_comes_with_them() {
    let mut random = fastrand::Rng::with_seed(3);
    for (seed, size) in [[1, 1], [16, 8], [7, 13], [1, 64], [200, 1], [4096, 16], [16, 2048]].iter().enumerate() {
        let map = random_map(seed as u64, *size);
        for rotation in [AS_IT_IS, Environment::rotation(1.0), Environment::rotation(-2.5)] {
            let extremes = [0, 1, u32::MAX - 1, u32::MAX, 1 << 31, 0xffff_ff00, 255];
            let extremes = extremes.map(|u| extremes.map(|v| [u, v])).concat();
            let any = (0..10_000).map(|_| [random.u32(..), random.u32(..)]);
            for u in any.chain(extremes) {
                let (direction, density) = map.sample(u, rotation);
                // Cosine and sine are those of f32.
                assert!((direction.length() - 1.0).abs() < 2e-7, "{u:?}");
                assert!(density > 0.0);
                let found = map.density(direction, rotation);
                assert!((found / density - 1.0).abs() < 1e-12, "{size:?}, {u:?}: {found}, {density}");
            }
        }
    }
}

/// Each texel gets as many random samples as its density says, within five standard deviations of χ². So does each
/// quarter of a texel's solid angle, where quarters have equal longitude and equal height.
#[test]
fn samples_follow_the_density() {
    const COUNT: usize = 1 << 20;
    let mut random = fastrand::Rng::with_seed(5);
    for (seed, size) in [[1, 1], [16, 8], [7, 13], [3, 2]].iter().enumerate() {
        let map = random_map(seed as u64, *size);
        let [width, height] = size.map(f64::from);
        let mut counts = vec![[0_usize; 4]; (size[0] * size[1]) as usize];
        for _ in 0..COUNT {
            let (d, _) = map.sample([random.u32(..), random.u32(..)], AS_IT_IS);
            let along = (d.x.atan2(-d.z) / TAU + 0.5) * width;
            let down = d.y.clamp(-1.0, 1.0).acos() / PI * height;
            let [column, row] = [(along, width), (down, height)].map(|(x, n)| x.min(n - 0.5) as u32);
            let edge = |row: u32| (PI * f64::from(row) / height).cos();
            let is_lower = d.y < 0.5 * (edge(row) + edge(row + 1));
            let quarter = 2 * usize::from(is_lower) + usize::from(along.fract() > 0.5);
            counts[(row * size[0] + column) as usize][quarter] += 1;
        }
        let (mut square, mut cells) = (0.0, 0.0);
        for ([column, row], counts) in places(&map).zip(&counts) {
            let density = map.density(within(&map, [column, row], [0.5; 2]), AS_IT_IS);
            let expected = density * solid_angle(&map, row) * COUNT as f64 / 4.0;
            if expected == 0.0 {
                assert_eq!(*counts, [0; 4]);
            } else if expected >= 5.0 {
                for count in counts {
                    square += (*count as f64 - expected).powi(2) / expected;
                    cells += 1.0;
                }
            }
        }
        let deviation = (square - cells) / (2.0_f64 * cells).sqrt();
        assert!(deviation.abs() < 5.0, "{size:?}: {square} of {cells} cells");
    }
}

#[test]
fn a_single_bright_texel_has_every_sample() {
    let mut random = fastrand::Rng::with_seed(9);
    for [column, row] in [[0, 0], [63, 31], [20, 0], [31, 16], [5, 31]] {
        let mut texels = vec![[0.0; 3]; 64 * 32];
        texels[(64 * row + column) as usize] = [0.0, 0.0, 1e-20];
        let map = Environment::new(64, 32, texels).unwrap();
        let expected = 1.0 / solid_angle(&map, row);
        for _ in 0..1000 {
            let (direction, density) = map.sample([random.u32(..), random.u32(..)], AS_IT_IS);
            assert!((density / expected - 1.0).abs() < 1e-12, "{density}, {expected}");
            assert!(map.radiance(direction, AS_IT_IS)[2] > 0.0, "{direction}");
        }
        assert_eq!(map.density(DVec3::new(0.0, 0.3, -1.0), AS_IT_IS), 0.0);
    }
}

/// A map like a picture of the sun, which has nearly all of the light. The sky is still sampled.
#[test]
fn no_light_is_too_faint() {
    let mut texels = vec![[1e-9; 3]; 4096 * 256];
    texels[4096 * 70 + 1000] = [1e9; 3];
    let map = Environment::new(4096, 256, texels).unwrap();
    for d in [DVec3::Y, DVec3::X, DVec3::Z, DVec3::NEG_Y, DVec3::ONE.normalize_or_zero()] {
        assert!(map.density(d, AS_IT_IS) > 0.0, "{d}");
    }
    let (direction, _) = map.sample([1 << 31; 2], AS_IT_IS);
    assert!(map.radiance(direction, AS_IT_IS)[0] > 1e8);
}

#[test]
fn a_black_map_has_nothing_to_sample() {
    let map = Environment::new(4, 2, vec![[0.0; 3]; 8]).unwrap();
    assert!(!map.has_light());
    for u in [[0; 2], [u32::MAX; 2], [77; 2]] {
        let (direction, density) = map.sample(u, AS_IT_IS);
        assert_eq!(density, 0.0);
        assert!((direction.length() - 1.0).abs() < 1e-12);
        assert_eq!(map.density(direction, AS_IT_IS), 0.0);
    }
    assert!(random_map(1, [4, 2]).has_light());
}

/// The mean of luminance over density is the integral of the light, without any variance but that of shares. Each of
/// 2¹¹ texels may have two of 2²⁴ too many. Half of the bound is left to chance.
#[test]
fn samples_integrate_the_light_without_variance() {
    let map = random_map(4, [64, 32]);
    let luminance = |d| {
        let [red, green, blue] = map.radiance(d, AS_IT_IS);
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    };
    let expected: f64 =
        places(&map).map(|texel| luminance(within(&map, texel, [0.5; 2])) * solid_angle(&map, texel[1])).sum();
    let mut random = fastrand::Rng::with_seed(1);
    let mut mean = 0.0;
    for _ in 0..4096 {
        let (d, density) = map.sample([random.u32(..), random.u32(..)], AS_IT_IS);
        mean += luminance(d) / density / 4096.0;
    }
    assert!((mean / expected - 1.0).abs() < 2_f64.powi(-11), "{mean}, {expected}");
}

/// The total light of a map, by the texels' own solid angles.
fn power(map: &Environment) -> [f64; 3] {
    let mut total = [0.0; 3];
    for (texel, [_, row]) in map.texels().iter().zip(places(map)) {
        for (sum, component) in total.iter_mut().zip(texel) {
            *sum += f64::from(*component) * solid_angle(map, row);
        }
    }
    total
}

#[test]
fn large_maps_keep_their_light() {
    for (size, expected) in [
        ([8192, 40], [4096, 20]),
        ([4097, 2], [2049, 1]),
        ([9001, 101], [3001, 34]),
        ([4, 2049], [2, 1025]),
        ([10, 4096], [5, 2048]),
        ([MAX_SIZE[0], 3], [MAX_SIZE[0], 3]),
        ([3, MAX_SIZE[1]], [3, MAX_SIZE[1]]),
    ] {
        let row_by_row = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| [column, row]));
        let values: Vec<_> =
            row_by_row.map(|[x, y]| [1.0 + (x % 7) as f32, (y % 5) as f32, if x == 2 { 1.0 } else { 0.0 }]).collect();
        let mut before = [0.0; 3];
        for (value, index) in values.iter().zip(0..) {
            let row = f64::from(index / size[0]);
            let edge = |row: f64| (PI * row / f64::from(size[1])).cos();
            let angle = TAU / f64::from(size[0]) * (edge(row) - edge(row + 1.0));
            for (sum, component) in before.iter_mut().zip(value) {
                *sum += f64::from(*component) * angle;
            }
        }
        let map = Environment::new(size[0], size[1], values).unwrap();
        assert_eq!([map.width(), map.height()], expected);
        for (before, after) in before.iter().zip(power(&map)) {
            assert!((after / before - 1.0).abs() < 1e-6, "{size:?}: {before}, {after}");
        }
    }
    let map = Environment::new(6000, 30, vec![[0.25, 1.0, 3.0]; 6000 * 30]).unwrap();
    assert!(map.texels().iter().all(|texel| *texel == [0.25, 1.0, 3.0]));
}

#[test]
fn what_is_no_radiance_is_refused_by_name() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1e-9, MAX_RADIANCE * 1.1] {
        for component in 0..3 {
            let mut texels = vec![[1.0; 3]; 12];
            texels[7][component] = bad;
            let value = format!("the texel in column 3 of row 1 is {:?};", texels[7]);
            let error = Environment::new(4, 3, texels).unwrap_err().to_string();
            assert!(error.starts_with(&value), "{error}");
        }
    }
    let largest = Environment::new(1, 1, vec![[MAX_RADIANCE, 0.0, -0.0]]).unwrap();
    assert!(largest.sample([0; 2], AS_IT_IS).1 > 0.0);
    let message = Environment::new(1, 1, vec![[0.0, -1.0, 2.5]]).unwrap_err().to_string();
    assert_eq!(
        message,
        "the texel in column 0 of row 0 is [0.0, -1.0, 2.5]; radiance is a number from 0 to 1.8446744e19"
    );
    assert_eq!(
        Environment::new(0, 3, vec![]).unwrap_err().to_string(),
        "a map of 0×3 texels is empty; width and height must be at least 1"
    );
    assert_eq!(
        Environment::new(2, 3, vec![[0.0; 3]; 5]).unwrap_err().to_string(),
        "a map of 2×3 texels was given 5; it needs width times height"
    );
    assert!(Environment::new(u32::MAX, u32::MAX, vec![]).is_err());
}

fn message(bytes: &[u8]) -> String {
    read(bytes).unwrap_err().to_string()
}

/// A Radiance file without run-length encoding.
fn flat_hdr(header: &str, pixels: &[[u8; 4]]) -> Vec<u8> {
    [header.as_bytes(), pixels.as_flattened()].concat()
}

const HEADER: &str = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2.0\n\n-Y 1 +X 2\n";

/// Each component is its byte divided by 256, times 2 to the power of the last byte less 128.
#[test]
fn radiance_of_known_bytes() {
    for header in [HEADER, &HEADER.replace("RADIANCE", "RGBE"), &HEADER.replace("EXPOSURE", "# EXP")] {
        let map = read(&flat_hdr(header, &[[128, 64, 32, 129], [255, 0, 1, 138]])).unwrap();
        assert_eq!([map.width(), map.height()], [2, 1]);
        assert_eq!(map.texels(), [[1.0, 0.5, 0.25], [1020.0, 0.0, 4.0]]);
    }
}

fn texels(width: usize, height: usize) -> Vec<[f32; 3]> {
    let mut random = fastrand::Rng::with_seed(4);
    // These numbers fit exactly into f16, and nearly into RGBE.
    (0..width * height).map(|_| [0; 3].map(|_: i32| f32::from(random.u8(..)) / 16.0 + 0.25)).collect()
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
    let channel = |name: &str, value: f32| AnyChannel::new(name, FlatSamples::F16(vec![f16::from_f32(value); 6]));
    let channels =
        vec![channel("A", 0.5), channel("B", 3.0), channel("G", 2.0), channel("R", 1.0), channel("Z", f32::INFINITY)];
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
    let attributes = LayerAttributes { environment_map: Some(EnvironmentMap::Cube), ..Default::default() };
    let bytes = exr_of([1, 6], &texels(1, 6), Compression::RLE, attributes);
    let error = read(&bytes).unwrap_err();
    assert!(error.to_string().contains("cube"), "{error}");
    let attributes = LayerAttributes { environment_map: Some(EnvironmentMap::LatitudeLongitude), ..Default::default() };
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
        format!("the image has 4294967295×1 texels, more than the limit of {MAX_TEXELS}; use a smaller image")
    );
    // A size that is valid, but too large for this file.
    let bytes = flat_hdr(&HEADER.replace("+X 2", "+X 10000000"), &[[9; 4]; 2]);
    assert_eq!(read(&bytes).unwrap_err().kind, LoadErrorKind::CutOff);
    // The data window of an OpenEXR file. Its maxima are the last two numbers.
    let mut bytes = exr(4, 4, Compression::Uncompressed);
    let name = b"dataWindow\0box2i\0\x10\0\0\0";
    let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len();
    bytes[at + 8..at + 12].copy_from_slice(&0x0fff_ffff_i32.to_le_bytes());
    assert!(message(&bytes).starts_with("the image has 268435456×4 texels, more than"));
}

/// Reads a file with any content. It must be read or refused without a panic.
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
fn many_empty_runs_are_refused() {
    // Markers of empty runs, which multiply the length of the next run.
    let markers = [&[[7; 4]; 1][..], &[[1, 1, 1, 0]; 30]].concat();
    assert!(survives(&flat_hdr(HEADER, &markers)).is_err());
}
