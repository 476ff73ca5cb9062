//! Long lists, on all cores if there are threads, with the same answers if there are none.

use std::collections::TryReserveError;

/// How many items a thread takes at a time: enough to be worth it, few enough for short lists to stay on
/// one thread.
const CHUNK: usize = 1 << 16;

/// What `f` makes of every chunk and the index of its first item, in order.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], f: impl Fn(usize, &[T]) -> R + Sync) -> Vec<R> {
    #[cfg(feature = "parallel")]
    if items.len() > CHUNK {
        use rayon::prelude::*;
        let chunks = items.par_chunks(CHUNK).enumerate();
        return chunks.map(|(chunk, items)| f(chunk * CHUNK, items)).collect();
    }
    items.chunks(CHUNK).enumerate().map(|(chunk, items)| f(chunk * CHUNK, items)).collect()
}

/// Changes every item.
pub(crate) fn each<T: Send>(items: &mut [T], f: impl Fn(&mut T) + Sync) {
    #[cfg(feature = "parallel")]
    if items.len() > CHUNK {
        use rayon::prelude::*;
        return items.par_chunks_mut(CHUNK).for_each(|chunk| chunk.iter_mut().for_each(&f));
    }
    items.iter_mut().for_each(f);
}

/// `f` of every index below `count`.
///
/// # Errors
/// If there is no memory for so many.
pub(crate) fn collect<R: Send>(
    count: usize,
    f: impl Fn(usize) -> R + Sync + Send,
) -> Result<Vec<R>, TryReserveError> {
    let mut list = Vec::new();
    list.try_reserve_exact(count)?;
    #[cfg(feature = "parallel")]
    if count > CHUNK {
        use rayon::prelude::*;
        list.par_extend((0..count).into_par_iter().with_min_len(CHUNK / 8).map(f));
        return Ok(list);
    }
    list.extend((0..count).map(f));
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_as_short_ones() {
        for count in [0, 1, CHUNK, CHUNK + 1, 5 * CHUNK + 3] {
            let mut list = collect(count, |i| i).unwrap();
            assert!(list.iter().copied().eq(0..count));
            each(&mut list, |i| *i += 1);
            let sums = map(&list, |first, items| (first, items.len(), items[0]));
            assert!(sums.iter().all(|(first, _, item)| first + 1 == *item));
            assert_eq!(sums.iter().map(|(_, length, _)| length).sum::<usize>(), count);
        }
    }

    #[test]
    fn what_no_memory_holds_is_an_error() {
        assert!(collect(usize::MAX / 8, |_| 0_u64).is_err());
    }
}
