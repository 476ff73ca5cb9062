//! Builds the acceleration structures of a scene, and runs work with them on a device.

use super::failure::Failure;
use super::speak::tell;
use super::{memory, profile, progress};
use pinhole::accel::{AccelChoice, Structure};
use pinhole::gpu::{GpuError, Headless, RenderPlan, Retry, Structures, with_retries};
use pinhole::scene::Scene;

/// Builds the structures that `plan` gives for a choice, if they fit, and runs `work` with them. If rays take too many
/// steps in the structures and the choice was automatic, tells the user and tries again with others. Returns the result
/// of `work` and the structure that was used. The inner errors are those of the device.
pub(super) fn with_structures<T>(
    headless: &Headless,
    scene: &Scene,
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> RenderPlan,
    work: impl Fn(Structures) -> Result<Result<T, GpuError>, Failure>,
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
        progress::stage(format!("building: {}", plan.accel.structure.name()));
        let phase = profile::phase("build");
        let structures = plan.build(scene);
        drop(phase);
        progress::stage("copying to the device");
        Ok(work(structures)?.map(|done| (done, plan.accel.structure)))
    })
}
