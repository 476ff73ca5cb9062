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
        let Violation { pixel, stage, ref message, .. } = *violation;
        Self { pixel, stage, message: message.clone() }
    }
}
