//! Certificates of outlines: what the library draws is never accused, and other lines are found.

mod drawn;

use drawn::{Fault, shares};
use fastrand::Rng;
use pinhole::camera::PinholeCamera;
use pinhole::image::{Layer, LayerSet, NO_ID};
use pinhole::render::{Integrator, Occlusion, Outline, Sampling, Studio};
use pinhole::verify::Outcome;
use pinhole::verify::outlined::{MissingData, OutlineCertificate, certify};
use pinhole::{Film, Image, LinearRgb, RenderSettings, Scene, Sphere, View, cpu};

use crate::support::spheres;

const LAYERS: LayerSet = LayerSet::DATA.with(Layer::Alpha);

/// The layers of a picture as lists.
#[derive(Clone)]
struct Layers {
    size: [usize; 2],
    color: Vec<[f32; 3]>,
    alpha: Vec<f32>,
    depth: Vec<f32>,
    normal: Vec<[f32; 3]>,
    id: Vec<u32>,
}

impl Layers {
    fn of(image: &Image) -> Self {
        Self {
            size: [image.width() as usize, image.height() as usize],
            color: image.color().to_vec(),
            alpha: image.alpha().unwrap().to_vec(),
            depth: image.depth().unwrap().to_vec(),
            normal: image.normal().unwrap().to_vec(),
            id: image.id().unwrap().to_vec(),
        }
    }

    fn image(&self) -> Image {
        let id: Vec<f32> = self.id.iter().map(|id| f32::from_bits(*id)).collect();
        let all = [self.color.as_flattened(), &self.alpha, &self.depth];
        let all = all.into_iter().chain([self.normal.as_flattened(), &id]).flatten();
        let bytes: Vec<u8> = all.flat_map(|value| value.to_bits().to_le_bytes()).collect();
        Image::from_le_bytes(self.size.map(|side| side as u32), LAYERS, &bytes).unwrap()
    }

    /// Colour and alpha with lines that cover these shares.
    fn with_lines(&self, shares: &[f32], outline: &Outline) -> Image {
        let mut drawn = self.clone();
        for (index, share) in shares.iter().enumerate() {
            for (c, line) in drawn.color[index].iter_mut().zip(outline.color.to_array()) {
                *c += share * (line - *c);
            }
            drawn.alpha[index] += share * (1.0 - drawn.alpha[index]);
        }
        drawn.image()
    }

    /// The rows of a range alone.
    fn rows(&self, rows: std::ops::Range<usize>) -> Self {
        let range = rows.start * self.size[0]..rows.end * self.size[0];
        Self {
            size: [self.size[0], rows.len()],
            color: self.color[range.clone()].to_vec(),
            alpha: self.alpha[range.clone()].to_vec(),
            depth: self.depth[range.clone()].to_vec(),
            normal: self.normal[range.clone()].to_vec(),
            id: self.id[range].to_vec(),
        }
    }
}

/// Spheres seen from far away, in colours that tell nothing.
fn random(seed: u64) -> (Layers, Outline) {
    let mut rng = Rng::with_seed(seed);
    let size = [rng.usize(20..110), rng.usize(20..300)];
    pictured(size, &mut rng, seed.is_multiple_of(10))
}

fn pictured(size: [usize; 2], rng: &mut Rng, is_wide: bool) -> (Layers, Outline) {
    let count = size[0] * size[1];
    let far = 20.0 + 2000.0 * rng.f32() * rng.f32();
    let balls: Vec<[f32; 4]> = (0..rng.usize(2..40))
        .map(|_| {
            let [x, y] = size.map(|side| rng.f32() * side as f32);
            [x, y, far + 40.0 * rng.f32(), 2.0 + 30.0 * rng.f32() * rng.f32()]
        })
        .collect();
    let mut layers = Layers {
        size,
        color: (0..count).map(|_| [rng.f32(), 2.0 * rng.f32(), rng.f32()]).collect(),
        alpha: vec![0.0; count],
        depth: vec![f32::INFINITY; count],
        normal: vec![[0.0; 3]; count],
        id: vec![NO_ID; count],
    };
    for index in 0..count {
        let [x, y] = [index % size[0], index / size[0]].map(|place| place as f32);
        for (id, [a, b, z, r]) in balls.iter().enumerate() {
            let (dx, dy) = (x - a, y - b);
            let height = (r * r - dx * dx - dy * dy).max(0.0).sqrt();
            if height > 0.0 && z - height < layers.depth[index] {
                layers.depth[index] = z - height;
                layers.normal[index] = [dx / r, dy / r, -height / r];
                layers.id[index] = id as u32;
                layers.alpha[index] = if rng.bool() { 1.0 } else { rng.f32() };
            }
        }
    }
    let outline = Outline {
        width: if is_wide { 64.0 } else { 0.5 + 6.0 * rng.f32() },
        color: LinearRgb::new([rng.f32(), rng.f32(), 0.0]).unwrap(),
        depth: [0.0, 0.001, 0.01, 0.1][rng.usize(0..4)],
        angle: [0.0, 0.3, 0.6, 1.2, std::f32::consts::PI][rng.usize(0..5)],
    };
    (layers, outline)
}

/// What the library draws.
fn finished(before: &Image, outline: &Outline) -> Image {
    let studio = Studio { outline: Some(*outline), ..Studio::default() };
    let settings =
        RenderSettings { integrator: Integrator::Studio(studio), ..RenderSettings::default() };
    cpu::finish(before.clone(), &settings, LAYERS)
}

#[track_caller]
fn proved(before: &Image, outline: &Outline) -> OutlineCertificate {
    let found = certify(before, &finished(before, outline), outline).unwrap();
    assert_eq!(found.outcome(), Outcome::Proved, "{outline:?}: {found:?}");
    assert_eq!(found.pixels, before.color().len() as u64);
    found
}

#[test]
fn what_the_library_draws_is_proved() {
    let (mut touched, mut open, mut undecided, mut widest) = (0, 0, 0, 0.0_f64);
    for seed in 0..80 {
        let (layers, outline) = random(seed);
        let before = layers.image();
        let found = proved(&before, &outline);
        (touched, open) = (touched + found.touched, open + found.open);
        (undecided, widest) = (undecided + found.undecided, widest.max(found.widest));
        // The lines of this test are those of the library, so that a fault in them is one of the library.
        let alike = layers.with_lines(&shares(&before, &outline, Fault::Nothing), &outline);
        assert!(alike == finished(&before, &outline), "{seed}");
    }
    let counts = (touched, open, undecided, widest);
    assert!(touched > 100_000 && undecided == 0 && widest < 4e-4, "{counts:?}");
}

/// Far from the first pixel, coordinates are rounded more.
#[test]
fn long_pictures_are_proved() {
    for size in [[5000, 40], [40, 5000]] {
        let (layers, outline) = random(3);
        let at = |index: usize| {
            let [i, j] = [index % size[0], index / size[0]];
            j % layers.size[1] * layers.size[0] + i % layers.size[0]
        };
        let all: Vec<usize> = (0..size[0] * size[1]).map(at).collect();
        let layers = Layers {
            size,
            color: all.iter().map(|at| layers.color[*at]).collect(),
            alpha: all.iter().map(|at| layers.alpha[*at]).collect(),
            depth: all.iter().map(|at| layers.depth[*at]).collect(),
            normal: all.iter().map(|at| layers.normal[*at]).collect(),
            id: all.iter().map(|at| layers.id[*at]).collect(),
        };
        let found = proved(&layers.image(), &outline);
        assert!(found.touched > 10_000 && found.widest < 0.011, "{}", found.widest);
    }
}

#[test]
fn lines_of_rendered_studios_are_proved() {
    for (seed, (width, height)) in [(1, (90, 70)), (2, (61, 150)), (3, (131, 40))] {
        let spheres = spheres::random(25, seed, |rng| 0.05 + 0.2 * rng.f32());
        let sphere = |[x, y, z, r]: &[f32; 4]| {
            Sphere::new([*x, *y, *z].map(f64::from), f64::from(*r), LinearRgb::WHITE)
        };
        let scene = Scene::new(&spheres.iter().map(sphere).collect::<Vec<_>>()).unwrap();
        let film = Film::new(width, height).unwrap();
        let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect()).unwrap();
        for outline in [Outline::thin(), Outline::default()] {
            let occlusion = Some(Occlusion { radius: None, samples: 1 });
            let studio = Studio { outline: Some(outline), occlusion, ..Studio::default() };
            let settings = RenderSettings {
                integrator: Integrator::Studio(studio),
                sampling: Sampling { samples: 2, seed: seed as u32, ..Sampling::default() },
                is_transparent: true,
                ..RenderSettings::default()
            };
            let view = View::new(&camera, film);
            let before = cpu::render(&scene, &view, &settings.unfinished(), LAYERS).unwrap();
            let after = cpu::render(&scene, &view, &settings, LAYERS).unwrap();
            let found = certify(&before, &after, &outline).unwrap();
            assert_eq!((found.outcome(), found.undecided), (Outcome::Proved, 0), "{found:?}");
            assert!(found.touched > 300, "{}", found.touched);
        }
    }
}

/// Pictures with lines of several widths, in more than one band of the library's.
fn busy() -> Vec<(Layers, Outline)> {
    let picture = |(seed, width): (u64, f32)| {
        let (layers, _) = pictured([90, 205], &mut Rng::with_seed(seed), false);
        let color = LinearRgb::new([0.25, 0.5, 0.75]).unwrap();
        (layers, Outline { width, color, depth: 0.01, angle: 0.6 })
    };
    (1..).zip([2.5, 0.8, 1.2, 6.0]).map(picture).collect()
}

/// What is wrong is found in one of the pictures at least. `draw` is given a picture, and what the library draws into it.
#[track_caller]
fn is_found(name: &str, draw: impl Fn(&Layers, &Outline, &Image) -> Image) {
    let counts: Vec<u64> = busy()
        .iter()
        .map(|(layers, outline)| {
            let before = layers.image();
            let after = draw(layers, outline, &finished(&before, outline));
            certify(&before, &after, outline).unwrap().violation_count
        })
        .collect();
    assert!(counts.iter().any(|count| *count > 0), "{name}: {counts:?}");
}

#[test]
fn faults_of_lines_are_found() {
    for (layers, outline) in busy() {
        assert!(proved(&layers.image(), &outline).touched > 1000);
    }
    for fault in Fault::ALL {
        is_found(&format!("{fault:?}"), |layers, outline, _| {
            layers.with_lines(&shares(&layers.image(), outline, fault), outline)
        });
    }
}

#[test]
fn other_settings_are_found() {
    type Change = fn(&mut Outline);
    let changes: [(&str, Change); 7] = [
        ("half a pixel less wide", |it| it.width -= if it.width > 1.0 { 0.5 } else { 0.25 }),
        ("a thousandth wider", |it| it.width *= 1.001),
        ("an angle off by a hundredth", |it| it.angle += 0.01),
        ("a least jump off by a hundredth", |it| it.depth *= 1.01),
        ("another blue", |it| it.color = LinearRgb::new([0.25, 0.5, 0.754]).unwrap()),
        ("channels that were swapped", |it| it.color = LinearRgb::new([0.75, 0.5, 0.25]).unwrap()),
        ("no angle", |it| it.angle = 3.2),
    ];
    for (name, change) in changes {
        is_found(name, |layers, outline, _| {
            let mut other = *outline;
            change(&mut other);
            finished(&layers.image(), &other)
        });
    }
}

#[test]
fn what_is_left_out_or_elsewhere_is_found() {
    let of = |image: &Image, change: &dyn Fn(&mut Layers)| {
        let mut after = Layers::of(image);
        change(&mut after);
        after.image()
    };
    is_found("no lines", |layers, _, _| layers.image());
    is_found("alpha as before", |layers, _, right| {
        of(right, &|after| after.alpha.clone_from(&layers.alpha))
    });
    is_found("colours as before", |layers, _, right| {
        of(right, &|after| after.color.clone_from(&layers.color))
    });
    is_found("twice", |_, outline, right| finished(right, outline));
    is_found("bands without what is around them", |layers, outline, right| {
        let [first, second] = [0..128, 128..layers.size[1]]
            .map(|rows| Layers::of(&finished(&layers.rows(rows).image(), outline)));
        of(right, &|after| {
            after.color = [&first.color[..], &second.color].concat();
            after.alpha = [&first.alpha[..], &second.alpha].concat();
        })
    });
    // What is drawn by other layers, over the colours of the right ones.
    let redrawn = |layers: &Layers, outline: &Outline, change: &dyn Fn(&mut Layers)| {
        let other = of(&layers.image(), change);
        layers.with_lines(&shares(&other, outline, Fault::Nothing), outline)
    };
    for (name, by) in [("a column to the right", 1), ("a row further down", 90)] {
        is_found(name, |layers, outline, _| {
            redrawn(layers, outline, &|other| {
                other.id.rotate_right(by);
                other.depth.rotate_right(by);
                other.normal.rotate_right(by);
            })
        });
    }
    is_found("normals that are not looked at", |layers, outline, _| {
        redrawn(layers, outline, &|other| other.normal.fill([0.0, 0.0, 1.0]))
    });
    type Share = fn(f32) -> f32;
    let others: [(&str, Share); 3] = [
        ("shares in steps", |share| (share * 64.0).round() / 64.0),
        ("shares that were squared", |share| share * share),
        ("a thousandth less", |share| share * 0.999),
    ];
    for (name, change) in others {
        is_found(name, |layers, outline, _| {
            let right = shares(&layers.image(), outline, Fault::Nothing);
            let other: Vec<f32> = right.into_iter().map(change).collect();
            layers.with_lines(&other, outline)
        });
    }
}

#[test]
fn one_pixel_is_named() {
    let (layers, outline) = busy().swap_remove(0);
    let before = layers.image();
    let mut after = Layers::of(&finished(&before, &outline));
    let index = 40 * layers.size[0] + 7;
    after.alpha[index] += 0.01;
    let found = certify(&before, &after.image(), &outline).unwrap();
    assert_eq!((found.violation_count, found.violations.len()), (1, 1));
    let words = found.violations[0].to_string();
    assert!(words.starts_with("pixel (7, 40): alpha is "), "{words}");
    // Another size, and a picture in which lines are not a number.
    let other = layers.rows(0..100).image();
    let found = certify(&before, &other, &outline).unwrap();
    assert_eq!(found.violation_count, found.pixels);
    assert_eq!(found.violations.len(), 100);
    assert!(found.violations.windows(2).all(|two| {
        let [a, b] = [0, 1].map(|k| two[k].pixel);
        [a[1], a[0]] < [b[1], b[0]]
    }));
    after.color[index] = [f32::NAN; 3];
    assert!(certify(&before, &after.image(), &outline).unwrap().violation_count > 0);
    let plain = Image::new(4, 4, LayerSet::COLOR).unwrap();
    assert_eq!(certify(&plain, &plain, &outline), Err(MissingData));
}

/// Two surfaces whose jump is the least one but for rounding: with and without a line, but not with half of one.
#[test]
fn where_rounding_decides_both_are_legal() {
    let size = [12, 5];
    let near = |index: usize| index % size[0] < 6;
    let count = size[0] * size[1];
    for (far, both) in [(1.01_f32, true), (1.0101, false)] {
        let layers = Layers {
            size,
            color: vec![[1.0; 3]; count],
            alpha: vec![1.0; count],
            depth: (0..count).map(|at| if near(at) { 1.0 } else { far }).collect(),
            normal: vec![[0.0, 0.0, 1.0]; count],
            id: (0..count).map(|at| u32::from(near(at))).collect(),
        };
        let outline = Outline { depth: 1.01 - 1.0, angle: 3.0, ..Outline::default() };
        let before = layers.image();
        let found = certify(&before, &finished(&before, &outline), &outline).unwrap();
        assert_eq!((found.violation_count, found.undecided), (0, 0), "{found:?}");
        // Its line is so weak that no outcome is far from the other.
        let found = certify(&before, &before, &outline).unwrap();
        assert_eq!(found.violation_count == 0, both, "{found:?}");
        let half = layers.with_lines(&vec![0.5; count], &outline);
        assert_eq!(certify(&before, &half, &outline).unwrap().violation_count, count as u64);
    }
    // By the angle, there is a whole line or none, in each row: too many combinations to say anything.
    let (sine, cosine) = 0.6_f32.sin_cos();
    let normal = |at: usize| if near(at) { [0.0, 0.0, 1.0] } else { [sine, 0.0, cosine] };
    for rows in [3, 9] {
        let count = size[0] * rows;
        let layers = Layers {
            size: [size[0], rows],
            color: vec![[1.0; 3]; count],
            alpha: vec![1.0; count],
            depth: vec![1.0; count],
            normal: (0..count).map(normal).collect(),
            id: (0..count).map(|at| u32::from(near(at))).collect(),
        };
        let (before, outline) = (layers.image(), Outline { width: 1.0, ..Outline::default() });
        let lines = layers.with_lines(&shares(&before, &outline, Fault::Nothing), &outline);
        let sharper = Outline { angle: 0.59, ..outline };
        for after in [&before, &lines, &finished(&before, &sharper)] {
            let found = certify(&before, after, &outline).unwrap();
            assert_eq!(found.outcome(), Outcome::Undecided, "{found:?}");
            assert!(found.open > 0 && found.open == found.undecided, "{found:?}");
        }
        // Half of a line is not legal, if all combinations can be followed.
        let weak = Outline { color: LinearRgb::new([0.5; 3]).unwrap(), ..sharper };
        let found = certify(&before, &finished(&before, &weak), &outline).unwrap();
        assert_eq!(found.violation_count > 0, rows == 3, "{found:?}");
    }
}
