//! Pairs of points that are close together, also across the borders of a periodic cell.

use std::collections::{HashMap, HashSet};

use glam::{DVec3, I64Vec3};

use super::shapes::AddError;
use crate::cell::PeriodicCell;
use crate::load::Dataset;

/// Pairs of spheres that are close together.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Neighbours {
    /// Pairs at their own places, sorted and the smaller index first.
    pub(super) within: Vec<[u32; 2]>,
    /// Pairs of a sphere and the image of another or of itself, with the centre of the image. After each pair comes the
    /// same one from the other side.
    pub(super) across: Vec<(u32, u32, DVec3)>,
}

impl Neighbours {
    /// Pairs of spheres at any distance, the second of each at the place of its nearest image. Those that are not in the
    /// data or are in one place are left out.
    pub(super) fn nearest(data: &Dataset, points: &[DVec3], pairs: &[[u32; 2]]) -> Self {
        let cell = PeriodicCell::of(data);
        let mut found = Self::default();
        for &[a, b] in pairs {
            let (Some(from), Some(to)) = (points.get(a as usize), points.get(b as usize)) else { continue };
            if !(from.is_finite() && to.is_finite() && from != to) {
                continue;
            }
            let turns = cell.as_ref().map_or(DVec3::ZERO, |cell| cell.turns_to_nearest(*from, *to));
            match &cell {
                Some(cell) if turns != DVec3::ZERO => {
                    found.across.push((a, b, cell.moved(*to, turns)));
                    found.across.push((b, a, cell.moved(*from, -turns)));
                }
                _ => found.within.push([a.min(b), a.max(b)]),
            }
        }
        found
    }

    /// Joins two lists, without the pairs that both have.
    pub(super) fn joined(mut self, other: Self) -> Self {
        self.within.extend(other.within);
        self.within.sort_unstable();
        self.within.dedup();
        let key = |(a, b, image): &(u32, u32, DVec3)| (*a, *b, image.to_array().map(f64::to_bits));
        let known: HashSet<_> = self.across.iter().map(key).collect();
        self.across.extend(other.across.into_iter().filter(|pair| !known.contains(&key(pair))));
        self
    }
}

/// Finds the pairs of spheres at most `reach` apart for which `is_pair` is true. It gets two indices and the squared
/// distance. In the directions in which the cell repeats, images of spheres count as well.
pub(super) fn neighbours(
    data: &Dataset,
    points: &[DVec3],
    reach: f64,
    is_pair: impl Fn(u32, u32, f64) -> bool,
) -> Result<Neighbours, AddError> {
    let Some(cell) = PeriodicCell::of(data) else {
        return Ok(Neighbours { within: pairs(points, points.len(), reach, is_pair)?, across: Vec::new() });
    };
    // The spheres in the cell, and behind them the images around the cell.
    let turns: Vec<DVec3> = points.iter().map(|point| cell.turns(*point)).collect();
    let mut all: Vec<DVec3> = points.iter().zip(&turns).map(|(point, turns)| cell.moved(*point, -*turns)).collect();
    let too_small = "the periodic cell is so small that spheres have too many images within the length of bonds; choose a \
                     smaller factor or length of bonds";
    let images = cell.images(&all, reach).ok_or_else(|| AddError(too_small.to_owned()))?;
    let count = points.len();
    let base = |index: u32| match images.get((index as usize).wrapping_sub(count)) {
        Some((base, shift)) => (*base, *shift),
        None => (index, DVec3::ZERO),
    };
    for (base, shift) in &images {
        all.push(cell.moved(all[*base as usize], *shift));
    }
    let found = pairs(&all, count, reach, |a, b, squared| is_pair(base(a).0, base(b).0, squared))?;
    let mut result = Neighbours::default();
    for [a, second] in found {
        let (b, shift) = base(second);
        // A pair of a sphere and an image is found from both sides.
        let is_first = a < b || (a == b && (0..3).find(|k| shift[*k] != 0.0).is_some_and(|k| shift[k] > 0.0));
        if !is_first {
            continue;
        }
        // By how many edges the image of the second sphere, which is near the first, is away from the sphere.
        let shift = shift + turns[a as usize] - turns[b as usize];
        if shift == DVec3::ZERO {
            result.within.push([a, b]);
        } else {
            result.across.push((a, b, cell.moved(points[b as usize], shift)));
            result.across.push((b, a, cell.moved(points[a as usize], -shift)));
        }
    }
    result.within.sort_unstable();
    Ok(result)
}

/// Pairs of spheres as [`neighbours`] finds them, each with the centre of the second if that is an image; `None` if there
/// are too many.
pub(crate) fn contacts(
    data: &Dataset,
    reach: f64,
    is_pair: impl Fn(u32, u32, f64) -> bool,
) -> Option<Vec<(u32, u32, Option<DVec3>)>> {
    let points: Vec<DVec3> = (0..data.spheres.len()).map(|index| data.center(index)).collect();
    let Neighbours { within, across } = neighbours(data, &points, reach, is_pair).ok()?;
    let within = within.into_iter().map(|[a, b]| (a, b, None));
    Some(within.chain(across.into_iter().map(|(a, b, image)| (a, b, Some(image)))).collect())
}

/// The most pairs for each point, on average. The densest packing of equal spheres has 6 pairs of neighbours for each.
const MOST_PAIRS: usize = 16;

/// The most distances that are computed for each point, on average, before the search is given up.
const MOST_TESTS: usize = 4096;

/// The number of distances that are computed in addition, so that few points are never too many.
const MORE_TESTS: usize = 1 << 22;

/// Half of the cells around a cell, so that each pair of neighbours is met once.
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

/// Returns pairs of indices, sorted and the smaller first, of finite points at most `reach` apart for which
/// `is_pair` is true. `is_pair` gets two indices and the squared distance. One of a pair is among the first `count` points.
fn pairs(
    points: &[DVec3],
    count: usize,
    reach: f64,
    is_pair: impl Fn(u32, u32, f64) -> bool,
) -> Result<Vec<[u32; 2]>, AddError> {
    let mut cells: HashMap<I64Vec3, Vec<u32>> = HashMap::new();
    let finite = points.iter().enumerate().filter(|(_, point)| point.is_finite());
    for (index, point) in finite.clone() {
        // Cells that are too far away for an i64 become the same cell, which takes time but changes no result.
        cells.entry((point / reach).floor().as_i64vec3()).or_default().push(index as u32);
    }
    let most_tests = points.len().saturating_mul(MOST_TESTS).saturating_add(MORE_TESTS);
    let most_pairs = points.len().saturating_mul(MOST_PAIRS);
    let (mut tests, mut found) = (0_usize, Vec::new());
    let mut test = |one: &[u32], others: &[u32]| {
        tests = tests.saturating_add(one.len().saturating_mul(others.len()));
        if tests > most_tests {
            return Err(AddError(format!(
                "too many of the {} spheres are close together to look for bonds; choose a smaller factor or length of \
                 bonds, or select fewer spheres",
                points.len()
            )));
        }
        for &a in one {
            for &b in others {
                let squared = points[a as usize].distance_squared(points[b as usize]);
                if squared <= reach * reach && (a.min(b) as usize) < count && is_pair(a, b, squared) {
                    found.push([a.min(b), a.max(b)]);
                }
            }
        }
        if found.len() > most_pairs {
            let (pairs, spheres) = (found.len(), points.len());
            return Err(AddError(format!(
                "{pairs} pairs of {spheres} spheres would be bonds, more than {MOST_PAIRS} for each; choose a smaller \
                 factor or length of bonds"
            )));
        }
        Ok(())
    };
    for (cell, inside) in &cells {
        for (place, index) in inside.iter().enumerate() {
            test(&[*index], &inside[place + 1..])?;
        }
        for offset in FORWARD {
            let next = cell.wrapping_add(I64Vec3::from(offset));
            // A cell at the end of the range of i64 is not its own neighbour.
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
    use glam::DMat3;
    use pinhole::scene::sphere_array::SphereArray;

    fn all_pairs(points: &[DVec3], reach: f64) -> Vec<[u32; 2]> {
        let count = points.len() as u32;
        let of = |a: u32| (a + 1..count).map(move |b| [a, b]);
        let near = |&[a, b]: &[u32; 2]| points[a as usize].distance_squared(points[b as usize]) <= reach * reach;
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
            // Points on the borders of cells, and several in one place.
            points.extend([DVec3::ZERO, DVec3::X * reach, DVec3::ZERO]);
            let found = pairs(&points, points.len(), reach, |_, _, _| true).unwrap();
            assert_eq!(found, all_pairs(&points, reach));
            assert!(!found.is_empty());
        }
    }

    /// Pairs across the borders of skewed cells are those that a search of all images of all points finds, however many
    /// edges away from the cell points lie, and in every combination of directions.
    #[test]
    fn images_are_found_as_a_search_of_all_finds_them() {
        let mut random = fastrand::Rng::with_seed(11);
        let mut found_across = 0;
        for round in 0..40 {
            let count = 1 + round % 9;
            let edges = [[3.0, 0.0, 0.0], [1.1, 2.5, 0.0], [-0.7, 0.9, 2.0]];
            let matrix = DMat3::from_cols_array_2d(&edges);
            let mut number = |low: f64, high: f64| low + (high - low) * random.f64();
            let points: Vec<DVec3> =
                (0..count).map(|_| matrix * DVec3::from([0; 3].map(|_| number(-2.0, 3.0)))).collect();
            let mut data = Dataset::new(SphereArray::F64(points.iter().map(|p| [p.x, p.y, p.z, 1.0]).collect()));
            data.cell = Some(edges);
            data.cell_origin = [0.3, -0.2, 5.0];
            data.is_periodic = [round & 1, round & 2, round & 4].map(|bit| bit != 0);
            let reach = number(0.2, 4.0);
            let found = neighbours(&data, &points, reach, |_, _, squared| squared > 0.0).unwrap();
            let steps = data.is_periodic.map(|is| if is { -12..=12 } else { 0..=0 });
            let (mut within, mut across) = (Vec::new(), Vec::new());
            for (a, b) in (0..count).flat_map(|a| (0..count).map(move |b| (a, b))) {
                for x in steps[0].clone() {
                    for y in steps[1].clone() {
                        for z in steps[2].clone() {
                            let image = points[b] + matrix * DVec3::from([x, y, z].map(f64::from));
                            let distance = points[a].distance(image);
                            if distance > 0.0 && distance < reach {
                                match [x, y, z] {
                                    [0, 0, 0] if a < b => within.push([a as u32, b as u32]),
                                    [0, 0, 0] => {}
                                    _ => across.push((a as u32, b as u32, image)),
                                }
                            }
                        }
                    }
                }
            }
            assert_eq!(found.within, within);
            let order = |one: &(u32, u32, DVec3), other: &(u32, u32, DVec3)| {
                let key =
                    |(a, b, image): &(u32, u32, DVec3)| (*a, *b, image.to_array().map(|x| (1e6 * x).round() as i64));
                key(one).cmp(&key(other))
            };
            let mut pairs = found.across.clone();
            pairs.sort_by(order);
            across.sort_by(order);
            assert_eq!(pairs.len(), across.len(), "{round}");
            assert!(pairs.iter().zip(&across).all(|(one, other)| one.2.distance(other.2) < 1e-9));
            found_across += across.len();
        }
        assert!(found_across > 1000, "{found_across}");
    }

    #[test]
    fn listed_pairs_go_to_the_nearest_image_once() {
        let mut data = Dataset::new(SphereArray::F64(vec![]));
        data.cell = Some([[10.0, 0.0, 0.0], [4.5, 10.0, 0.0], [0.0, 0.0, 10.0]]);
        data.is_periodic = [true, true, false];
        let points = [[0.5, 0.5, 1.0], [9.0, 0.5, 1.0], [4.0, 9.5, 9.0], [0.5, 0.5, 1.0], [25.0, 0.5, 1.0]];
        let points = points.map(DVec3::from);
        let found = Neighbours::nearest(&data, &points, &[[0, 1], [0, 2], [0, 3], [0, 4], [1, 9]]);
        assert!(found.within.is_empty());
        let images: Vec<_> = found.across.iter().step_by(2).map(|(a, b, image)| (*a, *b, image.to_array())).collect();
        assert_eq!(images, [(0, 1, [-1.0, 0.5, 1.0]), (0, 2, [-0.5, -0.5, 9.0]), (0, 4, [5.0, 0.5, 1.0])]);
        data.spheres = SphereArray::F64(points.map(|p| [p.x, p.y, p.z, 1.0]).to_vec());
        let near = neighbours(&data, &points, 2.0, |_, _, squared| squared > 0.0).unwrap();
        assert_eq!(near.across.len(), 4, "also between 1 and 3");
        let joined = near.joined(found);
        assert_eq!((joined.across.len(), joined.within.len()), (8, 0));
    }

    #[test]
    fn a_crowd_is_refused_before_it_takes_long() {
        let points = vec![DVec3::ZERO; 100_000];
        let refused = |all| pairs(&points, points.len(), 1.0, |_, _, _| all).unwrap_err().to_string();
        assert!(refused(true).contains("pairs of 100000 spheres would be bonds"));
        assert!(refused(false).starts_with("too many of the 100000 spheres are close together"));
    }
}
