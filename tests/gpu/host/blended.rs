//! Tests of pictures that are transparent in parts, over the drawings of the host.

use libtest_mimic::Trial;
use pinhole::gpu::{Composite, CompositeOptions, Headless, Wait, wgpu};
use wgpu::TextureFormat;

use super::stage::{FIRST, RANGE, SIZE, Stage, TARGET, at, begin_over, pixels};
use crate::host_program::view_of;
use crate::planted::planted;
use crate::support::hosts::Convention;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::blended::blends_and_has_the_depth_of_its_surroundings", right),
        trial("host::blended::faults_in_the_truth_are_found", faults),
        trial("host::blended::faults_in_shaders_are_found", faults_in_shaders),
    ]
}

/// Colours of a picture, premultiplied by alpha, and distances, which are 1e30 for a miss.
struct Picture {
    colors: Vec<[u8; 4]>,
    distances: Vec<f32>,
}

const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// The colour that the host has drawn before. It is not black, so that a missing part of it is seen.
const UNDER: [u8; 4] = [51, 102, 204, 255];

/// A fault that is planted into the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// Pixels whose own ray misses have the far depth.
    NoNeighbors,
    /// Only the four neighbours that share a side count.
    FourNeighbors,
    /// The farthest neighbour counts.
    Farthest,
    /// Pixels are drawn where their ray hits.
    Hits,
    /// The host's colour is not kept below the picture.
    NoBlend,
}

/// Hits are sparse, so that some pixels have no hit around. Some are behind the far plane.
fn random_picture(seed: u64) -> Picture {
    let mut random = fastrand::Rng::with_seed(seed);
    let colors = pixels().map(|_| {
        let alpha = [0, 0, 1, 128, 255, random.u8(..)][random.usize(0..6)];
        let mut part = || random.u8(0..=alpha);
        [part(), part(), part(), alpha]
    });
    let colors = colors.collect();
    let distances = pixels().map(|_| match random.u32(0..8) {
        0 => 2.0 + 12.0 * random.f32(),
        1 if random.u32(0..4) == 0 => 3.0 * RANGE[1] as f32,
        _ => 1e30,
    });
    Picture { colors, distances: distances.collect() }
}

/// The host's depth that a pixel must get, in f64; `None` if it is not drawn.
fn expected_depth(stage: &Stage, picture: &Picture, pixel: [u32; 2], fault: Fault) -> Option<f64> {
    let far = f64::from(stage.far());
    let depth_of = |pixel: [u32; 2]| {
        let distance = picture.distances[at(pixel)];
        (distance < 1e30).then(|| stage.camera.clip_depth(Stage::location(pixel), f64::from(distance)))
    };
    let own = depth_of(pixel);
    let is_drawn = match fault {
        Fault::Hits => own.is_some(),
        _ => picture.colors[at(pixel)][3] > 0,
    };
    if !is_drawn {
        return None;
    }
    let around = (-1..=1).flat_map(|y| (-1..=1).map(move |x| (x, y)));
    let around = around
        .filter(|(x, y)| match fault {
            Fault::NoNeighbors => false,
            Fault::FourNeighbors => x * y == 0,
            _ => true,
        })
        .filter_map(|(x, y)| {
            let near = [pixel[0].checked_add_signed(x)?, pixel[1].checked_add_signed(y)?];
            (near[0] < SIZE[0] && near[1] < SIZE[1]).then(|| depth_of(near)).flatten()
        });
    let is_largest = (far == 0.0) != (fault == Fault::Farthest);
    let nearest = around.reduce(|a, b| if is_largest { a.max(b) } else { a.min(b) });
    let depth = own.or(nearest).unwrap_or(far);
    let is_behind = if far == 1.0 { depth > far } else { depth < far };
    (!is_behind).then(|| depth.clamp(0.0, 1.0))
}

/// Number of pixels with a wrong colour or depth.
fn wrong(stage: &Stage, fault: Fault) -> usize {
    let options = CompositeOptions::lit(FORMAT, stage.composite_depth(DEPTH));
    wrong_by(stage, &Composite::new(&stage.host.device, &options).wait().unwrap(), fault)
}

/// Number of pixels that a pipeline draws with a wrong colour or depth.
fn wrong_by(stage: &Stage, composite: &Composite, fault: Fault) -> usize {
    let picture = random_picture(5);
    stage.host.write(&stage.layers.color, &picture.colors);
    stage.host.write(&stage.layers.depth, &picture.distances);
    let color = stage.attachment(FORMAT, 1);
    let depth = stage.attachment(DEPTH, 1);
    let mut drawn = stage.picture(composite);
    drawn.set_camera(&stage.host.queue, &stage.camera, FIRST);
    let mut encoder = stage.host.encoder();
    {
        let (color, depth) = (view_of(&color), view_of(&depth));
        let [r, g, b, a] = UNDER.map(|value| f64::from(value) / 255.0);
        let under = wgpu::Color { r, g, b, a };
        let mut pass = begin_over(&mut encoder, [&color, &depth], None, Some(stage.far()), under);
        composite.draw(&mut pass, &drawn).unwrap();
    }
    let colors: Vec<[u8; 4]> = stage.host.submit_and_read(encoder, &color);
    let depths: Vec<f32> = stage.host.read(&depth);
    let (mut wrong, mut seen) = (0, [0; 4]);
    for row in 0..TARGET[1] {
        for column in 0..TARGET[0] {
            let texel = (row * TARGET[0] + column) as usize;
            let found = colors[texel];
            let pixel = [column.wrapping_sub(FIRST[0]), row.wrapping_sub(FIRST[1])];
            let is_in = (0..2).all(|axis| pixel[axis] < SIZE[axis]);
            let expected = is_in.then(|| expected_depth(stage, &picture, pixel, fault)).flatten();
            let Some(expected) = expected else {
                seen[0] += 1;
                wrong += usize::from(depths[texel] != stage.far() || found != UNDER);
                continue;
            };
            let is_far = expected == f64::from(stage.far());
            seen[if picture.distances[at(pixel)] < 1e30 { 1 } else { 2 + usize::from(is_far) }] += 1;
            let over = picture.colors[at(pixel)].map(f64::from);
            let kept = if fault == Fault::NoBlend { 0.0 } else { 1.0 - over[3] / 255.0 };
            let is_color = (0..4).all(|i| {
                let mixed = over[i] + kept * f64::from(UNDER[i]);
                (f64::from(found[i]) - mixed).abs() < 1.01
            });
            let is_depth = (f64::from(depths[texel]) - expected).abs() < 1e-6;
            wrong += usize::from(!is_color || !is_depth);
        }
    }
    assert!(fault != Fault::None || seen.iter().all(|count| *count > 100), "{seen:?}");
    wrong
}

fn right(_: &'static Headless) {
    for convention in Convention::ALL {
        for stage in [Stage::new(convention), Stage::oblique(convention)] {
            assert_eq!(wrong(&stage, Fault::None), 0, "{convention:?}");
        }
    }
}

fn faults(_: &'static Headless) {
    for convention in [Convention::Perspective, Convention::InfiniteReversed] {
        let stage = Stage::new(convention);
        for fault in [Fault::NoNeighbors, Fault::FourNeighbors, Fault::Farthest, Fault::Hits, Fault::NoBlend] {
            assert!(wrong(&stage, fault) > 0, "{convention:?}: {fault:?}");
        }
    }
}

fn faults_in_shaders(_: &'static Headless) {
    let stages = [Convention::Perspective, Convention::InfiniteReversed]
        .map(|convention| [Stage::new(convention), Stage::oblique(convention)]);
    for fault in planted("composite") {
        let of = |stage: &Stage| {
            let options = CompositeOptions::lit(FORMAT, stage.composite_depth(DEPTH));
            let device = &stage.host.device;
            let composite = Composite::edited(device, &options, vec![fault.edit.clone()]).wait().unwrap();
            wrong_by(stage, &composite, Fault::None)
        };
        let found: usize = stages.iter().flatten().map(of).sum();
        assert!(found > 0, "{}", fault.name);
    }
}
