//! Whether a device computes as bounds of errors assume: WGSL leaves devices freedom, and some take more.
//!
//! Kernels compute and the host judges, in f64; what judges needs no device, and its tests plant faults.

#![expect(clippy::float_cmp, reason = "whether numbers are equal is what is asked")]

mod exactness;
#[cfg(test)]
mod fault_tests;
mod float;
mod inputs;
mod loops;
pub(super) mod records;
mod report;
mod rounding;
mod run;

pub use report::{PropertyOutcome, SelfTestExtent, SelfTestReport, TestedProperty};
pub(super) use run::SelfTestRun;
