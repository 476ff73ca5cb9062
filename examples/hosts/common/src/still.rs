//! The picture of a host as a device of pinhole's own renders it.
#![allow(clippy::print_stdout, reason = "a host tells what it wrote")]

use pinhole::gpu::{Headless, HeadlessOptions, Wait};
use pinhole::{Encoding, LayerSet, RenderSettings, Scene, View};
use pinhole_figure::write;

use crate::Outcome;

/// Renders a view without the host and writes it to `pinhole-host-NAME.png` in the current folder. It waits for the
/// device, which nothing else in these hosts does.
pub fn save_still(
    name: &str,
    scene: &Scene,
    view: &View<'_>,
    settings: &RenderSettings,
) -> Outcome<()> {
    let headless = Headless::open(&HeadlessOptions::default()).wait()?;
    let image = headless.render(scene, view, settings, LayerSet::COLOR).wait()?;
    let path = format!("pinhole-host-{name}.png");
    std::fs::write(&path, write::png::encode(&image, &Encoding::default())?)?;
    println!("wrote {path}");
    Ok(())
}
