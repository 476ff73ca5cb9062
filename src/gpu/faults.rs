//! Errors that wgpu reports by callback, outside of any call.

use std::sync::{Mutex, PoisonError};

use crate::gpu::error::GpuError;

/// Errors that wgpu reported by callback.
#[derive(Debug, Default)]
pub(super) struct Faults {
    first: Mutex<Option<GpuError>>,
}

impl Faults {
    /// Stores a fault, unless an earlier one is stored. The loss of the device replaces all others, because it is their
    /// cause.
    pub(super) fn report(&self, fault: GpuError) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() || matches!(fault, GpuError::DeviceLost { .. }) {
            *first = Some(fault);
        }
    }

    /// Removes the fault of an earlier render or of the caller's own commands, unless it is the loss of the device.
    pub(super) fn forget(&self) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        first.take_if(|fault| !matches!(fault, GpuError::DeviceLost { .. }));
    }

    pub(super) fn check(&self) -> Result<(), GpuError> {
        match self.first.lock().unwrap_or_else(PoisonError::into_inner).clone() {
            Some(fault) => Err(fault),
            None => Ok(()),
        }
    }
}
