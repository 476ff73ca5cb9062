//! `pinhole info`: lists the adapters of the machine and tests one of them, or describes a file.

#[cfg(feature = "gpu")]
use std::path::PathBuf;

use clap::Args;
use serde::{Serialize, Serializer};

use crate::commands::file_info::{self, FileArgs};
#[cfg(feature = "gpu")]
use crate::proof::self_test::{SelfTestResults, dump};
use crate::render::device::AdapterReport;
#[cfg(feature = "gpu")]
use crate::render::device::WantedAdapter;
use crate::terminal::failure::Failure;
use crate::terminal::progress::answer;
use crate::terminal::text;

pub(crate) const HELP: &str = "The self-test runs computations on the adapter and checks the properties that the error \
    bounds of `verify` rely on. Exit codes: 0 done; 1 the file cannot be read, or there is no adapter, or it cannot \
    compute; 2 wrong usage; 3 it computes, but a property fails.\n\n\
    JSON: `version`, `adapters` (name, backend, device_type, driver, driver_info, chosen, limits, features), \
    `problem`; with --self-test also `self_test` (adapter, passed, properties), whose properties have name, passed, \
    outcome (ok, note, FAILED), words, figures.\n\n\
    JSON of a file: `version`, `file`, `bytes`, `kind` (data, scene or bricks), `spheres`, `min`, `max`, `radius_min`, \
    `radius_max`, `notes`. Of data also `format`, `compressed`, `frames`, `frame`, `problem`, `colors`, `opacities`, \
    `cell`, `cell_origin`, `columns` (name, kind; of numbers min, max, nan; of text different, first). Of a scene also `width`, \
    `height`, `camera`, `stereo`, `integrator`, `samples`, `lights`, `files`. Of bricks also `source`, \
    `bricks`, `largest_brick_spheres`, `largest_brick_bytes`, `outer_spheres`, `colors`, and no `notes`. New versions may add keys, but do not \
    change these.";

#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    pub(crate) file: FileArgs,
    /// Test whether an adapter computes as precisely as the error bounds of `verify` assume
    #[cfg(feature = "gpu")]
    #[arg(long)]
    pub(crate) self_test: bool,
    /// Test the adapter whose name contains this text [default: the adapter that `render` would use]
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Write every shader as a device is given it, one WGSL file for each kernel, into this folder; it is created if it is
    /// missing. Needs no adapter
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "DIR", conflicts_with_all = ["self_test", "adapter", "json"])]
    pub(crate) dump_shaders: Option<PathBuf>,
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// The report on this program and the machine.
#[derive(Serialize)]
struct Info {
    version: &'static str,
    /// The adapters, best first; `render` uses the one that is `chosen`.
    adapters: Vec<ListedAdapter>,
    /// The reason why no adapter is chosen, with the message of `render`.
    problem: Option<String>,
    #[cfg(feature = "gpu")]
    #[serde(skip_serializing_if = "Option::is_none")]
    self_test: Option<SelfTestResults>,
}

/// An adapter, with the limits that bound the size of pictures and scenes, and the optional features that matter for
/// ray tracing.
#[derive(Serialize)]
struct ListedAdapter {
    #[serde(flatten)]
    adapter: AdapterReport,
    chosen: bool,
    #[serde(serialize_with = "named")]
    limits: [(&'static str, u64); 8],
    #[serde(serialize_with = "named")]
    features: [(&'static str, bool); 4],
}

/// Writes named values as an object.
fn named<S: Serializer, T: Serialize, const N: usize>(
    values: &[(&'static str, T); N],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(values.iter().map(|(name, value)| (name, value)))
}

pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    if let Some(path) = &args.file.path {
        return file_info::run(&args.file, path, args.json);
    }
    #[cfg(feature = "gpu")]
    if let Some(folder) = &args.dump_shaders {
        return dump(folder);
    } else if args.self_test {
        return run_self_test(args);
    } else if args.adapter.is_some() {
        return Err(Failure::usage(
            "--adapter applies only to --self-test; add --self-test, or remove --adapter to list all adapters",
        ));
    }
    print(&info(), args.json)
}

/// Runs the self-test. JSON contains its report and the list of adapters; text contains only the report.
#[cfg(feature = "gpu")]
fn run_self_test(args: &InfoArgs) -> Result<(), Failure> {
    let tested = SelfTestResults::new(&WantedAdapter::named(args.adapter.clone()))?;
    let verdict = tested.verdict();
    if args.json {
        print(&Info { self_test: Some(tested), ..info() }, true)?;
    } else {
        let text = format!("pinhole {VERSION}\n\n{}", tested.readable());
        answer(text.as_bytes())?;
    }
    verdict
}

fn print(info: &Info, json: bool) -> Result<(), Failure> {
    let text = if json { text::json(info)? } else { readable(info) };
    Ok(answer(text.as_bytes())?)
}

const VERSION: &str = env!("CARGO_PKG_VERSION");

#[cfg(feature = "gpu")]
fn info() -> Info {
    use pinhole::gpu::{GpuError, Wait, adapter};

    let adapters = adapter::adapters().wait();
    // `render` makes the same choice, also if WGPU_ADAPTER_NAME asks for another adapter.
    let choice = adapter::index_of_choice(&adapters, None);
    let is_chosen = |index| choice == Ok(index);
    let reports = adapters.iter().enumerate().map(|(index, a)| report(a, is_chosen(index)));
    Info {
        version: VERSION,
        adapters: reports.collect(),
        problem: choice.as_ref().err().map(|error| match error {
            GpuError::NoAdapter => format!("{error}; `render` uses the CPU reference"),
            refused => format!("`render` refuses: {refused}"),
        }),
        self_test: None,
    }
}

#[cfg(feature = "gpu")]
fn report(adapter: &pinhole::gpu::wgpu::Adapter, chosen: bool) -> ListedAdapter {
    use pinhole::gpu::wgpu::Features;

    let limits = adapter.limits();
    let features = adapter.features();
    ListedAdapter {
        adapter: AdapterReport::of(&adapter.get_info()),
        chosen,
        limits: [
            ("max_texture_dimension_2d", limits.max_texture_dimension_2d.into()),
            ("max_buffer_size", limits.max_buffer_size),
            ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size),
            ("max_storage_buffers_per_shader_stage", limits.max_storage_buffers_per_shader_stage.into()),
            ("max_storage_textures_per_shader_stage", limits.max_storage_textures_per_shader_stage.into()),
            ("max_compute_workgroups_per_dimension", limits.max_compute_workgroups_per_dimension.into()),
            ("max_compute_invocations_per_workgroup", limits.max_compute_invocations_per_workgroup.into()),
            ("max_compute_workgroup_storage_size", limits.max_compute_workgroup_storage_size.into()),
        ],
        features: [
            ("timestamp_query", Features::TIMESTAMP_QUERY),
            ("subgroup", Features::SUBGROUP),
            ("shader_f64", Features::SHADER_F64),
            ("ray_query", Features::EXPERIMENTAL_RAY_QUERY),
        ]
        .map(|(name, feature)| (name, features.contains(feature))),
    }
}

#[cfg(not(feature = "gpu"))]
fn info() -> Info {
    let problem = "built without the feature `gpu`; `render` uses the CPU reference";
    Info { version: VERSION, adapters: Vec::new(), problem: Some(problem.to_owned()) }
}

fn readable(info: &Info) -> String {
    let mut text = format!("pinhole {}\n", info.version);
    if let Some(problem) = &info.problem {
        text += &format!("{problem}\n");
    }
    for ListedAdapter { adapter, chosen, limits, features } in &info.adapters {
        let AdapterReport { name, backend, device_type, driver, driver_info } = adapter;
        let mark = if *chosen { ", used by `render`" } else { "" };
        text += &format!("\n{name} ({backend}, {device_type}{mark})\n  driver: {driver} {driver_info}\n  limits\n");
        let mut limits = *limits;
        limits.sort_unstable();
        limits.iter().for_each(|(name, value)| text += &format!("    {name}: {value}\n"));
        text += "  features\n";
        let mut features = *features;
        features.sort_unstable();
        features.iter().for_each(|(name, value)| text += &format!("    {name}: {value}\n"));
    }
    text
}
