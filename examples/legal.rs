//! A test for your own test suite: checks that the adapter of this machine renders a scene as a conforming device may.
//!
//! ```sh
//! cargo run --example legal
//! ```
//!
//! To test an adapter of your choice, use `Headless::from_adapter`.

use pinhole::camera::PinholeCamera;
use pinhole::generate::Kind;
use pinhole::gpu::{Headless, HeadlessOptions, Wait};
use pinhole::{Film, LinearRgb, RenderSettings, Scene, View};

/// In a test suite, mark this function with `#[test]`.
pub(crate) fn this_adapter_renders_legally() -> Result<(), Box<dyn std::error::Error>> {
    let headless = Headless::open(&HeadlessOptions::default()).wait()?;
    let scene = Scene::from_f32(Kind::Clusters.spheres(20_000, 1)?, LinearRgb::WHITE)?;
    let film = Film::new(512, 512)?;
    let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect())?;
    let view = View::new(&camera, film);
    let certificate = headless.verify(&scene, &view, &RenderSettings::default()).wait()?;
    assert!(certificate.is_legal(), "{certificate}");
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    this_adapter_renders_legally()
}
