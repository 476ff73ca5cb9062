//! Finds out which of a host's recordings were executed, and in which order, without asking the device.
//!
//! Each recording ends with a copy of its status words into a small buffer, and asks for the buffer to be mapped when
//! the encoder is submitted. The callback says that the commands were executed. If it is dropped, they never will be.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use wgpu::{Buffer, BufferUsages, CommandEncoder, Device};

use crate::gpu::resources::buffer;

/// Maximum number of recordings under way. With fewer, the device would be idle while the host makes the next one.
pub(super) const AT_ONCE: usize = 3;

/// The recordings under way.
#[derive(Debug)]
pub(super) struct Tickets {
    slots: [Slot; AT_ONCE],
    /// Number of the next recording.
    next: u64,
    order: Arc<Mutex<Order>>,
}

#[derive(Debug)]
struct Slot {
    buffer: Buffer,
    /// Number of the recording under way, and a flag that is set when its commands were executed. A callback shares the
    /// flag until it is called or dropped.
    under_way: Option<(u64, Arc<OnceLock<()>>)>,
}

/// The order in which recordings were executed, as far as it is known.
#[derive(Debug, Default)]
struct Order {
    /// Earlier recordings do not matter, because the first command of this one clears their results.
    first: u64,
    /// The recording that must be executed next.
    expected: u64,
    is_broken: bool,
}

impl Order {
    fn executed(&mut self, number: u64) {
        let is_before_all = number < self.first && self.expected == self.first;
        if !is_before_all {
            self.is_broken |= number != self.expected;
            self.expected = number + 1;
        }
    }

    fn dropped(&mut self, number: u64) {
        self.is_broken |= number >= self.first;
    }
}

/// Results that have arrived since the last call of [`Tickets::news`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct News {
    /// Commands were dropped, or executed in another order than they were recorded in.
    pub(super) is_lost: bool,
    /// A search was abandoned.
    pub(super) is_spent: bool,
}

impl Tickets {
    pub(super) fn new(device: &Device) -> Self {
        let slot = |_| Slot { buffer: buffer(device, "pinhole recording", 8, BufferUsages::MAP_READ), under_way: None };
        Self { slots: [0; AT_ONCE].map(slot), next: 0, order: Arc::default() }
    }

    /// Takes the results that have arrived. This never waits.
    pub(super) fn news(&mut self) -> News {
        let mut news = News::default();
        let mut order = locked(&self.order);
        for slot in &mut self.slots {
            let Some((number, executed)) = &mut slot.under_way else { continue };
            let Some(executed) = Arc::get_mut(executed) else { continue };
            if executed.take().is_some() {
                let words = slot.buffer.get_mapped_range(..);
                news.is_spent |= words.is_ok_and(|words| words.iter().any(|byte| *byte != 0));
                slot.buffer.unmap();
            } else {
                order.dropped(*number);
            }
            slot.under_way = None;
        }
        news.is_lost = std::mem::take(&mut order.is_broken);
        news
    }

    /// Index of a free slot for a recording.
    pub(super) fn free(&self) -> Option<usize> {
        self.slots.iter().position(|slot| slot.under_way.is_none())
    }

    /// Whether no recording is under way.
    pub(super) fn are_all_free(&self) -> bool {
        self.slots.iter().all(|slot| slot.under_way.is_none())
    }

    /// Notes that the next recording begins by clearing the results of all earlier ones.
    pub(super) fn begin_again(&mut self) {
        *locked(&self.order) = Order { first: self.next, expected: self.next, is_broken: false };
    }

    /// Records the copies of two status words for a recording that takes the slot `place`.
    pub(super) fn record(&mut self, encoder: &mut CommandEncoder, place: usize, words: [&Buffer; 2]) {
        let slot = &mut self.slots[place];
        for (word, offset) in words.into_iter().zip([0, 4]) {
            encoder.copy_buffer_to_buffer(word, 0, &slot.buffer, offset, 4);
        }
        let executed = Arc::default();
        slot.under_way = Some((self.next, Arc::clone(&executed)));
        let (number, order) = (self.next, Arc::clone(&self.order));
        self.next += 1;
        encoder.map_buffer_on_submit(&slot.buffer, wgpu::MapMode::Read, .., move |mapped| {
            if mapped.is_ok() {
                locked(&order).executed(number);
                let _ = executed.set(());
            }
        });
    }
}

fn locked(order: &Mutex<Order>) -> MutexGuard<'_, Order> {
    order.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(first: u64, events: &[Result<u64, u64>]) -> bool {
        let mut order = Order { first, expected: first, is_broken: false };
        for event in events {
            match *event {
                Ok(number) => order.executed(number),
                Err(number) => order.dropped(number),
            }
        }
        order.is_broken
    }

    #[test]
    fn an_order_is_broken_by_what_is_lost_late_or_early() {
        assert!(!after(0, &[Ok(0), Ok(1), Ok(2)]));
        assert!(after(0, &[Ok(0), Err(1), Ok(2)]), "one was dropped");
        assert!(after(0, &[Ok(1), Ok(0)]), "they were exchanged");
        assert!(after(0, &[Ok(0), Ok(2)]), "one is missing");
    }

    #[test]
    fn what_came_before_the_first_matters_only_if_it_is_executed_late() {
        assert!(!after(5, &[Ok(3), Ok(4), Ok(5), Ok(6)]));
        assert!(!after(5, &[Err(3), Ok(5), Err(4), Ok(6)]));
        assert!(after(5, &[Ok(5), Ok(4)]));
    }
}
