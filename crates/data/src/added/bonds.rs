//! Bonds between atoms.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3};

use super::shapes::{AddError, AddedShapes, Look};
use crate::load::{Covalent, Dataset, covalent};
use pinhole::internals::text::{listed, shortened};
use pinhole::scene::Appearance;
use pinhole::scene::material::Material;
use pinhole::scene::sphere_array::SphereArray;

/// The choice of bonded atoms. Bonds are drawn as cylinders, each half with the look of its atom.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Bonds {
    /// The greatest distance of bonded atoms.
    pub length: BondLength,
}

/// The greatest distance of bonded atoms, or spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BondLength {
    /// Two atoms are bonded if they are closer than this factor times the sum of their covalent radii (Cordero et al.
    /// 2008), unless both are hydrogen. Lengths are in Å.
    Covalent(f64),
    /// Two spheres of any kind are bonded if they are closer than this length.
    Below(f64),
}

impl Bonds {
    /// The factor of covalent radii by default: bonds may be a fifth longer than usual, as `CovalentBond.is_bonded` of
    /// pymatgen allows. Psi4 uses 1.3.
    pub const FACTOR: f64 = 1.2;

    /// Bonds of this length.
    #[must_use]
    pub fn new(length: BondLength) -> Self {
        Self { length }
    }
}

impl Default for Bonds {
    fn default() -> Self {
        Self::new(BondLength::Covalent(Self::FACTOR))
    }
}

/// The factor by which bonded atoms are smaller than their van der Waals radius.
const BALL: f64 = 0.25;

/// The factor by which bonded spheres are smaller that are not atoms of an element. Neighbours among them often
/// touch.
const OTHER_BALL: f64 = 0.5;

/// The radius of a stick, in radii of the smaller of the spheres that it joins.
const STICK: f64 = 0.45;

/// The factor by which bonds make a sphere of a species smaller.
pub(super) fn radius_factor(species: Option<&str>) -> f64 {
    if species.and_then(covalent).is_some() { BALL } else { OTHER_BALL }
}

fn center(spheres: &SphereArray, index: usize) -> (DVec3, f64) {
    let [x, y, z, radius] = spheres.at(index);
    (DVec3::new(x, y, z), radius)
}

impl Bonds {
    pub(super) fn add(&self, data: &Dataset, appearance: &Appearance, added: &mut AddedShapes) -> Result<(), AddError> {
        let count = data.spheres.len();
        let points: Vec<DVec3> = (0..count).map(|index| center(&data.spheres, index).0).collect();
        let bonds = match self.length {
            BondLength::Below(length) => {
                check("length", length)?;
                pairs(&points, length, |_, _, squared| squared > 0.0)?
            }
            BondLength::Covalent(factor) => {
                check("factor", factor)?;
                covalent_bonds(factor, data, &points, &mut added.notes)?
            }
        };
        added.bonds = bonds.len();
        let surface = |id: u32| appearance.surface_indices().and_then(|all| all.get(id as usize).copied());
        for [a, b] in bonds {
            let ((from, ball_a), (to, ball_b)) = (center(&data.spheres, a as usize), center(&data.spheres, b as usize));
            let radius = STICK * ball_a.min(ball_b);
            let (length, middle) = ((to - from).length(), 0.5 * (from + to));
            let along = (to - from) / length;
            // The stick leaves a ball at this distance from its centre.
            let [out_a, out_b] = [ball_a, ball_b].map(|ball| (ball * ball - radius * radius).max(0.0).sqrt());
            // It starts deeper by its radius, so that no part is short, but not behind the centre.
            let deep = |out: f64| (out - radius).max(0.0) * along;
            let ends = [from + deep(out_a), to - deep(out_b)];
            let halves = [(a, [ends[0], middle], 0.5 * length - out_a), (b, [middle, ends[1]], 0.5 * length - out_b)];
            let whole = [(a, ends, length - out_a - out_b)];
            let are_alike = appearance.color(a) == appearance.color(b) && surface(a) == surface(b);
            let parts = if are_alike { &whole[..] } else { &halves };
            for (atom, ends, _) in parts.iter().filter(|(.., seen)| *seen > 0.0 && radius > 0.0) {
                added.push(*ends, radius, Look::Sphere(*atom)).map_err(|error| {
                    AddError(format!(
                        "the bond between the spheres {a} and {b} cannot be drawn: {error}; choose larger radii, or a \
                         smaller factor or length of bonds"
                    ))
                })?;
            }
        }
        if data.cell.is_some() {
            added.notes.push("bonds across the borders of the periodic cell are not drawn".to_owned());
        }
        let shines = appearance.surfaces().iter().any(|surface| matches!(surface.material, Material::Emissive { .. }));
        if shines && added.bonds > 0 {
            added.notes.push("bonds of spheres that emit light are drawn without light".to_owned());
        }
        Ok(())
    }
}

fn check(what: &str, value: f64) -> Result<(), AddError> {
    match value.is_finite() && value > 0.0 {
        true => Ok(()),
        false => Err(AddError(format!("`bonds`: the {what} is {value}; it must be finite and greater than 0"))),
    }
}

fn no_elements() -> AddError {
    AddError(
        "the data does not say which chemical elements its spheres are, from which the lengths of bonds follow; give the \
         length below which two spheres are bonded (--bond-length L, or bonds = { length = L })"
            .to_owned(),
    )
}

/// Finds pairs of spheres that are closer than `factor` times the sum of their covalent radii.
fn covalent_bonds(
    factor: f64,
    data: &Dataset,
    points: &[DVec3],
    notes: &mut Vec<String>,
) -> Result<Vec<[u32; 2]>, AddError> {
    let labels = data.labels("species").ok_or_else(no_elements)?;
    let known: Vec<Option<Covalent>> = labels.names.iter().map(|name| covalent(name)).collect();
    let largest = known.iter().flatten().map(|known| known.radius).fold(0.0, f64::max);
    if largest <= 0.0 && !points.is_empty() {
        return Err(no_elements());
    }
    if known.contains(&None) {
        let names = labels.names.iter().zip(&known);
        let unknown = names.filter(|(_, known)| known.is_none()).map(|(name, _)| shortened(name));
        notes.push(format!(
            "these species have no covalent radius and therefore no bonds: {}; --bond-length L joins all that are closer",
            listed(unknown, 5)
        ));
    }
    let of = |index: u32| {
        let species = *labels.indices.get(index as usize)? as usize;
        known.get(species).copied().flatten()
    };
    pairs(points, 2.0 * factor * largest, |a, b, squared| {
        let Some((a, b)) = of(a).zip(of(b)) else { return false };
        let most = factor * (a.radius + b.radius);
        squared > 0.0 && squared < most * most && !(a.is_hydrogen && b.is_hydrogen)
    })
}

/// The most pairs for each point, on average. The densest packing of equal spheres has 6 pairs of neighbours for each.
pub(super) const MOST_PAIRS: usize = 16;

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
/// `is_pair` is true. `is_pair` gets two indices and the squared distance.
pub(super) fn pairs(
    points: &[DVec3],
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
                if squared <= reach * reach && is_pair(a, b, squared) {
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
            let found = pairs(&points, reach, |_, _, _| true).unwrap();
            assert_eq!(found, all_pairs(&points, reach));
            assert!(!found.is_empty());
        }
    }

    #[test]
    fn a_crowd_is_refused_before_it_takes_long() {
        let points = vec![DVec3::ZERO; 100_000];
        let refused = |all| pairs(&points, 1.0, |_, _, _| all).unwrap_err().to_string();
        assert!(refused(true).contains("pairs of 100000 spheres would be bonds"));
        assert!(refused(false).starts_with("too many of the 100000 spheres are close together"));
    }
}
