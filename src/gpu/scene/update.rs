//! Updates of scenes on the library's own device.

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::plan::StructurePlans;
use crate::gpu::headless::progress::go_on;
use crate::gpu::resources::Make;
use crate::gpu::scene::recolor::Recolor;
use crate::gpu::scene::scene_buffers::SceneBuffers;
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
                let make = Make { device: self.device(), queue: self.queue() };
                let (mut encoder, mut names) = (self.encoder(), self.pass_names());
                let recorded = (&mut encoder, &mut names);
                recolor.record_noted(make, recorded, buffers, scene, update).await?;
                self.run_timed(encoder, names, &[]).await
            };
            return self.with_recolor(work).await;
        }
        let choice = buffers.structure().choice();
        let accel = self.plan_accel(scene, choice);
        let opaque =
            (loses_opacity || buffers.occluders.is_some()).then(|| scene.opaque()).flatten();
        let occluders = opaque.map(|opaque| self.plan_accel(&opaque, choice));
        let plans = StructurePlans { accel, occluders };
        let copy = self.upload_planned_async(scene, &plans, &mut go_on).await?;
        buffers.replace(copy);
        Ok(())
    }
}
