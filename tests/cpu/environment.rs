//! Light as an image: where its texels are, and how they are sampled.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use pinhole::glam::DVec3;
use pinhole::light::environment::{Environment, MAX_RADIANCE, MAX_SIZE};

use crate::support::maps::{AS_IT_IS, direction, random_map};

#[test]
fn directions_have_their_texels() {
    let texels = (0..32).map(|i| [i as f32, 0.0, 0.0]).collect();
    let map = Environment::new(8, 4, texels).unwrap();
    let at = |d: [f64; 3], rotation| map.radiance(DVec3::from(d), rotation)[0];
    // Left and right of the middle, above and below it.
    assert_eq!(at([-0.1, 0.1, -1.0], AS_IT_IS), 11.0);
    assert_eq!(at([0.1, 0.1, -1.0], AS_IT_IS), 12.0);
    assert_eq!(at([0.1, -0.1, -1.0], AS_IT_IS), 20.0);
    // To the right, behind, to the left.
    assert_eq!(at([1.0, 0.1, 0.1], AS_IT_IS), 14.0);
    assert_eq!(at([0.1, 0.1, 1.0], AS_IT_IS), 15.0);
    assert_eq!(at([-0.1, 0.1, 1.0], AS_IT_IS), 8.0);
    assert_eq!(at([-1.0, 0.1, 0.1], AS_IT_IS), 9.0);
    // Poles are in the middle, whatever signs zeros have.
    for (y, row) in [(1.0, 0.0), (-1.0, 3.0)] {
        for x in [0.0, -0.0] {
            for z in [0.0, -0.0] {
                assert_eq!(at([x, y, z], AS_IT_IS), 8.0 * row + 4.0);
            }
        }
    }
    // Behind, neither left nor right.
    assert_eq!(at([0.0, 0.1, 1.0], AS_IT_IS), at([-0.0, 0.1, 1.0], AS_IT_IS));
    // A quarter from +z to +x brings what was in front, −z, to the left.
    let rotation = Environment::rotation(FRAC_PI_2);
    assert_eq!(at([-1.0, 0.1, -0.1], rotation), 12.0);
    assert_eq!(at([1.0, 0.1, 0.1], rotation), 8.0);
}

/// Of a texel, without the formula of the library.
fn solid_angle(map: &Environment, row: u32) -> f64 {
    let edge = |row: u32| (PI * f64::from(row) / f64::from(map.height())).cos();
    TAU / f64::from(map.width()) * (edge(row) - edge(row + 1))
}

/// A direction within a texel; parts in [0, 1].
fn within(map: &Environment, [column, row]: [u32; 2], [along, down]: [f64; 2]) -> DVec3 {
    direction(
        (f64::from(column) + along) / f64::from(map.width()),
        (f64::from(row) + down) / f64::from(map.height()),
    )
}

fn texels(map: &Environment) -> impl Iterator<Item = [u32; 2]> {
    let (width, height) = (map.width(), map.height());
    (0..height).flat_map(move |row| (0..width).map(move |column| [column, row]))
}

#[test]
fn densities_add_up_to_one_and_follow_the_light() {
    for (seed, size) in [[1, 1], [16, 8], [7, 13], [1, 64], [200, 1], [512, 256]].iter().enumerate()
    {
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
        for texel in texels(&map) {
            let density = map.density(within(&map, texel, [0.3, 0.6]), AS_IT_IS);
            sum += density * solid_angle(&map, texel[1]);
            assert_eq!(density > 0.0, luminance(texel) > 0.0, "{size:?}, {texel:?}");
            // One share of 2²⁴ for each, and rounding by as much, of columns and of rows.
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
    for (seed, size) in
        [[1, 1], [16, 8], [7, 13], [1, 64], [200, 1], [4096, 16], [16, 2048]].iter().enumerate()
    {
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
                assert!(
                    (found / density - 1.0).abs() < 1e-12,
                    "{size:?}, {u:?}: {found}, {density}"
                );
            }
        }
    }
}

/// Of random samples, each texel has as many as its density says, and each quarter of a texel's solid angle, which
/// are of equal longitude and of equal height, as many as the others: χ² within five standard deviations.
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
            let [column, row] =
                [(along, width), (down, height)].map(|(x, n)| x.min(n - 0.5) as u32);
            let edge = |row: u32| (PI * f64::from(row) / height).cos();
            let is_lower = d.y < 0.5 * (edge(row) + edge(row + 1));
            let quarter = 2 * usize::from(is_lower) + usize::from(along.fract() > 0.5);
            counts[(row * size[0] + column) as usize][quarter] += 1;
        }
        let (mut square, mut cells) = (0.0, 0.0);
        for ([column, row], counts) in texels(&map).zip(&counts) {
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

/// As in a picture of the sun: it has nearly all of the light, and the sky is still sampled.
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

/// The whole light by samples: the mean of luminance over density is the integral, without any variance but
/// that of shares. Each of 2¹¹ texels may have two of 2²⁴ too many; half of the bound is left to chance.
#[test]
fn samples_integrate_the_light_without_variance() {
    let map = random_map(4, [64, 32]);
    let luminance = |d| {
        let [red, green, blue] = map.radiance(d, AS_IT_IS);
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    };
    let expected: f64 = texels(&map)
        .map(|texel| luminance(within(&map, texel, [0.5; 2])) * solid_angle(&map, texel[1]))
        .sum();
    let mut random = fastrand::Rng::with_seed(1);
    let mut mean = 0.0;
    for _ in 0..4096 {
        let (d, density) = map.sample([random.u32(..), random.u32(..)], AS_IT_IS);
        mean += luminance(d) / density / 4096.0;
    }
    assert!((mean / expected - 1.0).abs() < 2_f64.powi(-11), "{mean}, {expected}");
}

/// What arrives from the whole map, by the texels' own sizes.
fn power(map: &Environment) -> [f64; 3] {
    let mut total = [0.0; 3];
    for (texel, [_, row]) in map.texels().iter().zip(texels(map)) {
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
        let values: Vec<_> = row_by_row
            .map(|[x, y]| [1.0 + (x % 7) as f32, (y % 5) as f32, if x == 2 { 1.0 } else { 0.0 }])
            .collect();
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
