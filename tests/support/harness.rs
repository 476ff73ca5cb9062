//! Helpers of tests on an adapter: one shared device, and trials that are ignored where no adapter is expected.

use std::sync::LazyLock;

use libtest_mimic::{Arguments, Completion, Failed, Trial};
use pinhole::gpu::{Headless, HeadlessOptions, Wait};

/// The device of all tests, which is opened, and printed, only once.
static HEADLESS: LazyLock<Result<Headless, String>> =
    LazyLock::new(|| Headless::open(&HeadlessOptions::default()).wait().map_err(|error| error.to_string()));

pub(crate) fn headless() -> Result<&'static Headless, Failed> {
    HEADLESS.as_ref().map_err(|error| {
        Failed::from(format!("{error}; without a GPU install mesa-vulkan-drivers, or set PINHOLE_NO_GPU_TESTS=1"))
    })
}

/// Makes a trial of a plain function.
pub(crate) fn trial(name: &str, test: fn(&'static Headless)) -> Trial {
    Trial::test(name, move || {
        test(headless()?);
        Ok(())
    })
}

/// Makes a trial for some adapters or systems. If `lacking` gives a reason, nothing runs, and the trial counts as
/// ignored.
pub(crate) fn trial_unless(
    name: impl Into<String>,
    lacking: fn(&'static Headless) -> Option<String>,
    test: impl FnOnce(&'static Headless) -> Result<(), Failed> + Send + 'static,
) -> Trial {
    Trial::ignorable_test(name, move || {
        let headless = headless()?;
        if let Some(reason) = lacking(headless) {
            return Ok(Completion::ignored_with(reason));
        }
        test(headless).map(|()| Completion::Completed)
    })
}

/// Runs trials and ends the program.
pub(crate) fn run(trials: impl FnOnce() -> Vec<Trial>) -> ! {
    let arguments = Arguments::from_args();
    let without_gpu = std::env::var_os("PINHOLE_NO_GPU_TESTS").is_some_and(|value| value != "0");
    if without_gpu && !arguments.list {
        println!("\nPINHOLE_NO_GPU_TESTS is set: tests on an adapter count as ignored");
    } else if !arguments.list {
        match &*HEADLESS {
            Ok(headless) => {
                let info = headless.adapter_info();
                println!("\nadapter: {} ({:?}), driver: {} {}", info.name, info.backend, info.driver, info.driver_info);
            }
            Err(error) => println!("\nadapter: none, {error}"),
        }
    }
    let trials = trials().into_iter().map(|trial| trial.with_ignored_flag(without_gpu)).collect();
    libtest_mimic::run(&arguments, trials).exit()
}
