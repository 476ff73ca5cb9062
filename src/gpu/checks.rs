//! Turns errors of a device into values. Error scopes catch errors around the creation of resources, so that none
//! reaches the error handler of the application that owns the device. wgpu reports other errors by callback.
//!
//! Nothing here blocks. A browser reports the error of a scope only later, so a scope is popped at once, and its answer
//! is awaited when everything has been created. Native devices answer at once.

use std::cell::RefCell;
use std::fmt;
use std::pin::Pin;
use std::sync::{Mutex, PoisonError};
use std::task::{Context, Poll, Waker};

use wgpu::{Device, ErrorFilter, WasmNotSend};

use crate::gpu::error::GpuError;

/// A future of the error that a scope has caught. It can be sent to other threads where wgpu's futures can.
trait CaughtError: Future<Output = Option<GpuError>> + WasmNotSend {}
impl<T: Future<Output = Option<GpuError>> + WasmNotSend> CaughtError for T {}

/// The result of creating something on the device, which may not be known yet.
pub(super) struct Check(Pin<Box<dyn CaughtError>>);

impl fmt::Debug for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Check").finish_non_exhaustive()
    }
}

impl Check {
    /// Runs `create` in error scopes.
    fn of<T>(device: &Device, create: impl FnOnce() -> T) -> (T, Self) {
        let filters = [ErrorFilter::OutOfMemory, ErrorFilter::Validation, ErrorFilter::Internal];
        let [memory, validation, internal] = filters.map(|filter| device.push_error_scope(filter));
        let created = create();
        // Scopes nest, so they are popped in reverse order.
        let (internal, validation, memory) = (internal.pop(), validation.pop(), memory.pop());
        let error = async move {
            // A resource without memory also causes validation errors wherever it is used, so the scope for memory is
            // reported first.
            let errors = [memory.await, validation.await, internal.await];
            errors.iter().flatten().next().map(GpuError::from_wgpu)
        };
        (created, Self(Box::pin(error)))
    }

    async fn passed(self) -> Result<(), GpuError> {
        self.0.await.map_or(Ok(()), Err)
    }

    /// Returns the answer if it is known, without waiting. It must not be called again after that.
    fn answer(&mut self) -> Option<Result<(), GpuError>> {
        match Future::poll(self.0.as_mut(), &mut Context::from_waker(Waker::noop())) {
            Poll::Ready(error) => Some(error.map_or(Ok(()), Err)),
            Poll::Pending => None,
        }
    }
}

/// The checks of several things that are created one after the other.
#[derive(Debug, Default)]
pub(super) struct Checks {
    pending: RefCell<Vec<Check>>,
}

impl Checks {
    /// Runs `create` in error scopes.
    pub(super) fn create<T>(&self, device: &Device, create: impl FnOnce() -> T) -> T {
        self.create_explained(device, create, |error| error)
    }

    /// Runs `create` in error scopes whose errors are changed by `explain`.
    pub(super) fn create_explained<T>(
        &self,
        device: &Device,
        create: impl FnOnce() -> T,
        explain: impl FnOnce(GpuError) -> GpuError + WasmNotSend + 'static,
    ) -> T {
        let (created, check) = Check::of(device, create);
        let explained = Box::pin(async move { check.0.await.map(explain) });
        self.pending.borrow_mut().push(Check(explained));
        created
    }

    /// Waits for the answers, and returns the first error in the order of creation.
    pub(super) async fn passed(self) -> Result<(), GpuError> {
        for check in self.pending.into_inner() {
            check.passed().await?;
        }
        Ok(())
    }

    /// Returns, without waiting, whether all answers are known, or the first error in the order of creation.
    pub(super) fn are_known(&mut self) -> Result<bool, GpuError> {
        let pending = self.pending.get_mut();
        while let Some(check) = pending.first_mut() {
            match check.answer() {
                None => return Ok(false),
                Some(answer) => {
                    pending.remove(0);
                    answer?;
                }
            }
        }
        Ok(true)
    }
}

/// Runs `create` in error scopes, and waits for the error that they caught, if any.
pub(super) async fn scoped<T>(device: &Device, create: impl FnOnce() -> T) -> Result<T, GpuError> {
    let (created, check) = Check::of(device, create);
    check.passed().await?;
    Ok(created)
}

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
