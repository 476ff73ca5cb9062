//! Which of an atom's alternate locations is kept.

use std::collections::HashMap;

/// What tells the locations of one atom apart, and atoms from each other.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// The residue: its chain, its number and its insertion code.
    pub(super) key: (u32, u64, u8),
    /// The name of the residue, which differs where one residue or another is at one place.
    pub(super) residue: u32,
    /// The name of the atom.
    pub(super) name: u32,
    /// The letter of the location, or a blank.
    pub(super) letter: u8,
    /// How much of the atom is there.
    pub(super) occupancy: f64,
}

/// All atoms of one residue that have one letter.
struct Location {
    letter: u8,
    residue: u32,
    /// The highest of its atoms.
    occupancy: f64,
}

/// Which atoms are kept.
///
/// In each residue the letters are ranked by the highest occupancy of their atoms, and by their order in
/// the file where this is the same; the blank precedes them all. Of each atom the location of the best
/// rank that it has is kept, so that neighbours belong together. Atoms of another residue than that of
/// the best letter are not kept.
pub(super) fn kept(atoms: impl Iterator<Item = Place> + Clone) -> Vec<bool> {
    let mut residues: HashMap<_, Vec<Location>> = HashMap::new();
    for Place { key, residue, letter, occupancy, .. } in atoms.clone().filter(|a| a.letter != b' ')
    {
        let locations = residues.entry(key).or_default();
        match locations.iter_mut().find(|location| location.letter == letter) {
            Some(location) => location.occupancy = location.occupancy.max(occupancy),
            None => locations.push(Location { letter, residue, occupancy }),
        }
    }
    for locations in residues.values_mut() {
        locations.sort_by(|a, b| b.occupancy.total_cmp(&a.occupancy));
    }
    let rank = |atom: &Place| {
        let locations = residues.get(&atom.key)?;
        if atom.letter == b' ' {
            return Some(0);
        }
        let same_residue = locations.first()?.residue == atom.residue;
        let index = locations.iter().position(|location| location.letter == atom.letter)?;
        same_residue.then_some(index + 1)
    };
    let mut best = HashMap::new();
    for atom in atoms.clone() {
        if let Some(rank) = rank(&atom) {
            let best = best.entry((atom.key, atom.name)).or_insert(rank);
            *best = rank.min(*best);
        }
    }
    atoms
        .map(|atom| {
            atom.letter == b' '
                || rank(&atom).is_some_and(|rank| best.get(&(atom.key, atom.name)) == Some(&rank))
        })
        .collect()
}
