//! Measures acceleration structures on standard scenes: building them, and tracing a ray through every pixel on the CPU
//! and on the adapter.
//!
//! ```sh
//! cargo bench --bench accel
//! cargo bench --bench accel -- 'C200k, trace'
//! ```
#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use pinhole::accel::{AccelChoice, AccelPlan, ListLayout};
use pinhole::camera::Camera;
use pinhole::generate::Standard;
use pinhole::gpu::{Headless, HeadlessOptions};
use pinhole::internals::{BinaryTree, GridBudget, RayF32, WideTree, build_grid};
use pinhole::{Film, LinearRgb, Scene, View};

const CHOICES: [AccelChoice; 3] = [AccelChoice::Grid, AccelChoice::Tree, AccelChoice::BinaryTree];

/// Size of a binding that every device supports.
const BINDING_BYTES: u64 = 1 << 27;

fn accel(criterion: &mut Criterion) {
    let headless = Headless::open(&HeadlessOptions::default()).unwrap();
    for standard in [Standard::R1M, Standard::C200k] {
        let grey = LinearRgb::from_srgb8([128, 128, 128]);
        let scene = Scene::from_f32(standard.spheres().unwrap(), grey).unwrap();
        let name = standard.name();
        build(&mut group(criterion, &format!("{name}, build")), &scene);
        let camera = standard.camera().unwrap();
        let mut traced = group(criterion, &format!("{name}, trace"));
        on_cpu(&mut traced, &scene, &camera);
        on_adapter(&mut traced, &headless, &scene, &camera, standard.film().unwrap());
    }
}

fn group<'a>(criterion: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(10);
    group
}

fn build(group: &mut BenchmarkGroup<'_, WallTime>, scene: &Scene) {
    let spheres = scene.spheres();
    let margin = AccelPlan::new(spheres, AccelChoice::Auto, BINDING_BYTES).statistics.margin();
    let count = spheres.len();
    let ids: Vec<u32> = (0..count as u32).collect();
    group.throughput(Throughput::Elements(count as u64));
    let budget = GridBudget { listed: 5 * count, cells: 2 * count };
    for (layout, name) in
        [(ListLayout::Balls, "grid, copied"), (ListLayout::Referenced, "grid, referenced")]
    {
        group.bench_function(name, |b| {
            b.iter(|| build_grid(spheres, &ids, margin, layout, budget));
        });
    }
    group.bench_function("wide tree", |b| b.iter(|| WideTree::build(spheres, margin)));
    group.bench_function("binary tree", |b| b.iter(|| BinaryTree::build(spheres, margin)));
}

/// Traces rays on one thread of the CPU.
fn on_cpu(group: &mut BenchmarkGroup<'_, WallTime>, scene: &Scene, camera: &dyn Camera) {
    let film = Film::new(128, 128).unwrap();
    for choice in CHOICES {
        let plan = AccelPlan::new(scene.spheres(), choice, BINDING_BYTES);
        let accel = plan.build(scene.spheres());
        let rays = rays(scene, camera, &film, accel.bounds());
        group.throughput(Throughput::Elements(rays.len() as u64));
        group.bench_function(format!("cpu, {choice}"), |b| {
            b.iter(|| rays.iter().filter(|ray| accel.find_nearest(ray).t < 1.0).count());
        });
    }
}

/// Returns the rays that meet the box of the scene. They start where they enter the box.
fn rays(
    scene: &Scene,
    camera: &dyn Camera,
    film: &Film,
    (min, max): (pinhole::glam::Vec3, pinhole::glam::Vec3),
) -> Vec<RayF32> {
    let pixels = (0..film.height()).flat_map(|j| (0..film.width()).map(move |i| (i, j)));
    pixels
        .filter_map(|(i, j)| {
            let location = film.relative_location(f64::from(i) + 0.5, f64::from(j) + 0.5);
            let ray = camera.ray_in_world(location);
            let origin = ray.origin - scene.origin();
            let (a, b) = (
                (min.as_dvec3() - origin) / ray.direction,
                (max.as_dvec3() - origin) / ray.direction,
            );
            let (enters, leaves) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
            (enters < leaves).then(|| RayF32 {
                origin: (origin + enters * ray.direction).as_vec3(),
                direction: ray.direction.as_vec3(),
            })
        })
        .collect()
}

fn on_adapter(
    group: &mut BenchmarkGroup<'_, WallTime>,
    headless: &Headless,
    scene: &Scene,
    camera: &dyn Camera,
    film: Film,
) {
    group.throughput(Throughput::Elements(film.pixel_count()));
    for choice in [AccelChoice::Grid, AccelChoice::Tree] {
        let accel = headless.plan_accel(scene, choice).build(scene.spheres());
        let buffers = headless.upload(scene, &accel.into()).unwrap();
        group.bench_function(format!("{}, {choice}", headless.adapter_info().name), |b| {
            b.iter(|| headless.measure(&buffers, &View::new(camera, film)).unwrap());
        });
    }
}

criterion_group!(benches, accel);
criterion_main!(benches);
