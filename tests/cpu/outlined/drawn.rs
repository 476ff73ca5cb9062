//! Outlines drawn in f32, rightly or with a fault.

use std::collections::BTreeMap;

use glam::Vec2;
use pinhole::Image;
use pinhole::image::NO_ID;
use pinhole::render::Outline;

/// What is done wrongly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fault {
    Nothing,
    NoSmoothing,
    SevenPasses,
    NinePasses,
    StrengthsStay,
    LinesAdd,
    CutAtCorners,
    NoLoneEdges,
    NoFading,
    FartherDepth,
    NoSilhouettes,
    EitherSideOfNormals,
    WeakestNeighborForgotten,
    HardEdges,
    OneEdgeMissing,
}

impl Fault {
    pub(crate) const ALL: [Self; 14] = [
        Self::NoSmoothing,
        Self::SevenPasses,
        Self::NinePasses,
        Self::StrengthsStay,
        Self::LinesAdd,
        Self::CutAtCorners,
        Self::NoLoneEdges,
        Self::NoFading,
        Self::FartherDepth,
        Self::NoSilhouettes,
        Self::EitherSideOfNormals,
        Self::WeakestNeighborForgotten,
        Self::HardEdges,
        Self::OneEdgeMissing,
    ];
}

fn strength(image: &Image, [a, b]: [usize; 2], outline: &Outline, fault: Fault) -> f32 {
    let (ids, depths) = (image.id().unwrap(), image.depth().unwrap());
    let normals = image.normal().unwrap();
    if ids[a] == ids[b] {
        return 0.0;
    }
    if ids[a] == NO_ID || ids[b] == NO_ID {
        return if fault == Fault::NoSilhouettes { 0.0 } else { 1.0 };
    }
    let [x, y, z]: [f32; 3] = std::array::from_fn(|k| normals[a][k] * normals[b][k]);
    let cosine = x + y + z;
    let cosine = if fault == Fault::EitherSideOfNormals { cosine.abs() } else { cosine };
    if cosine < outline.angle.cos() {
        return 1.0;
    }
    let of = if fault == Fault::FartherDepth { f32::max } else { f32::min };
    let least = outline.depth * of(depths[a], depths[b]);
    let jump = (depths[a] - depths[b]).abs();
    match jump > least {
        true if fault == Fault::NoFading => 1.0,
        true => ((jump - least) / (0.5 * least)).clamp(0.0, 1.0),
        false => 0.0,
    }
}

/// The middles of edges by their places, in halves of a pixel.
type Points = BTreeMap<[usize; 2], (Vec2, f32)>;

/// The share of each pixel that lines cover.
pub(crate) fn shares(image: &Image, outline: &Outline, fault: Fault) -> Vec<f32> {
    let [width, height] = [image.width() as usize, image.height() as usize];
    let mut points = Points::new();
    for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
        for [x, y] in [[1, 0], [0, 1]] {
            if i + x < width && j + y < height {
                let pair = [j * width + i, (j + y) * width + i + x];
                let strength = strength(image, pair, outline, fault);
                if strength > 0.0 {
                    let place = [2 * i + x, 2 * j + y];
                    let at = 0.5 * Vec2::new(place[0] as f32, place[1] as f32);
                    points.insert(place, (at, strength));
                }
            }
        }
    }
    if fault == Fault::OneEdgeMissing {
        let middle = points.keys().nth(points.len() / 2).copied();
        middle.map(|place| points.remove(&place));
    }
    // The two corners of an edge, and what else meets it there.
    let ends = |points: &Points, [x, y]: [usize; 2]| -> Vec<([usize; 2], Vec<[usize; 2]>)> {
        let corners = match x % 2 {
            1 => [[x, y.wrapping_sub(1)], [x, y + 1]],
            _ => [[x.wrapping_sub(1), y], [x + 1, y]],
        };
        let is_inside = |[x, y]: &[usize; 2]| *x < 2 * width - 2 && *y < 2 * height - 2;
        let meeting = |corner: [usize; 2]| {
            let [i, j] = corner;
            let around = [[i, j - 1], [i, j + 1], [i - 1, j], [i + 1, j]];
            let there = |place: &[usize; 2]| *place != [x, y] && points.contains_key(place);
            (corner, around.into_iter().filter(there).collect())
        };
        corners.into_iter().filter(is_inside).map(meeting).collect()
    };
    let passes = match fault {
        Fault::NoSmoothing => 0,
        Fault::SevenPasses => 7,
        Fault::NinePasses => 9,
        _ => 8,
    };
    for _ in 0..passes {
        let before = points.clone();
        for (place, point) in &mut points {
            let ends = ends(&before, *place);
            let both: Vec<_> = ends.iter().filter(|(_, others)| others.len() == 1).collect();
            if let [(_, a), (_, b)] = both[..] {
                let (here, a, b) = (before[place], before[&a[0]], before[&b[0]]);
                point.0 = 0.5 * here.0 + 0.25 * (a.0 + b.0);
                if fault != Fault::StrengthsStay {
                    point.1 = 0.5 * here.1 + 0.25 * (a.1 + b.1);
                }
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
        for (i, j) in range(low.y, high.y, height)
            .flat_map(|j| range(low.x, high.x, width).map(move |i| (i, j)))
        {
            let distance = distance(Vec2::new(i as f32, j as f32), a, b);
            let covered = match fault {
                Fault::HardEdges => f32::from(distance < reach - 0.5),
                _ => (reach - distance).clamp(0.0, 1.0),
            };
            let share = &mut shares[j * width + i];
            *share = match fault {
                Fault::LinesAdd => (*share + strength * covered).min(1.0),
                _ => share.max(strength * covered),
            };
        }
    };
    for (place, (at, strength)) in &points {
        let mut is_alone = fault != Fault::NoLoneEdges;
        for ([x, y], others) in ends(&points, *place) {
            match &others[..] {
                [] => continue,
                [other] => {
                    let (there, other) = points[other];
                    let forgets = fault == Fault::WeakestNeighborForgotten;
                    draw(*at, there, if forgets { *strength } else { strength.min(other) });
                }
                _ if fault == Fault::CutAtCorners => {}
                _ => draw(*at, 0.5 * Vec2::new(x as f32, y as f32), *strength),
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
