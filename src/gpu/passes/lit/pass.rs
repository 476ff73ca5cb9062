//! One kernel of lit pictures, and how it is recorded.

use wgpu::{
    BindGroup, BindGroupLayout, Buffer, CommandEncoder, ComputePassDescriptor, ComputePipeline,
    Device,
};

use crate::gpu::edit::ShaderEdit;
use crate::gpu::error::GpuError;
use crate::gpu::shader::Kernel;
use crate::gpu::shader::pipeline;

/// A kernel, ready to be recorded into any encoder of its device.
#[derive(Debug)]
pub(in crate::gpu) struct Pass {
    pipeline: ComputePipeline,
}

/// What a pass is bound to.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct Bound<'a> {
    /// Group 0: the frame, the lists, the paths and what the dispatch does.
    pub(super) frame: &'a BindGroup,
    /// The offset of the dispatch's parameters.
    pub(super) dispatch: u32,
    /// Group 1: a brick.
    pub(super) brick: Option<&'a BindGroup>,
    /// Group 2: lights and materials.
    pub(super) lighting: &'a BindGroup,
    /// Group 3: an image of the sky.
    pub(super) sky: Option<&'a BindGroup>,
}

/// How many workgroups a dispatch has.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) enum Extent<'a> {
    /// So many along each axis.
    Groups([u32; 3]),
    /// As many as a buffer says, from a place in bytes on.
    Indirect(&'a Buffer, u64),
}

impl Pass {
    /// Builds the pipeline, with its groups in their order.
    pub(super) fn new(
        device: &Device,
        kernel: Kernel,
        groups: &[&BindGroupLayout],
        edits: &[ShaderEdit],
    ) -> Result<Self, GpuError> {
        Ok(Self { pipeline: pipeline(device, &kernel.edited(edits)?, groups)? })
    }

    /// Records one dispatch. Nothing is submitted.
    pub(super) fn record(
        &self,
        encoder: &mut CommandEncoder,
        bound: Bound<'_>,
        extent: Extent<'_>,
    ) {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("pinhole"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bound.frame, &[bound.dispatch]);
        if let Some(brick) = bound.brick {
            pass.set_bind_group(1, brick, &[]);
            pass.set_bind_group(2, bound.lighting, &[]);
            if let Some(sky) = bound.sky {
                pass.set_bind_group(3, sky, &[]);
            }
        }
        match extent {
            Extent::Groups([x, y, z]) => pass.dispatch_workgroups(x, y, z),
            Extent::Indirect(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, offset),
        }
    }
}
