//! Outlines equal those of a simple second implementation, to the bit.

use std::collections::BTreeMap;

use fastrand::Rng;
use pinhole::glam::Vec2;
use pinhole::image::{Layer, NO_ID};
use pinhole::render::{Integrator, Outline, Studio};
use pinhole::{Image, LayerSet, LinearRgb, RenderSettings, cpu};

const LAYERS: LayerSet = LayerSet::DATA.with(Layer::Alpha);

/// A picture of spheres seen from far away, in random colours.
fn pictured(size: [usize; 2], rng: &mut Rng) -> Image {
    let count = size[0] * size[1];
    let far = 20.0 + 2000.0 * rng.f32() * rng.f32();
    let balls: Vec<[f32; 4]> = (0..rng.usize(2..40))
        .map(|_| {
            let [x, y] = size.map(|side| rng.f32() * side as f32);
            [x, y, far + 40.0 * rng.f32(), 2.0 + 30.0 * rng.f32() * rng.f32()]
        })
        .collect();
    let color: Vec<f32> = (0..3 * count).map(|_| 2.0 * rng.f32()).collect();
    let mut alpha = vec![0.0; count];
    let mut depth = vec![f32::INFINITY; count];
    let mut normal = vec![0.0; 3 * count];
    let mut id = vec![f32::from_bits(NO_ID); count];
    for index in 0..count {
        let [x, y] = [index % size[0], index / size[0]].map(|place| place as f32);
        for (ball, [a, b, z, r]) in (0..).zip(&balls) {
            let (dx, dy) = (x - a, y - b);
            let height = (r * r - dx * dx - dy * dy).max(0.0).sqrt();
            if height > 0.0 && z - height < depth[index] {
                depth[index] = z - height;
                normal[3 * index..][..3].copy_from_slice(&[dx / r, dy / r, -height / r]);
                id[index] = f32::from_bits(ball);
                alpha[index] = if rng.bool() { 1.0 } else { rng.f32() };
            }
        }
    }
    let all = [color, alpha, depth, normal, id].concat();
    let bytes: Vec<u8> = all.iter().flat_map(|value| value.to_le_bytes()).collect();
    Image::from_le_bytes(size.map(|side| side as u32), LAYERS, &bytes).unwrap()
}

fn strength(image: &Image, [a, b]: [usize; 2], outline: &Outline) -> f32 {
    let (ids, depths) = (image.id().unwrap(), image.depth().unwrap());
    let normals = image.normal().unwrap();
    if ids[a] == ids[b] {
        return 0.0;
    }
    if ids[a] == NO_ID || ids[b] == NO_ID {
        return 1.0;
    }
    let [x, y, z]: [f32; 3] = std::array::from_fn(|k| normals[a][k] * normals[b][k]);
    if x + y + z < outline.angle.cos() {
        return 1.0;
    }
    let least = outline.depth * depths[a].min(depths[b]);
    let jump = (depths[a] - depths[b]).abs();
    if jump > least { ((jump - least) / (2.0 * least)).clamp(0.0, 1.0) } else { 0.0 }
}

/// The fraction of its strength that a line keeps beside the nearer of two pixels: a quarter more for each width of the
/// line that the thing there is wider than three and a half.
fn kept(image: &Image, a: [usize; 2], b: [usize; 2], outline: &Outline) -> f32 {
    let depth =
        |index: usize| if image.id().unwrap()[index] == NO_ID { f32::MAX } else { image.depth().unwrap()[index] };
    let [width, height] = [image.width() as i64, image.height() as i64];
    let index = |[x, y]: [i64; 2]| (y * width + x) as usize;
    let [a, b] = [a, b].map(|place| place.map(|side| side as i64));
    let [mut at, from] = if depth(index(a)) <= depth(index(b)) { [a, b] } else { [b, a] };
    let along = [at[0] - from[0], at[1] - from[1]];
    let most = (7.5 * outline.width).ceil();
    let mut extent = 1.0;
    while extent < most {
        let next = [at[0] + along[0], at[1] + along[1]];
        if next[0] < 0 || next[1] < 0 || next[0] >= width || next[1] >= height {
            extent = most;
        } else if strength(image, [index(at), index(next)], outline) <= 0.0 {
            extent += 1.0;
            at = next;
            continue;
        } else if depth(index(at)) > depth(index(next)) {
            extent = most;
        }
        break;
    }
    ((extent / outline.width - 3.5) / 4.0).clamp(0.03, 1.0)
}

/// The fraction of each pixel that lines cover. The middles of edges between pixels, in units of half a pixel, are
/// smoothed eight times and joined by lines.
fn shares(image: &Image, outline: &Outline) -> Vec<f32> {
    let [width, height] = [image.width() as usize, image.height() as usize];
    let mut points = BTreeMap::new();
    for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
        for [x, y] in [[1, 0], [0, 1]] {
            if i + x < width && j + y < height {
                let pair = [j * width + i, (j + y) * width + i + x];
                let strength = strength(image, pair, outline) * kept(image, [i, j], [i + x, j + y], outline);
                if strength > 0.0 {
                    let place = [2 * i + x, 2 * j + y];
                    let at = 0.5 * Vec2::new(place[0] as f32, place[1] as f32);
                    points.insert(place, (at, strength));
                }
            }
        }
    }
    // The two corners of an edge, each with the other edges that meet there.
    let places: Vec<[usize; 2]> = points.keys().copied().collect();
    let ends = |[x, y]: [usize; 2]| -> Vec<(Vec2, Vec<[usize; 2]>)> {
        let corners = match x % 2 {
            1 => [[x, y.wrapping_sub(1)], [x, y + 1]],
            _ => [[x.wrapping_sub(1), y], [x + 1, y]],
        };
        let is_inside = |[x, y]: &[usize; 2]| *x < 2 * width - 2 && *y < 2 * height - 2;
        let meeting = |[i, j]: [usize; 2]| {
            let around = [[i, j - 1], [i, j + 1], [i - 1, j], [i + 1, j]];
            let is_there = |place: &[usize; 2]| *place != [x, y] && places.binary_search(place).is_ok();
            let corner = 0.5 * Vec2::new(i as f32, j as f32);
            (corner, around.into_iter().filter(is_there).collect())
        };
        corners.into_iter().filter(is_inside).map(meeting).collect()
    };
    for _ in 0..8 {
        let before = points.clone();
        for (place, point) in &mut points {
            let ends = ends(*place);
            let both: Vec<_> = ends.iter().filter(|(_, others)| others.len() == 1).collect();
            if let [(_, a), (_, b)] = both[..] {
                let (here, a, b) = (before[place], before[&a[0]], before[&b[0]]);
                let mean = 0.5 * here.1 + 0.25 * (a.1 + b.1);
                *point = (0.5 * here.0 + 0.25 * (a.0 + b.0), mean);
            }
        }
    }
    let mut shares = vec![0.0_f32; width * height];
    let reach = 0.5 * outline.width + 0.5;
    let mut draw = |a: Vec2, b: Vec2, strength: f32| {
        let (low, high) = (a.min(b) - reach, a.max(b) + reach);
        let range = |low: f32, high: f32, side: usize| {
            low.ceil().max(0.0) as usize..((high.floor() + 1.0).max(0.0) as usize).min(side)
        };
        for j in range(low.y, high.y, height) {
            for i in range(low.x, high.x, width) {
                let distance = distance(Vec2::new(i as f32, j as f32), a, b);
                let share = &mut shares[j * width + i];
                *share = share.max(strength * (reach - distance).clamp(0.0, 1.0));
            }
        }
    };
    for (place, (at, strength)) in &points {
        let mut is_alone = true;
        for (corner, others) in ends(*place) {
            match &others[..] {
                [] => continue,
                [other] => draw(*at, points[other].0, strength.min(points[other].1)),
                _ => draw(*at, corner, *strength),
            }
            is_alone = false;
        }
        if is_alone {
            draw(*at, *at, *strength);
        }
    }
    shares
}

fn distance(point: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let squared = along.length_squared();
    let t = match squared > 0.0 {
        true => ((point - a).dot(along) / squared).clamp(0.0, 1.0),
        false => 0.0,
    };
    point.distance(a + t * along)
}

#[test]
fn lines_are_those_of_a_second_drawing() {
    let mut covered = 0;
    for seed in 0..40 {
        let mut rng = Rng::with_seed(seed);
        // More rows than the library draws at once.
        let image = pictured([rng.usize(20..110), rng.usize(20..300)], &mut rng);
        let mut outline = Outline::thin();
        outline.width = if seed % 10 == 0 { 64.0 } else { 0.5 + 6.0 * rng.f32() };
        outline.color = LinearRgb::new([rng.f32(), rng.f32(), 0.0]).unwrap();
        outline.depth = [0.0, 0.001, 0.01, 0.1][rng.usize(0..4)];
        outline.angle = [0.0, 0.3, 0.6, 1.2, std::f32::consts::PI][rng.usize(0..5)];
        let studio = Studio { outline: Some(outline), ..Studio::default() };
        let settings = RenderSettings { integrator: Integrator::Studio(studio), ..RenderSettings::default() };
        let drawn = cpu::finish(image.clone(), &settings, LAYERS);
        let shares = shares(&image, &outline);
        let mixed = |from: f32, to: f32, share: f32| from + share * (to - from);
        let line = outline.color.to_array();
        for (index, share) in shares.iter().enumerate() {
            let color: [f32; 3] = std::array::from_fn(|k| mixed(image.color()[index][k], line[k], *share));
            let alpha = mixed(image.alpha().unwrap()[index], 1.0, *share);
            let found = (drawn.color()[index], drawn.alpha().unwrap()[index]);
            assert_eq!(found, (color, alpha), "{seed}: pixel {index}, {outline:?}");
        }
        assert_eq!((drawn.depth(), drawn.id()), (image.depth(), image.id()));
        covered += shares.iter().filter(|share| **share > 0.0).count();
    }
    assert!(covered > 50_000, "{covered}");
}
