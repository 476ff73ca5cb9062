//! An order of rows of workgroups that spreads any run of rows over the picture.

/// The step between consecutive rows of workgroups. It is about the golden ratio of their number, so that any run of
/// rows is spread evenly over the picture, and coprime to their number, so that no row is left out.
pub(crate) fn row_step(row_count: u32) -> u32 {
    let has_common_factor = |step: u32| {
        let (mut a, mut b) = (row_count, step);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a != 1
    };
    if row_count <= 1 {
        return 1;
    }
    let golden = (f64::from(row_count) * 0.618_033_988_75) as u32;
    (golden.max(1)..).find(|step| !has_common_factor(*step)).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_a_permutation() {
        for count in (1..300).chain([1024, 4096]) {
            let step = row_step(count);
            assert!(count * step < 1 << 24, "the kernel's remainder is exact below 2^24");
            let mut seen = vec![false; count as usize];
            for row in 0..count {
                seen[(row * step % count) as usize] = true;
            }
            assert!(seen.iter().all(|s| *s), "{count}");
        }
    }
}
