//! Finds pairs of spheres that are close together, with a grid of cells.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3};

use super::AddError;

/// The most pairs for each point, on average. In the densest packing of equal spheres there are 6 of neighbours.
pub(super) const MOST_PAIRS: usize = 16;

/// How many distances are computed for each point, on average, before the search is given up.
const MOST_TESTS: usize = 4096;

/// How many more distances are computed however few points there are.
const MORE_TESTS: usize = 1 << 22;

/// Half of the cells around a cell: each pair of neighbours is met once.
const FORWARD: [[i64; 3]; 13] = [
    [1, 0, 0],
    [-1, 1, 0],
    [0, 1, 0],
    [1, 1, 0],
    [-1, -1, 1],
    [0, -1, 1],
    [1, -1, 1],
    [-1, 0, 1],
    [0, 0, 1],
    [1, 0, 1],
    [-1, 1, 1],
    [0, 1, 1],
    [1, 1, 1],
];

/// Returns pairs of indices, the smaller first and in ascending order, of points at most `reach` apart for which
/// `is_pair` is true; it is given two indices and the squared distance. Points that are not finite have no pairs.
pub(super) fn pairs(
    points: &[DVec3],
    reach: f64,
    is_pair: impl Fn(u32, u32, f64) -> bool,
) -> Result<Vec<[u32; 2]>, AddError> {
    let mut cells: HashMap<I64Vec3, Vec<u32>> = HashMap::new();
    let finite = points.iter().enumerate().filter(|(_, point)| point.is_finite());
    for (index, point) in finite.clone() {
        // Cells that are too far for an i64 are all one, which takes time but changes nothing.
        cells.entry((point / reach).floor().as_i64vec3()).or_default().push(index as u32);
    }
    let most_tests = points.len().saturating_mul(MOST_TESTS).saturating_add(MORE_TESTS);
    let most_pairs = points.len().saturating_mul(MOST_PAIRS);
    let (mut tests, mut found) = (0_usize, Vec::new());
    let mut test = |one: &[u32], others: &[u32]| {
        tests = tests.saturating_add(one.len().saturating_mul(others.len()));
        if tests > most_tests {
            return Err(AddError::TooDense { spheres: points.len() });
        }
        for &a in one {
            for &b in others {
                let squared = points[a as usize].distance_squared(points[b as usize]);
                if squared <= reach * reach && is_pair(a, b, squared) {
                    found.push([a.min(b), a.max(b)]);
                }
            }
        }
        if found.len() > most_pairs {
            let (pairs, spheres) = (found.len(), points.len());
            return Err(AddError::TooManyBonds { pairs, spheres, most: MOST_PAIRS });
        }
        Ok(())
    };
    for (cell, inside) in &cells {
        for (place, index) in inside.iter().enumerate() {
            test(&[*index], &inside[place + 1..])?;
        }
        for offset in FORWARD {
            let next = cell.wrapping_add(I64Vec3::from(offset));
            // A cell at the end of the numbers is not its own neighbour.
            if let Some(others) = cells.get(&next).filter(|_| next != *cell) {
                test(inside, others)?;
            }
        }
    }
    // The order of cells is not the same in every run.
    found.sort_unstable();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_pairs(points: &[DVec3], reach: f64) -> Vec<[u32; 2]> {
        let count = points.len() as u32;
        let of = |a: u32| (a + 1..count).map(move |b| [a, b]);
        let near = |&[a, b]: &[u32; 2]| {
            points[a as usize].distance_squared(points[b as usize]) <= reach * reach
        };
        (0..count).flat_map(of).filter(near).collect()
    }

    #[test]
    fn the_grid_finds_what_a_search_of_all_pairs_finds() {
        let mut random = fastrand::Rng::with_seed(7);
        for reach in [0.3, 1.0, 2.5] {
            let mut point = || DVec3::from([0; 3].map(|_| 20.0 * random.f64() - 10.0));
            let mut points: Vec<DVec3> = (0..600).map(|_| point()).collect();
            points.push(DVec3::splat(1e300));
            points.push(DVec3::NAN);
            // On the borders of cells, and in one place.
            points.extend([DVec3::ZERO, DVec3::X * reach, DVec3::ZERO]);
            let found = pairs(&points, reach, |_, _, _| true).unwrap();
            assert_eq!(found, all_pairs(&points, reach));
            assert!(!found.is_empty());
        }
    }

    #[test]
    fn a_crowd_is_refused_before_it_takes_long() {
        let points = vec![DVec3::ZERO; 100_000];
        assert!(matches!(pairs(&points, 1.0, |_, _, _| true), Err(AddError::TooManyBonds { .. })));
        assert!(matches!(pairs(&points, 1.0, |_, _, _| false), Err(AddError::TooDense { .. })));
    }
}
