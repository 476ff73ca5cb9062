//! Measures acceleration structures on standard scenes: building them, and tracing a ray through every pixel on the adapter.
//!
//! ```sh
//! cargo bench --bench accel
//! cargo bench --bench accel -- 'C200k, trace'
//! ```
#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use pinhole::accel::{AccelChoice, AccelPlan};
use pinhole::camera::Camera;
use pinhole::generate::Standard;
use pinhole::gpu::{Headless, HeadlessOptions, Wait};
use pinhole::{Film, LinearRgb, Scene, View};

const CHOICES: [AccelChoice; 2] = [AccelChoice::Grid, AccelChoice::Tree];

/// Size of a binding that every device supports.
const BINDING_BYTES: u64 = 1 << 27;

fn accel(criterion: &mut Criterion) {
    let headless = Headless::open(&HeadlessOptions::default()).wait().unwrap();
    for standard in [Standard::R1M, Standard::C200k] {
        let grey = LinearRgb::from_srgb8([128, 128, 128]);
        let scene = Scene::from_f32(standard.spheres().unwrap(), grey).unwrap();
        let name = standard.name();
        build(&mut group(criterion, &format!("{name}, build")), &scene);
        let camera = standard.camera().unwrap();
        let mut traced = group(criterion, &format!("{name}, trace"));
        on_adapter(&mut traced, &headless, &scene, &camera, standard.film().unwrap());
    }
}

fn group<'a>(criterion: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(10);
    group
}

fn build(group: &mut BenchmarkGroup<'_, WallTime>, scene: &Scene) {
    group.throughput(Throughput::Elements(scene.len() as u64));
    for choice in CHOICES {
        let plan = AccelPlan::new(scene.spheres(), choice, BINDING_BYTES);
        group.bench_function(choice.to_string(), |b| b.iter(|| plan.build(scene.spheres())));
    }
}

fn on_adapter(
    group: &mut BenchmarkGroup<'_, WallTime>,
    headless: &Headless,
    scene: &Scene,
    camera: &dyn Camera,
    film: Film,
) {
    group.throughput(Throughput::Elements(film.pixel_count()));
    for choice in CHOICES {
        let accel = headless.plan_accel(scene, choice).build(scene.spheres());
        let buffers = headless.upload(scene, &accel.into()).wait().unwrap();
        group.bench_function(format!("{}, {choice}", headless.adapter_info().name), |b| {
            b.iter(|| headless.measure(&buffers, &View::new(camera, film)).wait().unwrap());
        });
    }
}

criterion_group!(benches, accel);
criterion_main!(benches);
