//! Copying scenes to the library's own device.

use std::borrow::Borrow;

use crate::accel::{Accel, Brick, Structure};
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::plan::{RenderPlan, StructurePlans};
use crate::gpu::headless::progress::{UploadProgress, UploadStep, UploadWatch, go_on};
use crate::gpu::headless::renderers::Renderers;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::gpu::scene::scene_upload::{BrickSource, SceneUpload};
use crate::gpu::scene::shape_ids::ShapeIds;
use crate::gpu::scene::structures::Structures;
use crate::scene::Scene;

impl RenderPlan {
    /// Returns the plans of the structures alone.
    #[must_use]
    pub fn structures(&self) -> StructurePlans {
        StructurePlans { accel: self.accel.clone(), occluders: self.occluders.clone() }
    }
}

impl Headless {
    /// Copies a scene to the device like [`Headless::upload`], without blocking the thread while the device works.
    ///
    /// # Errors
    /// The same as for [`Headless::upload`].
    pub async fn upload_async(
        &self,
        scene: &Scene,
        structures: &Structures,
    ) -> Result<SceneBuffers, GpuError> {
        let Structures { accel, occluders } = structures;
        let kinds = [accel].into_iter().chain(occluders).map(Accel::structure).collect();
        let watch: &mut UploadWatch<'_> = &mut go_on;
        self.alone(async |_: &mut Renderers| {
            let renderer = self.layouts_of(kinds).await?;
            let all = self.upload_all(&renderer, scene, accel.into(), watch).await?;
            let Some(accel) = occluders else {
                return Ok(all);
            };
            let some = self.upload_occluders(&renderer, scene, accel.into(), watch).await?;
            Ok(all.with_occluders(some))
        })
        .await
    }

    /// Builds the planned structures of a scene and copies them to the device like [`Headless::upload_planned`],
    /// without blocking the thread while the device works. The bricks are built by the thread that polls the future.
    ///
    /// # Errors
    /// The same as for [`Headless::upload_planned`].
    pub async fn upload_planned_async(
        &self,
        scene: &Scene,
        plans: &StructurePlans,
        watch: &mut UploadWatch<'_>,
    ) -> Result<SceneBuffers, GpuError> {
        let StructurePlans { accel, occluders } = plans;
        let planned = [accel].into_iter().chain(occluders).map(|plan| plan.structure);
        let kinds = planned.flat_map(|structure| [structure, structure.with_nested(true)]);
        let kinds: Vec<Structure> = kinds.collect();
        self.alone(async |_: &mut Renderers| {
            let renderer = self.layouts_of(kinds).await?;
            let phase = self.phase("divide");
            let bricks = accel.bricks(scene.spheres()).into();
            drop(phase);
            let all = self.upload_all(&renderer, scene, bricks, watch).await?;
            let Some((plan, opaque)) = occluders.as_ref().zip(scene.opaque()) else {
                return Ok(all);
            };
            let bricks = plan.bricks(opaque.spheres()).into();
            let some = self.upload_occluders(&renderer, scene, bricks, watch).await?;
            Ok(all.with_occluders(some))
        })
        .await
    }

    /// A renderer that only provides the bind group layouts of structures. Equal layouts of one device are compatible.
    pub(in crate::gpu) async fn layouts_of(
        &self,
        structures: Vec<Structure>,
    ) -> Result<Renderer, GpuError> {
        let cameras = Vec::new();
        let device_type = Some(self.info.device_type);
        let options =
            RendererOptions { cameras, structures, device_type, ..RendererOptions::default() };
        Renderer::new_async(self.device(), &options).await
    }

    async fn upload_all<B: Borrow<Brick>>(
        &self,
        renderer: &Renderer,
        scene: &Scene,
        bricks: BrickSource<impl ExactSizeIterator<Item = B>>,
        watch: &mut UploadWatch<'_>,
    ) -> Result<SceneBuffers, GpuError> {
        let ids = ShapeIds::of_all(scene, bricks.may_part_equals);
        self.upload_bricks(renderer, SceneSummary::of(scene), bricks, &ids, watch).await
    }

    async fn upload_occluders<B: Borrow<Brick>>(
        &self,
        renderer: &Renderer,
        scene: &Scene,
        bricks: BrickSource<impl ExactSizeIterator<Item = B>>,
        watch: &mut UploadWatch<'_>,
    ) -> Result<SceneBuffers, GpuError> {
        let (summary, ids) = (SceneSummary::of_occluders(scene), ShapeIds::of_opaque(scene));
        self.upload_bricks(renderer, summary, bricks, &ids, watch).await
    }

    /// Copies bricks one after the other, and waits for the copy of each, so that its memory is free for the next.
    async fn upload_bricks<B: Borrow<Brick>>(
        &self,
        renderer: &Renderer,
        summary: SceneSummary,
        bricks: BrickSource<impl ExactSizeIterator<Item = B>>,
        ids: &ShapeIds,
        watch: &mut UploadWatch<'_>,
    ) -> Result<SceneBuffers, GpuError> {
        let BrickSource { space, mut bricks, .. } = bricks;
        let (device, queue, total) = (self.device(), self.queue(), bricks.len());
        let mut upload = SceneUpload::new(renderer, device, queue, &summary, space, ids).await?;
        for number in 0..total {
            let mut tell = |step| UploadProgress { step, brick: number, bricks: total }.tell(watch);
            tell(UploadStep::Building)?;
            let phase = self.phase("build");
            let Some(brick) = bricks.next() else { break };
            drop(phase);
            tell(UploadStep::Copying)?;
            let _phase = self.phase("upload");
            upload.brick(brick.borrow()).await?;
            drop(brick);
            self.flush().await?;
        }
        Ok(SceneBuffers::new_of(upload.finish()?, summary, ids.exclude_by, renderer.shape))
    }
}
