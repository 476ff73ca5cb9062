//! What a device did with paths, dispatch by dispatch, and the numbers that it was given.

use crate::camera::film::Film;
use crate::render::RenderSettings;
use crate::verify::recording::{RequestedCamera, UploadedView};

/// Paths of a rectangle of a film as a device followed them. Beside the scene, this is all that the checker needs.
#[derive(Clone, Debug, PartialEq)]
pub struct PathRecording {
    /// The camera that was asked for.
    pub camera: RequestedCamera,
    /// What was made of it for the device.
    pub uploaded: UploadedView,
    /// The picture's size.
    pub film: Film,
    /// The rectangle's first column and row.
    pub origin: [u32; 2],
    /// Its width and height, in pixels.
    pub size: [u32; 2],
    /// How light was to be followed.
    pub settings: RenderSettings,
    /// How many surfaces a path meets at most.
    pub max_depth: u32,
    /// What was made of the settings for the device.
    pub lighting: UploadedLighting,
    /// The bits of lights, emitters, materials and energies, each at its own place.
    pub tables: Vec<[u32; 4]>,
    /// The sky's image, if it has one.
    pub sky: Option<UploadedSky>,
    /// The samples, one after the other.
    pub samples: Vec<RecordedSample>,
}

/// One sample of every pixel of the rectangle; lists are row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedSample {
    /// Which of a pixel's samples.
    pub sample: u32,
    /// The paths as the camera starts them.
    pub start: Vec<PathState>,
    /// The surfaces that they met, one after the other.
    pub surfaces: Vec<RecordedSurface>,
    /// The bits of what the sample adds to each pixel: colour and opacity; the first surface's colour and the
    /// luminance's square.
    pub sums: Vec<[[u32; 4]; 2]>,
}

/// What became of every path at one surface.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedSurface {
    /// What the rays met: the bits of the distance, the id, the sphere's place, and the bits of how far the ray went
    /// before it entered the scene's box.
    pub hits: Vec<[u32; 4]>,
    /// The paths after they were scattered.
    pub scattered: Vec<PathState>,
    /// Of each, the bits of whether nothing is between it and the light that it looks for.
    pub open: Vec<u32>,
}

/// A path between two dispatches, as bits: the slots of `shaders/path/state.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathState {
    /// Slot by slot.
    pub slots: [[u32; 4]; Self::SLOTS],
}

impl PathState {
    /// How many slots there are.
    pub const SLOTS: usize = 9;

    /// The slot of the light that is looked for, whose last number says whether nothing is in between.
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

    /// What the path leaves.
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

/// What a path leaves: `shaders/path/departure.wgsl`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Departure {
    /// The sphere; [`NO_ID`](crate::image::NO_ID) for none.
    pub(super) id: u32,
    /// Where the device has it.
    pub(super) shape_index: u32,
    /// How far its far side is, where the path goes inside; else 0.
    pub(super) exit_distance: f32,
    /// Which emitter is looked for, or [`NO_EMITTER`].
    pub(super) emitter: u32,
}

/// For [`Departure::emitter`].
pub(super) const NO_EMITTER: u32 = u32::MAX;

/// The slots that paths use.
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

/// Flags of a path, and of a lighting.
pub(super) mod flag {
    pub(in crate::verify) use crate::light::codes::lighting::{GROUND, SKY_SEEN, TRANSPARENT};
    pub(in crate::verify) use crate::light::codes::path::{
        ALIVE, FULL, INSIDE, ON_GROUND, SCATTERED,
    };
}

/// What of settings the kernels of paths are given: `LightingParameters` in `shaders/scene/lighting_records.wgsl`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UploadedLighting {
    /// What is seen where there is nothing.
    pub background: [f32; 3],
    /// Sums of the `LIGHTING_` constants.
    pub flags: u32,
    /// How many lights the tables have.
    pub light_count: u32,
    /// Radiance straight up.
    pub zenith: [f32; 3],
    /// Radiance of what is level.
    pub horizon: [f32; 3],
    /// Radiance straight down.
    pub nadir: [f32; 3],
    /// From which surface on paths end by chance.
    pub roulette_from: u32,
    /// How many sources of direct light there are to choose from.
    pub source_count: u32,
    /// 0 by chance, 1 directly, 2 both.
    pub light_sampling: u32,
    /// Which way is above the ground.
    pub ground_normal: [f32; 3],
    /// A point of the ground, in the scene's frame.
    pub ground_point: [f32; 3],
    /// The ground's colour.
    pub ground_color: [f32; 3],
    /// Of the noise.
    pub seed: u32,
    /// Where emitters start in the tables.
    pub emitter_first: u32,
    /// How many of them there are.
    pub emitter_count: u32,
    /// Where materials start in the tables.
    pub material_first: u32,
    /// Columns and rows of the sky's image.
    pub environment_size: [u32; 2],
    /// Cosine and sine of the angle by which it is turned.
    pub environment_rotation: [f32; 2],
    /// What it is multiplied by.
    pub environment_strength: f32,
    /// How many of the sources are lights that are no spheres of the scene.
    pub lamp_sources: u32,
    /// Offsets of samples, for each 256th of the distribution.
    pub filter_table: Vec<f32>,
}

/// A sky's image as kernels read it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UploadedSky {
    /// Radiance, row by row.
    pub texels: Vec<[f32; 3]>,
    /// What samples are chosen by: rows, and the columns of each row.
    pub shares: Vec<f32>,
}
