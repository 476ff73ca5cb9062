//! Tests that need an adapter; Mesa's lavapipe is enough.
//!
//! No adapter is a failure. If `PINHOLE_NO_GPU_TESTS=1`, this run is the half without a GPU, and
//! every test here counts as ignored.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

#[path = "../support/mod.rs"]
mod support;

mod agreement;
mod appearance;
mod compute;
mod device;
mod embedding;
mod faults;
mod lens;
mod light;
mod light_program;
mod parts;
mod paths;
mod pictures;
mod plan;
mod program;
mod scenes;
mod self_test;
mod structures;
mod twin;
mod update;
mod verify;
mod verify_program;
mod verify_views;

use std::sync::LazyLock;

use libtest_mimic::{Arguments, Failed, Trial};
use pinhole::gpu::{Headless, HeadlessOptions};

/// One device for all tests, so that it is opened, and printed, once.
static HEADLESS: LazyLock<Result<Headless, String>> = LazyLock::new(|| {
    Headless::open(&HeadlessOptions::default()).map_err(|error| error.to_string())
});

fn headless() -> Result<&'static Headless, Failed> {
    HEADLESS.as_ref().map_err(|error| {
        Failed::from(format!(
            "{error}; without a GPU install mesa-vulkan-drivers, or set PINHOLE_NO_GPU_TESTS=1"
        ))
    })
}

fn main() {
    let arguments = Arguments::from_args();
    let without_gpu = std::env::var_os("PINHOLE_NO_GPU_TESTS").is_some_and(|value| value != "0");
    if !without_gpu && !arguments.list {
        match &*HEADLESS {
            Ok(headless) => {
                let info = headless.adapter_info();
                println!(
                    "\nadapter: {} ({:?}), driver: {} {}",
                    info.name, info.backend, info.driver, info.driver_info
                );
            }
            Err(error) => println!("\nadapter: none, {error}"),
        }
    }
    let groups = [
        agreement::trials(),
        appearance::trials(),
        lens::trials(),
        light::trials(),
        light_program::trials(),
        pictures::trials(),
        parts::trials(),
        paths::trials(),
        embedding::trials(),
        device::trials(),
        program::trials(),
        structures::trials(),
        plan::trials(),
        self_test::trials(),
        twin::trials(),
        update::trials(),
        verify::trials(),
        verify_program::trials(),
    ];
    let trials =
        groups.into_iter().flatten().map(|trial| trial.with_ignored_flag(without_gpu)).collect();
    libtest_mimic::run(&arguments, trials).exit();
}

/// A trial from a plain function.
fn trial(name: &str, test: fn(&'static Headless)) -> Trial {
    Trial::test(name, move || {
        test(headless()?);
        Ok(())
    })
}
