//! A radius for spheres whose file gives none, from the distances between them.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3};

/// The start of the note about a radius that was found here.
pub(super) const NO_RADII: &str = "there are no radii; all spheres have the radius";

/// Number of sampled spheres whose nearest neighbours are found.
const ASKED: usize = 256;

/// Number of distances that are computed before smaller cells are tried.
const MOST_TESTS: usize = 1 << 25;

/// Number of times that the cells are made larger or smaller.
const ATTEMPTS: usize = 40;

/// Half of the median distance from a sphere to its nearest neighbour, so that neighbours about touch; `None` if all
/// centres are in one place.
pub(super) fn radius(count: usize, center: impl Fn(usize) -> DVec3) -> Option<f64> {
    distance(count, center, 0.5).map(|median| 0.5 * median)
}

/// The distance from a sphere to its nearest neighbour that this part of the spheres has at most; `None` if all centres are
/// in one place. Only a sample, spread over the file, is used if there are many spheres.
///
/// `center` returns the centre of a sphere, by its index below `count`; centres that are not finite are left out.
pub(super) fn distance(count: usize, center: impl Fn(usize) -> DVec3, part: f64) -> Option<f64> {
    let finite = || (0..count).map(&center).filter(|center| center.is_finite());
    let (low, high) = finite()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), center| (low.min(center), high.max(center)));
    let size = high - low;
    if !(size.is_finite() && size.max_element() > 0.0) {
        return None;
    }
    let asked: Vec<DVec3> =
        (0..count).step_by(count.div_ceil(ASKED).max(1)).map(&center).filter(|c| c.is_finite()).collect();
    // Along a side that is much shorter than the largest, spheres lie in one layer.
    let sides = size.to_array().into_iter().filter(|side| *side > 1e-6 * size.max_element());
    let (volume, dimensions) = sides.fold((1.0, 0), |(volume, n), side| (volume * side, n + 1));
    let mut cell = 0.5 * (volume / count as f64).powf(1.0 / f64::from(dimensions));
    let mut most_tests = MOST_TESTS;
    for _ in 0..ATTEMPTS {
        match nearest(&asked, cell, low, finite(), most_tests) {
            // Many spheres are close together in few places, so cells must be smaller.
            None => {
                cell /= 4.0;
                most_tests *= 2;
            }
            // A neighbour closer than the side of a cell is sure to be the nearest. If this part of the neighbours are,
            // so is the one that is returned.
            Some(mut squared) => {
                squared.sort_unstable_by(f64::total_cmp);
                let found = squared[((asked.len() - 1) as f64 * part) as usize].sqrt();
                if found <= cell {
                    return Some(found);
                }
                cell *= 2.0;
            }
        }
    }
    None
}

/// Returns the squared distance from each sampled sphere to its nearest neighbour in the 27 cells around it, or
/// infinity. Spheres in the same place do not count. `None` if that takes more than `most_tests` distances.
fn nearest(
    asked: &[DVec3],
    cell: f64,
    low: DVec3,
    all: impl Iterator<Item = DVec3>,
    most_tests: usize,
) -> Option<Vec<f64>> {
    let cell_of = |center: DVec3| ((center - low) / cell).floor().as_i64vec3();
    let mut around: HashMap<I64Vec3, Vec<usize>> = HashMap::new();
    for (index, center) in asked.iter().enumerate() {
        let middle = cell_of(*center);
        for offset in 0..27_i64 {
            let offset = I64Vec3::new(offset % 3, offset / 3 % 3, offset / 9) - I64Vec3::ONE;
            // Cells that are too far away for an i64 become the same cell, which takes time but changes no result.
            around.entry(middle.wrapping_add(offset)).or_default().push(index);
        }
    }
    let mut squared = vec![f64::INFINITY; asked.len()];
    let mut tested = 0;
    for center in all {
        let Some(near) = around.get(&cell_of(center)) else { continue };
        tested += near.len();
        if tested > most_tests {
            return None;
        }
        for &index in near {
            let distance = center.distance_squared(asked[index]);
            if distance > 0.0 && distance < squared[index] {
                squared[index] = distance;
            }
        }
    }
    Some(squared)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(side: i32, spacing: f64) -> Vec<DVec3> {
        let place = |i| DVec3::new(f64::from(i % side), f64::from(i / side % side), f64::from(i / side / side));
        (0..side.pow(3)).map(|i| spacing * place(i)).collect()
    }

    fn radius_of(centers: &[DVec3]) -> Option<f64> {
        radius(centers.len(), |index| centers[index])
    }

    #[test]
    fn neighbours_touch() {
        let near = |found: Option<f64>, wanted: f64| {
            assert!(found.is_some_and(|found| (found / wanted - 1.0).abs() < 1e-9), "{found:?}");
        };
        near(radius_of(&lattice(12, 3.0)), 1.5);
        // The spheres lie in one layer, or in one row.
        let flat: Vec<_> = (0..900).map(|i| DVec3::new(f64::from(i % 30), f64::from(i / 30), 4.0)).collect();
        near(radius_of(&flat), 0.5);
        let row: Vec<_> = (0..50).map(|i| DVec3::new(0.0, f64::from(i) * 0.1, 0.0)).collect();
        near(radius_of(&row), 0.05);
        // Two dense lumps are far from each other, and every place occurs twice.
        let mut lumps = lattice(20, 0.01);
        lumps.extend(lattice(20, 0.01).iter().map(|c| *c + 1e4));
        lumps.extend_from_within(..);
        near(radius_of(&lumps), 0.005);
        // Neither a far sphere nor one without a finite place matters.
        let mut odd = lattice(10, 2.0);
        odd.extend([DVec3::splat(1e6), DVec3::NAN]);
        near(radius_of(&odd), 1.0);
    }

    #[test]
    fn parts_of_the_spheres_have_their_own_distances() {
        let place = |i: i32| if i < 75 { 0.1 * f64::from(i) } else { 10.0 + f64::from(i - 75) };
        let row: Vec<_> = (0..100).map(|i| DVec3::new(place(i), 0.0, 0.0)).collect();
        let found = [0.5, 0.9].map(|part| distance(row.len(), |index| row[index], part).unwrap());
        assert!((found[0] - 0.1).abs() < 1e-9 && (found[1] - 1.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn one_place_has_no_spacing() {
        assert_eq!(radius_of(&[]), None);
        assert_eq!(radius_of(&[DVec3::ONE]), None);
        assert_eq!(radius_of(&[DVec3::ONE; 7]), None);
        // The volume is 0 in f64, and so is the side of a cell.
        assert_eq!(radius_of(&lattice(10, 1e-150)), None);
    }
}
