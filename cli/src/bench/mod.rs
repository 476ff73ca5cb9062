//! `pinhole bench`: measures acceleration structures on an adapter, and shows whether the automatic choice is fastest.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::Context;

use crate::bench::args::BenchArgs;
use crate::bench::report::{BenchReport, BenchScene, RunReport, SceneReport, Spread};
use crate::input::{Input, Source};
use crate::render::device::{AdapterReport, DEVICE_CLOCK, WantedAdapter, explained};
use crate::render::with_scene::watch_upload;
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, answer, tell};
use crate::terminal::text::json;
use crate::terminal::{interrupt, memory, profile, threads};
use pinhole::accel::{AccelChoice, Structure};
use pinhole::camera::View;
use pinhole::camera::film::Film;
use pinhole::generate::{BYTES_PER_SPHERE, Standard};
use pinhole::gpu::{GpuError, Headless, PictureRequest, RenderPlan, TraceTime, UploadStep, Wait};
use pinhole::image::LayerSet;
use pinhole::image::color::LinearRgb;
use pinhole::internals::text::one_line;
use pinhole::render::RenderSettings;
use pinhole::scene::Scene;
use pinhole_figure::scene_file::DEFAULT_COLOR;
use pinhole_figure::settings::size_of;

pub(crate) mod args;
mod report;

pub(crate) fn run(args: &BenchArgs) -> Result<(), Failure> {
    let size = args
        .size
        .as_deref()
        .map(|text| size_of(text).map_err(|error| Failure::usage(format!("--size {text}: {error}"))));
    let size = size.transpose()?;
    let sources = if args.scenes.is_empty() {
        DEFAULT.into_iter().map(BenchSource::Standard).collect()
    } else {
        let sources = args.scenes.iter().map(|scene| BenchSource::new(scene, args));
        sources.collect::<Result<Vec<_>, _>>()?
    };
    let adapter = WantedAdapter::new(&args.adapter).for_structures(args.accel.iter().copied());
    if args.accel.contains(&AccelChoice::Tiles) {
        profile::begin();
    }
    threads::start()?;
    let headless = adapter.open_any()?;
    let mut report = BenchReport {
        version: env!("CARGO_PKG_VERSION"),
        adapter: AdapterReport::of(headless.adapter_info()),
        reps: args.reps,
        scenes: Vec::new(),
    };
    if !args.json {
        say(&report.heading())?;
    }
    for source in sources {
        let scene = source.load(size)?;
        let measured = measure_scene(&headless, &scene, args)?;
        if !args.json {
            say(&measured.readable())?;
        }
        report.scenes.push(measured);
    }
    if args.json {
        say(&json(&report)?)?;
    }
    Ok(())
}

/// Prints a part of the report at once, because measuring all scenes takes minutes.
fn say(text: &str) -> Result<(), Failure> {
    progress::clear();
    Ok(answer(text.as_bytes())?)
}

fn measure_scene(headless: &Headless, scene: &BenchScene, args: &BenchArgs) -> Result<SceneReport, Failure> {
    let mut choices = args.accel.clone();
    if choices.is_empty() {
        let planned = headless.plan_accel(&scene.scene, AccelChoice::Auto).structure;
        let other = match planned {
            Structure::WideTree => AccelChoice::Grid,
            _ => AccelChoice::Tree,
        };
        choices = vec![AccelChoice::Auto, other];
    }
    let mut runs = Vec::new();
    for choice in choices {
        runs.push(measure(headless, scene, choice, args)?);
    }
    Ok(SceneReport::new(scene, runs))
}

/// Measures one structure, from planning to tracing.
fn measure(
    headless: &Headless,
    scene: &BenchScene,
    choice: AccelChoice,
    args: &BenchArgs,
) -> Result<RunReport, Failure> {
    let BenchScene { name, scene: spheres, camera, film, .. } = scene;
    let failed = |error: GpuError| explained(headless, &error);
    progress::stage(format!("{name}: building, {choice}"));
    let started = Instant::now();
    let (view, settings) = (View::new(camera.as_ref(), *film), RenderSettings::default());
    let request = PictureRequest {
        is_only: choice == AccelChoice::Tiles,
        is_shaded: true,
        scene: spheres,
        view,
        settings: &settings,
        layers: LayerSet::COLOR,
        host_bytes_per_pixel: memory::ENCODING_BYTES_PER_PIXEL,
    };
    let reps = args.reps;
    let plan = headless.plan(&request, choice);
    plan.check(&headless.device().limits(), memory::available()).map_err(failed)?;
    tell(format_args!(
        "{name}: {}; at most {} of memory on the device, and {} on the host in addition to the scene and the driver",
        plan.structure().name(),
        memory::readable(plan.device_bytes),
        memory::readable(plan.host_bytes),
    ));
    let measured = if plan.by_tiles {
        measure_tiles(headless, scene, &request, &plan, (started.elapsed(), reps))?
    } else {
        measure_structure(headless, scene, &request, &plan, (started, reps))?
    };
    let Measured { structure, build, upload, first_render, times, scene_bytes } = measured;
    let longest = times.iter().map(|time| time.longest).max().filter(|longest| *longest > Duration::ZERO);
    // The scene has the size of the built structure, and the frame the size that was planned.
    let frame = plan.tile_buffers.iter().chain(&plan.tile_textures).map(|buffer| buffer.bytes);
    let device_bytes = scene_bytes + frame.sum::<u64>();
    let clock = AdapterReport::of(headless.adapter_info()).clock();
    let rays = film.pixel_count();
    // The clock of a software device does not measure the work.
    let has_clock = clock == DEVICE_CLOCK;
    let of_device = |time: &TraceTime| time.device.filter(|_| has_clock);
    let trace_wall = Spread::of(times.iter().map(|time| Some(time.wall)));
    let trace_device = Spread::of(times.iter().map(of_device));
    let rate = trace_device.or(trace_wall).map(|spread| rays as f64 / spread.median_seconds);
    Ok(RunReport {
        choice: choice.to_string(),
        structure: structure.name(),
        reason: plan.reason().to_owned(),
        build_seconds: build.as_secs_f64(),
        upload_seconds: upload.as_secs_f64(),
        first_render_seconds: first_render.as_secs_f64(),
        trace_wall,
        trace_device,
        clock,
        rays,
        rays_per_second: rate,
        submissions: times.iter().map(|time| time.submissions).max().unwrap_or(0),
        longest_submission_seconds: longest.as_ref().map(Duration::as_secs_f64),
        device_bytes,
        device_bytes_per_sphere: (!spheres.is_empty()).then(|| device_bytes as f64 / spheres.shape_count() as f64),
        peak_memory_bytes: memory::peak_bytes(),
    })
}

/// The measurements of a structure.
struct Measured {
    structure: Structure,
    build: Duration,
    upload: Duration,
    first_render: Duration,
    times: Vec<TraceTime>,
    /// Bytes of the scene on the device.
    scene_bytes: u64,
}

/// Builds a structure, and traces rays with it several times.
fn measure_structure(
    headless: &Headless,
    BenchScene { name, scene, .. }: &BenchScene,
    PictureRequest { view, settings, layers, .. }: &PictureRequest<'_>,
    plan: &RenderPlan,
    (started, reps): (Instant, u32),
) -> Result<Measured, Failure> {
    let failed = |error: GpuError| explained(headless, &error);
    let mut times = UploadTimes { build: Duration::ZERO, upload: Duration::ZERO, started, step: None };
    let uploaded = interrupt::on_device(|| {
        headless
            .upload_planned(scene, &plan.structures(), &mut |progress| {
                times.begin(Some(progress.step));
                watch_upload(plan.accel.structure.name(), progress)
            })
            .wait()
    })?;
    times.begin(None);
    let buffers = uploaded.map_err(failed)?;
    let (UploadTimes { build, upload, .. }, structure) = (times, buffers.structure());
    progress::stage(format!("{name}: first render, {}", structure.name()));
    let started = Instant::now();
    let first = interrupt::on_device(|| {
        let watch = &mut |_: &_| interrupt::decide();
        headless.render_uploaded(&buffers, view, settings, *layers, watch).wait()
    })?;
    first.map(drop).map_err(failed)?;
    let first_render = started.elapsed();
    let times =
        repeat(name, reps, || interrupt::on_device(|| headless.measure(&buffers, view).wait())?.map_err(failed))?;
    Ok(Measured { structure, build, upload, first_render, times, scene_bytes: buffers.bytes() })
}

/// Renders a picture by tiles several times. All times but that of the first picture are of the device's profile.
fn measure_tiles(
    headless: &Headless,
    BenchScene { name, .. }: &BenchScene,
    request: &PictureRequest<'_>,
    plan: &RenderPlan,
    (planning, reps): (Duration, u32),
) -> Result<Measured, Failure> {
    let picture = || {
        let watch = &mut |_: &_| interrupt::decide();
        let watch_lists = &mut |progress: &_| watch_upload(plan.structure().name(), progress);
        let rendered = interrupt::on_device(|| headless.render_planned(request, plan, watch_lists, watch).wait())?;
        rendered.map(drop).map_err(|error| explained(headless, &error))
    };
    progress::stage(format!("{name}: first render, {}", plan.structure().name()));
    let started = Instant::now();
    picture()?;
    let first_render = started.elapsed();
    let (mut builds, mut uploads) = (Vec::new(), Vec::new());
    let times = repeat(name, reps, || {
        let [lists, copies, (trace, submissions)] =
            profile::spent([&["divide", "build"], &["upload"], &["trace"]], picture)?;
        builds.push(Some(lists.0));
        uploads.push(Some(copies.0));
        let mut time = TraceTime::default();
        (time.wall, time.submissions) = (trace, submissions as u32);
        Ok(time)
    })?;
    let [build, upload] = [builds, uploads].map(|times| {
        Spread::of(times.into_iter()).map_or(Duration::ZERO, |spread| Duration::from_secs_f64(spread.median_seconds))
    });
    let scene_bytes = plan.scene_buffers.iter().map(|buffer| buffer.bytes).sum();
    Ok(Measured { structure: plan.structure(), build: planning + build, upload, first_render, times, scene_bytes })
}

/// Total times of building bricks and of copying them to the device. Planning counts as building.
struct UploadTimes {
    build: Duration,
    upload: Duration,
    started: Instant,
    step: Option<UploadStep>,
}

impl UploadTimes {
    /// Ends a step and begins the next.
    fn begin(&mut self, next: Option<UploadStep>) {
        let elapsed = self.started.elapsed();
        match self.step {
            Some(UploadStep::Copying) => self.upload += elapsed,
            _ => self.build += elapsed,
        }
        (self.started, self.step) = (Instant::now(), next);
    }
}

fn repeat(
    name: &str,
    reps: u32,
    mut measure: impl FnMut() -> Result<TraceTime, Failure>,
) -> Result<Vec<TraceTime>, Failure> {
    (0..reps)
        .map(|rep| {
            progress::stage(format!("{name}: tracing, {} of {reps}", rep + 1));
            measure()
        })
        .collect()
}

/// The scenes to measure by default; any machine has enough memory for them.
pub(crate) const DEFAULT: [Standard; 3] = [Standard::R1M, Standard::L1M, Standard::C200k];

/// A scene that was named on the command line.
pub(crate) enum BenchSource {
    Standard(Standard),
    File(PathBuf, Box<Source>),
}

impl BenchSource {
    /// Finds the standard scene of this name, or else takes the name as the path of a file.
    pub(crate) fn new(named: &Path, args: &BenchArgs) -> Result<Self, Failure> {
        let standard = Standard::ALL.iter().find(|standard| named == Path::new(standard.name()));
        match standard {
            Some(standard) => Ok(Self::Standard(*standard)),
            None if named.extension().is_none() => {
                let names: Vec<_> = Standard::ALL.iter().map(|standard| standard.name()).collect();
                Err(Failure::usage(format!(
                    "{}: this is neither a standard scene nor a file with an extension; name one of {} or a file",
                    named.display(),
                    names.join(", ")
                )))
            }
            None => Ok(Self::File(named.to_path_buf(), Box::new(Source::of_bench(named, args)?))),
        }
    }

    /// Generates or reads the scene. For a generated scene, prints the memory that it needs, and refuses it if
    /// this memory is not free.
    pub(crate) fn load(&self, size: Option<[u32; 2]>) -> Result<BenchScene, Failure> {
        match self {
            Self::Standard(standard) => made(*standard, size),
            Self::File(path, source) => {
                let started = Instant::now();
                let input = source.load()?;
                let load = started.elapsed();
                let note = progress::notes(false);
                input.notes.iter().for_each(|text| note(text));
                let name = one_line(&path.display().to_string());
                let Input { scene, camera, film, .. } = input;
                let scene = Arc::unwrap_or_clone(scene);
                Ok(BenchScene { name, scene, camera, film, load })
            }
        }
    }
}

fn made(standard: Standard, size: Option<[u32; 2]>) -> Result<BenchScene, Failure> {
    let (name, count) = (standard.name(), standard.count());
    let film = match size {
        Some([width, height]) => {
            Film::new(width, height).map_err(|error| Failure::usage(format!("--size: {error}")))?
        }
        None => standard.film().context(name)?,
    };
    let bytes = count * BYTES_PER_SPHERE;
    memory::check_bytes(&format!("{name}: {count} spheres need"), bytes, "a smaller scene")?;
    tell(format_args!("{name}: {count} spheres, {} of memory", memory::readable(bytes)));
    progress::stage(format!("generating {name}"));
    let started = Instant::now();
    let spheres = standard.spheres().context(name)?;
    let scene = Scene::from_f32(spheres, LinearRgb::from_srgb8(DEFAULT_COLOR)).context(name)?;
    let load = started.elapsed();
    let camera = Box::new(standard.camera().context(name)?);
    Ok(BenchScene { name: name.to_owned(), scene, camera, film, load })
}
