//! Copying the bricks of a scene to a device, one after the other.

use std::sync::Arc;

use glam::Vec3;
use wgpu::{Buffer, CommandEncoder, Device, Queue};

use crate::accel::{Accel, Brick, BrickKind, Bricks, Primitive, Structure};
use crate::gpu::checks::scoped;
use crate::gpu::error::{GpuError, check_storage_size};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::scene::appearance;
use crate::gpu::scene::brick_buffers::{BrickBuffers, BrickContents, Upload};
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::gpu::scene::shape_ids::ShapeIds;

/// What all bricks of a scene have in common.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct BrickSpace {
    /// The planned structure. Grids of some bricks may be nested nevertheless.
    pub(in crate::gpu) structure: Structure,
    /// The inflated box of the scene.
    pub(in crate::gpu) bounds: (Vec3, Vec3),
}

/// The bricks of a scene that are to be copied. Each may be built when it is asked for.
pub(in crate::gpu) struct BrickSource<I> {
    pub(in crate::gpu) space: BrickSpace,
    pub(in crate::gpu) may_part_equals: bool,
    pub(in crate::gpu) bricks: I,
}

impl<'a> From<&'a Accel> for BrickSource<std::slice::Iter<'a, Brick>> {
    fn from(accel: &'a Accel) -> Self {
        let space = BrickSpace { structure: accel.structure(), bounds: accel.bounds() };
        let may_part_equals = accel.may_part_equals();
        Self { space, may_part_equals, bricks: accel.bricks().iter() }
    }
}

impl<'a> From<Bricks<'a>> for BrickSource<Bricks<'a>> {
    fn from(bricks: Bricks<'a>) -> Self {
        let space = BrickSpace { structure: bricks.structure(), bounds: bricks.bounds() };
        Self { space, may_part_equals: bricks.may_part_equals(), bricks }
    }
}

/// The state of copying the bricks of a scene to a device.
pub(in crate::gpu) struct SceneUpload<'a> {
    upload: Upload<'a>,
    palette: Buffer,
    ids: &'a ShapeIds,
    space: BrickSpace,
    bricks: Vec<BrickBuffers>,
}

/// The bricks of a scene on a device.
#[derive(Debug)]
pub(in crate::gpu) struct UploadedBricks {
    /// The structure is that of the bricks.
    pub(in crate::gpu) space: BrickSpace,
    pub(in crate::gpu) bricks: Vec<BrickBuffers>,
    pub(in crate::gpu) bytes: u64,
}

impl UploadedBricks {
    /// No bricks.
    pub(in crate::gpu) fn none(space: BrickSpace) -> Self {
        Self { space, bricks: Vec::new(), bytes: 0 }
    }
}

impl<'a> SceneUpload<'a> {
    pub(in crate::gpu) async fn new(
        renderer: &'a Renderer,
        device: &'a Device,
        queue: &'a Queue,
        summary: &SceneSummary,
        space: BrickSpace,
        ids: &'a ShapeIds,
    ) -> Result<Self, GpuError> {
        let appearance = Arc::clone(&summary.appearance);
        let palette = appearance::palette(&appearance);
        let (first_shape, bytes, work) = (0, 0, Vec::new());
        let mut upload = Upload { renderer, device, queue, appearance, first_shape, bytes, work };
        check_storage_size(device, "the palette", size_of_val(&palette[..]) as u64)?;
        let palette = scoped(device, || upload.storage("pinhole palette", &palette)).await?;
        Ok(Self { upload, palette, ids, space, bricks: Vec::new() })
    }

    /// Queues the copy of a brick. The brick can be dropped afterwards.
    pub(in crate::gpu) async fn brick(&mut self, brick: &Brick) -> Result<(), GpuError> {
        let ids = self.ids.of(&brick.ids);
        let structure = self.space.structure.with_nested(brick.is_nested());
        let kind = BrickKind { structure, primitive: Primitive::Sphere };
        let contents = BrickContents::of_spheres(brick, &ids, kind);
        self.bricks.push(self.upload.brick(&contents, &self.palette).await?);
        Ok(())
    }

    /// Returns the work since the last call that has to be submitted before the bricks are searched.
    pub(in crate::gpu) fn take_work(&mut self) -> Vec<CommandEncoder> {
        std::mem::take(&mut self.upload.work)
    }

    /// Returns the bricks since the last call, each of which is searched as what it is.
    pub(in crate::gpu) fn take_bricks(&mut self) -> Vec<BrickBuffers> {
        std::mem::take(&mut self.bricks)
    }

    /// Returns the bricks, which are all searched as nested grids if any of them is one.
    ///
    /// # Errors
    /// [`GpuError::NoStructure`] if the renderer was not built for the structure.
    pub(in crate::gpu) fn finish(self) -> Result<UploadedBricks, GpuError> {
        let Self { upload, mut bricks, mut space, .. } = self;
        let is_nested =
            |brick: &BrickBuffers| matches!(brick.kind.structure, Structure::NestedGrid);
        space.structure = space.structure.with_nested(bricks.iter().any(is_nested));
        for brick in &mut bricks {
            brick.kind.structure = space.structure;
            upload.renderer.layouts.brick_of(brick.kind)?;
        }
        Ok(UploadedBricks { space, bricks, bytes: upload.bytes })
    }
}
