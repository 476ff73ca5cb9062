//! What a device did, for the checker: rays and hits on their way back to the host, and the numbers that the
//! device was given.

use std::ops::ControlFlow;

use wgpu::{Buffer, Device};

use super::error::GpuError;
use super::frame::Frame;
use super::headless::Headless;
use super::options::Watch;
use super::readback::ReadableBuffer;
use super::records::{self, SceneSpace};
use super::renderers::RendererKey;
use super::scene_buffers::SceneBuffers;
use super::tiles::Tile;
use crate::camera::Camera;
use crate::film::Film;
use crate::image::{Image, LayerSet, NO_ID};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::verify::{
    Certificate, Checker, NO_HIT, Recording, Rendered, RequestedCamera, TracedPixel, TracedRay,
    UploadedView,
};

/// A camera, and the numbers that kernels get of it and of the scene's box.
pub(super) fn requested_view(
    space: &SceneSpace,
    camera: &dyn Camera,
) -> (RequestedCamera, UploadedView) {
    let vectors = camera.vectors();
    let records::Camera { origin, advance, right, up, forward, first, second, third } =
        records::Camera::new(camera.kind(), &vectors, space);
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
    (RequestedCamera { kind: camera.kind(), vectors }, uploaded)
}

/// A recording in which nothing is traced yet.
fn new_recording(
    space: &SceneSpace,
    camera: &dyn Camera,
    film: &Film,
    settings: &Settings,
) -> Result<Recording, GpuError> {
    let (requested, uploaded) = requested_view(space, camera);
    let image = Image::new(film.width(), film.height(), LayerSet::DATA)?;
    let untraced = TracedPixel { ray: None, t: NO_HIT, id: NO_ID };
    Ok(Recording {
        camera: requested,
        uploaded,
        film: *film,
        settings: *settings,
        pixels: vec![untraced; image.color().len()],
        image,
        rendered: Rendered::None,
    })
}

impl Headless {
    /// As [`Headless::render_uploaded`], with all layers, and with the ray and the hit of every pixel:
    /// everything by which [`Checker::certify`] judges the device.
    ///
    /// # Errors
    /// As [`Headless::render_uploaded`].
    pub fn record(
        &self,
        scene: &SceneBuffers,
        camera: &dyn Camera,
        film: &Film,
        settings: &Settings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        let key =
            RendererKey { data_layers: true, keeps_rays: true, ..RendererKey::new(scene, camera) };
        self.with_renderer(key, |renderer| {
            let mut recording = new_recording(scene.space(), camera, film, settings)?;
            let Recording { image, pixels, .. } = &mut recording;
            let view = (camera, film, settings);
            self.render_tiles(renderer, scene, view, image, Some(pixels), watch)?;
            Ok(recording)
        })
    }

    /// As [`Headless::record`], and renders the view once more as [`Headless::render_uploaded`] does, with kernels
    /// that keep no rays, for [`Recording::rendered`].
    ///
    /// # Errors
    /// As [`Headless::render_uploaded`].
    pub fn record_and_render(
        &self,
        scene: &SceneBuffers,
        camera: &dyn Camera,
        film: &Film,
        settings: &Settings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        let mut recording = self.record(scene, camera, film, settings, watch)?;
        let layers = LayerSet::DATA;
        recording.compare(self.render_uploaded(scene, camera, film, settings, layers, watch)?);
        Ok(recording)
    }

    /// Renders a picture and decides whether it is one that a conforming device may have made: as
    /// [`Headless::render`] makes it, and as [`Headless::record`] does, stage by stage.
    ///
    /// # Errors
    /// If it cannot be rendered, as with [`Headless::render`], or if there is no memory to check it. A picture
    /// that is not legal is no error.
    pub fn verify(
        &self,
        scene: &Scene,
        camera: &dyn Camera,
        film: &Film,
        settings: &Settings,
    ) -> Result<Certificate, GpuError> {
        let go_on = |_| ControlFlow::Continue(());
        let recording = self.with_uploaded(scene, film, |buffers| {
            self.record_and_render(buffers, camera, film, settings, &mut { go_on })
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
