//! Starts the threads of the program before they are needed.

use anyhow::Context;

use super::failure::Failure;

/// Starts the threads that work on spheres, rows and pixels. Otherwise rayon starts them later, and panics if it
/// cannot.
pub(super) fn start() -> Result<(), Failure> {
    let threads = rayon::ThreadPoolBuilder::new().build_global();
    Ok(threads.context("threads cannot be started; set RAYON_NUM_THREADS to a smaller number")?)
}
