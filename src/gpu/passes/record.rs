//! Recording a frame of primary rays.

use wgpu::{ComputePass, ComputePipeline};

use crate::accel::BrickKind;
use crate::camera::CameraKind;
use crate::gpu::error::GpuError;
use crate::gpu::passes::frame::{BandBrick, Frame, Slot};
use crate::gpu::passes::renderer::{PassKey, Renderer};
use crate::gpu::passes::tiles::Groups;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::BrickPass;

fn brick_pass(part: BandBrick) -> BrickPass {
    if part.is_first_of_band { BrickPass::First } else { BrickPass::Later }
}

impl Renderer {
    /// Records the frame's view of the scene into the caller's encoder, as one compute pass.
    ///
    /// Nothing is submitted, awaited or read back, and no resource of the device is created. The frame's targets contain
    /// the picture after the device has executed the encoder. They are overwritten completely.
    ///
    /// # Errors
    /// If the frame has no view of this scene, was made for other targets, or has a camera that this renderer was not
    /// built for; [`GpuError::NotReady`] if a pipeline is still being built. Nothing is recorded then.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneBuffers,
        frame: &Frame,
    ) -> Result<(), GpuError> {
        self.check_pipelines(scene, frame, |part| part)?;
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("pinhole"), timestamp_writes: None });
        for part in frame.parts() {
            self.record_trace(&mut pass, scene, frame, part)?;
            if part.is_last_of_band {
                self.record_shade(&mut pass, scene, frame, part.band)?;
            }
        }
        Ok(())
    }

    /// Moves the pipelines that [`Renderer::record`] needs for the frame to the front of the pipelines that
    /// [`Renderer::build_next`] builds. Returns the number of them that are not ready. On a native device, the frame
    /// can be recorded after this number of calls.
    ///
    /// # Errors
    /// If the frame has no view of this scene, or was made for other targets.
    pub fn build_first(&mut self, scene: &SceneBuffers, frame: &Frame) -> Result<usize, GpuError> {
        let camera = frame.view(self, scene)?.camera;
        let shades = scene.bricks.iter().map(|brick| brick.kind.primitive);
        let mut needed: Vec<_> = shades.map(|of| PassKey::Shade(camera, of)).collect();
        needed.extend(frame.parts().map(|part| {
            let kind = scene.bricks[part.brick].kind;
            PassKey::Trace(camera, kind, brick_pass(part))
        }));
        Ok(self.put_first(&needed))
    }

    /// Returns an error if the frame needs a pipeline that is missing, after `traced` has changed its parts.
    pub(crate) fn check_pipelines(
        &self,
        scene: &SceneBuffers,
        frame: &Frame,
        traced: impl Fn(BandBrick) -> BandBrick,
    ) -> Result<(), GpuError> {
        let camera = frame.view(self, scene)?.camera;
        for part in frame.parts().filter(|part| part.groups.count() > 0).map(traced) {
            self.trace_pipeline(camera, scene.bricks[part.brick].kind, part)?;
        }
        for brick in &scene.bricks {
            self.pipeline(PassKey::Shade(camera, brick.kind.primitive), brick.kind)?;
        }
        Ok(())
    }

    fn trace_pipeline(
        &self,
        camera: CameraKind,
        kind: BrickKind,
        part: BandBrick,
    ) -> Result<&ComputePipeline, GpuError> {
        self.pipeline(PassKey::Trace(camera, kind, brick_pass(part)), kind)
    }

    /// Records the tracing of a brick for a band or for a slice of one. The record of its slot must contain the
    /// first workgroup of the slice.
    pub(crate) fn record_trace(
        &self,
        pass: &mut ComputePass<'_>,
        scene: &SceneBuffers,
        frame: &Frame,
        part: BandBrick,
    ) -> Result<(), GpuError> {
        let camera = frame.view(self, scene)?.camera;
        if part.groups.count() == 0 {
            return Ok(());
        }
        let brick = &scene.bricks[part.brick];
        let pipeline = self.trace_pipeline(camera, brick.kind, part)?;
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, frame.group(part.slot), &[]);
        pass.set_bind_group(1, &brick.trace_group, &[]);
        pass.dispatch_workgroups(part.groups.size[0], part.groups.size[1], 1);
        Ok(())
    }

    /// Records the shading of a band whose hits are complete.
    pub(crate) fn record_shade(
        &self,
        pass: &mut ComputePass<'_>,
        scene: &SceneBuffers,
        frame: &Frame,
        band: usize,
    ) -> Result<(), GpuError> {
        let view = frame.view(self, scene)?;
        let camera = view.camera;
        let [width, height] = Groups::of_size(view.bands[band]).size;
        pass.set_bind_group(0, frame.group(Slot::of_scene(band)), &[]);
        pass.set_bind_group(2, frame.target_group(), &[]);
        let mut bound = None;
        for brick in &scene.bricks {
            let kind = brick.kind;
            if bound != Some(kind.primitive) {
                let shade = PassKey::Shade(camera, kind.primitive);
                let pipeline = self.pipeline(shade, kind)?;
                pass.set_pipeline(pipeline);
                bound = Some(kind.primitive);
            }
            pass.set_bind_group(1, &brick.surface_group, &[]);
            pass.dispatch_workgroups(width, height, 1);
        }
        Ok(())
    }
}
