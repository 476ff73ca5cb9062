//! The violations that a report of `pinhole verify` lists.

use serde::Serialize;

use pinhole::verify::Violation;

/// The largest number of violations in the JSON document.
pub(super) const LISTED: usize = 100;

/// A violation with its message.
#[derive(Serialize)]
pub(super) struct Listed {
    pub(super) pixel: [u32; 2],
    pub(super) stage: &'static str,
    pub(super) message: String,
}

impl From<&Violation> for Listed {
    fn from(violation: &Violation) -> Self {
        Self { pixel: violation.pixel, stage: violation.stage, message: violation.message.clone() }
    }
}
