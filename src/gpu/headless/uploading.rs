//! Copying scenes to the library's own device, and updating them there.

use std::borrow::Borrow;

use crate::accel::{Accel, Brick, BrickKind, Primitive, Structure};
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::plan::{RenderPlan, StructurePlans};
use crate::gpu::headless::progress::{UploadProgress, UploadStep, UploadWatch, go_on};
use crate::gpu::headless::renderers::Renderers;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::profile::NotedPass;
use crate::gpu::resources::Make;
use crate::gpu::scene::recolor::Recolor;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::scene_buffers::has_several;
use crate::gpu::scene::scene_summary::{SceneSummary, ShapeIds};
use crate::gpu::scene::scene_upload::{BrickSource, SceneUpload, bricks_of};
use crate::gpu::scene::structures::Structures;
use crate::scene::{Scene, SceneUpdate};

/// Returns the options of the renderer that a picture needs for bricks of a kind, and for several bricks if `true`.
pub(crate) type OptionsOf<'a> = dyn Fn(&[BrickKind], bool) -> RendererOptions + 'a;

/// Callback with the kinds of bricks that have been built, and whether there are several of a kind.
type WhenBuilt<'a> = dyn FnMut(&[BrickKind], bool) + 'a;

impl RenderPlan {
    /// Returns the plans of the structures alone.
    #[must_use]
    pub fn structures(&self) -> StructurePlans {
        StructurePlans { accel: self.accel.clone(), occluders: self.occluders.clone() }
    }
}

impl Headless {
    /// Copies a scene to the device, brick by brick, with the structures that were built for it. They come from
    /// [`RenderPlan::build`](crate::gpu::RenderPlan::build), or from a single [`Accel`](crate::accel::Accel).
    ///
    /// # Errors
    /// If the scene does not fit into the device's memory or limits, or if the device fails.
    pub async fn upload(&self, scene: &Scene, structures: &Structures) -> Result<SceneBuffers, GpuError> {
        let Structures { accel, occluders } = structures;
        let kinds = [accel].into_iter().chain(occluders).map(Accel::structure).collect();
        let watch: &mut UploadWatch<'_> = &mut go_on;
        self.alone(async |_: &mut Renderers| {
            let bricks = [accel].into_iter().chain(occluders).flat_map(Accel::bricks);
            let of_cones = bricks.filter(|brick| brick.primitive == Primitive::Cone);
            let renderer = self.layouts_of(kinds, of_cones.map(|brick| brick.kind().structure).collect()).await?;
            let all = self.upload_bricks(&renderer, scene, false, accel.into(), watch, &mut |_, _| {}).await?;
            let Some(accel) = occluders else {
                return Ok(all);
            };
            let some = self.upload_bricks(&renderer, scene, true, accel.into(), watch, &mut |_, _| {}).await?;
            Ok(all.with_occluders(some))
        })
        .await
    }

    /// Builds the planned structures of a scene and copies them to the device, brick by brick. Each brick is dropped
    /// before the next is built, so that this needs less memory than [`Headless::upload`]. `watch` is called before each
    /// step. The plans come from [`RenderPlan::structures`](crate::gpu::RenderPlan::structures).
    ///
    /// # Errors
    /// If the scene does not fit into the device's memory or limits, or if the device fails; [`GpuError::Stopped`] if
    /// `watch` stops the copy.
    pub async fn upload_planned(
        &self,
        scene: &Scene,
        plans: &StructurePlans,
        watch: &mut UploadWatch<'_>,
    ) -> Result<SceneBuffers, GpuError> {
        self.upload_ahead_of(scene, plans, watch, None).await
    }

    /// Like [`Headless::upload_planned`], but also builds the renderer of the picture that follows. `options_of`
    /// returns its options. A thread builds it while the last brick is copied, because copying leaves other cores idle.
    pub(crate) async fn upload_ahead_of(
        &self,
        scene: &Scene,
        plans: &StructurePlans,
        watch: &mut UploadWatch<'_>,
        options_of: Option<&OptionsOf<'_>>,
    ) -> Result<SceneBuffers, GpuError> {
        let StructurePlans { accel, occluders } = plans;
        let both = |planned: Structure| [planned, planned.with_nested(true)];
        let structures: Vec<Structure> =
            [accel].into_iter().chain(occluders).flat_map(|plan| both(plan.structure)).collect();
        let of_cones = [accel].into_iter().chain(occluders).filter_map(|plan| plan.cones);
        let of_cones: Vec<Structure> = of_cones.flat_map(|cones| both(cones.structure)).collect();
        self.alone(async |renderers: &mut Renderers| {
            let renderer = self.layouts_of(structures, of_cones).await?;
            let phase = self.phase("divide");
            let bricks = bricks_of(accel, scene).into();
            drop(phase);
            let mut begin = |kinds: &[BrickKind], several_bricks: bool| {
                if let Some(options_of) = options_of {
                    self.begin_renderer(renderers, options_of(kinds, several_bricks));
                }
            };
            let all = self.upload_bricks(&renderer, scene, false, bricks, watch, &mut begin).await?;
            let Some((plan, opaque)) = occluders.as_ref().zip(scene.opaque()) else {
                return Ok(all);
            };
            let bricks = bricks_of(plan, &opaque).into();
            let some = self.upload_bricks(&renderer, scene, true, bricks, watch, &mut |_, _| {}).await?;
            Ok(all.with_occluders(some))
        })
        .await
    }

    /// Applies an update to a scene on this device. The update must already have been applied to the host's scene with
    /// [`Scene::apply`].
    ///
    /// If only colours change, they are written to the existing buffers. If spheres move or change their radius, a
    /// new structure of the same kind is built on the host and copied to the device. The views of frames that show
    /// the scene must then be set again with [`Frame::set_view`](crate::gpu::Frame::set_view).
    /// `docs/dev/notebook-2026-11.md` lists the cost of both.
    ///
    /// # Errors
    /// If the scene does not fit on the device, or if the device fails. The scene must then be uploaded again.
    pub async fn update(
        &self,
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        // If the first sphere ceases to be opaque, a studio may need a separate structure of occluders.
        let loses_opacity = buffers.appearance().is_opaque() && !scene.checked_appearance().is_opaque();
        if buffers.takes_in_place(scene, update) && !loses_opacity {
            let work = async |_: &mut Renderers| {
                let recolor = self.recolor.of((), Recolor::new(&self.device)).await?;
                let make = Make { device: &self.device, queue: &self.queue };
                let (mut encoder, mut noted) = (self.encoder(), NotedPass::default());
                let recorded = (&mut encoder, &mut noted);
                recolor.record_noted(make, recorded, buffers, scene, update).await?;
                self.run_timed(encoder, noted, &[]).await
            };
            return self.alone(work).await;
        }
        let choice = buffers.structure().choice();
        let accel = self.plan_accel(scene, choice);
        let opaque = (loses_opacity || buffers.occluders.is_some()).then(|| scene.opaque()).flatten();
        let occluders = opaque.map(|opaque| self.plan_accel(&opaque, choice));
        let plans = StructurePlans { accel, occluders };
        let copy = self.upload_planned(scene, &plans, &mut go_on).await?;
        buffers.replace(copy);
        Ok(())
    }

    /// A renderer that only provides the bind group layouts of structures. Equal layouts of one device are compatible.
    pub(crate) async fn layouts_of(
        &self,
        structures: Vec<Structure>,
        cone_structures: Vec<Structure>,
    ) -> Result<Renderer, GpuError> {
        let cameras = Vec::new();
        let device_type = Some(self.info.device_type);
        let options =
            RendererOptions { cameras, structures, cone_structures, device_type, ..RendererOptions::default() };
        Renderer::new(self.device(), &options).await
    }

    /// Begins to build a renderer on a thread. A browser builds it later.
    pub(crate) fn begin_renderer(&self, renderers: &mut Renderers, options: RendererOptions) {
        #[cfg(not(target_arch = "wasm32"))]
        {
            renderers.begin(self.device(), options, self.options.profile.clone());
        }
        #[cfg(target_arch = "wasm32")]
        let _ = (renderers, options);
    }

    /// Copies bricks of all spheres, or of the spheres that cast shadows, one after the other. Waits for the copy of
    /// each, so that its memory is free for the next. Calls `built` once all are built, before the last is copied.
    async fn upload_bricks<B: Borrow<Brick>>(
        &self,
        renderer: &Renderer,
        scene: &Scene,
        cast_shadows: bool,
        bricks: BrickSource<impl ExactSizeIterator<Item = B>>,
        watch: &mut UploadWatch<'_>,
        built: &mut WhenBuilt<'_>,
    ) -> Result<SceneBuffers, GpuError> {
        let BrickSource { space, may_split_duplicates, mut bricks } = bricks;
        let (summary, ids) = if cast_shadows {
            (SceneSummary::of_occluders(scene), ShapeIds::of_opaque(scene))
        } else {
            (SceneSummary::of(scene), ShapeIds::of_all(scene, may_split_duplicates))
        };
        let (device, queue, total) = (self.device(), self.queue(), bricks.len());
        let mut upload = SceneUpload::new(renderer, device, queue, &summary, space, &ids).await?;
        let mut kinds = Vec::new();
        for number in 0..total {
            let mut tell = |step| UploadProgress { step, brick: number, bricks: total }.tell(watch);
            tell(UploadStep::Building)?;
            let phase = self.phase("build");
            let Some(brick) = bricks.next() else { break };
            drop(phase);
            kinds.push(brick.borrow().kind());
            if number + 1 == total {
                let searched: Vec<BrickKind> = kinds.iter().map(|kind| kind.among(&kinds)).collect();
                built(&searched, has_several(&searched));
            }
            tell(UploadStep::Copying)?;
            let _phase = self.phase("upload");
            upload.brick(brick.borrow()).await?;
            drop(brick);
            for work in upload.take_work() {
                self.start(work);
            }
            self.flush().await?;
        }
        Ok(SceneBuffers::new_of(upload.finish()?, summary, ids.exclude_by, renderer.shape))
    }
}
