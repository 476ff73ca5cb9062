//! Stands for the recording of a scene in a program that cannot use adapters.

use std::path::Path;

use super::recorded::Recorded;
use crate::args::VerifyArgs;
use crate::failure::Failure;

/// Refuses to record.
pub(super) fn recorded(_: &Path, _: &VerifyArgs) -> Result<Recorded, Failure> {
    Err(Failure::usage(
        "this program was built without the feature `gpu`, so it can only check recordings: \
         `pinhole verify --replay RUN`",
    ))
}
