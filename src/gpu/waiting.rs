//! Blocking forms of async functions.
//!
//! Everything that can wait is an async function. Its blocking form runs it by [`block_on`], in which waiting for the
//! device blocks the thread as well. A program for browsers cannot block, so the blocking forms do not exist for
//! `wasm32`.

use std::cell::Cell;

thread_local! {
    /// Whether the future that this thread runs was called by a blocking function.
    static MAY_BLOCK: Cell<bool> = const { Cell::new(false) };
}

/// Runs a future to its end and blocks the thread meanwhile.
pub(super) fn block_on<T>(future: impl Future<Output = T>) -> T {
    /// Restores the previous value, also if the future panics.
    struct Before(bool);
    impl Drop for Before {
        fn drop(&mut self) {
            MAY_BLOCK.set(self.0);
        }
    }
    let _before = Before(MAY_BLOCK.replace(true));
    pollster::block_on(future)
}

/// Whether the future that this thread runs may block it.
pub(super) fn may_block() -> bool {
    MAY_BLOCK.get()
}
