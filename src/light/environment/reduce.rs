//! Reduction of environment maps that are too large.

use std::f64::consts::PI;

use crate::parallel::map;

/// The largest numbers of columns and rows; larger maps are reduced.
pub const MAX_SIZE: [u32; 2] = [4096, 2048];

/// The map itself if it fits, or a smaller one whose texels are the means, by solid angle, of the texels that they
/// cover. The total light stays the same.
pub(super) fn reduced(size: [u32; 2], texels: Vec<[f32; 3]>) -> ([u32; 2], Vec<[f32; 3]>) {
    let factor = (0..2).map(|axis| size[axis].div_ceil(MAX_SIZE[axis])).max().unwrap_or(1);
    if factor == 1 {
        return (size, texels);
    }
    let reduced = size.map(|count| count.div_ceil(factor));
    let [columns, rows] = [0, 1].map(|axis| covers(size[axis], reduced[axis]));
    let width = size[0] as usize;
    let lines = map(reduced[1] as usize, |row| {
        columns
            .iter()
            .map(|columns| {
                let (mut sum, mut total) = ([0.0; 3], 0.0);
                for &(row, from, to) in &rows[row] {
                    let edge = |row: f64| (PI * row / f64::from(size[1])).cos();
                    let height = edge(from) - edge(to);
                    for &(column, from, to) in columns {
                        let weight = height * (to - from);
                        let texel = texels[row * width + column].map(f64::from);
                        sum = std::array::from_fn(|i| sum[i] + weight * texel[i]);
                        total += weight;
                    }
                }
                sum.map(|component| (component / total) as f32)
            })
            .collect::<Vec<[f32; 3]>>()
    });
    (reduced, lines.concat())
}

/// For each of `few` equal parts of an axis that has `many` texels: the texels that it covers, and from where to where.
fn covers(many: u32, few: u32) -> Vec<Vec<(usize, f64, f64)>> {
    // Positions are compared as fractions with the denominator `few`, so that no texel is missed and none is covered by
    // an interval of length zero.
    let (many, few) = (u64::from(many), u64::from(few));
    let at = |numerator: u64| numerator as f64 / few as f64;
    (0..few)
        .map(|i| {
            let (from, to) = (i * many, (i + 1) * many);
            (from / few..to.div_ceil(few))
                .map(|k| (k as usize, at(from.max(k * few)), at(to.min((k + 1) * few))))
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_the_axis_once() {
        for (many, few) in [(4, 2), (5, 3), (8193, 2731), (9001, 3001)] {
            let covers = covers(many, few);
            let pieces: Vec<_> = covers.concat();
            assert!(pieces.iter().all(|(k, from, to)| {
                from < to && *from >= *k as f64 && *to <= *k as f64 + 1.0
            }));
            let total: f64 = pieces.iter().map(|(_, from, to)| to - from).sum();
            assert!((total / f64::from(many) - 1.0).abs() < 1e-12, "{many}, {few}: {total}");
            assert_eq!(covers.len(), few as usize);
        }
        assert_eq!(covers(4, 2)[1], [(2, 2.0, 3.0), (3, 3.0, 4.0)]);
    }
}
