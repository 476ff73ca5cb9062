//! A test for your own suite: does this machine's adapter render a scene as a conforming device may?
//!
//! ```sh
//! cargo run --example legal
//! ```
//!
//! For an adapter of your own choice take `Headless::from_adapter`.

use pinhole::camera::PinholeCamera;
use pinhole::generate::Kind;
use pinhole::gpu::{Headless, HeadlessOptions};
use pinhole::{Film, LinearRgb, RenderSettings, Scene, View};

/// Put `#[test]` here.
pub(crate) fn this_adapter_renders_legally() -> Result<(), Box<dyn std::error::Error>> {
    let headless = Headless::open(&HeadlessOptions::default())?;
    let scene = Scene::from_f32(Kind::Clusters.spheres(20_000, 1)?, LinearRgb::WHITE)?;
    let film = Film::new(512, 512)?;
    let camera = PinholeCamera::framing_from_the_front(&scene.bounds_to_frame(), film.aspect())?;
    let view = View::new(&camera, film);
    let certificate = headless.verify(&scene, &view, &RenderSettings::default())?;
    assert!(certificate.is_legal(), "{certificate}");
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    this_adapter_renders_legally()
}
