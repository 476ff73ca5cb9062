//! Loops that run on all cores with the feature `parallel`, and on one without it.

/// The results of `f` for `0..count`, in order.
#[cfg(feature = "parallel")]
pub(super) fn map<R: Send>(count: usize, f: impl Fn(usize) -> R + Sync) -> Vec<R> {
    use rayon::prelude::*;
    (0..count).into_par_iter().map(&f).collect()
}

/// The results of `f` for `0..count`, in order.
#[cfg(not(feature = "parallel"))]
pub(super) fn map<R: Send>(count: usize, f: impl Fn(usize) -> R + Sync) -> Vec<R> {
    (0..count).map(f).collect()
}

/// Calls `f` with every element of `parts`.
#[cfg(feature = "parallel")]
pub(super) fn for_each<T: Send>(parts: Vec<T>, f: impl Fn(T) + Sync) {
    use rayon::prelude::*;
    parts.into_par_iter().for_each(&f);
}

/// Calls `f` with every element of `parts`.
#[cfg(not(feature = "parallel"))]
pub(super) fn for_each<T: Send>(parts: Vec<T>, f: impl Fn(T) + Sync) {
    parts.into_iter().for_each(f);
}

/// The ranges of at most `size` that make up `0..count`.
pub(super) fn chunks(count: usize, size: usize) -> Vec<std::ops::Range<usize>> {
    (0..count).step_by(size).map(|start| start..(start + size).min(count)).collect()
}

/// Cuts a slice at ascending `ends`, of which the last is its length.
pub(super) fn split_mut<T>(
    mut slice: &mut [T],
    ends: impl IntoIterator<Item = usize>,
) -> Vec<&mut [T]> {
    let mut start = 0;
    ends.into_iter()
        .map(|end| {
            let (part, rest) = std::mem::take(&mut slice).split_at_mut(end - start);
            (slice, start) = (rest, end);
            part
        })
        .collect()
}
