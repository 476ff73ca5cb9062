//! Measures rendering three spheres at 1920×1080, on the adapter that `pinhole render` would choose and on the CPU.
//!
//! ```sh
//! cargo bench --bench render
//! ```
#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use criterion::{Criterion, criterion_group, criterion_main};
use pinhole::gpu::{Headless, HeadlessOptions};
use pinhole::scene_file::{IntegratorKind, SceneFile};
use pinhole::{Film, LayerSet, View, cpu};

fn three_spheres(criterion: &mut Criterion) {
    let file = SceneFile::parse(include_str!("../examples/three-spheres.toml")).unwrap();
    let scene = file.scene(&[]).unwrap();
    let film = Film::new(1920, 1080).unwrap().with_y_axis(file.film.y_axis());
    let camera = file.camera(&film, &scene).unwrap();
    let (view, kind) = (View::new(camera.as_ref(), film), IntegratorKind::Primary);
    let settings = file.settings(kind, &scene, camera.as_ref(), None).unwrap();

    let mut group = criterion.benchmark_group("three spheres, 1920x1080");
    group.sample_size(20);
    group.throughput(criterion::Throughput::Elements(film.pixel_count()));
    group.bench_function("cpu", |b| {
        b.iter(|| cpu::render(&scene, &view, &settings, LayerSet::COLOR));
    });
    let headless = Headless::open(&HeadlessOptions::default()).unwrap();
    for (layers, name) in [(LayerSet::COLOR, "color"), (LayerSet::DATA, "all layers")] {
        // This includes the copy back to the host, as in a headless program.
        let name = format!("{}, {name}", headless.adapter_info().name);
        group.bench_function(name, |b| {
            b.iter(|| headless.render(&scene, &view, &settings, layers).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, three_spheres);
criterion_main!(benches);
