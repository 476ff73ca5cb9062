//! The quick part of the self-test of an adapter, which runs before a render.

use crate::render::with_scene::explained_alone;
use crate::terminal::failure::Failure;
use pinhole::gpu::{GpuError, Headless, SelfTestExtent, SelfTestReport, Wait};

pub(crate) fn failure(adapter: &str, report: &SelfTestReport) -> Option<String> {
    let failure = report.first_failure()?;
    Some(format!("{adapter} fails the self-test ({failure})"))
}

/// Runs the quick part of the test. Returns a warning if the pictures of the adapter may be wrong.
///
/// # Errors
/// Returns an error if the device was lost or does not answer, which means that it cannot render either.
pub(crate) fn quick_warning(headless: &Headless) -> Result<Option<String>, Failure> {
    match headless.self_test(SelfTestExtent::Quick).wait() {
        Err(error @ (GpuError::DeviceLost { .. } | GpuError::Timeout { .. })) => Err(explained_alone(headless, &error)),
        tested => Ok(warning(&headless.adapter_info().name, tested)),
    }
}

fn warning(adapter: &str, tested: Result<SelfTestReport, GpuError>) -> Option<String> {
    let failure = match tested {
        Ok(report) => failure(adapter, &report)?,
        // The render may still succeed; if not, it reports the error again.
        Err(error) => format!("{adapter} cannot run the self-test ({error})"),
    };
    Some(format!("warning: {failure}; check its pictures with `pinhole verify`"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pinhole::gpu::{PropertyOutcome, TestedProperty};

    #[test]
    fn a_warning_names_adapter_and_property() {
        let report = |outcome| {
            let words = "the words".to_owned();
            SelfTestReport::new(vec![TestedProperty { name: "fence", outcome, words, figures: vec![] }])
        };
        for good in [PropertyOutcome::Passed, PropertyOutcome::Noted] {
            assert_eq!(warning("some", Ok(report(good))), None);
        }
        assert_eq!(
            warning("some", Ok(report(PropertyOutcome::Failed))).unwrap(),
            "warning: some fails the self-test (fence: the words); check its pictures with `pinhole verify`"
        );
        let failed = warning("some", Err(GpuError::OutOfMemory));
        assert!(failed.unwrap().contains("cannot run the self-test"));
    }
}
