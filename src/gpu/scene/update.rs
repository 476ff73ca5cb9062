//! Updates of scenes on the library's own device.

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::structures::Structures;
use crate::scene::{Scene, SceneUpdate};

impl Headless {
    /// Applies an update to a scene on this device. The update must already have been applied to the host's scene with
    /// [`Scene::apply`].
    ///
    /// If only colours change, they are written to the existing buffers. If spheres move or change their radius, a new
    /// structure of the same kind is built on the host and copied to the device; the views of frames that show the
    /// scene must then be set again with [`Frame::set_view`](crate::gpu::Frame::set_view). `docs/performance.md` lists
    /// the cost of both.
    ///
    /// # Errors
    /// If the scene does not fit on the device, or if the device fails. The scene must then be uploaded again.
    pub fn update(
        &self,
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        // If the first sphere ceases to be opaque, a studio may need a separate structure of occluders.
        let loses_opacity =
            buffers.appearance().is_opaque() && !scene.checked_appearance().is_opaque();
        if buffers.takes_in_place(scene, update) && !loses_opacity {
            return self.with_recolor(|recolor| {
                let mut encoder = self.encoder();
                recolor.record(
                    self.device(),
                    self.queue(),
                    &mut encoder,
                    buffers,
                    scene,
                    update,
                )?;
                self.run(encoder, &[])
            });
        }
        let choice = buffers.structure().choice();
        let accel = self.plan_accel(scene, choice).build(scene.spheres());
        let opaque = (loses_opacity || buffers.has_occluders()).then(|| scene.opaque()).flatten();
        let occluders =
            opaque.map(|opaque| self.plan_accel(&opaque, choice).build(opaque.spheres()));
        let copy = self.upload(scene, &Structures { accel, occluders })?;
        buffers.replace(copy);
        Ok(())
    }
}
