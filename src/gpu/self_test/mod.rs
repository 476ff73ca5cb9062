//! The self-test, which tests whether the arithmetic of a device has the properties that the error bounds of the
//! checker assume. WGSL leaves devices some freedom, and some devices take more.
//!
//! Kernels compute results, and the host judges them in f64. The judging code needs no device, and its tests insert
//! faults.

#![expect(clippy::float_cmp, reason = "the self-test compares numbers for equality")]

mod cones;
#[cfg(test)]
mod fault_tests;
pub(super) mod fence_probe;
mod loops;
pub(super) mod records;
mod report;
mod rounding;
mod run;

pub use report::{PropertyOutcome, SelfTestExtent, SelfTestReport, TestedProperty};
pub(super) use run::SelfTestRun;
