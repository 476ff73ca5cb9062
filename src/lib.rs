//! Ray traces spheres with WGSL compute shaders, without a display, and checks its pictures against a
//! CPU reference.
//!
//! A [`Scene`] holds spheres that have been checked. A [`View`] joins a camera, which answers which ray
//! belongs to a place in the picture, with a [`Film`], which has the picture's size.
//! [`RenderSettings`] say how rays become colours: by what they meet first, by the lights of a studio, or
//! along paths. From these three, [`cpu::render`] makes
//! an [`Image`] in f64, slowly and simply, and the module `gpu` makes the same image with
//! compute shaders: [`gpu::Headless`] on a device of its own, [`gpu::Renderer`] inside the frame of a
//! program that already uses wgpu.
//!
//! ```
//! use pinhole::camera::{PinholeCamera, Pose};
//! use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, View, cpu};
//!
//! let scene = Scene::new(&[Sphere::new([0.0, 0.0, 0.0], 1.0, LinearRgb::from_srgb8([255, 0, 0]))])?;
//! let film = Film::new(64, 48)?;
//! let pose = Pose::looking_at([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
//! let camera = PinholeCamera::with_vertical_fov(pose, 0.5, film.aspect())?;
//! let view = View::new(&camera, film);
//! let image = cpu::render(&scene, &view, &RenderSettings::default(), LayerSet::DATA)?;
//! assert_eq!(image.id().unwrap()[24 * 64 + 32], 0);
//! assert!((image.depth().unwrap()[24 * 64 + 32] - 4.0).abs() < 1e-3);
//! // The same with lights, shadows and soft ambient light; `RenderSettings::path()` follows light along paths.
//! let lit = cpu::render(&scene, &view, &RenderSettings::studio(), LayerSet::COLOR)?;
//! assert_eq!(lit.color().len(), 64 * 48);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//! `gpu` (default) is the compute-shader renderer; `parallel` (default) runs builders, readers of arrays
//! and the CPU reference on all cores; `npy`, `pdb`, `png` and `xyz` (default), `exr`, `hdr` and `scene-file` are readers and
//! writers; `run-file` keeps what a device rendered; `all-formats` is all of these. An embedder wants
//! `default-features = false, features = ["gpu"]`. The program is the package `pinhole-cli`.
//!
//! # Units
//! World space is right-handed, lengths are in scene units, angles in radians. Colours are linear
//! light. Depth is measured along the ray. `CONTRIBUTING.md` has the rest.
#![cfg_attr(not(feature = "gpu"), allow(rustdoc::broken_intra_doc_links, reason = "gpu is off"))]

// Scenes that tests share name this crate from outside.
#[cfg(test)]
extern crate self as pinhole;

pub use glam;

pub mod accel;
pub mod camera;
pub mod cpu;
#[cfg(feature = "scene-file")]
mod exact;
pub mod generate;
pub mod geometry;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod image;
pub mod light;
pub mod load;
mod parallel;
pub mod range;
pub mod render;
pub mod scene;
#[cfg(feature = "scene-file")]
pub mod scene_file;
#[doc(hidden)]
pub mod text;
pub mod verify;
pub mod write;

pub use camera::View;
pub use camera::film::Film;
pub use camera::filter::PixelFilter;
pub use image::color::LinearRgb;
pub use image::encoding::Encoding;
pub use image::tone::ToneCurve;
pub use image::{Image, LayerSet};
pub use light::environment::Environment;
pub use render::{Integrator, RenderSettings, Shading};
pub use scene::material::{Finish, Material};
pub use scene::points::{Points, Radii};
pub use scene::sphere::Sphere;
pub use scene::{Appearance, ColorMap, Colors, Scene};

/// Compiles the example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
