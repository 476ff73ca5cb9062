//! Ray traces spheres with WGSL compute shaders, without a display, and checks whether each pixel is one that a
//! conforming device may have made.
//!
//! | I want to … | start here |
//! |---|---|
//! | render a file of atoms or points | the package `pinhole-data`, [below](#render-a-file) |
//! | render arrays that I have in memory | [`Scene::from_f32`], [below](#render-from-arrays) |
//! | have light, shadows and soft edges | [`RenderSettings::studio`], [`RenderSettings::path`], [below](#light-it) |
//! | colour spheres by numbers, with a legend, or read a scene file | the package `pinhole-figure` |
//! | draw spheres inside the frame of my wgpu program | [`gpu::Renderer`], [below](#embed-it) |
//! | know whether a GPU and its driver compute what they should | [`gpu::Headless::verify`], [below](#verify-it) |
//! | render without any driver | [`cpu::render`], the reference: the same pictures but for rounding, slowly; with a [`cpu::SearchStructure`], not so slowly |
//!
//! A picture needs three things. A [`Scene`] holds spheres that have been checked. A [`View`] joins a camera, which
//! says which ray belongs to a location in the picture, with a [`Film`], which is the picture's size.
//! [`RenderSettings`] say how rays become colours: from the surface that they hit first, by the lights of a studio, or
//! by path tracing.
//!
//! # Render a file
//! ```no_run
//! # #[cfg(feature = "gpu")] {
//! use pinhole::camera::PinholeCamera;
//! use pinhole::gpu::{Headless, HeadlessOptions, Wait};
//! use pinhole::{Encoding, Film, LayerSet, LinearRgb, RenderSettings, View};
//! use pinhole_data::load;
//! use pinhole_figure::write;
//!
//! let loaded = load::open("4hhb.pdb", &load::Options::default())?;
//! let scene = loaded.scene(LinearRgb::WHITE)?; // white where the file gives no colours
//! let film = Film::new(800, 600)?;
//! let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect())?;
//! let headless = Headless::open(&HeadlessOptions::default()).wait()?;
//! let view = View::new(&camera, film);
//! let image = headless.render(&scene, &view, &RenderSettings::studio(), LayerSet::COLOR).wait()?;
//! std::fs::write("4hhb.png", write::png::encode(&image, &Encoding::default())?)?;
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Render from arrays
//! ```
//! use pinhole::camera::{PinholeCamera, Pose};
//! use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, View, cpu};
//!
//! let spheres = vec![[0.0, 0.0, 0.0, 1.0], [1.5, 0.0, 0.0, 0.5]]; // x, y, z, radius
//! let scene = Scene::from_f32(spheres, LinearRgb::from_srgb8([255, 0, 0]))?;
//! let film = Film::new(64, 48)?;
//! let pose = Pose::looking_at([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
//! let camera = PinholeCamera::with_vertical_fov(pose, 0.5, film.aspect())?;
//! let view = View::new(&camera, film);
//! let image = cpu::render(&scene, &view, &RenderSettings::default(), LayerSet::DATA)?;
//! assert_eq!(image.id().unwrap()[24 * 64 + 32], 0);
//! assert!((image.depth().unwrap()[24 * 64 + 32] - 4.0).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! [`Appearance`] gives each sphere a colour, or a number that a [`ColorMap`] turns into one.
//!
//! # Light it
//! ```
//! # use pinhole::camera::PinholeCamera;
//! # use pinhole::{Film, LayerSet, LinearRgb, Scene, View, cpu};
//! use pinhole::RenderSettings;
//! use pinhole::render::Sampling;
//!
//! # let scene = Scene::from_f32(vec![[0.0, 0.0, 0.0, 1.0]], LinearRgb::WHITE)?;
//! # let film = Film::new(16, 12)?;
//! # let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect())?;
//! # let view = View::new(&camera, film);
//! let sampling = Sampling { samples: 4, ..Sampling::default() }; // rays for each pixel
//! let studio = RenderSettings { sampling: sampling.clone(), ..RenderSettings::studio() };
//! let path = RenderSettings { sampling, ..RenderSettings::path() };
//! for settings in [studio, path] {
//!     let image = cpu::render(&scene, &view, &settings, LayerSet::COLOR)?;
//!     assert_eq!(image.color().len(), 16 * 12);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Embed it
//! The host keeps its device, queue, encoder and textures; pinhole records and never submits. `examples/embed.rs` is a
//! whole program.
//! ```no_run
//! # #[cfg(feature = "gpu")]
//! # fn frame(device: &pinhole::gpu::wgpu::Device, queue: &pinhole::gpu::wgpu::Queue, target: &pinhole::gpu::wgpu::TextureView,
//! #     encoder: &mut pinhole::gpu::wgpu::CommandEncoder, scene: &pinhole::Scene, view: &pinhole::View<'_>,
//! # ) -> Result<(), Box<dyn std::error::Error>> {
//! use pinhole::RenderSettings;
//! use pinhole::gpu::{Frame, Renderer, RendererOptions, SceneBuffers, Targets, Wait};
//!
//! let renderer = Renderer::new(device, &RendererOptions::default()).wait()?; // once for each device
//! let buffers = SceneBuffers::new(&renderer, device, queue, scene).wait()?; // once for each scene
//! let mut frame = Frame::new(&renderer, device, &Targets { color: target, data: None }).wait()?;
//! frame.set_view(queue, &buffers, view, &RenderSettings::default())?; // when the camera moves
//! renderer.record(encoder, &buffers, &frame)?; // in every frame
//! # Ok(())
//! # }
//! ```
//!
//! # Verify it
//! ```no_run
//! # #[cfg(feature = "gpu")]
//! # fn verify(scene: &pinhole::Scene, view: &pinhole::View<'_>) -> Result<(), Box<dyn std::error::Error>> {
//! use pinhole::RenderSettings;
//! use pinhole::gpu::{Headless, HeadlessOptions, Wait};
//!
//! let headless = Headless::open(&HeadlessOptions::default()).wait()?;
//! let certificate = headless.verify(scene, view, &RenderSettings::default()).wait()?;
//! assert!(certificate.is_legal(), "{certificate}");
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//! `gpu` (default) is the compute-shader renderer. `run-file` stores what a device rendered. To embed only the renderer, use
//! `default-features = false, features = ["gpu"]`.
//!
//! The package `pinhole-data` reads files of spheres, finds and selects by their columns, and adds bonds and cells.
//! `pinhole-figure` reads scene files, turns columns into colours, draws legends, scale bars and labels, and writes
//! pictures. The command-line program is `pinhole-cli`.
//!
//! # Stability
//! A version that breaks nothing may add fields to settings and options, such as [`RenderSettings`]: write
//! `..RenderSettings::default()` after those that you set. Enums and results to which it may add are `#[non_exhaustive]`.
//! What is hidden from this documentation may change in any version.
//!
//! # Units
//! World space is right-handed, lengths are in scene units, and angles are in radians. Colours are linear light. Depth
//! is measured along the ray. `CONTRIBUTING.md` lists all conventions.
#![cfg_attr(not(feature = "gpu"), allow(rustdoc::broken_intra_doc_links, reason = "gpu is off"))]

// Test scenes that are shared with `tests` refer to this crate by its name.
#[cfg(test)]
extern crate self as pinhole;

pub use glam;

pub mod accel;
pub mod camera;
pub mod cpu;
mod exact;
pub mod generate;
pub mod geometry;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod image;
#[doc(hidden)]
pub mod internals;
pub mod light;
mod parallel;
pub mod range;
mod recording;
pub mod render;
pub mod scene;
mod smooth;
mod text;
pub mod verify;

pub use camera::View;
pub use camera::film::Film;
pub use camera::filter::PixelFilter;
pub use image::color::LinearRgb;
pub use image::encoding::Encoding;
pub use image::tone::ToneCurve;
pub use image::{Image, LayerSet};
pub use light::environment::Environment;
pub use render::{Integrator, RenderSettings, Shading};
pub use scene::material::{Material, SurfaceProperties};
pub use scene::sphere::Sphere;
pub use scene::sphere_array::{Radii, SphereArray};
pub use scene::{Appearance, ColorMap, Colors, Scene};

/// Compiles the examples of the README and of `docs`.
#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../README.md")]
    struct Readme;
    #[cfg(feature = "gpu")]
    #[doc = include_str!("../docs/how-to/verify.md")]
    struct Verify;
    #[doc = include_str!("../docs/how-to/color-and-legends.md")]
    struct Color;
}
