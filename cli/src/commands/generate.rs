//! Generated spheres: `pinhole generate` writes them into a file, and `pinhole demo` writes a scene and its picture.

use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, anyhow};
use clap::Args;
use clap::builder::PossibleValuesParser;
use tempfile::NamedTempFile;

use crate::flags::common::DeviceArgs;
use crate::input::{Source, extension};
use crate::output::files::{check_writable, name_all, unnamed_with};
use crate::output::picture::Outputs;
use crate::render::device::Device;
use crate::render::render;
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, tell};
use crate::terminal::{memory, threads};
use pinhole::generate::{BYTES_PER_SPHERE, Kind, check_count};
use pinhole::image::LayerSet;
use pinhole_data::load::open_regular;
use pinhole_data::write;

#[derive(Debug, Args)]
pub(crate) struct GenerateArgs {
    /// Arrangement of the spheres
    #[arg(value_name = "KIND", value_parser = kinds())]
    pub(crate) kind: String,
    /// Number of spheres
    #[arg(short = 'n', value_name = "N")]
    pub(crate) count: u64,
    /// File for the spheres: a NumPy array (.npy) or raw little-endian f32 (.bin) of x, y, z, radius
    #[arg(short, long, value_name = "OUT.npy")]
    pub(crate) output: PathBuf,
    /// Seed of the random numbers: the same kind, number and seed give the same file on every machine
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(crate) seed: u64,
}

#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Width and height of the picture in pixels, such as 800x600 [default: the scene's]
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<String>,
    #[command(flatten)]
    pub(crate) device: DeviceArgs,
}

pub(crate) fn run(args: &GenerateArgs) -> Result<(), Failure> {
    let Some(kind) = Kind::ALL.iter().copied().find(|kind| kind.name() == args.kind) else {
        return Err(Failure::usage(format!("{}: this is not a valid kind", args.kind)));
    };
    let count = args.count;
    check_count(count).map_err(|error| Failure::usage(format!("-n {count}: {error}")))?;
    let path: &Path = &args.output;
    let write: fn(&[[f32; 4]], &mut NamedTempFile) -> std::io::Result<()> = match extension(path).as_deref() {
        Some("npy") => |spheres, file| write::npy(spheres, file),
        Some("bin") => |spheres, file| write::raw(spheres, file),
        _ => {
            return Err(Failure::usage(format!(
                "{}: spheres are written as .npy or .bin; change the extension",
                path.display()
            )));
        }
    };
    check_writable(path)?;
    let bytes = count * BYTES_PER_SPHERE;
    memory::check_bytes(&format!("-n {count}: {count} spheres need"), bytes, "fewer spheres")?;
    tell(format_args!("{}: {count} spheres, {bytes} bytes", path.display()));
    threads::start()?;
    progress::stage("generating spheres");
    let spheres = kind.spheres(count, args.seed).map_err(|error| Failure::Job(error.into()))?;
    progress::stage("writing");
    let file = unnamed_with(path, |file| write(&spheres, file))?;
    Ok(name_all(vec![(&args.output, file)])?)
}

fn kinds() -> PossibleValuesParser {
    PossibleValuesParser::new(Kind::ALL.iter().map(|kind| kind.name()))
}

const SCENE: &str = include_str!("../../../examples/demo.toml");
const SCENE_FILE: &str = "demo.toml";
const PICTURE_FILE: &str = "demo.png";

pub(crate) fn run_demo(args: &DemoArgs) -> Result<(), Failure> {
    let started = Instant::now();
    let device = Device::new(&args.device, None)?;
    let outputs = Outputs::new(Path::new(PICTURE_FILE), &[])?;
    let scene_file = PathBuf::from(SCENE_FILE);
    let source = Source::of_scene(&scene_file).with_size(args.size.as_deref())?;
    let is_there = is_there(&scene_file)?;
    threads::start()?;
    let input = source.scene_from_text(SCENE)?;
    let opened = device.open()?;
    let image = render(&input, LayerSet::COLOR, &opened)?;
    let text = (!is_there).then(|| (scene_file, SCENE.to_owned()));
    outputs.write(&image, &input.encoding, None, text.as_ref())?;
    tell(format_args!(
        "wrote {SCENE_FILE} and {PICTURE_FILE} in {:.1} s; change the scene and run \
         `pinhole render {SCENE_FILE} -o {PICTURE_FILE}`",
        started.elapsed().as_secs_f64()
    ));
    Ok(())
}

/// Whether the demo's scene file exists already. A file that the user has changed is refused, never overwritten.
fn is_there(scene_file: &Path) -> Result<bool, Failure> {
    let mut found = Vec::new();
    let longest = SCENE.len() as u64 + 1;
    match open_regular(scene_file).and_then(|file| file.take(longest).read_to_end(&mut found)) {
        Ok(_) if found == SCENE.as_bytes() => Ok(true),
        Ok(_) => Err(Failure::usage(format!(
            "{SCENE_FILE}: this file exists and differs from the demo's; \
             rename it, or render it with `pinhole render {SCENE_FILE} -o {PICTURE_FILE}`"
        ))),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(anyhow!(error)).context(format!("{SCENE_FILE}: cannot be read"))?,
    }
}
