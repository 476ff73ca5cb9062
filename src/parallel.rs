//! Loops that run on all cores if there are threads, with the same results for any number of threads.

use std::collections::TryReserveError;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

/// The number of items that a thread takes at a time. It is large enough to be worth a task, and small enough that
/// short lists stay on one thread.
const CHUNK: usize = 1 << 16;

/// Calls `f` with every index of `0..count`. This is the only loop that is compiled with rayon. With one for each
/// closure, they would be a sixth of the library.
fn each_index(count: usize, f: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(f);
}

/// The number of threads that run loops.
#[must_use]
pub fn threads() -> usize {
    rayon::current_num_threads()
}

/// The results of `f` for `0..count`, in order.
pub fn map<R: Send>(count: usize, f: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let chunk = count.div_ceil(16 * threads()).clamp(1, CHUNK / 8);
    extended(Vec::with_capacity(count), count, chunk, f)
}

/// The results of `f` for `0..count`, in order. It is like [`map`], but for cheap results.
///
/// # Errors
/// Returns an error if there is not enough memory for `count` results.
pub fn try_map<R: Send>(count: usize, f: impl Fn(usize) -> R + Sync) -> Result<Vec<R>, TryReserveError> {
    let mut list = Vec::new();
    list.try_reserve_exact(count)?;
    Ok(extended(list, count, CHUNK / 8, f))
}

/// Fills an empty list with the results of `f` for `0..count`. A thread takes `chunk` of them at a time.
#[expect(unsafe_code, reason = "the results are written where they stay, so that nothing is copied or written twice")]
fn extended<R: Send>(mut list: Vec<R>, count: usize, chunk: usize, f: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let slots = list.spare_capacity_mut()[..count].chunks_mut(chunk);
    for_each(slots.enumerate().collect(), |(k, slots)| {
        for (i, slot) in slots.iter_mut().enumerate() {
            slot.write(f(k * chunk + i));
        }
    });
    // SAFETY: the list was empty, and each of its first `count` slots has been written, because `for_each` passes every part
    // to its function once and returns after all of them. If that panics, the list stays empty.
    unsafe { list.set_len(count) };
    list
}

/// The results of `f` for every chunk and the index of its first item, in order.
pub fn map_chunks<'a, T: Sync, R: Send>(items: &'a [T], f: impl Fn(usize, &'a [T]) -> R + Sync) -> Vec<R> {
    map_parts(ranges(items.len(), CHUNK), |range| f(range.start, &items[range]))
}

/// The results of `f` for every element of `parts`, in order.
pub fn map_parts<T: Send, R: Send>(parts: Vec<T>, f: impl Fn(T) -> R + Sync) -> Vec<R> {
    let mut results: Vec<_> = parts.iter().map(|_| None).collect();
    let slots = results.iter_mut().zip(parts).collect();
    for_each(slots, |(slot, part)| *slot = Some(f(part)));
    results.into_iter().flatten().collect()
}

/// Calls `f` with every element of `parts`.
pub fn for_each<T: Send>(parts: Vec<T>, f: impl Fn(T) + Sync) {
    let parts: Vec<_> = parts.into_iter().map(|part| Mutex::new(Some(part))).collect();
    let take = |k: usize| parts[k].lock().unwrap_or_else(PoisonError::into_inner).take();
    each_index(parts.len(), &|k| take(k).into_iter().for_each(&f));
}

/// Calls `f` with every item of a slice.
pub fn for_each_mut<T: Send>(items: &mut [T], f: impl Fn(&mut T) + Sync) {
    for_each(items.chunks_mut(CHUNK).collect(), |chunk| chunk.iter_mut().for_each(&f));
}

/// Runs two tasks, in parallel if they are `large`.
pub fn both<A: Send, B: Send>(
    large: bool,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if large { rayon::join(first, second) } else { (first(), second()) }
}

/// Splits `0..count` into ranges of at most `size`.
#[must_use]
pub fn ranges(count: usize, size: usize) -> Vec<Range<usize>> {
    (0..count).step_by(size).map(|start| start..(start + size).min(count)).collect()
}

/// Splits a slice at the ascending indices `ends`. The last of them is the length of the slice.
pub fn split_mut<T>(mut slice: &mut [T], ends: impl IntoIterator<Item = usize>) -> Vec<&mut [T]> {
    let mut start = 0;
    ends.into_iter()
        .map(|end| {
            let (part, rest) = std::mem::take(&mut slice).split_at_mut(end - start);
            (slice, start) = (rest, end);
            part
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_as_short_ones() {
        for count in [0, 1, CHUNK, CHUNK + 1, 5 * CHUNK + 3] {
            let mut list = try_map(count, |i| i).unwrap();
            assert!(list.iter().copied().eq(0..count));
            for_each_mut(&mut list, |i| *i += 1);
            let sums = map_chunks(&list, |first, items| (first, items.len(), items[0]));
            assert!(sums.iter().all(|(first, _, item)| first + 1 == *item));
            assert_eq!(sums.iter().map(|(_, length, _)| length).sum::<usize>(), count);
        }
    }

    #[test]
    fn what_no_memory_holds_is_an_error() {
        assert!(try_map(usize::MAX / 8, |_| 0_u64).is_err());
    }
}
