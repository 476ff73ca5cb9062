//! Planning the memory that a render needs on the device and on the host, before any of it is allocated.

use wgpu::Limits;

use crate::accel::{AccelChoice, AccelPlan, PlannedBuffer, Structure};
use crate::camera::View;
use crate::camera::film::Film;
use crate::gpu::device_shape::DeviceLimits;
use crate::gpu::error::GpuError;
use crate::gpu::headless::readback::{self, ReadBack};
use crate::gpu::headless::tile_plan;
use crate::gpu::passes::bands::{BandBuffers, tile_size};
use crate::gpu::passes::emitter_table;
use crate::gpu::scene::appearance;
use crate::gpu::shader::records;
use crate::image::LayerSet;
use crate::recording::TracedPixel;
use crate::render::RenderSettings;
use crate::scene::Scene;
use crate::smooth::SmoothPicture;
use crate::verify::{Checker, Verdict};

/// The resources that a render by [`Headless`](crate::gpu::Headless) needs. Sizes are upper bounds for buffers and
/// textures; a few hundred bytes of records for each brick are not included.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderPlan {
    /// The structure of all spheres, and the reason for its choice.
    pub accel: AccelPlan,
    /// Returns true if the picture is rendered without the structure, by lists of the spheres that may be seen in each
    /// tile of 8×8 pixels. [`Headless::render_planned`](crate::gpu::Headless::render_planned) does so.
    pub by_tiles: bool,
    /// The structure of the spheres that cast shadows, if a studio needs a separate one because some spheres are not
    /// opaque.
    pub occluders: Option<AccelPlan>,
    /// Buffers of the scene: the buffers of the structures and of the colours.
    pub scene_buffers: Vec<PlannedBuffer>,
    /// Buffers that kernels write for one tile.
    pub tile_buffers: Vec<PlannedBuffer>,
    /// Textures of one tile, and the buffers through which the host reads them.
    pub tile_textures: Vec<PlannedBuffer>,
    /// Width and height of a tile in pixels. A tile is the whole picture if it is small enough.
    pub tile_size: [u32; 2],
    /// Number of tiles, which are rendered one after another.
    pub tile_count: u64,
    /// Number of bytes on the device, for the scene and one tile.
    pub device_bytes: u64,
    /// Maximum number of bytes of host memory in use at once, excluding the scene itself.
    pub host_bytes: u64,
    /// The step that needs `host_bytes`, in words.
    pub host_peak: &'static str,
}

/// Names of steps, one of which needs the most host memory.
pub(crate) const BUILDING: &str = "building the structure";
pub(crate) const UPLOADING: &str = "copying the scene to the device";
pub(crate) const PICTURE: &str = "the picture";
const CHECKING: &str = "checking the picture";

/// The picture that a plan is made for.
#[derive(Clone, Copy, Debug)]
pub struct PictureRequest<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The camera and the film.
    pub view: View<'a>,
    /// The render settings.
    pub settings: &'a RenderSettings,
    /// The layers of the picture.
    pub layers: LayerSet,
    /// Host memory in bytes that the caller needs for each pixel in addition to the image itself, for example to encode
    /// it.
    pub host_bytes_per_pixel: u64,
    /// True if no other picture of the scene is wanted, or one more, so that nothing is kept for others.
    pub is_only: bool,
    /// False for a picture by primary rays of which colours and normals are not wanted, and left at zero.
    pub is_shaded: bool,
}

impl<'a> PictureRequest<'a> {
    /// A picture for which the caller needs no host memory beyond the image.
    #[must_use]
    pub fn new(scene: &'a Scene, view: &View<'a>, settings: &'a RenderSettings, layers: LayerSet) -> Self {
        Self { scene, view: *view, settings, layers, host_bytes_per_pixel: 0, is_only: false, is_shaded: true }
    }
}

impl<'a> PictureRequest<'a> {
    /// The picture, if it is smooth.
    pub(crate) fn smooth(&self) -> Option<SmoothPicture<'a>> {
        SmoothPicture::of(self.scene, &self.view, self.settings)
    }

    /// True unless tiles would shade bricks of different shapes together, which they cannot.
    pub(crate) fn suits_tiles(&self) -> bool {
        self.scene.cones().is_empty() || !self.is_shaded
    }

    /// The picture of ids from which a smooth picture follows.
    pub(crate) fn of_ids(&self, smooth: &SmoothPicture<'a>) -> Self {
        let (layers, is_shaded) = smooth.layers(self.layers);
        Self { view: smooth.view_of_ids(), layers, is_shaded, ..*self }
    }
}

/// Plans of the structures that will be built for a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct StructurePlans {
    /// The structure of all spheres.
    pub accel: AccelPlan,
    /// The structure of the spheres that cast shadows in a studio, if some spheres do not.
    pub occluders: Option<AccelPlan>,
}

impl RenderPlan {
    /// Plans a picture of primary rays. With `keeps_rays`, it is a recording of all layers, rays and hits, a second render
    /// without rays, and the check of both.
    pub(crate) fn planned(
        request: &PictureRequest<'_>,
        accel: AccelPlan,
        device: &DeviceLimits,
        keeps_rays: bool,
    ) -> Self {
        let PictureRequest { scene, host_bytes_per_pixel, .. } = *request;
        let layers = if keeps_rays { LayerSet::DATA } else { request.layers };
        let (limits, film) = (&device.limits, &request.view.film);
        let may_be = !keeps_rays && request.is_only && request.suits_tiles();
        let by_tiles = may_be
            && match accel.choice {
                AccelChoice::Auto => tile_plan::suits(scene, &request.view, &accel, device),
                AccelChoice::Tiles => tile_plan::of_picture(scene, &request.view, &accel).is_some(),
                _ => false,
            };
        let tile_size = match by_tiles {
            true => tile_plan::part_size(&request.view, device),
            false => tile_size(limits, device.shape(), film, keeps_rays),
        };
        let of_structure = match by_tiles {
            true => tile_plan::buffers(scene, tile_size),
            false => accel.buffers.clone(),
        };
        let scene_buffers = scene_buffers(scene, of_structure);
        let band = BandBuffers::new(limits, tile_size, keeps_rays);
        let tile_buffers = band.planned();
        let mut tile_textures = band.planned_read_back();
        tile_textures.extend(readback::planned(tile_size, ReadBack::new(layers, request.is_shaded || keeps_rays)));
        let scene_bytes = total(&scene_buffers);
        let tile_bytes = total(&tile_buffers) + total(&tile_textures);
        let in_host = |bytes| device.in_host(bytes);
        // Rays, hits and verdicts, and the picture of the second render. A second copy of the
        // verdicts exists while parts are joined.
        let judged = (size_of::<TracedPixel>() + 2 * size_of::<Verdict>()) as u64 + layers.bytes_per_pixel();
        let per_pixel = layers.bytes_per_pixel().saturating_add(host_bytes_per_pixel).saturating_add(if keeps_rays {
            judged
        } else {
            0
        });
        let picture = film.pixel_count().saturating_mul(per_pixel);
        let checker = Checker::bytes_for(scene);
        let checking = if keeps_rays { picture.saturating_add(checker) } else { 0 };
        let [building, uploading] = if by_tiles {
            let listing = tile_plan::building_bytes(scene.shape_count(), tile_size);
            [listing + scene_bytes + in_host(scene_bytes), listing + 2 * scene_bytes + in_host(scene_bytes)]
        } else {
            [device.building_bytes(&accel, &scene_buffers), device.uploading_bytes(&accel, &scene_buffers)]
        };
        let moments = [
            (BUILDING, building),
            (UPLOADING, uploading),
            (CHECKING, checking),
            (PICTURE, picture.saturating_add(in_host(scene_bytes + tile_bytes))),
        ];
        let worst = moments.into_iter().max_by_key(|(_, bytes)| *bytes);
        let (host_peak, host_bytes) = worst.unwrap_or((PICTURE, 0));
        Self {
            accel,
            by_tiles,
            occluders: None,
            scene_buffers,
            tile_buffers,
            tile_textures,
            tile_size,
            tile_count: tile_count(film, tile_size),
            device_bytes: scene_bytes + tile_bytes,
            host_bytes,
            host_peak,
        }
    }

    /// Returns the structure by which [`Headless::render_planned`](crate::gpu::Headless::render_planned) finds spheres.
    #[must_use]
    pub fn structure(&self) -> Structure {
        let of_shapes = match self.accel.cones {
            Some(cones) if self.accel.statistics.count == 0 => cones.structure,
            _ => self.accel.structure,
        };
        if self.by_tiles { Structure::Tiles } else { of_shapes }
    }

    /// Returns the reason for the choice of the structure.
    #[must_use]
    pub fn reason(&self) -> &str {
        match self.accel.choice {
            AccelChoice::Auto if self.by_tiles => "no other picture, and one ray for each pixel",
            AccelChoice::Tiles if self.by_tiles => "asked for",
            _ => &self.accel.reason,
        }
    }

    /// Returns the number of bricks, or of the first of them if the picture is rendered by tiles, where more are made for
    /// what is not hidden.
    #[must_use]
    pub fn brick_count(&self) -> usize {
        if self.by_tiles { 1 } else { self.accel.count_bricks() }
    }

    /// Returns the minimum number of submissions: one for every brick of every tile. There are usually more, because
    /// they are divided so that each takes about 60 milliseconds.
    #[must_use]
    pub fn least_submissions(&self) -> u64 {
        self.tile_count * self.brick_count() as u64
    }

    /// Returns the mean number of bytes on the device for a sphere; `None` for an empty scene, and for one with cones.
    #[must_use]
    pub fn device_bytes_per_sphere(&self) -> Option<f64> {
        let count = self.accel.statistics.count;
        (count > 0 && self.accel.cones.is_none()).then(|| self.device_bytes as f64 / count as f64)
    }

    /// Checks that the plan fits into the limits of a device and into the free host memory in bytes. If `memory` is
    /// `None`, because the free memory is not known, only the limits are checked.
    ///
    /// # Errors
    /// [`GpuError::Limit`] with the first limit that is too low; [`GpuError::HostMemory`] if the memory is too small;
    /// [`GpuError::NoTiles`] if tiles were asked for, which this picture cannot have.
    pub fn check(&self, limits: &Limits, memory: Option<u64>) -> Result<(), GpuError> {
        if self.accel.choice == AccelChoice::Tiles && !self.by_tiles && self.accel.statistics.count > 0 {
            return Err(GpuError::NoTiles);
        }
        let binding = ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size);
        let buffer = ("max_buffer_size", limits.max_buffer_size);
        let bound = self.scene_buffers.iter().chain(&self.tile_buffers);
        let checks = bound
            .flat_map(|planned| [(planned, binding), (planned, buffer)])
            .chain(self.tile_textures.iter().map(|planned| (planned, buffer)));
        let largest = emitter_table::limit(limits);
        let textures = self.tile_textures.iter().filter(|planned| planned.name == emitter_table::NAME);
        if let Some(planned) = textures.into_iter().find(|planned| planned.bytes > largest.1) {
            let (what, (limit_name, limit)) = (emitter_table::WHAT, largest);
            return Err(GpuError::Limit { what, needed: planned.bytes, limit_name, limit });
        }
        for (planned, (limit_name, limit)) in checks {
            let needed = planned.bytes_per_binding;
            if needed > limit {
                let what = in_words(planned.name);
                return Err(GpuError::Limit { what, needed, limit_name, limit });
            }
        }
        let instead = match (self.host_peak, self.structure()) {
            (PICTURE | CHECKING, _) => "a smaller size",
            (_, Structure::Grid) => "fewer spheres, or the structure `tree`",
            _ => "fewer spheres",
        };
        let (what, needed) = (self.host_peak, self.host_bytes);
        match memory {
            Some(available) if needed > available => Err(GpuError::HostMemory { what, needed, available, instead }),
            _ => Ok(()),
        }
    }
}

/// The buffers of the structure, and the buffers that shading reads.
pub(crate) fn scene_buffers(scene: &Scene, mut buffers: Vec<PlannedBuffer>) -> Vec<PlannedBuffer> {
    let spheres = buffers.iter().find(|buffer| buffer.name == "spheres").copied();
    let words = appearance::words_per_sphere(scene.checked_appearance());
    if let Some(PlannedBuffer { bytes, bytes_per_binding, .. }) = spheres.filter(|_| words > 0) {
        // A sphere has four numbers.
        buffers.push(PlannedBuffer {
            name: "colors",
            bytes: words * (bytes / 4),
            bytes_per_binding: words * (bytes_per_binding / 4),
        });
    }
    let palette = appearance::palette_length(scene.appearance()) * size_of::<records::Color>();
    buffers.push(PlannedBuffer::one("palette", palette as u64));
    buffers
}

pub(crate) fn tile_count(film: &Film, [width, height]: [u32; 2]) -> u64 {
    u64::from(film.width().div_ceil(width)) * u64::from(film.height().div_ceil(height))
}

/// Description of a planned buffer for error messages.
fn in_words(name: &str) -> &'static str {
    match name {
        "spheres" => "the buffer of spheres",
        "cones" => "the buffer of cones and cylinders",
        "ids" | "ids, cells and references" | "ids of cones" | "ids, cells and references of cones" => {
            "the buffer of ids"
        }
        "colors" => "the buffer of colors",
        "palette" => "the palette",
        "hits" => "the buffer of hits",
        "rays" => "the buffer of rays",
        "paths" => "the paths of a tile",
        "tables" => "the tables of lights and materials",
        "sky" | "sky shares" => "the image of the sky",
        "nodes" | "balls" | "tiles" | "nodes of cones" | "capsules" => "the buffer of the structure",
        _ => "a tile of the picture",
    }
}

pub(crate) fn total(buffers: &[PlannedBuffer]) -> u64 {
    buffers.iter().map(|buffer| buffer.bytes).sum()
}

#[cfg(test)]
mod tests {
    use wgpu::DeviceType;

    use super::*;
    use crate::accel::AccelChoice;
    use crate::camera::PinholeCamera;
    use crate::image::Layer;
    use crate::image::color::LinearRgb;
    use crate::scene::material::SurfaceProperties;
    use crate::scene::sphere_array::SphereArray;
    use crate::scene::{Appearance, Colors};

    fn plan(size: u32, layers: LayerSet, device_type: DeviceType) -> RenderPlan {
        planned(size, layers, device_type, false)
    }

    fn planned(size: u32, layers: LayerSet, device_type: DeviceType, keeps_rays: bool) -> RenderPlan {
        let scene =
            Scene::from_f32((0..1000).map(|i| [i as f32, 0.0, 0.0, 0.5]).collect(), LinearRgb::from_srgb8([255, 0, 0]))
                .unwrap();
        let accel = AccelPlan::new(scene.spheres(), AccelChoice::List, 1 << 27);
        let film = Film::new(size, size).unwrap();
        let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.0).unwrap();
        let request = PictureRequest {
            scene: &scene,
            view: View::new(&camera, film),
            settings: &RenderSettings::default(),
            layers,
            host_bytes_per_pixel: 16,
            is_only: false,
            is_shaded: true,
        };
        let device = DeviceLimits { limits: Limits::default(), device_type };
        RenderPlan::planned(&request, accel, &device, keeps_rays)
    }

    #[test]
    fn a_tile_needs_hits_textures_and_read_back_buffers() {
        let plan = plan(1024, LayerSet::COLOR, DeviceType::DiscreteGpu);
        assert_eq!((plan.tile_size, plan.tile_count), ([1024, 1024], 1));
        let hit = size_of::<records::Hit>() as u64;
        assert_eq!(total(&plan.tile_buffers), hit << 20);
        assert_eq!(total(&plan.tile_textures), 32 << 20);

        assert_eq!(plan.check(&Limits::default(), None), Ok(()));
        let all = super::tests::plan(1024, LayerSet::DATA, DeviceType::DiscreteGpu);
        assert_eq!(total(&all.tile_textures), (2 * (16 + 4 + 16 + 4)) << 20);
    }

    #[test]
    fn the_host_keeps_every_layer_and_the_device_four() {
        let plan = |layers| plan(1024, layers, DeviceType::DiscreteGpu);
        let (color, alpha) = (plan(LayerSet::COLOR), plan(LayerSet::COLOR.with(Layer::Alpha)));
        let (data, all) = (plan(LayerSet::DATA), plan(LayerSet::ALL));
        assert_eq!(color.host_bytes, (12 + 16) << 20);
        assert_eq!(alpha.host_bytes, color.host_bytes + (4 << 20));
        assert_eq!(data.host_bytes, color.host_bytes + ((4 + 12 + 4) << 20));
        assert_eq!(all.host_bytes, data.host_bytes + ((4 + 12 + 12 + 4 + 4) << 20));
        assert_eq!(all.tile_textures, data.tile_textures);
        assert_eq!(alpha.tile_textures, data.tile_textures);
    }

    /// Four million individual colours take four bytes each, and the indices of two surfaces another four bytes each.
    #[test]
    fn an_individual_color_takes_four_bytes_per_sphere() {
        let count = 4_000_000;
        let spheres: Vec<[f32; 4]> =
            (0..count).map(|i| [(i % 215) as f32, (i / 215 % 215) as f32, (i / 46_225) as f32, 0.4]).collect();
        let accel = AccelPlan::new(&spheres, AccelChoice::Auto, 1 << 27);
        let colors = (0..count as u32).map(|i| (i | 0xff00_0000).to_le_bytes()).collect();
        let mut appearance = Appearance::new(Colors::Rgba8(colors));
        let stored = accel.buffers.iter().find(|buffer| buffer.name == "spheres").unwrap().bytes;
        assert_eq!(stored, 16 * count as u64);
        let mut spheres = spheres;
        for words in [1, 2] {
            let scene = Scene::from_parts(SphereArray::F32(spheres), appearance.clone()).unwrap();
            let buffers = scene_buffers(&scene, accel.buffers.clone());
            let bytes = |name| buffers.iter().find(|buffer| buffer.name == name).unwrap().bytes;
            assert_eq!((bytes("colors"), bytes("palette")), (4 * words * count as u64, 16 * 256));
            spheres = scene.spheres().to_vec();
            let surfaces =
                vec![SurfaceProperties::default(), SurfaceProperties { opacity: 0.5, ..SurfaceProperties::default() }];
            let indices = (0..count as u32).map(|i| i % 2).collect();
            appearance = appearance.with_surfaces(surfaces, indices);
        }
    }

    #[test]
    fn a_software_device_takes_its_memory_from_the_host() {
        let gpu = plan(1024, LayerSet::COLOR, DeviceType::DiscreteGpu);
        let software = plan(1024, LayerSet::COLOR, DeviceType::Cpu);
        assert_eq!(software.device_bytes, gpu.device_bytes);
        assert_eq!(software.host_peak, PICTURE);
        assert_eq!(software.host_bytes, gpu.host_bytes + gpu.device_bytes);
        assert_eq!(software.check(&Limits::default(), Some(software.host_bytes)), Ok(()));
        assert!(matches!(
            software.check(&Limits::default(), Some(software.host_bytes - 1)),
            Err(GpuError::HostMemory { what: "the picture", .. })
        ));
    }

    #[test]
    fn a_recording_keeps_rays_and_hits() {
        let plan = plan(1024, LayerSet::DATA, DeviceType::DiscreteGpu);
        let recording = planned(1024, LayerSet::COLOR, DeviceType::DiscreteGpu, true);
        assert_eq!((recording.tile_size, recording.tile_count), (plan.tile_size, 1));
        // Both rays of each pixel, and the read-back buffers of rays and hits.
        assert_eq!(recording.device_bytes, plan.device_bytes + ((64 + 80) << 20));
        assert_eq!(recording.host_peak, CHECKING);
        assert_eq!(recording.host_bytes, plan.host_bytes + ((72 + 2 + 32) << 20) + 40_000);
        assert_eq!(recording.check(&Limits::default(), None), Ok(()));
    }

    #[test]
    fn a_limit_that_is_too_low_is_named() {
        let plan = plan(64, LayerSet::COLOR, DeviceType::DiscreteGpu);
        let limits = Limits { max_storage_buffer_binding_size: 100, ..Limits::default() };
        let refused = plan.check(&limits, None);
        assert!(
            matches!(
                refused,
                Err(GpuError::Limit {
                    what: "the buffer of spheres",
                    limit_name: "max_storage_buffer_binding_size",
                    limit: 100,
                    ..
                })
            ),
            "{refused:?}"
        );
    }
}
