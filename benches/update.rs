//! Measures changing the colours and the centres of a million spheres on the adapter.
//!
//! ```sh
//! cargo bench --bench update
//! ```
#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pinhole::accel::AccelChoice;
use pinhole::generate::Standard;
use pinhole::gpu::{Headless, HeadlessOptions};
use pinhole::scene::{Centers, NewColors, SceneUpdate};
use pinhole::{Appearance, Scene, SphereArray};

fn update(criterion: &mut Criterion) {
    let headless = Headless::open(&HeadlessOptions::default()).unwrap();
    let spheres = Standard::R1M.spheres().unwrap();
    let centers: Vec<[f32; 3]> = spheres.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
    let count = spheres.len();
    let colors: Vec<[u8; 4]> = (0..count as u32).map(|i| (i | 0xff00_0000).to_le_bytes()).collect();
    let appearance = Appearance::from(colors.clone());
    let mut scene = Scene::from_parts(SphereArray::F32(spheres), appearance).unwrap();
    let plan = headless.plan_accel(&scene, AccelChoice::Auto);
    let mut buffers = headless.upload(&scene, &plan.build(scene.spheres()).into()).unwrap();

    let mut group = criterion.benchmark_group("R1M, update");
    group.sample_size(10);
    for part in [count, count / 100] {
        let colors = Some(NewColors::Rgba8(&colors[..part]));
        let recolored = SceneUpdate { colors, ..SceneUpdate::default() };
        let centers = Some(Centers::F32(&centers[..part]));
        let moved = SceneUpdate { centers, ..SceneUpdate::default() };
        group.throughput(Throughput::Elements(part as u64));
        for (what, update) in [("colors", recolored), ("centers", moved)] {
            group.bench_function(format!("{what} of {part}, host"), |b| {
                b.iter(|| scene.apply(&update).unwrap());
            });
            group.bench_function(format!("{what} of {part}, adapter"), |b| {
                b.iter(|| headless.update(&mut buffers, &scene, &update).unwrap());
            });
        }
    }
}

criterion_group!(benches, update);
criterion_main!(benches);
