//! Rendering one picture of a scene in several bricks. Each brick is built, copied to the device, traced and dropped
//! before the next, and what the picture does not show is never built.

use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::View;
use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::derived::Derived;
use crate::gpu::headless::hidden_bricks::SeenPixels;
use crate::gpu::headless::plan::RenderPlan;
use crate::gpu::headless::primary::begin_pass;
use crate::gpu::headless::progress::{
    Picture, TracedPixels, UploadProgress, UploadStep, UploadWatch, Watch,
};
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::headless::renderers::{RendererKey, Renderers};
use crate::gpu::headless::tile_textures::TileTextures;
use crate::gpu::headless::uploading::KeyOf;
use crate::gpu::passes::bands::rows_per_band;
use crate::gpu::passes::frame::{BandBrick, Frame};
use crate::gpu::passes::tiles::{Groups, Tile};
use crate::gpu::passes::visible_bricks::{VisibleBricks, space_of};
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::gpu::scene::scene_upload::{BrickSource, SceneUpload, UploadedBricks};
use crate::gpu::scene::shape_ids::ShapeIds;
use crate::gpu::shader::records::Hit;
use crate::image::{Image, LayerSet};
use crate::render::RenderSettings;
use crate::scene::Scene;

/// Is told the hit of each pixel that was traced, by its index in the picture.
pub(in crate::gpu) type KeepHit<'a> = dyn FnMut(usize, &Hit) + 'a;

impl Headless {
    /// Builds the planned structures of a scene and renders one picture, like [`Headless::upload_planned`] and
    /// [`Headless::render_uploaded`], which call the two callbacks.
    ///
    /// If a picture by primary rays is a single tile and the scene has several bricks, each brick is traced as soon as
    /// it is on the device, and dropped. Bricks that the picture does not show are not built.
    ///
    /// # Errors
    /// The same as for [`Headless::upload_planned`] and [`Headless::render_uploaded`].
    pub async fn render_planned_async(
        &self,
        scene: &Scene,
        plan: &RenderPlan,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        (upload_watch, watch): (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<Picture, GpuError> {
        if self.drops_bricks(plan, view, settings) {
            let watches = (upload_watch, watch);
            let image = self.render_by_brick(scene, plan, view, settings, layers, watches, None);
            return Ok(Picture { image: image.await?, samples: 1, noise: None, hits: None });
        }
        let key_of = |kind: BrickKind, several_bricks: bool| {
            RendererKey::of_picture(vec![kind], several_bricks, view.camera, layers)
        };
        let key_of: Option<&KeyOf<'_>> =
            if settings.integrator.is_primary() { Some(&key_of) } else { None };
        let plans = plan.structures();
        let buffers = self.upload_ahead_of(scene, &plans, upload_watch, key_of).await?;
        self.render_uploaded_async(&buffers, view, settings, layers, watch).await
    }

    /// Whether the hits of the whole picture are in one buffer, so that no brick is needed twice, and there is a choice
    /// of bricks.
    fn drops_bricks(&self, plan: &RenderPlan, view: &View<'_>, settings: &RenderSettings) -> bool {
        let size = [view.film.width(), view.film.height()];
        settings.integrator.is_primary()
            && plan.accel.brick_count > 1
            && plan.accel.structure != Structure::List
            && plan.tile_size == size
            && rows_per_band(&self.device().limits(), size, false) == size[1]
    }

    /// Renders a picture whose hits are in one buffer. Copies the hits of the pixels that were traced to `traced`, by
    /// their indices in the picture.
    #[expect(
        clippy::too_many_arguments,
        reason = "a picture has a scene, a plan, a view and settings"
    )]
    pub(in crate::gpu) async fn render_by_brick(
        &self,
        scene: &Scene,
        plan: &RenderPlan,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        (upload_watch, watch): (&mut UploadWatch<'_>, &mut Watch<'_>),
        mut traced: Option<&mut KeepHit<'_>>,
    ) -> Result<Image, GpuError> {
        let data_layers = layers != LayerSet::COLOR;
        let (device, queue, film) = (self.device(), self.queue(), &view.film);
        let device_type = self.info.device_type;
        let size = [film.width(), film.height()];
        let tile = Tile { origin: [0, 0], size, in_target: [0, 0] };
        let phase = self.phase("divide");
        let BrickSource { space: brick_space, mut bricks, .. } =
            BrickSource::from(plan.accel.bricks(scene.spheres()));
        let boxes = bricks.boxes();
        drop(phase);
        // The nearest of equal spheres has the smallest id in every brick, so the ids of the input do.
        let ids = ShapeIds::of_all(scene, false);
        let summary = SceneSummary::of(scene);
        let no_bricks = UploadedBricks { space: brick_space, bricks: Vec::new(), bytes: 0 };
        let kinds = [false, true].map(|nested| brick_space.structure.with_nested(nested));
        self.alone(async |renderers: &mut Renderers| {
            let layouts = self.layouts_of(kinds.to_vec()).await?;
            let mut upload =
                SceneUpload::new(&layouts, device, queue, &summary, brick_space, &ids).await?;
            let mut scene = SceneBuffers::new_of(no_bricks, summary, ids.exclude_by, self.shape());
            let primary = scene.primary_settings(settings)?;
            let visible = VisibleBricks::of(view, &scene.space, &boxes);
            let textures = scoped(device, || TileTextures::new(device, size, data_layers)).await?;
            let key = |structure| RendererKey {
                kinds: vec![BrickKind { structure, primitive: Primitive::Sphere }],
                data_layers,
                several_bricks: true,
                ..RendererKey::new(&scene, view.camera)
            };
            let keys = kinds.map(key);
            let first = renderers.of(device, device_type, keys[0].clone()).await?;
            let mut frame = Frame::new_async(first, device, &textures.targets()).await?;
            let seen_buffer = scoped(device, || {
                ReadableBuffer::new(device, "pinhole hits read-back", frame.traced().0.size())
            })
            .await?;
            frame.set_bricks(queue, &scene, &visible, view, tile, &primary);
            let parts: Vec<BandBrick> = frame.parts().collect();
            bricks.keep(&parts.iter().map(|part| part.brick).collect::<Vec<_>>());
            let mut done = TracedPixels::of(parts.iter().map(|part| part.groups.pixels()).sum());
            let mut seen: Option<SeenPixels> = None;
            for (number, part) in parts.iter().enumerate() {
                let region = frame.traced_groups(part.slot);
                let own = space_of(&scene.space, &boxes[part.brick]);
                if let (Some(seen), Some(own)) = (&seen, &own)
                    && seen.hide(view, own, region)
                {
                    bricks.leave_out();
                    done.add(part.groups, watch)?;
                    continue;
                }
                let mut tell = |step| {
                    UploadProgress { step, brick: number, bricks: parts.len() }.tell(upload_watch)
                };
                tell(UploadStep::Building)?;
                let phase = self.phase("build");
                let Some(brick) = bricks.next() else { break };
                drop(phase);
                tell(UploadStep::Copying)?;
                let phase = self.phase("upload");
                upload.brick(&brick).await?;
                for work in upload.take_work() {
                    self.start(work);
                }
                self.flush().await?;
                drop(phase);
                let key = keys[usize::from(brick.is_nested())].clone();
                drop(brick);
                scene.set_bricks(upload.take_bricks());
                let renderer = renderers.of(device, device_type, key).await?;
                let mut left = vec![part.groups];
                while let Some(groups) = Groups::take(&mut left, scene.submission_size().groups()) {
                    frame.set_first_group(queue, part.slot, groups.first);
                    let (mut encoder, mut names) = (self.encoder(), self.pass_names());
                    let mut pass = begin_pass(&mut encoder, &mut names, "trace");
                    let slice = BandBrick { groups, brick: 0, ..*part };
                    renderer.record_trace(&mut pass, &scene, &frame, slice)?;
                    drop(pass);
                    self.submit_slice(encoder, names, groups, &scene, &[]).await?;
                    done.add(groups, watch)?;
                }
                // What a later brick hides will be shaded again.
                let (mut encoder, mut names) = (self.encoder(), self.pass_names());
                let mut pass = begin_pass(&mut encoder, &mut names, "shade");
                renderer.record_shade(&mut pass, &scene, &frame, part.band)?;
                drop(pass);
                if number + 1 == parts.len() {
                    self.run_timed(encoder, names, &[]).await?;
                    break;
                }
                seen_buffer.record_copy(&mut encoder, frame.traced().0);
                self.run_timed(encoder, names, &[&seen_buffer.buffer]).await?;
                seen = Some(seen_buffer.read(|hits| SeenPixels::new(size, hits))?);
            }
            if let (Some(traced), Some(first)) = (&mut traced, parts.first()) {
                let mut encoder = self.encoder();
                seen_buffer.record_copy(&mut encoder, frame.traced().0);
                self.run(encoder, &[&seen_buffer.buffer]).await?;
                seen_buffer.read(|hits: &[Hit]| {
                    let groups = frame.traced_groups(first.slot);
                    groups.indices(size).for_each(|at| traced(at, &hits[at]));
                })?;
            }
            let mut encoder = self.encoder();
            let mapped = textures.record_read_back(&mut encoder, &frame, size);
            self.run(encoder, &mapped).await?;
            let mut image = Image::new(film.width(), film.height(), layers)?;
            let derived = Derived { view: *view, appearance: scene.appearance() };
            textures.read_into(&mut image, tile, &derived)?;
            // Where nothing is traced, the picture is complete only now.
            done.add(Groups::NONE, watch)?;
            Ok(image)
        })
        .await
    }
}
