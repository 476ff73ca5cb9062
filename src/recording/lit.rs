//! The common parts of recordings of lit pictures: the inputs of the device, and the states of paths.

use super::{RequestedCamera, UploadError, UploadedView, pixel_at};
use crate::camera::film::Film;
use crate::render::RenderSettings;

/// The view and the settings of a lit picture, and the inputs of the device for a rectangle of it.
#[derive(Clone, Debug, PartialEq)]
pub struct LitInputs {
    /// The requested camera.
    pub camera: RequestedCamera,
    /// The numbers of the view on the device.
    pub uploaded: UploadedView,
    /// The corners of the box of the opaque spheres, to which the origins of shadow rays of a studio are moved.
    pub occluders: [[f32; 3]; 2],
    /// The size of the picture.
    pub film: Film,
    /// First column and row of the rectangle.
    pub origin: [u32; 2],
    /// Width and height of the rectangle in pixels.
    pub size: [u32; 2],
    /// The requested settings.
    pub settings: RenderSettings,
    /// Maximum number of surfaces: the surfaces at which a path is scattered, or in a studio the
    /// surfaces that are seen behind each other.
    pub max_surfaces: u32,
    /// The parameters of the lighting on the device.
    pub lighting: UploadedLighting,
    /// The tables of lights, materials and energies, as bits.
    pub tables: Vec<[u32; 4]>,
    /// The table of emitters, as bits: three entries for each.
    pub emitters: Vec<[u32; 4]>,
    /// The image of the sky, if it has one.
    pub sky: Option<UploadedSky>,
}

impl LitInputs {
    /// The pixel of the film with an index in the rectangle.
    pub(crate) fn pixel(&self, index: usize) -> [u32; 2] {
        let [i, j] = pixel_at(index, self.size[0]);
        [self.origin[0] + i, self.origin[1] + j]
    }

    /// First column and row, width and height of the rectangle.
    pub(crate) fn rectangle(&self) -> [u32; 4] {
        let ([x, y], [width, height]) = (self.origin, self.size);
        [x, y, width, height]
    }

    pub(crate) fn is_studio(&self) -> bool {
        self.settings.studio_parameters().is_some()
    }

    /// The number of lists of lights, and of directions of ambient light, at each surface of a studio.
    pub(crate) fn batches(&self) -> [usize; 2] {
        let UploadedLighting { light_count, occlusion_samples, .. } = self.lighting;
        [light_count, occlusion_samples].map(|count| count.div_ceil(BITS) as usize)
    }

    /// The number of pixels in the rectangle.
    pub(crate) fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// A recording of samples of a rectangle of a lit picture, of paths or of rays of a studio. The checker needs only this
/// and the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct LitRecording {
    /// The request, and the inputs of the device.
    pub given: LitInputs,
    /// The samples in the order in which they were taken.
    pub samples: Vec<RecordedSample>,
}

/// One sample of every pixel of the rectangle. Lists are row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedSample {
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// The state of every ray at the camera.
    pub start: Vec<PathState>,
    /// The surfaces in the order in which they are hit, up to the surface at which the last ray ends.
    pub surfaces: Vec<RecordedSurface>,
    /// The sums of the pixels without and with the sample.
    pub film: RecordedFilm,
}

/// The results of all rays at one surface.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedSurface {
    /// The hits, as bits: distance, id, index in the structure, and distance from the ray's origin to the scene's box.
    pub hits: Vec<[u32; 4]>,
    /// The state of every ray after shading; in a studio, once the surface is known.
    pub states: Vec<PathState>,
    /// The visibility of each path's sampled light, as the bits of a number: 0 if it is occluded. Empty in a studio.
    pub open: Vec<u32>,
    /// In a studio, the lights, 32 at a time.
    pub lights: Vec<StudioLight>,
    /// In a studio, the directions of ambient light, 32 at a time.
    pub ambient: Vec<StudioLight>,
}

/// The results of all rays at one surface for up to 32 lights or directions.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StudioLight {
    /// A bit for each light that is hidden.
    pub hidden: Vec<u32>,
    /// Radiance and opacity after the lights that are not hidden were added, as bits.
    pub radiance: Vec<[u32; 4]>,
    /// The bits that are left for the next lights. They should all be 0.
    pub left: Vec<u32>,
}

/// The number of lights, or of directions of ambient light, of a [`StudioLight`].
pub(crate) const BITS: u32 = 32;

impl LitRecording {
    /// Whether every list has an element for each pixel of the rectangle, and every light and direction is in a list.
    pub(crate) fn check_size(&self) -> Result<(), UploadError> {
        let count = self.given.pixels();
        let are_all = |lights: &[StudioLight], batches: usize, pixels: usize| {
            let is_whole = |StudioLight { hidden, radiance, left }: &StudioLight| {
                [hidden.len(), radiance.len(), left.len()] == [pixels; 3]
            };
            lights.len() == batches && lights.iter().all(is_whole)
        };
        let are_whole = self.samples.iter().all(|RecordedSample { start, surfaces, film, .. }| {
            let pixels = start.len();
            let is_whole = |surface: &RecordedSurface| {
                let RecordedSurface { hits, states, open, lights, ambient } = surface;
                let has_light = match self.given.is_studio() {
                    true => {
                        let [of_lights, of_ambient] = self.given.batches();
                        open.is_empty() && are_all(lights, of_lights, pixels) && are_all(ambient, of_ambient, pixels)
                    }
                    false => open.len() == pixels && lights.is_empty() && ambient.is_empty(),
                };
                [hits.len(), states.len()] == [pixels; 2] && has_light
            };
            pixels as u64 == count
                && [film.before.len(), film.after.len()] == [pixels; 2]
                && surfaces.iter().all(is_whole)
        });
        if are_whole {
            return Ok(());
        }
        Err(UploadError(format!(
            "the recording has a list that does not have {count} pixels, the size of its rectangle"
        )))
    }
}

/// The sums of a pixel on the device, as bits: the vectors of `shaders/path/film_sums.wgsl`.
pub type PixelSums = [[u32; 4]; 3];

/// The sums of every pixel before and after a sample was added. Lists are row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedFilm {
    /// The sums before the sample.
    pub before: Vec<PixelSums>,
    /// The sums after the sample.
    pub after: Vec<PixelSums>,
}

/// The state of a path between two dispatches, as bits: the slots of `shaders/path/state.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathState {
    /// The slots, in order.
    pub slots: [[u32; 4]; Self::SLOTS],
}

impl PathState {
    /// The number of slots. The last three are for the sampled light and the medium, or in a studio for the surface:
    /// its normal, its colour, and its specular lobe.
    pub const SLOTS: usize = 9;

    pub(crate) const EMPTY: Self = Self { slots: [[0; 4]; Self::SLOTS] };

    /// The slot of the radiance so far, whose last number is the opacity.
    pub const RADIANCE: usize = 4;

    /// The slot of the pending light, whose last number is its visibility.
    pub const PENDING: usize = 7;

    /// In a studio, the slot of the normal, whose last word has a bit for each hidden light.
    pub const NORMAL: usize = 6;

    /// The state once the visibility of its light is known. A light that is occluded is not searched again.
    pub(crate) fn with_visibility(mut self, open: u32) -> Self {
        if open != self.bits(slot::PENDING) {
            self.slots[slot::PENDING][3] = open;
            self.slots[slot::SHADOW][3] = 0;
        }
        self
    }

    /// The state in a studio after the light of some lights was added, with the bits that are left of them.
    pub(crate) fn with_light(mut self, radiance: [u32; 4], left: u32) -> Self {
        self.slots[slot::RADIANCE] = radiance;
        self.slots[slot::NORMAL][3] = left;
        self
    }

    pub(crate) fn vector(&self, slot: usize) -> [f32; 3] {
        let [x, y, z, _] = self.slots[slot];
        [x, y, z].map(f32::from_bits)
    }

    pub(crate) fn number(&self, slot: usize) -> f32 {
        f32::from_bits(self.slots[slot][3])
    }

    pub(crate) fn bits(&self, slot: usize) -> u32 {
        self.slots[slot][3]
    }

    /// The surface that the path leaves.
    pub(crate) fn departure(&self) -> Departure {
        let [id, _, exit_distance, emitter] = self.slots[slot::DEPARTURE];
        Departure { id, exit_distance: f32::from_bits(exit_distance), emitter }
    }

    pub(crate) fn flags(&self) -> u32 {
        self.bits(slot::ORIGIN)
    }

    pub(crate) fn has(&self, flag: u32) -> bool {
        self.flags() & flag != 0
    }
}

/// The surface that a path leaves: `shaders/path/departure.wgsl`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Departure {
    /// Id of the sphere; [`NO_ID`](crate::image::NO_ID) for none.
    pub(crate) id: u32,
    /// Exit distance of the sphere if the path goes inside; else 0.
    pub(crate) exit_distance: f32,
    /// Index of the sampled emitter, or [`NO_EMITTER`].
    pub(crate) emitter: u32,
}

/// The value of [`Departure::emitter`] if there is no emitter.
pub(crate) const NO_EMITTER: u32 = u32::MAX;

/// The indices of the slots.
pub(crate) mod slot {
    pub(crate) const ORIGIN: usize = 0;
    pub(crate) const DIRECTION: usize = 1;
    pub(crate) const DEPARTURE: usize = 2;
    pub(crate) const THROUGHPUT: usize = 3;
    pub(crate) const RADIANCE: usize = super::PathState::RADIANCE;
    pub(crate) const FIRST: usize = 5;
    pub(crate) const SHADOW: usize = 6;
    pub(crate) const PENDING: usize = super::PathState::PENDING;
    pub(crate) const MEDIUM: usize = 8;
    pub(crate) const NORMAL: usize = super::PathState::NORMAL;
    pub(crate) const ALBEDO: usize = 7;
    pub(crate) const LOBE: usize = 8;
}

/// Flags of the state of a path, and flags of the lighting.
pub(crate) mod flag {
    pub(crate) use crate::light::codes::lighting::{CATCHER, GROUND, SHADOWS, SKY_SEEN, TRANSPARENT};
    pub(crate) use crate::light::codes::path::{ALIVE, BACK, FULL, INSIDE, ON_GROUND, SCATTERED};
}

/// The parameters of the lighting on the device: `LightingParameters` in `shaders/scene/lighting_records.wgsl`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UploadedLighting {
    /// Colour of the background.
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
    /// Ambient light of a studio.
    pub ambient: [f32; 3],
    /// Colour to which depth cueing fades.
    pub cue_color: [f32; 3],
    /// Distance at which depth cueing begins.
    pub cue_near: f32,
    /// Reciprocal of the depth over which colours fade; 0 if they do not.
    pub cue_scale: f32,
    /// Largest distance at which a sphere occludes ambient light.
    pub occlusion_radius: f32,
    /// Number of directions of ambient light for each sample.
    pub occlusion_samples: u32,
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
    /// Cumulative tables for sampling: one for the rows, and one for the columns of each row.
    pub shares: Vec<f32>,
}
