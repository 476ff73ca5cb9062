//! Measures the checker: the share of decided pixels, its time, and the time of the fences in kernels.
//!
//! ```sh
//! cargo bench --bench verify -- standard    # the standard scenes, also from 100 times as far away
//! cargo bench --bench verify -- cost        # the checker against the CPU reference
//! cargo bench --bench verify -- fences      # tracing with and without fences, in turns
//! cargo bench --bench verify -- margins    # ray queries, where there are any: the margin of boxes at which they fail
//! cargo bench --bench verify -- campaign 3    # as many times 100 million rays over many scenes; ends at a violation
//! cargo bench --bench verify -- lit-campaign 500 1000    # light paths of 500 random scenes, the seeds from 1000 on;
//!                                                        # ends at a violation
//! cargo bench --bench verify -- studio-campaign 500 1000    # the same in random studios
//! cargo bench --bench verify -- adversary 100    # devices that round as they like: all scenes of the campaign in small,
//!                                                # and this number of random scenes and studios for each
//! ```
#![allow(clippy::panic, clippy::print_stdout, clippy::unwrap_used, reason = "a benchmark may panic, and prints")]

use std::ops::Range;
use std::time::{Duration, Instant};

use pinhole::accel::AccelChoice;
use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::generate::{Kind, Standard};
use pinhole::glam::{DQuat, DVec3};
use pinhole::gpu::wgpu::DeviceType;
use pinhole::gpu::{Decision, Headless, HeadlessOptions, PictureRequest, SampleRequest, Structures, Wait};
use pinhole::internals::ShaderEdit;
use pinhole::verify::{Certificate, Checker, LitCertificate, LitRecording, Outcome, Recording, Verdict};
use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, View, cpu};

#[path = "../tests/support/spheres.rs"]
#[allow(dead_code, reason = "tests use all of them")]
mod spheres;

#[path = "../tests/support/random_light.rs"]
mod random_light;

#[path = "../tests/support/any_rounding/mod.rs"]
mod any_rounding;

use any_rounding::{Adversary, Rounding};
use random_light::RandomView;

/// The random view of a seed.
type ViewOf = fn(u64) -> RandomView;

fn main() {
    let headless = Headless::open(&HeadlessOptions::default()).wait().unwrap();
    let info = headless.adapter_info();
    println!("{} ({:?}), {} {}\n", info.name, info.backend, info.driver, info.driver_info);
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let runs = |name: &str| wanted.is_empty() || wanted.iter().any(|wanted| wanted == name);
    if runs("standard") {
        standard(&headless);
    }
    if runs("cost") {
        cost(&headless);
    }
    if runs("fences") {
        fences(&headless);
    }
    if wanted.iter().any(|wanted| wanted == "margins") {
        margins();
    }
    // The campaign runs only if it is named, because it takes minutes.
    let number = |at: usize, default| wanted.get(at).map_or(default, |n| n.parse().unwrap());
    if let Some(at) = wanted.iter().position(|wanted| wanted == "campaign") {
        (0..number(at + 1, 1)).for_each(|round| campaign(&headless, 1080, round));
    }
    let campaigns: [(&str, ViewOf); 2] =
        [("lit-campaign", random_light::view), ("studio-campaign", random_light::studio)];
    for (name, view) in campaigns {
        if let Some(at) = wanted.iter().position(|wanted| wanted == name) {
            let first = number(at + 2, 0);
            lit_campaign(&headless, first..first + number(at + 1, 500), view);
        }
    }
    if let Some(at) = wanted.iter().position(|wanted| wanted == "adversary") {
        adversaries(number(at + 1, 100));
    }
}

/// Checks pictures of devices that conform but round in different ways. Ends at a violation.
fn adversaries(count: u64) {
    for (seed, rounding) in (1..).zip(Rounding::ALL) {
        let rewrite = Some(Adversary::new(rounding, seed).rewrite());
        let options = HeadlessOptions { rewrite, ..HeadlessOptions::default() };
        let headless = Headless::open(&options).wait().unwrap();
        println!("{rounding:?}");
        campaign(&headless, 128, 0);
        for view in [random_light::view as ViewOf, random_light::studio] {
            lit_campaign(&headless, 0..count, view);
        }
    }
}

fn grey(spheres: Vec<[f32; 4]>) -> Scene {
    Scene::from_f32(spheres, LinearRgb::from_srgb8([128, 128, 128])).unwrap()
}

fn record(headless: &Headless, scene: &Scene, camera: &dyn Camera, film: &Film) -> Recording {
    let (view, settings) = (View::new(camera, *film), RenderSettings::default());
    let request = PictureRequest::new(scene, &view, &settings, LayerSet::DATA);
    let plan = headless.plan(&request, AccelChoice::Auto);
    let buffers = headless.upload(scene, &plan.build(scene)).wait().unwrap();
    let go_on = |_: &_| Decision::GoOn;
    headless.record(&buffers, &view, &settings, &mut { go_on }).wait().unwrap()
}

/// Prints one row of a table.
fn row(name: &str, certificate: &Certificate) {
    let count = |verdict| certificate.count(verdict);
    println!(
        "{name:<34}{:>11}{:>12.5}{:>9}{:>9}{:>6}{:>9.3}{:>9.3}",
        certificate.verdicts.len(),
        100.0 * certificate.decided_fraction(),
        count(Verdict::Silhouette),
        count(Verdict::Tie),
        count(Verdict::Violation),
        certificate.worst_depth,
        certificate.worst_normal,
    );
}

fn heading() {
    println!(
        "{:<34}{:>11}{:>12}{:>9}{:>9}{:>6}{:>9}{:>9}",
        "scene", "rays", "decided, %", "silhou.", "ties", "viol.", "depth", "normal"
    );
}

fn standard(headless: &Headless) {
    heading();
    for standard in Standard::ALL {
        let scene = grey(standard.spheres().unwrap());
        let film = standard.film().unwrap();
        let started = Instant::now();
        let checker = Checker::new(&scene).unwrap();
        let prepared = started.elapsed();
        let bounds = scene.bounds().unwrap();
        let away = DVec3::new(0.48, 0.36, -0.8);
        let far = far(bounds.center(), bounds.size().max_element(), away, 100.0);
        let near = standard.camera().unwrap();
        let views: [(&str, &dyn Camera); 2] = [("", &near), (", from 100 times as far", &far)];
        for (from, camera) in views {
            let started = Instant::now();
            let recording = record(headless, &scene, camera, &film);
            let recorded = started.elapsed();
            let started = Instant::now();
            let certificate = checker.certify(&recording);
            let checked = started.elapsed();
            row(&format!("{}{from}", standard.name()), &certificate);
            println!(
                "    checker prepared in {:.2} s, picture made in {:.2} s, checked in {:.2} s",
                prepared.as_secs_f64(),
                recorded.as_secs_f64(),
                checked.as_secs_f64()
            );
        }
    }
    println!();
}

/// Returns a camera at a distance of `times` the size in a direction. It sees as much of the scene as a near camera.
fn far(center: DVec3, size: f64, away: DVec3, times: f64) -> PinholeCamera {
    let eye = center + away * times * size;
    let pose = Pose::looking_at(eye, center, [0.0, 1.0, 0.0]).unwrap();
    PinholeCamera::new(pose, times * size, [0.8 * size, 0.8 * size]).unwrap()
}

fn cost(headless: &Headless) {
    for (name, count, side) in [("3", 3, 1024), ("100", 100, 1024), ("2000", 2000, 512)] {
        let scene = grey(spheres::random(count, 1, |rng| 0.05 + 0.1 * rng.f32()));
        let film = Film::new(side, side).unwrap();
        let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), film.aspect()).unwrap();
        let recording = record(headless, &scene, &camera, &film);
        let (mut reference, mut check) = (Duration::MAX, Duration::MAX);
        for _ in 0..5 {
            let started = Instant::now();
            cpu::render(&scene, &View::new(&camera, film), &RenderSettings::default(), LayerSet::DATA).unwrap();
            reference = reference.min(started.elapsed());
            let started = Instant::now();
            let certificate = Checker::new(&scene).unwrap().certify(&recording);
            check = check.min(started.elapsed());
            assert!(certificate.is_legal(), "{certificate}");
        }
        println!(
            "{name} spheres, {side}x{side}: reference {:.1} ms, checker {:.1} ms, {:.2} times",
            reference.as_secs_f64() * 1e3,
            check.as_secs_f64() * 1e3,
            check.as_secs_f64() / reference.as_secs_f64()
        );
    }
    println!();
}

/// Number of rounds of a comparison. The best time of each device counts.
const ROUNDS: usize = 15;

fn fences(fenced: &Headless) {
    let edit = |file: &str, find: &str, replace: &str| {
        let [file, find, replace] = [file, find, replace].map(str::to_owned);
        ShaderEdit { file, find, replace }
    };
    let open = |edits| Headless::open(&HeadlessOptions { edits, ..HeadlessOptions::default() }).wait();
    let bare = open(vec![
        edit("math/fence.wgsl", "bitcast<f32>(bitcast<u32>(v) ^ runtime_zero())", "v"),
        edit("math/fence.wgsl", "bitcast<vec3f>(bitcast<vec3u>(v) ^ vec3u(runtime_zero()))", "v"),
    ])
    .unwrap();
    // A zero from one uniform, which a driver might know, instead of two equal numbers. It is 0 for a single tile.
    let pair = "frame.iteration_limit ^ frame.iteration_limit_again";
    let known = open(vec![edit("scene/frame.wgsl", pair, "frame.target_origin.x")]).unwrap();
    for standard in [Standard::R1M, Standard::L1M, Standard::C200k] {
        let scene = grey(standard.spheres().unwrap());
        let (camera, film) = (standard.camera().unwrap(), standard.film().unwrap());
        for choice in [AccelChoice::Auto, AccelChoice::Tree] {
            let structures: Structures = fenced.plan_accel(&scene, choice).build(scene.spheres()).into();
            let devices = [fenced, &bare, &known];
            let buffers = devices.map(|headless| headless.upload(&scene, &structures).wait().unwrap());
            let mut best = [Duration::MAX; 3];
            for round in 0..=ROUNDS {
                for (which, headless) in devices.into_iter().enumerate() {
                    let time = headless.measure(&buffers[which], &View::new(&camera, film)).wait().unwrap();
                    // The clock of a software device counts only the work that it queues.
                    let is_software = headless.adapter_info().device_type == DeviceType::Cpu;
                    let time = time.device.filter(|_| !is_software).unwrap_or(time.wall);
                    // The first round is a warm-up.
                    if round > 0 {
                        best[which] = best[which].min(time);
                    }
                }
            }
            let [with, without, known] = best.map(|time| time.as_secs_f64() * 1e3);
            println!(
                "{}, {}: {with:.2} ms with fences, {without:.2} without, {:+.1} %; {known:.2} with a zero of one \
                 uniform",
                standard.name(),
                structures.accel.structure().name(),
                100.0 * (with / without - 1.0)
            );
        }
    }
    println!();
}

/// Prints the number of pixels that miss a sphere if the boxes for ray queries have smaller margins.
fn margins() {
    // With a margin of 0, only roundings of coordinates are left. A negative margin cuts spheres.
    const PARTS: [f32; 8] = [1.0, 0.25, 0.0625, 0.0, -0.015_625, -0.0625, -0.25, -1.0];
    let options = HeadlessOptions { ray_query: true, ..HeadlessOptions::default() };
    let headless = Headless::open(&options).wait().unwrap();
    print!("{:<26}{:>9}", "margin, of that of trees", "rays");
    PARTS.iter().for_each(|part| print!("{part:>9.5}"));
    println!();
    let mut sums = [0; PARTS.len()];
    for (name, scene) in campaign_scenes(0) {
        if scene.spheres().len() > 10_000 {
            // A list of as many spheres takes too long.
            continue;
        }
        let (mut rays, mut missed) = (0, [0; PARTS.len()]);
        for (_, camera) in campaign_views(&scene, 0) {
            let view = View::new(camera.as_ref(), Film::new(256, 256).unwrap());
            let hits = |choice, part| {
                let plan = headless.plan_accel(&scene, choice).with_box_margin(part);
                let structures: Structures = plan.build(scene.spheres()).into();
                let buffers = headless.upload(&scene, &structures).wait().unwrap();
                let (settings, go_on) = (RenderSettings::default(), |_: &_| Decision::GoOn);
                let recording = headless.record(&buffers, &view, &settings, &mut { go_on }).wait().unwrap();
                let hit = |pixel: &pinhole::verify::TracedPixel| (pixel.t.to_bits(), pixel.id);
                recording.pixels.iter().map(hit).collect::<Vec<_>>()
            };
            let expected = hits(AccelChoice::List, 1.0);
            rays += expected.len();
            for (missed, part) in missed.iter_mut().zip(PARTS) {
                let found = hits(AccelChoice::RayQuery, part);
                *missed += found.iter().zip(&expected).filter(|(a, b)| a != b).count();
            }
        }
        print!("{name:<26}{rays:>9}");
        missed.iter().for_each(|missed| print!("{missed:>9}"));
        println!();
        sums.iter_mut().zip(missed).for_each(|(sum, missed)| *sum += missed);
    }
    println!("{:<35}{}", "all", sums.map(|sum| format!("{sum:>9}")).concat());
}

type NamedScene = (&'static str, Scene);

/// The scenes of a round. Each round has separate random numbers.
fn campaign_scenes(round: u64) -> Vec<NamedScene> {
    let seed = 7 + 100 * round;
    let made = |kind: Kind, count| kind.spheres(count, seed).unwrap();
    let offset =
        |spheres: Vec<[f32; 4]>| spheres.into_iter().map(|[x, y, z, r]| [x + 1e6, y - 2e6, z + 5e5, r]).collect();
    [
        ("random, 100", made(Kind::Random, 100)),
        ("random, 100000", made(Kind::Random, 100_000)),
        ("lattice, 864", made(Kind::Lattice, 864)),
        ("lattice, 108000", made(Kind::Lattice, 108_000)),
        ("clusters, 50000", made(Kind::Clusters, 50_000)),
        ("sphereflake, 7381", made(Kind::Sphereflake, 7381)),
        ("four decades of radii", spheres::four_decades(20_000)),
        ("equal pairs", spheres::twice(3000)),
        ("mirrored pairs", spheres::mirrored(3000)),
        ("coincident", spheres::coincident(50)),
        ("nearly coincident", spheres::nearly_coincident(40)),
        ("concentric", spheres::concentric(100)),
        ("each in the next", spheres::nested(100)),
        ("a line that touches", spheres::line(300)),
        ("a plane", spheres::flat(5000)),
        ("one around all", spheres::one_around_all(3000)),
        ("dense in places", spheres::clusters(20, 500)),
        ("two to the 45", spheres::scaled(&spheres::four_decades(3000), 2_f32.powi(45))),
        ("two to the -40", spheres::scaled(&spheres::random(3000, seed - 5, |_| 0.02), 2_f32.powi(-40))),
        ("offset by a million", offset(spheres::random(500, seed - 4, |_| 64.0))),
        ("a ground of radius a million", {
            let mut spheres = spheres::random(500, seed - 3, |_| 0.03);
            spheres.push([0.5, -1e6, 0.5, 1e6]);
            spheres
        }),
        ("an outlier", spheres::outlier(3000)),
    ]
    .map(|(name, spheres)| (name, grey(spheres)))
    .into()
}

/// Returns views from outside, from 100 times as far away, from within, and with parallel
/// rays. Each round has other directions.
fn campaign_views(scene: &Scene, round: u64) -> Vec<(&'static str, Box<dyn Camera>)> {
    let bounds = scene.bounds_to_frame();
    let (center, size) = (bounds.center(), bounds.size().max_element());
    let up = [0.1, 1.0, 0.2];
    let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.64, 0.48), round as f64);
    let from = turn * DVec3::new(0.9, 0.6, 1.4);
    let outside = Pose::looking_at(center + from * size, center, up).unwrap();
    let within = Pose::looking_along(center, turn * DVec3::new(0.3, -0.4, 0.8), up).unwrap();
    let away = turn * DVec3::new(0.48, 0.36, -0.8);
    vec![
        ("near", Box::new(PinholeCamera::with_vertical_fov(outside, 0.7, 1.0).unwrap())),
        ("far", Box::new(far(center, size, away, 100.0))),
        ("within", Box::new(PinholeCamera::with_vertical_fov(within, 1.9, 1.0).unwrap())),
        ("parallel", Box::new(OrthographicCamera::new(outside, [0.8 * size, 0.8 * size]).unwrap())),
    ]
}

fn campaign(headless: &Headless, side: u32, round: u64) {
    heading();
    let film = Film::new(side, side).unwrap();
    let (mut rays, mut pictures) = (0, 0);
    let started = Instant::now();
    for (name, scene) in campaign_scenes(round) {
        let checker = Checker::new(&scene).unwrap();
        for (from, camera) in campaign_views(&scene, round) {
            let recording = record(headless, &scene, camera.as_ref(), &film);
            let certificate = checker.certify(&recording);
            row(&format!("{name}, {from}"), &certificate);
            assert_ne!(certificate.outcome(), Outcome::Violated, "{certificate}");
            rays += certificate.verdicts.len();
            pictures += 1;
        }
    }
    println!("{rays} rays in {pictures} pictures, {:.0} s\n", started.elapsed().as_secs_f64());
}

/// Checks the light of random scenes with these seeds.
fn lit_campaign(headless: &Headless, seeds: Range<u64>, view: ViewOf) {
    let mut all = LitCertificate::default();
    let (mut undecided, mut worst) = (0, 0.0);
    let started = Instant::now();
    let count = seeds.end - seeds.start;
    for seed in seeds {
        let RandomView { scene, camera, film, settings, name } = view(seed);
        let go_on = &mut |_: &_| Decision::GoOn;
        let view = View::new(camera.as_ref(), film);
        let request = PictureRequest::new(&scene, &view, &settings, LayerSet::COLOR);
        let plan = headless.plan(&request, AccelChoice::Auto);
        let buffers = headless.upload(&scene, &plan.build(&scene)).wait().unwrap();
        let checker = Checker::new(&scene).unwrap();
        let mut certificate = LitCertificate::default();
        let each = &mut |recording: &LitRecording| certificate.join(checker.certify_lit(recording));
        headless.record_lit(&buffers, &view, &settings, SampleRequest::middle(&[0, 1]), each, go_on).wait().unwrap();
        assert_ne!(certificate.outcome(), Outcome::Violated, "seed {seed}: {name}: {certificate}");
        let stages = certificate.stages();
        let share = stages.undecided as f64 / stages.checked as f64;
        if share > worst {
            worst = share;
            println!("seed {seed}: {name}: {certificate}");
        }
        undecided += u64::from(stages.undecided > 0);
        all.join(certificate);
    }
    let seconds = started.elapsed().as_secs_f64();
    println!("{count} scenes, {undecided} with undecided stages, {seconds:.0} s: {all}");
    println!("{:#?}\n", all.named());
}
