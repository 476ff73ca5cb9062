//! Chooses which alternate location of each atom is kept.

use std::collections::HashMap;

/// An atom record, reduced to the fields that identify the atom and one of its alternate locations.
#[derive(Clone, Copy)]
pub(super) struct Candidate {
    /// The residue: its chain, its number and its insertion code.
    pub(super) key: (u32, u64, u8),
    /// The index of the residue's name. Two residues can be alternatives for the same place in the chain.
    pub(super) residue: u32,
    /// The index of the atom's name.
    pub(super) name: u32,
    /// The letter of the location, or a blank.
    pub(super) letter: u8,
    /// The occupancy of this location, usually from 0 to 1.
    pub(super) occupancy: f64,
}

/// The atoms of one residue that share a location letter.
struct Location {
    letter: u8,
    residue: u32,
    /// The highest occupancy of these atoms.
    occupancy: f64,
}

/// Returns for each atom record whether it is kept.
///
/// In each residue the letters are ranked by the highest occupancy of their atoms, and by their order in the file
/// where the occupancies are equal; the blank precedes them all. Each atom keeps the best-ranked of its locations, so
/// that neighbouring atoms come from the same location. If a residue name other than that of the best letter occurs
/// at the same place in the chain, its atoms are not kept.
pub(super) fn kept(atoms: impl Iterator<Item = Candidate> + Clone) -> Vec<bool> {
    let mut residues: HashMap<_, Vec<Location>> = HashMap::new();
    for Candidate { key, residue, letter, occupancy, .. } in
        atoms.clone().filter(|a| a.letter != b' ')
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
    let rank = |atom: &Candidate| {
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
