//! Plans the acceleration structures of a scene, builds them on their way to a device, and runs work with them.

use super::failure::Failure;
use super::speak::tell;
use super::{interrupt, memory, profile, progress};
use pinhole::accel::{AccelChoice, Structure};
use pinhole::gpu::{
    Decision, GpuError, Headless, RenderPlan, Retry, SceneBuffers, UploadProgress, UploadStep,
    with_retries,
};
use pinhole::scene::Scene;

/// Runs `work` with the plan of the structures for a choice, if they fit; the work begins with [`upload`]. If rays take too many
/// steps in the structures and the choice was automatic, tells the user and tries again with others. Returns the result
/// of `work` and the structure that was used. The inner errors are those of the device.
pub(super) fn with_structures<T>(
    headless: &Headless,
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> RenderPlan,
    work: impl Fn(&RenderPlan) -> Result<Result<T, GpuError>, Failure>,
) -> Result<Result<(T, Structure), GpuError>, Failure> {
    let plan = |choice| {
        progress::stage("planning");
        let _phase = profile::phase("plan");
        plan(choice)
    };
    let retrying = |Retry { failed, next }| {
        tell(format_args!(
            "note: rays take more steps in the {} than this device allows; trying the structure `{next}`, \
             which takes longer; to use it at once, add --accel {next}",
            failed.name()
        ));
    };
    with_retries(choice, plan, retrying, |plan| {
        if let Err(error) = plan.check(&headless.device().limits(), memory::available()) {
            return Ok(Err(error));
        }
        Ok(work(plan)?.map(|done| (done, plan.accel.structure)))
    })
}

/// Builds the planned structures of a scene brick by brick, and copies each brick to the device.
pub(super) fn upload(
    headless: &Headless,
    scene: &Scene,
    plan: &RenderPlan,
) -> Result<SceneBuffers, GpuError> {
    let name = plan.accel.structure.name();
    headless.upload_planned(scene, &plan.structures(), &mut |progress| watch_upload(name, progress))
}

/// Shows a step of the upload of a structure. While a brick is built, a signal ends the program at once.
pub(super) fn watch_upload(name: &str, progress: &UploadProgress) -> Decision {
    let UploadProgress { step, brick, bricks, .. } = *progress;
    let place =
        if bricks > 1 { format!(", brick {} of {bricks}", brick + 1) } else { String::new() };
    let is_building = step == UploadStep::Building;
    interrupt::driver_rests(is_building);
    if is_building {
        progress::stage(format!("building: {name}{place}"));
    } else {
        progress::stage(format!("copying to the device{place}"));
    }
    interrupt::decide()
}
