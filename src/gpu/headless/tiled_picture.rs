//! Rendering one picture of primary rays by lists of the spheres that may be seen in each tile, without a structure.

use crate::accel::tile_lists::{NoBrick, ONE_SLAB, TileBricks};
use crate::accel::tiles::TileLists;
use crate::accel::{Brick, BrickBounds, BrickKind, Index, Structure};
use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::plan::{PictureRequest, RenderPlan};
use crate::gpu::headless::primary::begin_pass;
use crate::gpu::headless::progress::{TracedPixels, UploadProgress, UploadStep, UploadWatch, Watch};
use crate::gpu::headless::readback::{DerivedLayers, ReadBack, ReadableBuffer, TileTextures};
use crate::gpu::headless::renderers::Renderers;
use crate::gpu::headless::tile_plan::{self, tile_view};
use crate::gpu::passes::frame::{BandBrick, Frame};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::passes::tiles::{Groups, tiles};
use crate::gpu::passes::visible_bricks::VisibleBricks;
use crate::gpu::profile::NotedPass;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::scene_summary::{SceneSummary, ShapeIds};
use crate::gpu::scene::scene_upload::{BrickSpace, SceneUpload, UploadedBricks};
use crate::image::Image;

impl Headless {
    /// Renders a picture by tiles.
    pub(crate) async fn render_by_tiles(
        &self,
        request: &PictureRequest<'_>,
        plan: &RenderPlan,
        upload_watch: &mut UploadWatch<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<Image, GpuError> {
        let PictureRequest { scene, view, settings, layers, is_shaded, .. } = request;
        let what = ReadBack::new(*layers, *is_shaded);
        let (device, queue, film) = (self.device(), self.queue(), &view.film);
        let structure = Structure::Tiles;
        let kinds: Vec<BrickKind> =
            plan.accel.primitives().map(|primitive| BrickKind { structure, primitive }).collect();
        let options_of = |several_bricks| {
            let options = self.options_of(&kinds, several_bricks, view.camera);
            RendererOptions { data_layers: what.has_data(), ..options }
        };
        let brick_space = BrickSpace { structure, bounds: plan.accel.statistics.inflated_bounds() };
        // In every brick, the nearest of equal spheres has the smallest id, so the ids of the input suffice.
        let ids = ShapeIds::of_all(scene, false);
        let mut image = Image::new(film.width(), film.height(), *layers)?;
        self.alone(async |renderers: &mut Renderers| {
            let layouts = self.layouts_of(vec![structure], vec![structure]).await?;
            let has_both = !scene.spheres().is_empty() && !scene.cones().is_empty();
            // Pipelines for cones always go on from the hits of spheres.
            let has_slabs = scene.len() > ONE_SLAB || !has_both && scene.cones().len() > ONE_SLAB;
            self.begin_renderer(renderers, options_of(has_slabs));
            let summary = SceneSummary::of(scene);
            let no_bricks = UploadedBricks { space: brick_space, bricks: Vec::new(), bytes: 0 };
            let mut buffers = SceneBuffers::new_of(no_bricks, summary, ids.exclude_by, self.shape());
            let primary = buffers.primary_settings(settings)?;
            let bounds = BrickBounds::of_box(brick_space.bounds);
            let visible = VisibleBricks::of(view, &buffers.space, &[bounds]);
            // The last of the pixels are done once all bricks are.
            let last = Groups { first: [0, 0], size: [1, 1] };
            let traced: u64 = tiles(film, plan.tile_size).map(|tile| visible.pixels_of(tile)).sum();
            let mut done = TracedPixels::of(traced + last.pixels());
            for tile in tiles(film, plan.tile_size) {
                let textures = scoped(device, || TileTextures::new(device, tile.size, what)).await?;
                let tiles = tile_view(view, &buffers.space, plan.accel.statistics.margin(), tile);
                // Another structure is tried.
                let Some(tiles) = tiles else { return Err(GpuError::Steps) };
                let phase = self.phase("divide");
                let mut bricks = match has_both || scene.cones().is_empty() {
                    true => TileBricks::new(tiles, scene.spheres()),
                    false => TileBricks::of_cones(tiles, scene.cones(), 0),
                };
                let (mut cones_are_left, mut made, mut several) = (has_both, 0, has_slabs);
                drop(phase);
                let mut farthest = vec![f32::INFINITY; tiles.count()];
                let mut upload = SceneUpload::new(&layouts, device, queue, &buffers.summary, brick_space, &ids).await?;
                let mut frame: Option<(Frame, BandBrick)> = None;
                let most_listed = tile_plan::listed(scene.len(), tile.size) as usize;
                let mut traced = Traced::default();
                loop {
                    let number = made;
                    let mut tell = |step| UploadProgress { step, brick: number, bricks: number + 1 }.tell(upload_watch);
                    tell(UploadStep::Building)?;
                    let phase = self.phase("build");
                    let brick = match bricks.next(&farthest) {
                        Ok(brick) => brick,
                        Err(NoBrick::Done) if cones_are_left => {
                            cones_are_left = false;
                            bricks = TileBricks::of_cones(tiles, scene.cones(), scene.len() as u32);
                            continue;
                        }
                        Err(NoBrick::Done) => break,
                        Err(NoBrick::TooMany) => return Err(GpuError::Steps),
                    };
                    drop(phase);
                    made += 1;
                    several |= bricks.made() > 1 && cones_are_left == has_both;
                    if let (true, Some((frame, part))) = (traced.listed() + brick.spheres.len() > most_listed, &frame) {
                        traced.upload(self, (&layouts, &ids), &mut buffers).await?;
                        let renderer = renderers.of(device, options_of(several)).await?;
                        let (encoder, noted) = self.shading(renderer, &buffers, frame, part.band, &textures)?;
                        self.run_timed(encoder, noted, &[]).await?;
                        traced = traced.after();
                    }
                    tell(UploadStep::Copying)?;
                    let phase = self.phase("upload");
                    upload.brick(&brick).await?;
                    drop(phase);
                    buffers.bricks = upload.take_bricks();
                    if textures.are_shaded() {
                        traced.add(brick);
                    }
                    let renderer = renderers.of(device, options_of(several)).await?;
                    if frame.is_none() {
                        let mut new = Frame::new(renderer, device, &textures.targets()).await?;
                        new.set_bricks(queue, &buffers, &visible, view, tile, &primary);
                        let Some(part) = new.parts().next() else { break };
                        frame = Some((new, part));
                    }
                    let Some((frame, part)) = &mut frame else { break };
                    let part = BandBrick { is_first_of_band: number == 0, ..*part };
                    let mut left = vec![part.groups];
                    while let Some(groups) = Groups::take(&mut left, buffers.submission_size().groups()) {
                        frame.set_first_group(queue, part.slot, groups.first);
                        let (mut encoder, mut noted) = (self.encoder(), NotedPass::default());
                        let mut pass = begin_pass(&mut encoder, &mut noted, "trace");
                        renderer.record_trace(&mut pass, &buffers, frame, BandBrick { groups, ..part })?;
                        drop(pass);
                        self.submit_slice(encoder, noted, groups, &buffers, &[]).await?;
                        done.add(if number == 0 { groups } else { Groups::NONE }, watch)?;
                    }
                    if !bricks.may_go_on() && !cones_are_left {
                        break;
                    }
                    let Some(of_tiles) = buffers.bricks.first().and_then(|brick| brick.farthest.as_ref()) else {
                        break;
                    };
                    let mut encoder = self.encoder();
                    let read_back = ReadableBuffer::new(device, "pinhole tiles read-back", of_tiles.size());
                    read_back.record_copy(&mut encoder, of_tiles);
                    self.run(encoder, &[&read_back.buffer]).await?;
                    farthest = read_back.read(<[f32]>::to_vec)?;
                }
                let Some((frame, part)) = &frame else { continue };
                traced.upload(self, (&layouts, &ids), &mut buffers).await?;
                let renderer = renderers.of(device, options_of(several)).await?;
                let (mut encoder, noted) = self.shading(renderer, &buffers, frame, part.band, &textures)?;
                let mapped = textures.record_read_back(&mut encoder, frame, tile.size);
                self.run_timed(encoder, noted, &mapped).await?;
                let derived = DerivedLayers { view: *view, appearance: buffers.appearance() };
                textures.read_into(&mut image, tile, frame.traced_groups(part.slot), &derived)?;
            }
            done.add(last, watch)?;
            Ok(image)
        })
        .await
    }
}

/// Bricks that were traced and will be shaded by one pass.
#[derive(Default)]
struct Traced {
    all: Brick,
    bricks: usize,
    /// Number of shapes of the bricks before these.
    before: u32,
}

impl Traced {
    fn listed(&self) -> usize {
        self.all.spheres.len()
    }

    fn add(&mut self, brick: Brick) {
        self.all.index = Index::Tiles(TileLists::default());
        self.all.spheres.extend(brick.spheres);
        self.all.ids.extend(brick.ids);
        self.bricks += 1;
    }

    /// None of the bricks that come after these.
    fn after(self) -> Self {
        Self { before: self.before + self.listed() as u32, ..Self::default() }
    }

    /// Copies the bricks as one, unless the one that was traced last is the only one. Indices of shapes count those of
    /// all bricks, so that one pass shades these.
    async fn upload(
        &self,
        headless: &Headless,
        (layouts, ids): (&Renderer, &ShapeIds),
        buffers: &mut SceneBuffers,
    ) -> Result<(), GpuError> {
        if self.bricks > 1 {
            let space = BrickSpace { structure: Structure::Tiles, bounds: (buffers.space.min, buffers.space.max) };
            let (device, queue) = (headless.device(), headless.queue());
            buffers.bricks.clear();
            let upload = SceneUpload::new(layouts, device, queue, &buffers.summary, space, ids).await?;
            let mut upload = upload.after(self.before);
            upload.brick(&self.all).await?;
            buffers.bricks = upload.take_bricks();
        }
        Ok(())
    }
}
