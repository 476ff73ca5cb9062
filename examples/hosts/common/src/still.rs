//! The picture of a host, as a separate device of pinhole renders it.
#![allow(clippy::print_stdout, reason = "a host tells what it wrote")]

use pinhole::gpu::{Headless, HeadlessOptions, Wait};
use pinhole::{Encoding, LayerSet, RenderSettings, Scene, View};
use pinhole_figure::write;

use crate::Outcome;

/// Renders a view without the host and writes it to `pinhole-host-NAME.png` in the current folder. Unlike all other
/// code of these hosts, it waits for the device.
pub fn save_still(name: &str, scene: &Scene, view: &View<'_>, settings: &RenderSettings) -> Outcome<()> {
    let headless = Headless::open(&HeadlessOptions::default()).wait()?;
    let image = headless.render(scene, view, settings, LayerSet::COLOR).wait()?;
    let path = format!("pinhole-host-{name}.png");
    std::fs::write(&path, write::png::encode(&image, &Encoding::default())?)?;
    println!("wrote {path}");
    Ok(())
}
