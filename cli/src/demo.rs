//! `pinhole demo`: writes an example scene file and renders it.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, anyhow};

use super::args::DemoArgs;
use super::device::Device;
use super::failure::Failure;
use super::input::Source;
use super::picture::Outputs;
use super::render::render;
use super::speak::tell;
use super::threads;
use pinhole::image::LayerSet;

const SCENE: &str = include_str!("../../examples/demo.toml");
const SCENE_FILE: &str = "demo.toml";
const PICTURE_FILE: &str = "demo.png";

pub(super) fn run(args: &DemoArgs) -> Result<(), Failure> {
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
    outputs.write(&image, &input.encoding, None, (!is_there).then_some((&scene_file, SCENE)))?;
    tell(format_args!(
        "wrote {SCENE_FILE} and {PICTURE_FILE} in {:.1} s; change the scene and run \
         `pinhole render {SCENE_FILE} -o {PICTURE_FILE}`",
        started.elapsed().as_secs_f64()
    ));
    Ok(())
}

/// Whether the demo's scene file exists already. A file that the user has changed is refused, never overwritten.
fn is_there(scene_file: &Path) -> Result<bool, Failure> {
    match std::fs::read(scene_file) {
        Ok(found) if found == SCENE.as_bytes() => Ok(true),
        Ok(_) => Err(Failure::usage(format!(
            "{SCENE_FILE}: this file exists and differs from the demo's; \
             rename it, or render it with `pinhole render {SCENE_FILE} -o {PICTURE_FILE}`"
        ))),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(anyhow!(error)).context(format!("{SCENE_FILE}: cannot be read"))?,
    }
}
