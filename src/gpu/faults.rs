//! What goes wrong on a device outside any call of ours.

use std::sync::{Mutex, PoisonError};

use crate::gpu::error::GpuError;

/// What wgpu reported outside any call.
#[derive(Debug, Default)]
pub(super) struct Faults {
    first: Mutex<Option<GpuError>>,
}

impl Faults {
    /// Keeps the first fault, unless this one explains it: what follows a lost device is noise.
    pub(super) fn report(&self, fault: GpuError) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() || matches!(fault, GpuError::DeviceLost { .. }) {
            *first = Some(fault);
        }
    }

    /// Forgets what an earlier render or the caller's own commands met; a lost device stays lost.
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
