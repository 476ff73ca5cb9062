//! The cumulative tables from which texels are sampled.

use std::f64::consts::{PI, TAU};

use crate::image::color;
use crate::parallel::for_each;

/// The solid angle of a texel in a row: 2π/width times the difference of the cosines of its edges' colatitudes, written
/// as a product.
pub(super) fn solid_angle([width, height]: [u32; 2], row: usize) -> f64 {
    let half = 0.5 * PI / f64::from(height);
    2.0 * TAU / f64::from(width) * ((2 * row + 1) as f64 * half).sin() * half.sin()
}

/// The number of equal shares into which a table divides probability: f32 holds every multiple of 2⁻²⁴ up to 1, and the
/// differences of these multiples.
const SHARES: f64 = (1 << 24) as f64;

fn luminance(texel: &[f32; 3]) -> f64 {
    color::luminance(texel.map(f64::from))
}

/// The cumulative table of rows, and those of the columns of each row.
pub(super) fn tables([width, height]: [u32; 2], texels: &[[f32; 3]]) -> (Vec<f32>, Vec<f32>) {
    let (columns, rows) = (width as usize, height as usize);
    let mut sums = vec![0.0; rows];
    let mut tables = vec![0.0; rows * (columns + 1)];
    let parts: Vec<_> = sums
        .iter_mut()
        .zip(tables.chunks_mut(columns + 1))
        .zip(texels.chunks(columns))
        .enumerate()
        .collect();
    for_each(parts, |(row, ((sum, table), texels))| {
        let weights = texels.iter().map(luminance);
        *sum = fill(table, weights) * solid_angle([width, height], row);
    });
    let mut table = vec![0.0; rows + 1];
    fill(&mut table, sums.into_iter());
    (table, tables)
}

/// Fills a table with the cumulative distribution of weights, and returns their sum.
///
/// Each weight that is not zero has one share for certain, so that no light is too faint to be sampled; the other
/// shares are distributed in proportion.
fn fill(table: &mut [f32], weights: impl Iterator<Item = f64> + Clone) -> f64 {
    let total: f64 = weights.clone().sum();
    if total == 0.0 {
        table.fill(0.0);
        return total;
    }
    let certain = weights.clone().filter(|weight| *weight > 0.0).count() as f64;
    let (mut before, mut sum) = (0.0, 0.0);
    table[0] = 0.0;
    for (entry, weight) in table[1..].iter_mut().zip(weights) {
        sum += weight;
        before += if weight > 0.0 { 1.0 } else { 0.0 };
        // The weights are added in the same order as for the total, so the last sum equals it.
        let shares: f64 = before + ((SHARES - certain) * (sum / total)).round();
        *entry = (shares / SHARES) as f32;
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(weights: &[f64]) -> Vec<f32> {
        let mut table = vec![f32::NAN; weights.len() + 1];
        fill(&mut table, weights.iter().copied());
        table
    }

    #[test]
    fn shares_are_in_proportion_and_end_at_one() {
        assert_eq!(filled(&[1.0, 2.0, 1.0]), [0.0, 0.25, 0.75, 1.0]);
        assert_eq!(filled(&[0.0, 3.0, 0.0]), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(filled(&[0.0, 0.0]), [0.0, 0.0, 0.0]);
        let faint = filled(&[1e-30, 1e30, 1e-30, 0.0]);
        assert_eq!(faint.map_shares(), [1.0, SHARES - 2.0, 1.0, 0.0]);
    }

    trait Shares {
        fn map_shares(&self) -> Vec<f64>;
    }

    impl Shares for Vec<f32> {
        fn map_shares(&self) -> Vec<f64> {
            self.windows(2).map(|pair| f64::from(pair[1] - pair[0]) * SHARES).collect()
        }
    }
}
