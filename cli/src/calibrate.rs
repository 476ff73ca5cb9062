//! `pinhole bench --calibrate`: measures the prices of an adapter on small generated scenes, and keeps them.

use std::time::{Duration, Instant};

use anyhow::Context;
use serde::Serialize;

use super::adapter::AdapterReport;
use super::bench_counts::count;
use super::bench_report::DEVICE_CLOCK;
use super::bench_scene::BenchScene;
use super::device::explained;
use super::failure::Failure;
use super::prices;
use super::speak::{answer, tell};
use super::table::table;
use super::{interrupt, progress};
use pinhole::accel::{AccelPlan, ListLayout, Prices, Structure, StructurePrices};
use pinhole::camera::View;
use pinhole::camera::film::Film;
use pinhole::generate::{Kind, Standard};
use pinhole::gpu::{GpuError, Headless};
use pinhole::image::color::LinearRgb;
use pinhole::scene::Scene;

/// The scenes, which take a fraction of a second to build and to trace on a software device.
const SCENES: [(Kind, u64); 2] = [(Kind::Random, 100_000), (Kind::Clusters, 25_000)];

/// The number of times that building and tracing are measured; the shortest counts, because other programs only make
/// times longer.
const TURNS: u32 = 3;

/// A binding that every device has; the scenes are far smaller.
const BINDING_BYTES: u64 = 1 << 27;

/// The structures with prices of their own.
const STRUCTURES: [Structure; 3] = [
    Structure::Grid(ListLayout::Referenced),
    Structure::Grid(ListLayout::Balls),
    Structure::WideTree,
];

/// The measured prices, and how they relate to the built-in ones.
#[derive(Serialize)]
struct Calibrated {
    version: &'static str,
    adapter: AdapterReport,
    measured_on: String,
    seconds: f64,
    structures: Vec<Factors>,
    /// The time to copy a byte to the device.
    upload_byte_nanoseconds: f64,
    /// The file; null if the prices could not be kept.
    file: Option<String>,
}

/// Times as multiples of what the built-in prices say, as geometric means over the scenes.
#[derive(Serialize)]
struct Factors {
    structure: &'static str,
    tracing: f64,
    building: f64,
}

/// What was measured for one structure of one scene.
struct Measured {
    tracing: f64,
    building: f64,
    upload_byte: f64,
}

/// Measures and keeps the prices. The device has its built-in prices.
pub(super) fn run(headless: &Headless, json: bool) -> Result<(), Failure> {
    let started = Instant::now();
    let built_in = *headless.prices();
    let scenes = SCENES.map(|(kind, number)| scene(headless, kind, number));
    let scenes = scenes.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut prices = built_in;
    let mut structures = Vec::new();
    let mut upload_bytes = Vec::new();
    for structure in STRUCTURES {
        let of = built_in.of(structure).context("this structure has no prices")?;
        let measured = scenes.iter().map(|scene| measure(headless, scene, structure, of));
        let measured = measured.collect::<Result<Vec<_>, _>>()?;
        let mean = |of: fn(&Measured) -> f64| mean(measured.iter().map(of));
        let (tracing, building) = (mean(|one| one.tracing), mean(|one| one.building));
        let scaled = of.scaled(tracing, building);
        match structure {
            Structure::WideTree => prices.tree = scaled,
            Structure::Grid(ListLayout::Balls) => prices.balls = scaled,
            _ => prices.references = scaled,
        }
        structures.push(Factors { structure: structure.name(), tracing, building });
        upload_bytes.push(mean(|one| one.upload_byte));
    }
    prices.upload_byte = upload_bytes.into_iter().fold(f64::INFINITY, f64::min);
    let measured_on = prices::today();
    let file = keep(headless, &prices, &measured_on);
    let calibrated = Calibrated {
        version: env!("CARGO_PKG_VERSION"),
        adapter: AdapterReport::of(headless),
        measured_on,
        seconds: started.elapsed().as_secs_f64(),
        structures,
        upload_byte_nanoseconds: prices.upload_byte,
        file,
    };
    let text = if json {
        let text = serde_json::to_string_pretty(&calibrated);
        text.context("the report cannot be written as JSON")? + "\n"
    } else {
        calibrated.readable()
    };
    progress::clear();
    Ok(answer(text.as_bytes()).context("standard output: cannot be written")?)
}

/// Keeps the prices, and returns the file. Prices that cannot be kept are a note, not a failure.
fn keep(headless: &Headless, prices: &Prices, day: &str) -> Option<String> {
    let remedy = "set XDG_CACHE_HOME to a folder in which files can be written";
    let Some(path) = prices::path() else {
        tell(format_args!(
            "note: there is no folder for caches, so these prices are not kept; {remedy}"
        ));
        return None;
    };
    match prices::keep(&path, headless.adapter_info(), prices, day) {
        Ok(()) => Some(path.display().to_string()),
        Err(error) => {
            tell(format_args!(
                "note: {}: cannot be written, so these prices are not kept: {error}; {remedy}",
                path.display()
            ));
            None
        }
    }
}

fn scene(headless: &Headless, kind: Kind, number: u64) -> Result<BenchScene, Failure> {
    // A GPU traces more rays in less time.
    let is_software = AdapterReport::of(headless).clock() != DEVICE_CLOCK;
    let side = if is_software { 256 } else { 2048 };
    let started = Instant::now();
    let name = kind.name();
    let spheres = kind.spheres(number, Standard::SEED).context(name)?;
    let scene = Scene::from_f32(spheres, LinearRgb::WHITE).context(name)?;
    Ok(BenchScene {
        name: name.to_owned(),
        scene,
        camera: Box::new(Standard::R1M.camera().context(name)?),
        film: Film::new(side, side).context(name)?,
        load: started.elapsed(),
    })
}

/// Measures a structure, whatever it costs.
fn measure(
    headless: &Headless,
    scene: &BenchScene,
    structure: Structure,
    prices: &StructurePrices,
) -> Result<Measured, Failure> {
    let failed = |error: GpuError| explained(headless, &error);
    progress::stage(format!("measuring: {}, {}", scene.name, structure.name()));
    let plan = AccelPlan::of(scene.scene.spheres(), structure, BINDING_BYTES);
    let (mut building, mut accel) = (Duration::MAX, None);
    for _ in 0..TURNS {
        let started = Instant::now();
        accel = Some(plan.build(scene.scene.spheres()));
        building = building.min(started.elapsed());
    }
    let accel = accel.context("no structure was built")?;
    let (counts, share_in_box) = count(scene, &accel);
    let expected = share_in_box * prices.of_ray(&counts.times(1.0 / share_in_box));
    let structures = accel.into();
    let (mut uploading, mut buffers) = (Duration::MAX, None);
    for _ in 0..TURNS {
        let started = Instant::now();
        let uploaded = interrupt::on_device(|| headless.upload(&scene.scene, &structures))?;
        buffers = Some(uploaded.map_err(failed)?);
        uploading = uploading.min(started.elapsed());
    }
    let buffers = buffers.context("nothing was copied")?;
    let view = View::new(scene.camera.as_ref(), scene.film);
    let has_clock = AdapterReport::of(headless).clock() == DEVICE_CLOCK;
    let mut tracing = Duration::MAX;
    // The first turn also builds the pipeline and finds the size of submissions.
    for _ in 0..=TURNS {
        let time = interrupt::on_device(|| headless.measure(&buffers, &view))?;
        let time = time.map_err(failed)?;
        tracing = tracing.min(time.device.filter(|_| has_clock).unwrap_or(time.wall));
    }
    let nanoseconds = |time: Duration| time.as_secs_f64().max(1e-9) * 1e9;
    let number = scene.scene.len() as f64;
    Ok(Measured {
        tracing: nanoseconds(tracing) / scene.film.pixel_count() as f64 / expected,
        building: nanoseconds(building) / number / prices.build,
        upload_byte: nanoseconds(uploading) / buffers.bytes().max(1) as f64,
    })
}

/// The geometric mean.
fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    let logarithms: Vec<f64> = numbers.map(f64::ln).collect();
    (logarithms.iter().sum::<f64>() / logarithms.len() as f64).exp()
}

impl Calibrated {
    fn readable(&self) -> String {
        let rows: Vec<_> = self
            .structures
            .iter()
            .map(|Factors { structure, tracing, building }| {
                [(*structure).to_owned(), format!("{tracing:.2}"), format!("{building:.2}")]
            })
            .collect();
        let kept = match &self.file {
            Some(file) => format!("kept in {file}"),
            None => "not kept".to_owned(),
        };
        format!(
            "pinhole {}\n{}\n\ntimes as multiples of what the built-in prices say\n{}\ncopying a byte: {:.3} ns\n\
             measured in {:.1} s; {kept}\n",
            self.version,
            self.adapter.line(),
            table(["structure", "tracing", "building"], &rows),
            self.upload_byte_nanoseconds,
            self.seconds,
        )
    }
}
