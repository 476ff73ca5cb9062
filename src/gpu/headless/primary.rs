//! Rendering pictures of primary rays, tile by tile.

use wgpu::ComputePassDescriptor;

use crate::accel::BrickKind;
use crate::camera::{Camera, View};
use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::progress::{TracedPixels, Watch};
use crate::gpu::headless::readback::{DerivedLayers, ReadBack, ReadableTrace, TileTextures};
use crate::gpu::passes::bands::tile_size;
use crate::gpu::passes::frame::{BandBrick, Frame};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::passes::tiles::{Groups, tiles};
use crate::gpu::passes::visible_bricks::traced_pixels;
use crate::gpu::profile::NotedPass;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::formats::ColorTarget;
use crate::image::{Image, LayerSet};
use crate::recording::TracedPixel;
use crate::render::PrimarySettings;

/// The destination of a picture.
pub(crate) struct Output<'a> {
    pub(crate) image: &'a mut Image,
    /// Destination of the ray and the hit of every pixel, if they are kept.
    pub(crate) pixels: Option<&'a mut Vec<TracedPixel>>,
}

impl Headless {
    /// The options of a renderer for pictures of a scene without data layers.
    pub(crate) fn options_for(&self, scene: &SceneBuffers, camera: &dyn Camera) -> RendererOptions {
        self.options_of(&scene.kinds(), scene.has_several_bricks(), camera)
    }

    /// The options of a renderer for pictures without data layers, of one brick or of several bricks.
    /// `kinds` are the kinds of the bricks.
    pub(crate) fn options_of(&self, kinds: &[BrickKind], several_bricks: bool, camera: &dyn Camera) -> RendererOptions {
        RendererOptions {
            color: ColorTarget::Linear32,
            cameras: vec![camera.kind()],
            several_bricks,
            device_type: Some(self.info.device_type),
            edits: self.edits.replacements.clone(),
            rewrite: self.edits.rewrite.clone(),
            ..RendererOptions::default()
        }
        .with_kinds(kinds)
    }

    /// Renders a picture with a ray through the centre of every pixel. Without `primary`, colours and normals are not
    /// wanted.
    pub(crate) async fn render_primary(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        primary: Option<&PrimarySettings>,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Image, GpuError> {
        let what = ReadBack::new(layers, primary.is_some());
        let options = RendererOptions { data_layers: what.has_data(), ..self.options_for(scene, view.camera) };
        self.with_renderer(options, async |renderer: &Renderer| {
            let mut image = Image::new(view.film.width(), view.film.height(), layers)?;
            let output = Output { image: &mut image, pixels: None };
            let primary = primary.copied().unwrap_or_default();
            self.render_tiles(renderer, scene, view, (&primary, what), output, watch).await?;
            Ok(image)
        })
        .await
    }

    pub(crate) async fn render_tiles(
        &self,
        renderer: &Renderer,
        scene: &SceneBuffers,
        view: &View<'_>,
        (primary, what): (&PrimarySettings, ReadBack),
        mut output: Output<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        let (device, film) = (self.device(), &view.film);
        let tile_size = tile_size(&device.limits(), self.shape(), film, renderer.keeps_rays);
        let textures = scoped(device, || TileTextures::new(device, tile_size, what)).await?;
        let mut frame = Frame::new(renderer, device, &textures.targets()).await?;
        let traced = scoped(device, || ReadableTrace::new(device, &frame)).await?;
        let derived = DerivedLayers { view: *view, appearance: scene.appearance() };
        let mut done = TracedPixels::of(traced_pixels(scene, view, tile_size));
        for tile in tiles(film, tile_size) {
            frame.set_tile(self.queue(), scene, view, tile, primary);
            let (mut encoder, mut noted) = (self.encoder(), NotedPass::default());
            if renderer.keeps_rays {
                // Pixels that are not traced are recognised by their cleared rays.
                frame.record_clear(&mut encoder);
            }
            let mut unfinished = Groups::NONE;
            for part in frame.parts().collect::<Vec<_>>() {
                let mut left = vec![part.groups];
                while let Some(groups) = Groups::take(&mut left, scene.submission_size().groups()) {
                    frame.set_first_group(self.queue(), part.slot, groups.first);
                    let mut pass = begin_pass(&mut encoder, &mut noted, "trace");
                    let slice = BandBrick { groups, ..part };
                    renderer.record_trace(&mut pass, scene, &frame, slice)?;
                    drop(pass);
                    if left.is_empty() && part.is_last && !self.submits_one_by_one() {
                        // The last slice of a tile is submitted together with shading and copies.
                        unfinished = groups;
                        break;
                    }
                    self.submit_slice(encoder, noted, groups, scene, &[]).await?;
                    done.add(groups, watch)?;
                    (encoder, noted) = (self.encoder(), NotedPass::default());
                }
                if part.is_last_of_band && textures.are_shaded() {
                    let mut pass = begin_pass(&mut encoder, &mut noted, "shade");
                    renderer.record_shade(&mut pass, scene, &frame, part.band)?;
                }
            }
            let mut mapped = textures.record_read_back(&mut encoder, &frame, tile.size);
            if let Some(traced) = &traced {
                traced.record_copy(&mut encoder, &frame);
                mapped.extend(traced.buffers());
            }
            self.submit_slice(encoder, noted, unfinished, scene, &mapped).await?;
            let _phase = self.phase("read back");
            let first = frame.parts().next().map_or(Groups::NONE, |part| frame.traced_groups(part.slot));
            textures.read_into(output.image, tile, first, &derived)?;
            if let (Some(traced), Some(pixels)) = (&traced, &mut output.pixels) {
                traced.read_into(pixels, film, tile)?;
            }
            done.add(unfinished, watch)?;
        }
        Ok(())
    }
}

impl Headless {
    /// Begins commands with the shading of a band, if it is wanted.
    pub(crate) fn shading(
        &self,
        renderer: &Renderer,
        scene: &SceneBuffers,
        frame: &Frame,
        band: usize,
        textures: &TileTextures,
    ) -> Result<(wgpu::CommandEncoder, NotedPass), GpuError> {
        let (mut encoder, mut noted) = (self.encoder(), NotedPass::default());
        if textures.are_shaded() {
            renderer.record_shade(&mut begin_pass(&mut encoder, &mut noted, "shade"), scene, frame, band)?;
        }
        Ok((encoder, noted))
    }
}

/// Begins a compute pass, and notes its name.
pub(crate) fn begin_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    noted: &mut NotedPass,
    name: &'static str,
) -> wgpu::ComputePass<'a> {
    noted.note(name);
    encoder.begin_compute_pass(&ComputePassDescriptor::default())
}
