//! Counting the calls of wgpu that this thread makes, by what wgpu logs of them.

use std::cell::RefCell;
use std::sync::Once;

/// Numbers of calls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Calls {
    /// Resources of any kind that were created.
    pub(crate) created: u32,
    /// Writes that were queued. wgpu copies what is written to memory of its own.
    pub(crate) writes: u32,
    pub(crate) submitted: u32,
    /// Calls that wait for the device or ask whether it is done.
    pub(crate) waited: u32,
    /// Calls that map memory of the device or read it.
    pub(crate) mapped: u32,
    /// All calls that are logged.
    pub(crate) all: u32,
}

thread_local! {
    static CALLS: RefCell<Calls> = const { RefCell::new(Calls {
        created: 0, writes: 0, submitted: 0, waited: 0, mapped: 0, all: 0,
    }) };
}

struct Counter;

impl log::Log for Counter {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.target().starts_with("wgpu_core")
    }

    fn log(&self, record: &log::Record<'_>) {
        if !self.enabled(record.metadata()) {
            return;
        }
        let line = record.args().to_string();
        let starts = |with: &str| line.starts_with(with);
        CALLS.with_borrow_mut(|calls| {
            let waits = ["Device::poll", "poll_all_devices", "Queue::on_submitted_work_done"];
            if starts("Device::create_") || starts("Texture::create_") {
                calls.created += 1;
            } else if starts("Queue::write_") {
                calls.writes += 1;
            } else if line == "Queue::submit" {
                calls.submitted += 1;
            } else if waits.into_iter().any(starts) {
                calls.waited += 1;
            } else if starts("Buffer::map_async") || starts("Buffer::get_mapped_range") {
                calls.mapped += 1;
            }
            calls.all += 1;
        });
    }

    fn flush(&self) {}
}

/// The calls that `work` makes on this thread.
pub(crate) fn of<T>(work: impl FnOnce() -> T) -> (Calls, T) {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        log::set_logger(&Counter).unwrap();
        log::set_max_level(log::LevelFilter::Trace);
    });
    CALLS.take();
    let result = work();
    (CALLS.take(), result)
}
