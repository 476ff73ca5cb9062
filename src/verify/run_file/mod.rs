//! Run files: a recording with its scene, which can be judged again on any machine, with or without a GPU. They hold no
//! light: pictures with light are judged from their own files ([`finished`](super::finished)).
//!
//! A run file has the format `safetensors`, which Python reads with `safetensors.numpy.load_file`. With H rows of W
//! pixels, n spheres, c cones and cylinders, and m colours, its arrays are:
//!
//! | array | type, shape | |
//! |---|---|---|
//! | `camera` | f64 (5, 3) | origin, right, up, forward and numbers of [`CameraVectors`](crate::camera::CameraVectors) |
//! | `scene_origin` | f64 (3,) | origin of the scene's frame in world space |
//! | `spheres` | f32 (n, 4) | centre in the frame, and radius |
//! | `cones` | f32 (c, 8) | start, first radius, end and second radius of [`ConeInFrame`](crate::scene::ConeInFrame); absent without cones |
//! | `palette` | f32 (m, 3) | linear colours of the palette or of the colour map |
//! | `color_index` | u32 (n + c,) | indices into the palette, of spheres and then of cones; absent if all have the first colour |
//! | `color_rgba8` | u8 (n + c, 4) | instead of both, if every shape has its own colour: sRGB, and alpha |
//! | `background` | f32 (3,) | linear colour |
//! | `view` | f32 (7, 3) | origin, right, up, forward, numbers, `scene_min`, `scene_max` of [`UploadedView`](super::UploadedView) |
//! | `advance` | f32 (1,) | `advance` of the same |
//! | `traced` | bool (H, W) | whether a ray was traced; if not, its numbers are zero |
//! | `ray_origin`, `ray_direction` | f32 (H, W, 3) | `origin` and `direction` of [`TracedRay`](super::TracedRay) |
//! | `ray_distance` | f32 (H, W) | `distance` of the same |
//! | `shaded` | bool (H, W) | whether the ray is known with which a hit was shaded; if not, its numbers are zero |
//! | `shading_origin`, `shading_direction`, `shading_distance` | like those of `ray` | `shading_ray` of [`TracedPixel`](super::TracedPixel) |
//! | `hit_t` | f32 (H, W) | `t` of [`TracedPixel`](super::TracedPixel) |
//! | `hit_id` | u32 (H, W) | `id` of the same |
//! | `color`, `normal` | f32 (H, W, 3) | layers of the picture |
//! | `depth`, `id` | f32, u32 (H, W) | layers of the picture |
//! | `rendered_color`, `rendered_normal`, `rendered_depth`, `rendered_id` | like those | layers of the picture rendered without recording, if it differs |
//! | `surfaces` | f32 (k, 5) | surface properties: material (0 Lambert, 1 conductor, 2 dielectric, 3 emissive), three parameters, and opacity; absent if they are the default |
//! | `surface_index` | u32 (n + c,) | indices into them; absent if all have the first |
//!
//! The metadata are texts: `pinhole_run`, the version of the format, [`VERSION`]; `sha256`, the digest of the
//! whole file, computed with zeros in place of its own 64 digits; `scene_sha256`, the digest of the arrays
//! `spheres` and `cones`; `camera`, `y_axis` and `shading`; `rendered`, which is `same` or `other` if the view was also
//! rendered without recording; and the fields of [`Provenance`], with the prefix `limit_` for limits. The same run
//! gives the same file, to the byte.
//!
//! Input from the host is validated like scenes, films and cameras. The results of the device are kept as they are,
//! even if they are wrong, because the checker judges them. Digests are no signatures: whoever writes a file can write
//! any adapter, driver and command, so these are hearsay.

mod container;
mod error;
mod read;
mod write;

use std::collections::BTreeMap;

use sha2::{Digest, Sha256};

use crate::recording::Recording;
use crate::scene::Scene;
use container::{Array, sink_into};
pub(super) use error::hex;

pub use error::{RunFileError, VERSION};
pub use read::{read, read_from};
pub use write::write;

/// The contents of a run file.
#[derive(Clone, Debug)]
pub struct Run {
    /// The scene that was rendered. Only its bounds may differ.
    pub scene: Scene,
    /// The recording: the inputs of the device, and its results.
    pub recording: Recording,
    /// The origin of the recording.
    pub provenance: Provenance,
}

/// The origin of a recording, for human readers. It does not affect the verdict, and is hearsay in a file from others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Provenance {
    /// Version of this crate.
    pub version: String,
    /// The command line that made the recording.
    pub command: String,
    /// Name of the adapter.
    pub adapter: String,
    /// Backend, such as `Vulkan`.
    pub backend: String,
    /// Type of the device, such as `DiscreteGpu`.
    pub device_type: String,
    /// Name of the driver.
    pub driver: String,
    /// Version of the driver, as it describes itself.
    pub driver_info: String,
    /// The acceleration structure.
    pub structure: String,
    /// Limits of the device that affect the picture, in bytes or pixels.
    pub limits: BTreeMap<String, u64>,
}

impl Provenance {
    /// Every text field with its key.
    fn texts(&mut self) -> [(&'static str, &mut String); 8] {
        [
            ("version", &mut self.version),
            ("command", &mut self.command),
            ("adapter", &mut self.adapter),
            ("backend", &mut self.backend),
            ("device_type", &mut self.device_type),
            ("driver", &mut self.driver),
            ("driver_info", &mut self.driver_info),
            ("structure", &mut self.structure),
        ]
    }
}

/// The prefix of the metadata keys of limits.
const LIMIT: &str = "limit_";

/// The SHA-256 digest of the spheres of a scene, each as four little-endian f32, and of its cones, each as eight, in
/// hexadecimal.
#[must_use]
pub fn scene_sha256(scene: &Scene) -> String {
    let mut digest = Sha256::new();
    // Writing to a digest cannot fail.
    let _ = Array::shapes(scene).try_for_each(|array| array.emit(&mut sink_into(&mut digest)));
    hex(digest)
}
