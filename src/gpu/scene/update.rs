//! Updates of scenes on the library's own device.

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::plan::StructurePlans;
use crate::gpu::headless::progress::go_on;
use crate::gpu::scene::recolor::Recolor;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::scene::{Scene, SceneUpdate};

impl Headless {
    /// Applies an update like [`Headless::update`], without blocking the thread while the device works.
    ///
    /// # Errors
    /// The same as for [`Headless::update`].
    pub async fn update_async(
        &self,
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        // If the first sphere ceases to be opaque, a studio may need a separate structure of occluders.
        let loses_opacity =
            buffers.appearance().is_opaque() && !scene.checked_appearance().is_opaque();
        if buffers.takes_in_place(scene, update) && !loses_opacity {
            let work = async |recolor: &Recolor| {
                let queues = (self.device(), self.queue());
                let (mut encoder, mut times) = (self.encoder(), self.pass_times());
                let recorded = (&mut encoder, &mut times);
                recolor.record_timed(queues, recorded, buffers, scene, update).await?;
                self.run_timed(encoder, times, &[]).await
            };
            return self.with_recolor(work).await;
        }
        let choice = buffers.structure().choice();
        let accel = self.plan_accel(scene, choice);
        let opaque = (loses_opacity || buffers.has_occluders()).then(|| scene.opaque()).flatten();
        let occluders = opaque.map(|opaque| self.plan_accel(&opaque, choice));
        let plans = StructurePlans { accel, occluders };
        let copy = self.upload_planned_async(scene, &plans, &mut go_on).await?;
        buffers.replace(copy);
        Ok(())
    }
}
