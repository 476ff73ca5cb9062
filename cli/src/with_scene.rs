//! A scene on a device, in the structures that suit it, and work with it.

use super::failure::Failure;
use super::speak::tell;
use super::{memory, progress};
use pinhole::accel::{AccelChoice, Structure};
use pinhole::gpu::{GpuError, Headless, RenderPlan, Retry, Structures, with_retries};
use pinhole::scene::Scene;

/// Builds what `plan` says of a choice, as long as it fits, and does some work with it. Where rays take too many steps
/// in the structures, and the choice was free, it is done once more with others, and said. The result comes with the
/// structure in which it was done; the errors within are the device's.
pub(super) fn with_structures<T>(
    headless: &Headless,
    scene: &Scene,
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> RenderPlan,
    work: impl Fn(Structures) -> Result<Result<T, GpuError>, Failure>,
) -> Result<Result<(T, Structure), GpuError>, Failure> {
    let plan = |choice| {
        progress::stage("planning");
        plan(choice)
    };
    let retrying = |Retry { failed, next }| {
        tell(format_args!(
            "note: rays take more steps in the {} than this device may loop for; \
             trying the structure `{next}`, which takes longer",
            failed.name()
        ));
    };
    with_retries(choice, plan, retrying, |plan| {
        if let Err(error) = plan.check(&headless.device().limits(), memory::available()) {
            return Ok(Err(error));
        }
        progress::stage(format!("building: {}", plan.accel.structure.name()));
        let structures = plan.build(scene);
        progress::stage("copying to the device");
        Ok(work(structures)?.map(|done| (done, plan.accel.structure)))
    })
}
