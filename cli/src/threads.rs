//! Starts the threads of the program before they are needed.

use std::sync::OnceLock;

use super::failure::Failure;

/// Starts the threads that work on spheres, rows and pixels, if they are not running. Otherwise rayon starts them later,
/// and panics if it cannot.
pub(super) fn start() -> Result<(), Failure> {
    static STARTED: OnceLock<Result<(), String>> = OnceLock::new();
    let started = STARTED.get_or_init(|| {
        let threads = rayon::ThreadPoolBuilder::new().build_global();
        threads.map_err(|error| error.to_string())
    });
    started.clone().map_err(|error| {
        Failure::Job(anyhow::anyhow!(
            "threads cannot be started; set RAYON_NUM_THREADS to a smaller number: {error}"
        ))
    })
}
