//! Starts the threads of the program before they are needed.

use std::num::NonZero;
use std::sync::OnceLock;
use std::thread::available_parallelism;

use crate::terminal::failure::Failure;
use crate::terminal::progress::tell;

/// The environment variable for the number of threads, which rayon reads.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// The most threads that are started for each processor. More are not faster, and starting thousands takes minutes.
const MOST_PER_PROCESSOR: usize = 8;

/// The most threads that are started on a machine with few processors.
const MOST_ON_FEW: usize = 64;

/// Starts the threads that work on spheres, rows and pixels, if they are not running. Otherwise rayon starts them later,
/// and panics if it cannot.
pub(crate) fn start() -> Result<(), Failure> {
    static STARTED: OnceLock<Result<(), String>> = OnceLock::new();
    let started = STARTED.get_or_init(|| {
        let wanted = std::env::var(VARIABLE).ok();
        let processors = available_parallelism().map_or(1, NonZero::get);
        let mut builder = rayon::ThreadPoolBuilder::new();
        if let Some(most) = wanted.as_deref().and_then(|wanted| lowered(wanted, processors)) {
            tell(format_args!(
                "note: {VARIABLE} is more than this machine can use; starting {most} threads for {processors} processors"
            ));
            builder = builder.num_threads(most);
        }
        builder.build_global().map_err(|error| error.to_string())
    });
    started.clone().map_err(|error| {
        Failure::Job(anyhow::anyhow!("threads cannot be started; set {VARIABLE} to a smaller number: {error}"))
    })
}

/// Returns the number of threads to start instead of the requested number, if that is far too large. Text that is not
/// a number is left to rayon, which then chooses by itself.
fn lowered(wanted: &str, processors: usize) -> Option<usize> {
    let most = (MOST_PER_PROCESSOR * processors).max(MOST_ON_FEW);
    let is_number = !wanted.is_empty() && wanted.bytes().all(|byte| byte.is_ascii_digit());
    // A number that does not fit counts as the largest.
    let wanted = wanted.parse::<usize>().unwrap_or(usize::MAX);
    (is_number && wanted > most).then_some(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_numbers_far_above_the_processors_are_lowered() {
        for wanted in ["", "0", "1", "64", "-5", "many", "1e9"] {
            assert_eq!(lowered(wanted, 2), None, "{wanted}");
        }
        for wanted in ["65", "5000", "100000", "99999999999999999999999"] {
            assert_eq!(lowered(wanted, 2), Some(64), "{wanted}");
        }
        assert_eq!((lowered("512", 64), lowered("513", 64)), (None, Some(512)));
    }
}
