//! Threads, started before anything needs them.

use anyhow::Context;

use super::failure::Failure;

/// Starts the threads of spheres, rows and pixels. Left to itself, rayon panics where they cannot be had.
pub(super) fn start() -> Result<(), Failure> {
    let threads = rayon::ThreadPoolBuilder::new().build_global();
    Ok(threads.context("threads cannot be started; set RAYON_NUM_THREADS to fewer")?)
}
