//! Run files: a recording with its scene, to be judged again on any machine, with or without a GPU.
//!
//! A run file is in the format `safetensors`, which Python reads with `safetensors.numpy.load_file`. Its arrays,
//! with H rows of W pixels, n spheres and m colours:
//!
//! | array | type, shape | |
//! |---|---|---|
//! | `camera` | f64 (5, 3) | origin, right, up, forward and numbers of [`CameraVectors`](crate::camera::CameraVectors) |
//! | `scene_origin` | f64 (3,) | of the scene's frame in the world |
//! | `spheres` | f32 (n, 4) | centre in the frame, and radius |
//! | `palette` | f32 (m, 3) | linear colours, also those of a colour map |
//! | `color_index` | u32 (n,) | places in the palette; absent if all spheres have the first colour |
//! | `color_rgba8` | u8 (n, 4) | in their place, if spheres have colours of their own: sRGB, and alpha |
//! | `background` | f32 (3,) | linear colour |
//! | `view` | f32 (7, 3) | origin, right, up, forward, numbers, `scene_min`, `scene_max` of [`UploadedView`](super::UploadedView) |
//! | `advance` | f32 (1,) | of the same |
//! | `traced` | bool (H, W) | whether there is a ray; if not, its numbers are zero |
//! | `ray_origin`, `ray_direction` | f32 (H, W, 3) | of [`TracedRay`](super::TracedRay) |
//! | `ray_distance` | f32 (H, W) | of the same |
//! | `hit_t` | f32 (H, W) | of [`TracedPixel`](super::TracedPixel) |
//! | `hit_id` | u32 (H, W) | of the same |
//! | `color`, `normal` | f32 (H, W, 3) | layers of the picture |
//! | `depth`, `id` | f32, u32 (H, W) | layers of the picture |
//! | `rendered_color`, `rendered_normal`, `rendered_depth`, `rendered_id` | as those | layers of the picture without a recording, if that is another |
//!
//! Its metadata are texts: `pinhole_run`, the format's version, [`VERSION`]; `sha256`, of the whole file, with the
//! digest's own 64 digits taken as zeros; `scene_sha256`, of the array `spheres`; `camera`, `y_axis`, `shading`;
//! `rendered`, which is `same` or `other` if the view was also rendered without a recording;
//! and the fields of [`Provenance`], with `limit_` before names of limits. The same run is the same file, to the
//! byte.
//!
//! What the host decides is checked as scenes, films and cameras check it. What the device answered is kept as it
//! is, whatever it is, because that is what the checker judges.

mod container;
mod numbers;
mod read;
mod write;

use std::collections::BTreeMap;

use sha2::{Digest, Sha256};

use super::recording::Recording;
use crate::scene::Scene;
use container::sink_into;
use numbers::Array;

pub use read::read;
pub use write::write;

/// The version of the format that this crate writes, and the only one that it reads.
pub const VERSION: &str = "2";

/// What a run file holds.
#[derive(Clone, Debug)]
pub struct Run {
    /// Bounds apart, the very scene that was rendered.
    pub scene: Scene,
    /// What the device was given, and what it made of it.
    pub recording: Recording,
    /// Where it comes from.
    pub provenance: Provenance,
}

/// Where a recording comes from, for people. Nothing of it is judged.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Provenance {
    /// Of this crate.
    pub version: String,
    /// The command line.
    pub command: String,
    /// The adapter's name.
    pub adapter: String,
    /// Such as `Vulkan`.
    pub backend: String,
    /// Such as `DiscreteGpu`.
    pub device_type: String,
    /// The driver's name.
    pub driver: String,
    /// The driver's version, in its own words.
    pub driver_info: String,
    /// What found the spheres of a ray.
    pub structure: String,
    /// Limits of the device that bear on the picture, in bytes or pixels.
    pub limits: BTreeMap<String, u64>,
}

impl Provenance {
    /// Every text with its key.
    fn texts(&self) -> [(&'static str, &String); 8] {
        [
            ("version", &self.version),
            ("command", &self.command),
            ("adapter", &self.adapter),
            ("backend", &self.backend),
            ("device_type", &self.device_type),
            ("driver", &self.driver),
            ("driver_info", &self.driver_info),
            ("structure", &self.structure),
        ]
    }
}

/// Stands before the name of a limit.
const LIMIT: &str = "limit_";

/// Why bytes are no run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RunFileError {
    /// Something else.
    #[error("this is no run file; `pinhole verify --save` writes one")]
    NotRun,
    /// The end is missing.
    #[error("the run file is cut off: it has {found} bytes of {expected}; copy it again")]
    Truncated {
        /// Bytes that there are.
        found: u64,
        /// Bytes that there should be.
        expected: u64,
    },
    /// A format of another time.
    #[error(
        "this is a run file of version {found}, and this program reads version {VERSION}; use the program that wrote it"
    )]
    Version {
        /// What the file says.
        found: String,
    },
    /// Not what was written.
    #[error("the run file was altered after it was written: its SHA-256 is another; copy it again")]
    Altered,
    /// Unaltered, and yet no run.
    #[error("the run file contradicts itself: {message}")]
    Contents {
        /// What, and where.
        message: String,
    },
    /// It does not fit into memory.
    #[error("there is no memory for the run's {name}, which need {bytes} bytes")]
    Memory {
        /// Which array.
        name: String,
        /// Its bytes.
        bytes: u64,
    },
}

/// SHA-256 of the spheres of a scene, as four little-endian f32 each, in hexadecimal.
#[must_use]
pub fn scene_sha256(scene: &Scene) -> String {
    let mut digest = Sha256::new();
    // Nothing that a digest is fed with fails.
    let _ = Array::spheres(scene).emit(&mut sink_into(&mut digest));
    hex(digest)
}

fn hex(digest: Sha256) -> String {
    data_encoding::HEXLOWER.encode(&digest.finalize())
}
