//! Measures the whole process of `pinhole demo`, from start to exit, with and without a GPU.
//!
//! ```sh
//! cargo bench --bench startup
//! ```
#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::process::{Command, Stdio};

use criterion::{Criterion, criterion_group, criterion_main};

fn demo(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().unwrap();
    let mut group = criterion.benchmark_group("process");
    group.sample_size(20);
    for backend in ["gpu", "cpu"] {
        group.bench_function(format!("pinhole demo --backend {backend}"), |b| {
            b.iter(|| {
                let status = Command::new(env!("CARGO_BIN_EXE_pinhole"))
                    .args(["demo", "--backend", backend])
                    .current_dir(folder.path())
                    .stderr(Stdio::null())
                    .status()
                    .unwrap();
                assert!(status.success());
            });
        });
    }
    group.finish();
}

criterion_group!(benches, demo);
criterion_main!(benches);
