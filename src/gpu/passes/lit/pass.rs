//! A pass of lit pictures: the pipeline of a kernel, and recording its dispatches.

use wgpu::{
    BindGroup, BindGroupLayout, Buffer, CommandEncoder, ComputePassDescriptor, ComputePipeline,
    Device,
};

use crate::gpu::checks::Checks;
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
use crate::gpu::profile::PassNames;
use crate::gpu::shader::Kernel;
use crate::gpu::shader::pipeline;

/// The pipeline of a kernel, which can be recorded into any encoder of its device.
#[derive(Debug)]
pub(in crate::gpu) struct Pass {
    /// The name of the entry point.
    name: &'static str,
    pipeline: ComputePipeline,
}

/// The bind groups of a dispatch.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct Bound<'a> {
    /// Bind group 0: the frame, the lists, the paths and the parameters of the dispatch.
    pub(super) frame: &'a BindGroup,
    /// Offset of the parameters of the dispatch in bytes.
    pub(super) dispatch: u32,
    /// Bind group 1: a brick.
    pub(super) brick: Option<&'a BindGroup>,
    /// Bind group 2: lights and materials.
    pub(super) lighting: &'a BindGroup,
    /// Bind group 3: the image of the sky, or the appearance of the shapes of the brick.
    pub(super) last: Option<&'a BindGroup>,
}

/// The number of workgroups of a dispatch.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) enum Extent<'a> {
    /// The numbers of workgroups along the three axes.
    Groups([u32; 3]),
    /// An indirect dispatch, which reads the numbers from a buffer at an offset in bytes.
    Indirect(&'a Buffer, u64),
}

impl Pass {
    /// Builds the pipeline. `groups` are the layouts of its bind groups, in order. Whether the device accepts it is
    /// known when the checks have passed.
    pub(super) fn new(
        device: &Device,
        kernel: Kernel,
        groups: &[&BindGroupLayout],
        edits: &Edits,
        checks: &Checks,
    ) -> Result<Self, GpuError> {
        let name = kernel.entry_point;
        Ok(Self { name, pipeline: pipeline(device, &kernel.edited(edits)?, groups, checks) })
    }

    /// Records one dispatch, and notes its name. Nothing is submitted.
    pub(super) fn record(
        &self,
        encoder: &mut CommandEncoder,
        bound: Bound<'_>,
        extent: Extent<'_>,
        names: &mut PassNames,
    ) {
        names.note(self.name);
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("pinhole"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bound.frame, &[bound.dispatch]);
        if let Some(brick) = bound.brick {
            pass.set_bind_group(1, brick, &[]);
            pass.set_bind_group(2, bound.lighting, &[]);
            if let Some(last) = bound.last {
                pass.set_bind_group(3, last, &[]);
            }
        }
        match extent {
            Extent::Groups([x, y, z]) => pass.dispatch_workgroups(x, y, z),
            Extent::Indirect(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, offset),
        }
    }
}
