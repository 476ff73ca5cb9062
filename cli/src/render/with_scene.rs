//! Work with a scene on a device: other structures after one fails, uploads, and the meaning of device errors.

use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, tell};
use crate::terminal::{interrupt, memory, profile};
use pinhole::accel::{AccelChoice, Structure};
use pinhole::gpu::{
    Decision, GpuError, Headless, RenderPlan, Retry, SceneBuffers, UploadProgress, UploadStep, Wait, with_retries,
};
use pinhole::scene::Scene;

/// Runs `work`, which must begin with [`upload`], with the planned structures for a choice, if they fit. If rays take
/// too many steps and the choice was automatic, prints a line and tries others. Returns the result of `work` and the
/// structure that was used. The inner errors are those of the device.
pub(crate) fn with_structures<T>(
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
    with_retries(choice, plan, retrying, async |plan: &RenderPlan| {
        if let Err(error) = plan.check(&headless.device().limits(), memory::available()) {
            return Ok(Err(error));
        }
        Ok(work(plan)?.map(|done| (done, plan.structure())))
    })
    .wait()
}

/// Builds the planned structures of a scene brick by brick, and copies each brick to the device.
pub(crate) fn upload(headless: &Headless, scene: &Scene, plan: &RenderPlan) -> Result<SceneBuffers, GpuError> {
    let name = plan.accel.structure.name();
    headless.upload_planned(scene, &plan.structures(), &mut |progress| watch_upload(name, progress)).wait()
}

/// Shows a step of the upload of a structure. While a brick is built, a signal ends the program at once.
pub(crate) fn watch_upload(name: &str, progress: &UploadProgress) -> Decision {
    let UploadProgress { step, brick, bricks, .. } = *progress;
    let place = if bricks > 1 { format!(", brick {} of {bricks}", brick + 1) } else { String::new() };
    let is_building = step == UploadStep::Building;
    interrupt::driver_rests(is_building);
    if is_building {
        progress::stage(format!("building: {name}{place}"));
    } else {
        progress::stage(format!("copying to the device{place}"));
    }
    interrupt::decide()
}

/// The library's name, in errors, for the table of emissive spheres.
const EMITTERS: &str = "the table of emissive spheres";

/// Turns an error of a device into a failure with the name of the adapter and advice.
pub(crate) fn explained(headless: &Headless, error: &GpuError) -> Failure {
    let remedy = match error {
        // The CPU reference would take hours for so many lights.
        GpuError::Limit { what: EMITTERS, .. } => {
            "; write light_sampling = \"chance\" into [path], which needs no table"
        }
        GpuError::Limit { .. } => "; use --backend cpu, which has no such limit",
        _ => "",
    };
    named(headless, error, remedy)
}

/// Like [`explained`], for commands that cannot use the CPU reference.
pub(crate) fn explained_alone(headless: &Headless, error: &GpuError) -> Failure {
    named(headless, error, "")
}

fn named(headless: &Headless, error: &GpuError, remedy: &str) -> Failure {
    let adapter = &headless.adapter_info().name;
    let remedy = match error {
        GpuError::DeviceLost { .. } | GpuError::Timeout { .. } => "; try again",
        _ => remedy,
    };
    of_kind(error, anyhow::anyhow!("{adapter}: {error}{remedy}"))
}

/// The failure with a message, of the kind that an error of a device is for the program.
fn of_kind(error: &GpuError, message: anyhow::Error) -> Failure {
    match error {
        GpuError::Stopped => Failure::Stopped,
        GpuError::DeviceLost { .. } | GpuError::Timeout { .. } => Failure::Device(message),
        _ => Failure::Job(message),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::ExitCode;
    use std::time::Duration;

    #[test]
    fn errors_after_which_another_try_may_succeed_have_a_code_of_their_own() {
        let code = |error: GpuError| {
            let failure = of_kind(&error, anyhow::anyhow!("{error}"));
            format!("{:?}", failure.exit_code())
        };
        let five = format!("{:?}", ExitCode::from(5));
        assert_eq!(code(GpuError::DeviceLost { message: "gone".to_owned() }), five);
        assert_eq!(code(GpuError::Timeout { waited: Duration::from_secs(600) }), five);
        let one = format!("{:?}", ExitCode::from(1));
        assert_eq!(code(GpuError::OutOfMemory), one);
        assert_eq!(code(GpuError::NoAdapter), one);
        assert!(matches!(of_kind(&GpuError::Stopped, anyhow::anyhow!("")), Failure::Stopped));
    }
}
