//! Repeats the spheres of a periodic cell.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use crate::added::bonded_pairs;
use crate::cell::PeriodicCell;
use crate::load::{ColumnValues, Dataset};

/// How the spheres of a periodic cell are repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replicate {
    /// This many cells along each edge.
    Cells([u32; 3]),
    /// Spheres at a face, an edge or a corner of the cell are repeated at those opposite, as drawings of crystals show
    /// them. All spheres are moved into the cell, and the data does not repeat any more.
    Faces,
    /// No sphere is repeated, but all are moved into the cell.
    Wrap,
    /// No sphere is repeated, but molecules that faces of the cell cut are made whole, with their middle in the cell.
    Whole,
}

/// The most spheres that come out.
const MOST: usize = 200_000_000;

/// Spheres that are closer to a face than this part of an edge are at it.
const AT_FACE: f64 = 1e-3;

/// Spheres cannot be repeated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReplicateError(&'static str);

impl fmt::Display for ReplicateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

impl std::error::Error for ReplicateError {}

impl FromStr for Replicate {
    type Err = ReplicateError;

    fn from_str(text: &str) -> Result<Self, ReplicateError> {
        let text = text.trim();
        if text.eq_ignore_ascii_case("faces") {
            return Ok(Self::Faces);
        }
        if text.eq_ignore_ascii_case("wrap") {
            return Ok(Self::Wrap);
        }
        if text.eq_ignore_ascii_case("whole") {
            return Ok(Self::Whole);
        }
        let counts: Option<Vec<u32>> =
            text.split(['x', 'X', ',', ' ']).map(|part| part.parse().ok().filter(|count| *count > 0)).collect();
        match counts.as_deref() {
            Some(&[count]) => Ok(Self::Cells([count; 3])),
            Some(&[a, b, c]) => Ok(Self::Cells([a, b, c])),
            _ => Err(ReplicateError(
                "write the numbers of cells along the edges, such as 2x2x1, or faces, wrap or whole",
            )),
        }
    }
}

impl fmt::Display for Replicate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cells([a, b, c]) => write!(f, "{a}x{b}x{c}"),
            Self::Faces => f.write_str("faces"),
            Self::Wrap => f.write_str("wrap"),
            Self::Whole => f.write_str("whole"),
        }
    }
}

impl Replicate {
    /// Repeats the spheres of data, with their values. The cell grows with them.
    ///
    /// # Errors
    /// Returns an error if the data has no periodic cell, or too many spheres would come out.
    pub fn apply(self, data: &mut Dataset) -> Result<(), ReplicateError> {
        const NO_CELL: ReplicateError = ReplicateError("the data has no periodic cell; leave it out");
        if data.is_part_of_crystal {
            return Err(ReplicateError(
                "the symmetry of the crystal is not applied, so its cell is not full; leave it out",
            ));
        }
        let cell = PeriodicCell::of(data).ok_or(NO_CELL)?;
        match self {
            Self::Cells(counts) => cells(data, &cell, counts),
            Self::Faces => faces(data, &cell),
            Self::Wrap => {
                data.move_centers(|_, center| cell.moved(center, -cell.turns(center)));
                Ok(())
            }
            Self::Whole => whole(data, &cell),
        }
    }
}

fn cells(data: &mut Dataset, cell: &PeriodicCell, counts: [u32; 3]) -> Result<(), ReplicateError> {
    if (0..3).any(|axis| counts[axis] > 1 && !data.is_periodic[axis]) {
        return Err(ReplicateError("the data does not repeat along all of these edges; write 1 for the others"));
    }
    let count = data.spheres.len();
    let copies = counts.iter().try_fold(1_usize, |all, count| all.checked_mul(*count as usize));
    let total = copies.and_then(|copies| copies.checked_mul(count)).filter(|total| *total <= MOST);
    let Some((_, copies)) = total.zip(copies) else {
        return Err(ReplicateError("there would be more than 200 million spheres; choose fewer cells"));
    };
    let [a, b, c] = counts.map(u64::from);
    let turns: Vec<[u64; 3]> = (0..c).flat_map(|z| (0..b).flat_map(move |y| (0..a).map(move |x| [x, y, z]))).collect();
    // A bond that reaches into another cell joins the copies there.
    let bonds = std::mem::take(&mut data.bonds);
    let reaches: Vec<DVec3> = bonds
        .iter()
        .map(|[from, to]| cell.turns_to_nearest(data.center(*from as usize), data.center(*to as usize)))
        .collect();
    let place = |[x, y, z]: [u64; 3]| (x + a * (y + b * z)) as u32;
    let mut repeated: Vec<[u32; 2]> = turns
        .iter()
        .flat_map(|own| {
            let bonds = bonds.iter().zip(&reaches);
            bonds.map(move |([from, to], reach)| {
                let other =
                    [0, 1, 2].map(|k| (own[k] as i64 + reach[k] as i64).rem_euclid(i64::from(counts[k])) as u64);
                let ends = [from + count as u32 * place(*own), to + count as u32 * place(other)];
                [ends[0].min(ends[1]), ends[0].max(ends[1])]
            })
        })
        .collect();
    repeated.sort_unstable();
    repeated.dedup();
    let indices: Vec<u32> = (0..copies).flat_map(|_| 0..count as u32).collect();
    data.repeat(&indices);
    data.bonds = repeated;
    let shift = |index: usize| cell.edges * DVec3::from(turns[index / count.max(1)].map(|turn| turn as f64));
    data.move_centers(|index, center| center + shift(index));
    data.cell = data.cell.map(|edges| [0, 1, 2].map(|axis| edges[axis].map(|part| part * f64::from(counts[axis]))));
    Ok(())
}

fn faces(data: &mut Dataset, cell: &PeriodicCell) -> Result<(), ReplicateError> {
    let inverse = cell.edges.inverse();
    let origin = DVec3::from(data.cell_origin);
    let (mut indices, mut centers) = (Vec::new(), Vec::new());
    for index in 0..data.spheres.len() {
        let center = data.center(index);
        let moved = cell.moved(center, -cell.turns(center));
        let mut place = inverse * (moved - origin);
        let mut is_at = [false; 3];
        for axis in 0..3 {
            // What is rounded at the far face is at the near one.
            if data.is_periodic[axis] && place[axis] > 1.0 - AT_FACE {
                place[axis] -= 1.0;
            }
            is_at[axis] = data.is_periodic[axis] && place[axis].abs() < AT_FACE;
        }
        for corner in 0..8_usize {
            let of_axis = |axis: usize| corner >> axis & 1 == 1;
            if (0..3).all(|axis| is_at[axis] || !of_axis(axis)) {
                let turns = DVec3::from([0, 1, 2].map(|axis| f64::from(u8::from(of_axis(axis)))));
                indices.push(index as u32);
                centers.push(origin + cell.edges * (place + turns));
            }
        }
    }
    if indices.len() > MOST {
        return Err(ReplicateError("there would be more than 200 million spheres"));
    }
    if !data.bonds.is_empty() {
        data.notes.push("the bonds of the file are left out where atoms at faces are repeated".to_owned());
    }
    data.repeat(&indices);
    data.move_centers(|index, center| centers.get(index).copied().unwrap_or(center));
    data.is_periodic = [false; 3];
    Ok(())
}

/// Moves spheres by the numbers of cells that the file gives for each.
fn by_images(data: &mut Dataset, cell: &PeriodicCell) -> Result<(), ReplicateError> {
    let columns = ["ix", "iy", "iz"].map(|name| match data.column(name) {
        Some(ColumnValues::Numbers(numbers)) => Some(numbers.clone()),
        _ => None,
    });
    let [Some(x), Some(y), Some(z)] = columns else {
        return Err(ReplicateError(
            "neither bonds nor columns ix, iy and iz say which spheres belong together; --bond-length LENGTH makes bonds",
        ));
    };
    let turns = |index: usize| DVec3::new(x[index], y[index], z[index]);
    let is_known = |index: usize| index < x.len() && turns(index).is_finite();
    data.move_centers(|index, center| if is_known(index) { cell.moved(center, turns(index)) } else { center });
    Ok(())
}

/// Moves spheres to their images beside others to which bonds join them.
fn whole(data: &mut Dataset, cell: &PeriodicCell) -> Result<(), ReplicateError> {
    let Ok(pairs) = bonded_pairs(data) else { return by_images(data, cell) };
    let mut links: Vec<[u32; 2]> = pairs.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]).collect();
    links.sort_unstable();
    let mut centers: Vec<DVec3> = (0..data.spheres.len()).map(|index| data.center(index)).collect();
    let mut is_placed = vec![false; centers.len()];
    for start in 0..centers.len() {
        if std::mem::replace(&mut is_placed[start], true) {
            continue;
        }
        let (mut molecule, mut next) = (Vec::new(), vec![start as u32]);
        while let Some(from) = next.pop() {
            molecule.push(from);
            let first = links.partition_point(|[end, _]| *end < from);
            for [_, to] in links[first..].iter().take_while(|[end, _]| *end == from) {
                if !std::mem::replace(&mut is_placed[*to as usize], true) {
                    let turns = cell.turns_to_nearest(centers[from as usize], centers[*to as usize]);
                    centers[*to as usize] = cell.moved(centers[*to as usize], turns);
                    next.push(*to);
                }
            }
        }
        let middle = molecule.iter().map(|index| centers[*index as usize]).sum::<DVec3>() / molecule.len() as f64;
        for index in molecule {
            centers[index as usize] = cell.moved(centers[index as usize], -cell.turns(middle));
        }
    }
    data.move_centers(|index, center| centers.get(index).copied().unwrap_or(center));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{self, Options};

    fn salt() -> Dataset {
        let text =
            "2\nLattice=\"4 0 0 1 4 0 0 0 4\" Properties=species:S:1:pos:R:3:q:R:1\nNa 0 0 0 1\nCl 2.5 2 3.9999 2\n";
        load::from_bytes(text.as_bytes(), "a.xyz", &Options::default()).unwrap()
    }

    #[test]
    fn spheres_are_moved_into_the_cell() {
        let text = "3\nLattice=\"4 0 0 1 4 0 0 0 4\" Properties=species:S:1:pos:R:3\nNa 5 1 1\nCl -1 2 3\nCl 1 1 1\n";
        let mut data = load::from_bytes(text.as_bytes(), "a.xyz", &Options::default()).unwrap();
        let replicate: Replicate = "wrap".parse().unwrap();
        assert_eq!(replicate.to_string(), "wrap");
        replicate.apply(&mut data).unwrap();
        assert_eq!(centers(&data), [[1.0, 1.0, 1.0], [3.0, 2.0, 3.0], [1.0, 1.0, 1.0]]);
        assert_eq!(data.is_periodic, [true; 3]);
    }

    #[test]
    fn molecules_are_made_whole() {
        let water = "4\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3\nO 8.9 1 8.9\nH 0.8 1 8.9\nH 8.9 1 0.7\nAr -4 0 9\n";
        let mut data = load::from_bytes(water.as_bytes(), "a.xyz", &Options::default()).unwrap();
        "whole".parse::<Replicate>().unwrap().apply(&mut data).unwrap();
        let wanted = [[-0.1, 1.0, -0.1], [0.8, 1.0, -0.1], [-0.1, 1.0, 0.7], [5.0, 0.0, 0.0]];
        for (found, wanted) in centers(&data).iter().zip(wanted) {
            assert!((DVec3::from(*found) - DVec3::from(wanted)).length() < 1e-9, "{found:?}");
        }
    }

    fn centers(data: &Dataset) -> Vec<[f64; 3]> {
        (0..data.spheres.len()).map(|index| data.center(index).to_array()).collect()
    }

    #[test]
    fn cells_are_repeated_with_their_values_and_bonds() {
        let mut data = salt();
        data.bonds = vec![[0, 1]];
        "1x2x1".parse::<Replicate>().unwrap().apply(&mut data).unwrap();
        assert_eq!(centers(&data), [[0.0; 3], [2.5, 2.0, 3.9999], [1.0, 4.0, 0.0], [3.5, 6.0, 3.9999]]);
        assert_eq!(data.cell, Some([[4.0, 0.0, 0.0], [2.0, 8.0, 0.0], [0.0, 0.0, 4.0]]));
        assert_eq!(data.labels("species").unwrap().indices, [0, 1, 0, 1]);
        assert_eq!(data.bonds, [[0, 1], [2, 3]]);
        let mut data = salt();
        data.bonds = vec![[0, 1]];
        // The nearest image of the second atom is in the cell below.
        Replicate::Cells([1, 1, 3]).apply(&mut data).unwrap();
        assert_eq!(data.bonds, [[0, 5], [1, 2], [3, 4]]);
    }

    #[test]
    fn faces_are_repeated() {
        let mut data = salt();
        Replicate::Faces.apply(&mut data).unwrap();
        // Eight corners, and the other at two faces.
        assert_eq!(data.spheres.len(), 10);
        assert!(centers(&data).contains(&[5.0, 4.0, 4.0]));
        assert_eq!(data.is_periodic, [false; 3]);
    }

    #[test]
    fn what_cannot_be_repeated_is_refused() {
        for text in ["", "0x1x1", "2x2", "axbxc", "-1", "1x1x1x1", "9999999999"] {
            assert!(text.parse::<Replicate>().is_err(), "{text}");
        }
        assert_eq!("3".parse(), Ok(Replicate::Cells([3; 3])));
        let refused = |replicate: Replicate, data: &mut Dataset| replicate.apply(data).unwrap_err().to_string();
        let mut data = salt();
        assert!(refused(Replicate::Cells([u32::MAX; 3]), &mut data).contains("200 million"));
        data.is_periodic[2] = false;
        assert!(refused(Replicate::Cells([1, 1, 2]), &mut data).contains("does not repeat"));
        data.cell = None;
        assert!(refused(Replicate::Faces, &mut data).contains("no periodic cell"));
    }
}
