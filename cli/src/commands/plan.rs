//! `pinhole plan`: shows how much memory a render would need, and whether it fits. Nothing is allocated on the device.

use std::sync::Arc;

use clap::Args;
use serde::Serialize;

use crate::flags::common::{AccelArgs, AdapterArgs, InputArgs};
use crate::flags::settings::{LOOK, SettingArgs};
use crate::input::{Input, Source};
use crate::render;
use crate::render::MOST_BY_TILES;
use crate::render::device::{AdapterReport, WantedAdapter, explained};
use crate::render::renderer::reason_for_cpu;
use crate::render::views::views_of;
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, answer};
use crate::terminal::text::{json, table};
use crate::terminal::{memory, threads};
use pinhole::accel::PlannedBuffer;
use pinhole::gpu::{Headless, RenderPlan};
use pinhole::image::{Layer, LayerSet};

#[derive(Debug, Args)]
#[command(after_help = "Nothing is allocated on the device. Exit codes: 0 the render fits; 1 it does not, \
    and the error is that of `render`; 2 wrong usage.\n\n\
    JSON: `version`, `scene` (spheres, cones, min, max, radius_min, radius_mean, radius_max), `structure` (name, \
    reason, bricks), `picture` (width, height, tile_width, tile_height, tiles, submissions_at_least), \
    `buffers` (name, bytes, bytes_per_binding, bindings), `device_bytes`, `device_bytes_per_sphere`, `host_bytes`, \
    `host_peak`, `host_bytes_available`, `adapter` (name, backend, device_type, driver, driver_info), `limits`, `fits`, \
    `problem`. New versions may add keys, but do not change these.")]
pub(crate) struct PlanArgs {
    #[command(flatten)]
    pub(crate) input: InputArgs,
    #[command(flatten)]
    pub(crate) light: SettingArgs<LOOK>,
    #[command(flatten)]
    pub(crate) adapter: AdapterArgs,
    #[command(flatten)]
    pub(crate) accel: AccelArgs,
    /// Data layer that would be written in addition (alpha, depth, normal, position, albedo, id, samples, variance);
    /// may be repeated
    #[arg(long = "layer", value_name = "LAYER")]
    pub(crate) layers: Vec<String>,
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Serialize)]
struct Report {
    version: &'static str,
    scene: SceneReport,
    structure: StructureReport,
    picture: PictureReport,
    buffers: Vec<BufferReport>,
    device_bytes: u64,
    device_bytes_per_sphere: Option<f64>,
    host_bytes: u64,
    host_peak: &'static str,
    host_bytes_available: Option<u64>,
    adapter: AdapterReport,
    limits: LimitsReport,
    fits: bool,
    problem: Option<String>,
}

#[derive(Serialize)]
struct SceneReport {
    spheres: usize,
    cones: usize,
    /// Smallest coordinates of the scene in world space.
    min: Option<[f64; 3]>,
    max: Option<[f64; 3]>,
    radius_min: f32,
    radius_mean: f32,
    radius_max: f32,
}

#[derive(Serialize)]
struct StructureReport {
    name: &'static str,
    reason: String,
    bricks: usize,
}

#[derive(Serialize)]
struct PictureReport {
    width: u32,
    height: u32,
    tile_width: u32,
    tile_height: u32,
    tiles: u64,
    submissions_at_least: u64,
}

#[derive(Serialize)]
struct BufferReport {
    name: &'static str,
    bytes: u64,
    bytes_per_binding: u64,
    bindings: u64,
}

/// The limits that bound the size of scenes and pictures.
#[derive(Serialize)]
struct LimitsReport {
    max_storage_buffer_binding_size: u64,
    max_buffer_size: u64,
    max_texture_dimension_2d: u32,
}

pub(crate) fn run(args: &PlanArgs) -> Result<(), Failure> {
    let source = {
        let InputArgs { path, view } = &args.input;
        Source::lit(path, &view.given.clone().and(&args.light.given), None)?
    };
    let layers = args.layers.iter().try_fold(LayerSet::COLOR, |layers, name| {
        let layer = name.parse::<Layer>();
        layer.map(|layer| layers.with(layer)).map_err(|error| Failure::usage(format!("--layer {name}: {error}")))
    })?;
    let adapter = WantedAdapter::new(&args.adapter).for_structures(args.accel.accel);
    threads::start()?;
    let mut input = source.load()?;
    if let Some(bricks) = input.bricks.clone() {
        let count = bricks.len();
        input.notes.push(format!("this is the plan of the largest of {count} bricks, which are rendered one by one"));
        input.scene = Arc::new(bricks.largest_scene(input.color)?);
    }
    let headless = adapter.open_any()?;
    if args.adapter.first_given(args.accel.accel).is_none() && reason_for_cpu(&headless, &input).is_some() {
        let text =
            "this is the plan with --backend gpu; without it, `render` follows random rays on the CPU reference here";
        input.notes.push(text.to_owned());
    }
    let note = progress::notes(false);
    input.notes.iter().for_each(|text| note(text));
    // `render` adds this layer too.
    let alpha = input.encoding.transparent.then_some(Layer::Alpha);
    let layers = layers.iter().chain(alpha).collect();
    progress::stage("planning");
    let choice = args.accel.accel.unwrap_or_default();
    let views = views_of(&input, input.film);
    let is_only = input.bricks.is_none() && views.len() <= MOST_BY_TILES;
    let plan = render::plan(&headless, &input, &views, layers, choice, is_only);
    let available = memory::available();
    let verdict = plan.check(&headless.device().limits(), available).map_err(|error| explained(&headless, &error));
    let problem = verdict.as_ref().err().map(Failure::message);
    let report = Report::new(&input, &plan, &headless, available, problem);
    let text = if args.json { json(&report)? } else { report.readable() };
    progress::clear();
    answer(text.as_bytes())?;
    verdict
}

impl Report {
    fn new(
        input: &Input,
        plan: &RenderPlan,
        headless: &Headless,
        host_bytes_available: Option<u64>,
        problem: Option<String>,
    ) -> Self {
        let limits = headless.device().limits();
        let statistics = &plan.accel.statistics;
        let bounds = input.scene.bounds();
        let buffers = [&plan.scene_buffers, &plan.tile_buffers, &plan.tile_textures];
        Self {
            version: env!("CARGO_PKG_VERSION"),
            scene: SceneReport {
                spheres: statistics.count,
                cones: input.scene.cones().len(),
                min: bounds.map(|bounds| bounds.min().to_array()),
                max: bounds.map(|bounds| bounds.max().to_array()),
                radius_min: statistics.radius_min,
                radius_mean: statistics.radius_mean,
                radius_max: statistics.radius_max,
            },
            picture: PictureReport {
                width: input.film.width(),
                height: input.film.height(),
                tile_width: plan.tile_size[0],
                tile_height: plan.tile_size[1],
                tiles: plan.tile_count,
                submissions_at_least: plan.least_submissions(),
            },
            buffers: buffers.into_iter().flatten().map(BufferReport::of).collect(),
            device_bytes: plan.device_bytes,
            device_bytes_per_sphere: plan.device_bytes_per_sphere(),
            host_bytes: plan.host_bytes,
            host_peak: plan.host_peak,
            host_bytes_available,
            adapter: AdapterReport::of(headless.adapter_info()),
            limits: LimitsReport {
                max_storage_buffer_binding_size: limits.max_storage_buffer_binding_size,
                max_buffer_size: limits.max_buffer_size,
                max_texture_dimension_2d: limits.max_texture_dimension_2d,
            },
            structure: StructureReport {
                name: plan.structure().name(),
                reason: plan.reason().to_owned(),
                bricks: plan.brick_count(),
            },
            fits: problem.is_none(),
            problem,
        }
    }

    fn readable(&self) -> String {
        let Self { scene, structure, picture, limits, .. } = self;
        let mut text = format!("spheres: {}\n", scene.spheres);
        if scene.cones > 0 {
            text += &format!("cones and cylinders: {}\n", scene.cones);
        }
        if let (Some(min), Some(max)) = (scene.min, scene.max) {
            text += &format!("bounds: {min:?} to {max:?}\n");
            let SceneReport { radius_min, radius_mean, radius_max, .. } = scene;
            if scene.spheres > 0 {
                text += &format!("radii: {radius_min} to {radius_max}, mean {radius_mean}\n");
            }
        }
        let StructureReport { name, reason, bricks } = structure;
        text += &format!("structure: {name} ({reason}); bricks: {bricks}\n");
        let PictureReport { width, height, tile_width, tile_height, tiles, .. } = picture;
        text += &format!(
            "picture: {width}x{height}; tiles: {tiles} of at most {tile_width}x{tile_height}\n\
             submissions: at least {}; their size adapts to 60 ms each\n\nbuffers, at most\n",
            picture.submissions_at_least
        );
        let rows: Vec<_> = self.buffers.iter().map(BufferReport::row).collect();
        text += &table(["name", "bytes", "bytes per binding", "bindings"], &rows);
        let per_sphere =
            self.device_bytes_per_sphere.map_or_else(String::new, |bytes| format!("; {bytes:.1} bytes per sphere"));
        text += &format!("\ndevice: {}{per_sphere}\n", in_words(self.device_bytes));
        let available = self.host_bytes_available.map_or("not known".to_owned(), in_words);
        text += &format!(
            "host: {} for {}, in addition to the scene; free: {available}\n",
            in_words(self.host_bytes),
            self.host_peak
        );
        text += &format!("adapter: {}\n", self.adapter.line());
        text += &format!(
            "limits: max_storage_buffer_binding_size {}, max_buffer_size {}, \
             max_texture_dimension_2d {}\n",
            limits.max_storage_buffer_binding_size, limits.max_buffer_size, limits.max_texture_dimension_2d
        );
        text += if self.fits { "fits\n" } else { "does not fit\n" };
        text
    }
}

impl BufferReport {
    fn of(planned: &PlannedBuffer) -> Self {
        let PlannedBuffer { name, bytes, bytes_per_binding } = *planned;
        Self { name, bytes, bytes_per_binding, bindings: bytes / bytes_per_binding.max(1) }
    }

    fn row(&self) -> [String; 4] {
        let Self { name, bytes, bytes_per_binding, bindings } = self;
        [(*name).to_owned(), bytes.to_string(), bytes_per_binding.to_string(), bindings.to_string()]
    }
}

/// Formats a number of bytes, exactly and in MiB or GiB.
fn in_words(bytes: u64) -> String {
    format!("{bytes} bytes ({})", memory::readable(bytes))
}
