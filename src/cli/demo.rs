//! `pinhole demo`: a first scene file and its picture.

use std::path::Path;

use anyhow::Context;

use super::args::DemoArgs;
use super::failure::Failure;
use super::input::{self, Format};
use super::output::{Outputs, write_file};
use super::render::{Device, render};
use crate::image::LayerSet;

const SCENE: &str = include_str!("../../examples/three-spheres.toml");
const SCENE_FILE: &str = "three-spheres.toml";
const PICTURE_FILE: &str = "three-spheres.png";

pub(super) fn run(args: &DemoArgs) -> Result<(), Failure> {
    let device = Device::new(&args.device)?;
    let outputs = Outputs::new(Path::new(PICTURE_FILE), &[])?;
    let scene_path = Path::new(SCENE_FILE);
    // Never over a scene that the user has changed.
    match std::fs::read(scene_path) {
        Ok(found) if found == SCENE.as_bytes() => {}
        Ok(_) => {
            return Err(Failure::usage(format!(
                "{SCENE_FILE}: this file exists and is not the demo's; \
                 rename it, or render it with `pinhole render {SCENE_FILE} -o {PICTURE_FILE}`"
            )));
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            write_file(scene_path, SCENE.as_bytes())?;
        }
        Err(error) => {
            return Err(anyhow::Error::from(error)
                .context(format!("{SCENE_FILE}: cannot be read"))
                .into());
        }
    }
    let input = input::load(scene_path, Format::Scene, None, None)?;
    let image = render(&input, LayerSet::COLOR, &device)?;
    outputs.write(&image).context("the demo's picture")?;
    eprintln!(
        "wrote {SCENE_FILE} and {PICTURE_FILE}; change the scene and run \
         `pinhole render {SCENE_FILE} -o {PICTURE_FILE}`"
    );
    Ok(())
}
