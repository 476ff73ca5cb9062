//! What an error of a device is for the program, and what may help.

use super::failure::Failure;
use pinhole::gpu::{GpuError, Headless};

/// What errors of the library call the table of emissive spheres.
const EMITTERS: &str = "the table of emissive spheres";

/// Turns an error of a device into a failure with the name of the adapter, and with what may help.
pub(super) fn explained(headless: &Headless, error: &GpuError) -> Failure {
    let remedy = match error {
        // The reference would take hours for so many lights.
        GpuError::Limit { what: EMITTERS, .. } => {
            "; write light_sampling = \"chance\" into [path], which needs no table"
        }
        GpuError::Limit { .. } => "; use --backend cpu, which has no such limit",
        _ => "",
    };
    named(headless, error, remedy)
}

/// Like [`explained`], for commands that cannot use the CPU reference.
pub(super) fn explained_alone(headless: &Headless, error: &GpuError) -> Failure {
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

/// The failure with a message that an error of a device is for the program.
fn of_kind(error: &GpuError, message: anyhow::Error) -> Failure {
    match error {
        GpuError::Stopped => Failure::Stopped,
        GpuError::DeviceLost { .. } | GpuError::Timeout { .. } => Failure::Device(message),
        _ => Failure::Job(message),
    }
}

#[cfg(test)]
mod tests {
    use std::process::ExitCode;
    use std::time::Duration;

    use super::*;

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
