//! What a device did, for the checker: rays and hits on their way back to the host, and the numbers that the
//! device was given.

use wgpu::{Buffer, Device};

use super::error::GpuError;
use super::frame::Frame;
use super::headless::Headless;
use super::primary::Output;
use super::progress::{Watch, go_on};
use super::readback::ReadableBuffer;
use super::records::{self, SceneSpace};
use super::renderers::RendererKey;
use super::scene_buffers::SceneBuffers;
use super::tiles::Tile;
use crate::accel::AccelChoice;
use crate::camera::{Camera, View};
use crate::film::Film;
use crate::image::{Image, LayerSet, NO_ID};
use crate::render::{PrimaryLook, RenderSettings};
use crate::scene::Scene;
use crate::verify::{
    Certificate, Checker, NO_HIT, Recording, Rendered, RequestedCamera, TracedPixel, TracedRay,
    UploadedView,
};

/// A camera, and the numbers that kernels get of it and of the scene's box.
pub(super) fn requested_view(
    space: &SceneSpace,
    camera: &dyn Camera,
) -> (RequestedCamera, UploadedView) {
    let requested = RequestedCamera::of(camera);
    let records::Camera { origin, advance, right, up, forward, first, second, third } =
        records::Camera::new(&requested, space);
    let uploaded = UploadedView {
        origin,
        advance,
        right,
        up,
        forward,
        numbers: [first, second, third],
        scene_min: space.min.to_array(),
        scene_max: space.max.to_array(),
    };
    (requested, uploaded)
}

/// A recording in which nothing is traced yet.
fn new_recording(
    space: &SceneSpace,
    view: &View<'_>,
    look: PrimaryLook,
) -> Result<Recording, GpuError> {
    let (requested, uploaded) = requested_view(space, view.camera);
    let film = view.film;
    let image = Image::new(film.width(), film.height(), LayerSet::DATA)?;
    let untraced = TracedPixel { ray: None, t: NO_HIT, id: NO_ID };
    Ok(Recording {
        camera: requested,
        uploaded,
        film,
        look,
        pixels: vec![untraced; image.color().len()],
        image,
        rendered: Rendered::None,
    })
}

impl Headless {
    /// As [`Headless::render_uploaded`] of primary rays, with all layers, and with the ray and the hit of every pixel:
    /// everything by which [`Checker::certify`] judges the device.
    ///
    /// # Errors
    /// As [`Headless::render_uploaded`]; [`GpuError::NotPrimary`] if the settings are of a lit picture, whose paths
    /// [`Headless::record_paths`] records.
    pub fn record(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        let look = scene.primary_look(settings)?;
        let key = RendererKey {
            data_layers: true,
            keeps_rays: true,
            ..RendererKey::new(scene, view.camera)
        };
        self.with_renderer(key, |renderer| {
            let mut recording = new_recording(scene.space(), view, look)?;
            let Recording { image, pixels, .. } = &mut recording;
            let output = Output { image, pixels: Some(pixels) };
            self.render_tiles(renderer, scene, view, &look, output, watch)?;
            Ok(recording)
        })
    }

    /// As [`Headless::record`], and renders the view once more as [`Headless::render_uploaded`] does, with kernels
    /// that keep no rays, for [`Recording::rendered`].
    ///
    /// # Errors
    /// As [`Headless::record`].
    pub fn record_and_render(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        let mut recording = self.record(scene, view, settings, watch)?;
        let picture = self.render_uploaded(scene, view, settings, LayerSet::DATA, watch)?;
        recording.compare(picture.image);
        Ok(recording)
    }

    /// Renders a picture of primary rays and decides whether it is one that a conforming device may have made: as
    /// [`Headless::render`] makes it, and as [`Headless::record`] does, stage by stage.
    ///
    /// # Errors
    /// If it cannot be rendered, as with [`Headless::record`], or if there is no memory to check it. That a picture
    /// is not legal is not an error.
    pub fn verify(
        &self,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<Certificate, GpuError> {
        if !settings.integrator.is_primary() {
            return Err(GpuError::NotPrimary { integrator: settings.integrator.name() });
        }
        let plan = |choice: AccelChoice| self.plan_record(scene, view, choice, 0);
        let recording = self.with_uploaded(scene, plan, |buffers| {
            self.record_and_render(buffers, view, settings, &mut go_on)
        })?;
        Ok(Checker::new(scene)?.certify(&recording))
    }
}

/// The rays and hits of a tile.
#[derive(Debug)]
pub(super) struct ReadableTrace {
    hits: ReadableBuffer,
    rays: ReadableBuffer,
}

impl ReadableTrace {
    /// `None` for a frame that keeps no rays.
    pub(super) fn new(device: &Device, frame: &Frame) -> Option<Self> {
        let (hits, rays) = frame.traced();
        Some(Self {
            hits: ReadableBuffer::new(device, "pinhole hits read-back", hits.size()),
            rays: ReadableBuffer::new(device, "pinhole rays read-back", rays?.size()),
        })
    }

    pub(super) fn buffers(&self) -> [&Buffer; 2] {
        [self.hits.buffer(), self.rays.buffer()]
    }

    pub(super) fn record_copy(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame) {
        let (hits, rays) = frame.traced();
        self.hits.record_copy(encoder, hits);
        if let Some(rays) = rays {
            self.rays.record_copy(encoder, rays);
        }
    }

    /// Copies the mapped buffers to the tile's place among the pixels, and unmaps them.
    pub(super) fn read_into(
        &self,
        pixels: &mut [TracedPixel],
        film: &Film,
        tile: Tile,
    ) -> Result<(), GpuError> {
        let [x, y] = tile.origin.map(|start| start as usize);
        let [width, height] = tile.size.map(|side| side as usize);
        let mut rows: Vec<&mut [TracedPixel]> = pixels
            .chunks_mut(film.width() as usize)
            .skip(y)
            .take(height)
            .map(|row| &mut row[x..x + width])
            .collect();
        self.rays.read(|rays: &[records::TracedRay]| {
            for (row, rays) in rows.iter_mut().zip(rays.chunks(width)) {
                for (pixel, ray) in row.iter_mut().zip(rays) {
                    pixel.ray = traced_ray(*ray);
                }
            }
        })?;
        self.hits.read(|hits: &[records::Hit]| {
            for (row, hits) in rows.iter_mut().zip(hits.chunks(width)) {
                for (pixel, [t, id, ..]) in row.iter_mut().zip(hits) {
                    if pixel.ray.is_some() {
                        (pixel.t, pixel.id) = (f32::from_bits(*t), *id);
                    }
                }
            }
        })
    }
}

/// Cleared memory is no ray.
fn traced_ray(
    [ox, oy, oz, distance, dx, dy, dz, is_traced]: records::TracedRay,
) -> Option<TracedRay> {
    let (origin, direction) = ([ox, oy, oz], [dx, dy, dz]);
    (is_traced != 0.0).then_some(TracedRay { origin, direction, distance })
}
