//! Recordings of paths: their states dispatch by dispatch, and the numbers that the device was given.

use crate::camera::film::Film;
use crate::render::RenderSettings;
use crate::verify::recording::{RequestedCamera, UploadedView};

/// A recording of the paths of a rectangle of a film. The checker needs only this and the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PathRecording {
    /// The requested camera.
    pub camera: RequestedCamera,
    /// The numbers of the view on the device.
    pub uploaded: UploadedView,
    /// The size of the picture.
    pub film: Film,
    /// First column and row of the rectangle.
    pub origin: [u32; 2],
    /// Width and height of the rectangle in pixels.
    pub size: [u32; 2],
    /// The requested settings.
    pub settings: RenderSettings,
    /// The largest number of surfaces that a path hits.
    pub max_depth: u32,
    /// The parameters of the lighting on the device.
    pub lighting: UploadedLighting,
    /// The tables of lights, materials and energies, as bits.
    pub tables: Vec<[u32; 4]>,
    /// The table of emitters, as bits: three entries for each.
    pub emitters: Vec<[u32; 4]>,
    /// The image of the sky, if it has one.
    pub sky: Option<UploadedSky>,
    /// The samples in the order of their indices.
    pub samples: Vec<RecordedSample>,
}

/// One sample of every pixel of the rectangle. Lists are row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedSample {
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// The state of every path at the camera.
    pub start: Vec<PathState>,
    /// The surfaces of the paths, in the order in which they are hit.
    pub surfaces: Vec<RecordedSurface>,
    /// The contribution of the sample to each pixel, as bits: colour and opacity; the first surface's colour and the
    /// square of the luminance.
    pub sums: Vec<[[u32; 4]; 2]>,
}

/// The results of all paths at one surface.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedSurface {
    /// The hits, as bits: distance, id, index in the structure, and distance from the ray's origin to the scene's box.
    pub hits: Vec<[u32; 4]>,
    /// The state of every path after shading.
    pub scattered: Vec<PathState>,
    /// The visibility of each path's sampled light, as the bits of a number: 0 if it is occluded.
    pub open: Vec<u32>,
}

/// The state of a path between two dispatches, as bits: the slots of `shaders/path/state.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathState {
    /// The slots, in order.
    pub slots: [[u32; 4]; Self::SLOTS],
}

impl PathState {
    /// The number of slots.
    pub const SLOTS: usize = 9;

    /// The slot of the pending light, whose last number is its visibility.
    pub const PENDING: usize = 7;

    pub(super) fn vector(&self, slot: usize) -> [f32; 3] {
        let [x, y, z, _] = self.slots[slot];
        [x, y, z].map(f32::from_bits)
    }

    pub(super) fn number(&self, slot: usize) -> f32 {
        f32::from_bits(self.slots[slot][3])
    }

    pub(super) fn bits(&self, slot: usize) -> u32 {
        self.slots[slot][3]
    }

    /// The surface that the path leaves.
    pub(super) fn departure(&self) -> Departure {
        let [id, shape_index, exit_distance, emitter] = self.slots[slot::DEPARTURE];
        Departure { id, shape_index, exit_distance: f32::from_bits(exit_distance), emitter }
    }

    pub(super) fn flags(&self) -> u32 {
        self.bits(slot::ORIGIN)
    }

    pub(super) fn has(&self, flag: u32) -> bool {
        self.flags() & flag != 0
    }
}

/// The surface that a path leaves: `shaders/path/departure.wgsl`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Departure {
    /// Id of the sphere; [`NO_ID`](crate::image::NO_ID) for none.
    pub(super) id: u32,
    /// Index of the sphere on the device.
    pub(super) shape_index: u32,
    /// Exit distance of the sphere if the path goes inside; else 0.
    pub(super) exit_distance: f32,
    /// Index of the sampled emitter, or [`NO_EMITTER`].
    pub(super) emitter: u32,
}

/// The value of [`Departure::emitter`] without an emitter.
pub(super) const NO_EMITTER: u32 = u32::MAX;

/// The indices of the slots.
pub(super) mod slot {
    pub(in crate::verify) const ORIGIN: usize = 0;
    pub(in crate::verify) const DIRECTION: usize = 1;
    pub(in crate::verify) const DEPARTURE: usize = 2;
    pub(in crate::verify) const THROUGHPUT: usize = 3;
    pub(in crate::verify) const RADIANCE: usize = 4;
    pub(in crate::verify) const FIRST: usize = 5;
    pub(in crate::verify) const SHADOW: usize = 6;
    pub(in crate::verify) const PENDING: usize = super::PathState::PENDING;
    pub(in crate::verify) const MEDIUM: usize = 8;
}

/// Flags of the state of a path, and flags of the lighting.
pub(super) mod flag {
    pub(in crate::verify) use crate::light::codes::lighting::{GROUND, SKY_SEEN, TRANSPARENT};
    pub(in crate::verify) use crate::light::codes::path::{
        ALIVE, FULL, INSIDE, ON_GROUND, SCATTERED,
    };
}

/// The parameters of the lighting on the device: `LightingParameters` in `shaders/scene/lighting_records.wgsl`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UploadedLighting {
    /// Colour where a ray hits nothing.
    pub background: [f32; 3],
    /// Sum of the `LIGHTING_` constants that apply.
    pub flags: u32,
    /// Number of lights in the tables.
    pub light_count: u32,
    /// Radiance of the sky straight up.
    pub zenith: [f32; 3],
    /// Radiance of the sky at the horizon.
    pub horizon: [f32; 3],
    /// Radiance of the sky straight down.
    pub nadir: [f32; 3],
    /// First surface at which paths may end by Russian roulette.
    pub roulette_from: u32,
    /// Number of light sources that can be sampled.
    pub source_count: u32,
    /// Method of light sampling: 0 for scattered rays only, 1 for direct sampling only, 2 for both.
    pub light_sampling: u32,
    /// Unit normal of the ground.
    pub ground_normal: [f32; 3],
    /// A point of the ground, in the scene's frame.
    pub ground_point: [f32; 3],
    /// Colour of the ground.
    pub ground_color: [f32; 3],
    /// Seed of the random numbers.
    pub seed: u32,
    /// Number of emitters.
    pub emitter_count: u32,
    /// Index of the first material in the tables.
    pub material_first: u32,
    /// Columns and rows of the sky's image.
    pub environment_size: [u32; 2],
    /// Cosine and sine of the rotation of the sky's image.
    pub environment_rotation: [f32; 2],
    /// Factor of the radiance of the sky's image.
    pub environment_strength: f32,
    /// Number of light sources that are not spheres of the scene and not the sky.
    pub lamp_sources: u32,
    /// Offsets of samples, for each 256th of the filter's distribution.
    pub filter_table: Vec<f32>,
}

/// The image of a sky, as kernels read it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UploadedSky {
    /// Radiance, row by row.
    pub texels: Vec<[f32; 3]>,
    /// Cumulative tables for sampling: that of the rows, and those of the columns of each row.
    pub shares: Vec<f32>,
}
