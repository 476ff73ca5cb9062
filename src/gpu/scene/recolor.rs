//! Changing the colours of spheres on a device in place.

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroupLayout, Buffer, BufferUsages, CommandEncoder, ComputePipeline, Device, Queue};

use crate::gpu::checks::Checks;
use crate::gpu::error::GpuError;
use crate::gpu::profile::NotedPass;
use crate::gpu::resources::{Make, numbered_group};
use crate::gpu::scene::appearance::color_words;
use crate::gpu::scene::scene_buffers::{SceneBuffers, binding_limit};
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::gpu::scene::scene_upload::BrickBuffers;
use crate::gpu::shader::layouts::{layout, searched, storage, uniform};
use crate::gpu::shader::textures::Searched;
use crate::gpu::shader::{Kernel, pipeline};
use crate::scene::material::{Material, SurfaceProperties};
use crate::scene::{Colors, Scene, SceneUpdate};

/// Uniform record of a dispatch: the ids of the spheres that are updated, and the number of shapes of the brick.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct RecolorRange {
    pub(crate) first: u32,
    pub(crate) count: u32,
    pub(crate) shape_count: u32,
    pub(crate) zero: u32,
}

/// Maximum number of workgroups in a row of a dispatch. Every WebGPU device allows at least 65,535.
const ROW: u32 = 1 << 15;

/// The pass that writes new colours. One is enough for a device.
#[derive(Debug)]
pub struct Recolor {
    layout: BindGroupLayout,
    pipeline: ComputePipeline,
}

pub(crate) fn recolor_kernel() -> Kernel {
    Kernel::new("recolor", &[])
}

impl Recolor {
    /// Builds the pipeline on a device that the caller owns.
    ///
    /// # Errors
    /// If the device rejects the kernel, which is a defect of this crate or of the driver.
    pub async fn new(device: &Device) -> Result<Self, GpuError> {
        let [read, written] = [true, false].map(storage::<u32>);
        let kinds = [uniform::<RecolorRange>(), read, searched(device, Searched::Ids), written];
        let checks = Checks::default();
        let layout = checks.create(device, || layout(device, "pinhole recolor", &kinds));
        let pipeline = pipeline(device, &recolor_kernel(), &[&layout], &checks);
        checks.passed().await?;
        Ok(Self { layout, pipeline })
    }

    /// Records the new colours of an update into the caller's encoder. The update must already have been applied to
    /// `scene` with [`Scene::apply`]. No buffer is replaced, so bind groups and the views of frames stay valid.
    ///
    /// The new colours are queued on `queue`. They take effect for commands that follow in the encoder or are submitted
    /// later.
    ///
    /// # Errors
    /// [`GpuError::NotInPlace`] if [`SceneBuffers::takes_in_place`] returns `false`; an error if the device has no
    /// memory left.
    pub async fn record(
        &self,
        device: &Device,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        let (make, noted) = (Make { device, queue }, &mut NotedPass::default());
        self.record_noted(make, (encoder, noted), buffers, scene, update).await
    }

    /// Records the new colours like [`Recolor::record`], and notes the pass.
    pub(crate) async fn record_noted(
        &self,
        make: Make<'_>,
        (encoder, noted): (&mut CommandEncoder, &mut NotedPass),
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        if !buffers.takes_in_place(scene, update) {
            return Err(GpuError::NotInPlace);
        }
        // The words of this number of spheres, with four bytes each, fit into a binding.
        let max_count = u32::try_from(binding_limit(&make.device.limits()) / 4).unwrap_or(u32::MAX);
        let range = update.range();
        let checks = Checks::default();
        for first in range.clone().step_by(max_count as usize) {
            let ids = first..range.end.min(first.saturating_add(max_count));
            let words = color_words(scene.appearance().colors(), ids);
            checks.create(make.device, || {
                self.record_range(make, (encoder, noted), buffers, first, &words);
            });
        }
        checks.passed().await?;
        buffers.set_summary(SceneSummary::of(scene));
        Ok(())
    }

    fn record_range(
        &self,
        make: Make<'_>,
        (encoder, noted): (&mut CommandEncoder, &mut NotedPass),
        buffers: &SceneBuffers,
        first: u32,
        words: &[u32],
    ) {
        let label = "pinhole recolor";
        let new_words = make.filled(label, bytemuck::cast_slice(words), BufferUsages::STORAGE);
        for brick in &buffers.bricks {
            let BrickBuffers { ids, appearances, shape_count, .. } = brick;
            let (count, shape_count) = (words.len() as u32, *shape_count);
            let record = RecolorRange { first, count, shape_count, zero: 0 };
            let range = make.filled(label, bytemuck::bytes_of(&record), BufferUsages::UNIFORM);
            let [range, new_words, appearances] = [&range, &new_words, appearances].map(Buffer::as_entire_binding);
            let bound = [range, new_words, ids.binding(), appearances];
            let group = numbered_group(make.device, label, &self.layout, bound);
            noted.note("recolor");
            let mut pass =
                encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &group, &[]);
            let groups = shape_count.div_ceil(64);
            pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
        }
    }
}

impl SceneBuffers {
    /// Returns whether [`Recolor`] can apply an update to these buffers. It can if no sphere moves or changes its
    /// radius, unless a colour affects more than the look of its sphere. This is the case if glass absorbs light
    /// according to its colour, or if spheres become opaque or cease to be opaque in a scene that was planned for a
    /// studio.
    #[must_use]
    pub fn takes_in_place(&self, scene: &Scene, update: &SceneUpdate<'_>) -> bool {
        let absorbs = |surface: &SurfaceProperties| {
            matches!(surface.material, Material::Dielectric { attenuation_distance: Some(_), .. })
        };
        let (before, after) = (self.appearance(), scene.appearance());
        let is_same_kind = match (before.colors(), after.colors()) {
            (Colors::Palette { palette, .. }, Colors::Palette { palette: other, .. }) => palette == other,
            (Colors::Scalars { map, .. }, Colors::Scalars { map: other, .. }) => map == other,
            (before, after) => std::mem::discriminant(before) == std::mem::discriminant(after),
        };
        let is_opaque = |alpha: f32| alpha >= 1.0;
        let hides_the_same = || update.range().all(|id| is_opaque(before.alpha(id)) == is_opaque(after.alpha(id)));
        !update.changes_shape()
            && is_same_kind
            && before.sphere_count() == scene.len()
            && before.surfaces() == after.surfaces()
            && !after.surfaces().iter().any(absorbs)
            && (self.occluders.is_none() || hides_the_same())
    }
}
