//! Waiting for a device, for callbacks and for turns, by futures.

#[cfg(not(target_arch = "wasm32"))]
use std::cell::Cell;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, Waker};
use std::time::Duration;

use wgpu::{Device, Queue, SubmissionIndex};

use crate::gpu::error::GpuError;

#[cfg(not(target_arch = "wasm32"))]
pub(crate) use std::time::Instant;
#[cfg(target_arch = "wasm32")]
pub(crate) use web_time::Instant;

#[cfg(not(target_arch = "wasm32"))]
thread_local! {
    /// Whether this thread polls a device.
    static POLLS: Cell<bool> = const { Cell::new(false) };
    /// Whether this thread runs a future by [`Wait::wait`].
    static MAY_BLOCK: Cell<bool> = const { Cell::new(false) };
}

/// Returns true if this thread is in a call of wgpu whose panics are caught and become errors.
///
/// Wgpu panics when a device is lost while the library waits for it; the library then returns [`GpuError::DeviceLost`].
/// A program whose panic hook prints nothing while this is true reports the loss only once.
#[cfg(not(target_arch = "wasm32"))]
#[must_use]
pub fn catches_panics() -> bool {
    POLLS.get()
}

/// Polls a device. If it is lost, its callback has been called when this returns an error.
#[cfg(not(target_arch = "wasm32"))]
fn poll(device: &Device, how: wgpu::PollType, timeout: Duration) -> Result<(), GpuError> {
    // Wgpu panics after it has left all of its locks.
    let polling = std::panic::AssertUnwindSafe(|| device.poll(how));
    // A callback may poll as well.
    let before = POLLS.replace(true);
    let polled = std::panic::catch_unwind(polling);
    POLLS.set(before);
    match polled {
        Ok(Ok(_)) => Ok(()),
        Ok(Err(wgpu::PollError::Timeout)) => Err(GpuError::Timeout { waited: timeout }),
        Ok(Err(error)) => Err(GpuError::Device { message: error.to_string() }),
        Err(panic) => {
            let text = panic.downcast_ref::<&str>().copied();
            let text = panic.downcast_ref::<String>().map(String::as_str).or(text);
            let message = text.unwrap_or("wgpu panicked");
            Err(GpuError::Device { message: message.to_owned() })
        }
    }
}

/// Blocking until a future is done. Browsers cannot block, so this does not exist for `wasm32`.
#[cfg(not(target_arch = "wasm32"))]
pub trait Wait: Future + Sized {
    /// Blocks the thread until the future is done, and returns its result. Only here does waiting for a device block
    /// the thread; elsewhere, the future returns to its caller meanwhile.
    fn wait(self) -> Self::Output {
        /// Restores the previous value, also if the future panics.
        struct Before(bool);
        impl Drop for Before {
            fn drop(&mut self) {
                MAY_BLOCK.set(self.0);
            }
        }
        let _before = Before(MAY_BLOCK.replace(true));
        pollster::block_on(self)
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl<T: Future> Wait for T {}

/// Lets the device call the callbacks of events that have already happened.
pub(crate) fn call_back(device: &Device) {
    #[cfg(not(target_arch = "wasm32"))]
    let _ = poll(device, wgpu::PollType::Poll, Duration::ZERO);
    #[cfg(target_arch = "wasm32")]
    let _ = device.poll(wgpu::PollType::Poll);
}

/// Waits until the device has finished a submission.
///
/// A native device calls no callback unless some thread waits for it. If this thread must not block, another one waits.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) async fn until_done(
    device: &Device,
    _: &Queue,
    submission: SubmissionIndex,
    timeout: Duration,
) -> Result<(), GpuError> {
    let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(timeout) };
    if MAY_BLOCK.get() {
        return poll(device, wait, timeout);
    }
    let (answer, to_answer) = answer();
    let (waiting, how) = (device.clone(), wait.clone());
    let thread = std::thread::Builder::new().name("pinhole: wait".to_owned());
    match thread.spawn(move || to_answer.give(poll(&waiting, how, timeout))) {
        Ok(_) => answer.await,
        // The system cannot start another thread.
        Err(_) => poll(device, wait, timeout),
    }
}

/// Waits until the device has finished everything that was submitted. The browser waits as long as it takes.
#[cfg(target_arch = "wasm32")]
pub(crate) async fn until_done(_: &Device, queue: &Queue, _: SubmissionIndex, _: Duration) -> Result<(), GpuError> {
    let (answer, to_answer) = answer();
    queue.on_submitted_work_done(move || to_answer.give(()));
    answer.await;
    Ok(())
}

/// Returns a future, and the place where a callback gives its result.
pub(crate) fn answer<T>() -> (Answer<T>, ToAnswer<T>) {
    let shared = Arc::new(Mutex::new(AnswerState { given: None, waker: None }));
    (Answer(Arc::clone(&shared)), ToAnswer(shared))
}

/// A result that a callback will give.
#[derive(Debug)]
pub(crate) struct Answer<T>(Arc<Mutex<AnswerState<T>>>);

/// The place where a callback gives a result.
#[derive(Debug)]
pub(crate) struct ToAnswer<T>(Arc<Mutex<AnswerState<T>>>);

#[derive(Debug)]
struct AnswerState<T> {
    given: Option<T>,
    waker: Option<Waker>,
}

impl<T> ToAnswer<T> {
    pub(crate) fn give(self, result: T) {
        let waker = {
            let mut shared = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            shared.given = Some(result);
            shared.waker.take()
        };
        if let Some(waker) = waker {
            waker.wake();
        }
    }
}

impl<T> Answer<T> {
    /// Returns the result if it has been given, without waiting.
    pub(crate) fn known(self) -> Option<T> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).given.take()
    }
}

impl<T> Future for Answer<T> {
    type Output = T;

    fn poll(self: std::pin::Pin<&mut Self>, context: &mut Context<'_>) -> Poll<T> {
        let mut shared = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match shared.given.take() {
            Some(result) => Poll::Ready(result),
            None => {
                shared.waker = Some(context.waker().clone());
                Poll::Pending
            }
        }
    }
}

/// A value that one task at a time uses; others wait for their turn. Unlike a guard of [`Mutex`], a turn may last
/// while a future waits.
#[derive(Debug, Default)]
pub(crate) struct Turns<T> {
    shared: Mutex<Place<T>>,
}

#[derive(Debug, Default)]
struct Place<T> {
    value: T,
    is_taken: bool,
    waiting: Vec<Waker>,
}

/// The turn of a task, which ends when this is dropped.
#[derive(Debug)]
pub(crate) struct Turn<'a, T: Default> {
    turns: &'a Turns<T>,
    pub(crate) value: T,
}

impl<T: Default> Turns<T> {
    /// Waits until no other task uses the value.
    pub(crate) async fn turn(&self) -> Turn<'_, T> {
        std::future::poll_fn(|context| {
            let mut place = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
            if place.is_taken {
                place.waiting.push(context.waker().clone());
                return Poll::Pending;
            }
            place.is_taken = true;
            Poll::Ready(Turn { turns: self, value: std::mem::take(&mut place.value) })
        })
        .await
    }
}

impl<T: Default> Drop for Turn<'_, T> {
    fn drop(&mut self) {
        let waiting = {
            let mut place = self.turns.shared.lock().unwrap_or_else(PoisonError::into_inner);
            place.value = std::mem::take(&mut self.value);
            place.is_taken = false;
            std::mem::take(&mut place.waiting)
        };
        // All are woken, because any of them may have been given up meanwhile.
        waiting.into_iter().for_each(Waker::wake);
    }
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests {
    use super::*;

    #[test]
    fn a_turn_that_was_given_up_blocks_nobody() {
        let turns = Turns::<i32>::default();
        let first = turns.turn().wait();
        let mut context = Context::from_waker(Waker::noop());
        let mut given_up = Box::pin(turns.turn());
        assert!(Future::poll(given_up.as_mut(), &mut context).is_pending());
        drop(given_up);
        std::thread::scope(|scope| {
            let second = scope.spawn(|| {
                let mut turn = turns.turn().wait();
                turn.value += 1;
                turn.value
            });
            drop(first);
            assert_eq!(second.join().unwrap(), 1);
        });
        assert_eq!(turns.turn().wait().value, 1);
    }

    /// Without [`Wait::wait`], a future returns to its caller while a device or a callback is busy.
    #[test]
    fn an_answer_is_awaited_without_blocking() {
        let (answer, to_answer) = answer();
        let mut answer = Box::pin(answer);
        let mut context = Context::from_waker(Waker::noop());
        assert!(Future::poll(answer.as_mut(), &mut context).is_pending());
        to_answer.give(7);
        assert_eq!(Future::poll(answer.as_mut(), &mut context), Poll::Ready(7));
    }
}
