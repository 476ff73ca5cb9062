//! Scenes that change on a device of our own.

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::structures::Structures;
use crate::scene::{Scene, SceneUpdate};

impl Headless {
    /// Brings a scene on this device up to date with an update that the host's scene has been given with
    /// [`Scene::apply`].
    ///
    /// Colours alone are written into the buffers that there are. Where spheres move or grow, the structure is built
    /// anew on the host, of the same kind as before, and copied to the device; frames that show the scene then need
    /// [`Frame::set_view`](crate::gpu::Frame::set_view). `docs/performance.md` says what both cost.
    ///
    /// # Errors
    /// If it does not fit the device, or if the device fails; then the scene on the device is to be uploaded again.
    pub fn update(
        &self,
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        // A studio may want what casts shadows where that is no longer all.
        let is_first_clear =
            buffers.appearance().is_opaque() && !scene.checked_appearance().is_opaque();
        if buffers.takes_in_place(scene, update) && !is_first_clear {
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
        let opaque = (is_first_clear || buffers.has_occluders()).then(|| scene.opaque()).flatten();
        let occluders =
            opaque.map(|opaque| self.plan_accel(&opaque, choice).build(opaque.spheres()));
        let copy = self.upload(scene, &Structures { accel, occluders })?;
        buffers.replace(copy);
        Ok(())
    }
}
