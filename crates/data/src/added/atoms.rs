//! The elements of atoms that distances may join, and their ions.

use super::shapes::AddError;
use crate::load::{ColumnValues, Covalent, Dataset, Family, Labels, covalent};
use pinhole::internals::text::{listed, shortened};

/// The sum of the radii of two bonded oxygen atoms in Å. With the usual factor it gives 1.52, a little more than in peroxides.
const BONDED_OXYGEN: f64 = 1.27;

/// The elements of spheres, and which of them are ions.
pub(super) struct Atoms<'a> {
    labels: &'a Labels,
    /// For each name of the labels, the covalent radius.
    known: Vec<Option<Covalent>>,
    is_ion: Vec<bool>,
    /// The largest covalent radius.
    pub(super) largest: f64,
}

impl<'a> Atoms<'a> {
    /// The atoms of data; `None` if no element has a covalent radius.
    pub(super) fn of(data: &'a Dataset) -> Option<Self> {
        let labels = data.labels("species")?;
        let known: Vec<Option<Covalent>> = labels.names.iter().map(|name| covalent(name)).collect();
        let largest = known.iter().flatten().map(|known| known.radius).fold(0.0, f64::max);
        let mut atoms = Self { labels, known, is_ion: Vec::new(), largest };
        atoms.is_ion = atoms.ions(data);
        (largest > 0.0 || data.spheres.is_empty()).then_some(atoms)
    }

    /// Returns true if all spheres are atoms of elements with a covalent radius.
    pub(super) fn are_all_known(&self) -> bool {
        !self.known.contains(&None)
    }

    /// The note about species without a covalent radius.
    pub(super) fn note(&self) -> Option<String> {
        let names = self.labels.names.iter().zip(&self.known);
        let unknown = names.filter(|(name, known)| known.is_none() && !name.is_empty());
        let unknown: Vec<String> = unknown.map(|(name, _)| shortened(name)).collect();
        (!unknown.is_empty()).then(|| {
            format!(
                "these species have no covalent radius and therefore no bonds: {}; --bond-length L joins all that are closer",
                listed(unknown.into_iter(), 5)
            )
        })
    }

    /// Returns true if all spheres are metals, among which no bonds are found.
    pub(super) fn are_metals(&self) -> bool {
        let is_metal = |known: &Option<Covalent>| known.is_some_and(|known| known.family == Family::Metal);
        !self.known.is_empty() && self.known.iter().all(is_metal)
    }

    fn atom(&self, index: u32) -> Option<Covalent> {
        let species = *self.labels.indices.get(index as usize)? as usize;
        self.known.get(species).copied().flatten()
    }

    /// The distance in Å within which two atoms are bonded, in units of the factor; `None` for those that are never joined
    /// by distance: two atoms of hydrogen, two metals, and an ion with any other.
    pub(super) fn most(&self, a: u32, b: u32) -> Option<f64> {
        let is_ion = |index: u32| self.is_ion.get(index as usize).copied().unwrap_or(false);
        let (one, other) = self.atom(a).zip(self.atom(b))?;
        match (one.family, other.family) {
            (Family::Hydrogen, Family::Hydrogen) | (Family::Metal, Family::Metal) => None,
            _ if is_ion(a) || is_ion(b) => None,
            (Family::Oxygen, Family::Oxygen) => Some(BONDED_OXYGEN),
            _ => Some(one.radius + other.radius),
        }
    }

    /// Finds the metals and halogens that are alone in their residues. If every atom is, the residues say nothing.
    fn ions(&self, data: &Dataset) -> Vec<bool> {
        let columns = ["residue_number", "residue", "chain", "icode"].map(|name| data.column(name));
        if columns[0].is_none() {
            return Vec::new();
        }
        let count = data.spheres.len();
        let differs = |index: usize| {
            columns.iter().flatten().any(|values| match values {
                ColumnValues::Numbers(numbers) => {
                    numbers.get(index).map(|n| n.to_bits()) != numbers.get(index - 1).map(|n| n.to_bits())
                }
                ColumnValues::Labels(labels) => labels.indices.get(index) != labels.indices.get(index - 1),
            })
        };
        let starts: Vec<bool> = (0..=count).map(|index| index == 0 || index == count || differs(index)).collect();
        if !starts.contains(&false) {
            return Vec::new();
        }
        let is_ion = |index: usize| {
            let family = self.atom(index as u32).map(|atom| atom.family);
            starts[index] && starts[index + 1] && matches!(family, Some(Family::Metal | Family::Halogen))
        };
        (0..count).map(is_ion).collect()
    }
}

pub(super) fn no_elements() -> AddError {
    AddError(
        "the data does not say which chemical elements its spheres are, from which the lengths of bonds follow; give the \
         length below which two spheres are bonded (--bond-length L, or bonds = { length = L })"
            .to_owned(),
    )
}

#[cfg(test)]
mod tests {
    use crate::added::bonded_pairs;
    use crate::load::{Dataset, Options, from_bytes};

    fn read(name: &str, text: &str) -> Dataset {
        from_bytes(text.as_bytes(), name, &Options::default()).unwrap()
    }

    fn pairs(data: &Dataset) -> Vec<[u32; 2]> {
        bonded_pairs(data).unwrap()
    }

    /// In rutile titanium is 2.96 Å from titanium, less than 1.2 times two radii, and six times 1.95 to 1.98 Å from oxygen.
    #[test]
    fn metals_are_not_joined() {
        let rutile = "rutile\n1\n4.594 0 0\n0 4.594 0\n0 0 2.959\nTi O\n2 4\nDirect\n0 0 0\n.5 .5 .5\n.305 .305 0\n\
                      .695 .695 0\n.195 .805 .5\n.805 .195 .5\n";
        let data = read("a.vasp", rutile);
        let found = pairs(&data);
        assert_eq!(found.len(), 8, "{found:?}");
        assert!(found.iter().all(|[a, b]| *a < 2 && *b >= 2), "{found:?}");
        assert!(pairs(&read("a.xyz", "2\n\nCu 0 0 0\nCu 2.5 0 0\n")).is_empty());
    }

    /// Two oxygen atoms of a heme in the entry 4HHB are 1.54 Å apart, within 1.2 times two radii. They are a carboxylate's.
    #[test]
    fn oxygen_is_joined_up_to_the_length_of_peroxides() {
        for (distance, count) in [("1.21", 1), ("1.48", 1), ("1.54", 0)] {
            let found = pairs(&read("a.xyz", &format!("2\n\nO 0 0 0\nO {distance} 0 0\n")));
            assert_eq!(found.len(), count, "{distance}");
        }
    }

    fn pdb(atoms: &[(&str, &str, u32, f64)], more: &str) -> Dataset {
        let line = |(name, residue, number, x): &(&str, &str, u32, f64)| {
            let element = name.trim();
            format!(
                "HETATM{number:>5} {name:<4} {residue:>3} A{number:>4}    {x:8.3}   0.000   0.000  1.00  0.00          \
                 {element:>2}\n"
            )
        };
        read("a.pdb", &(atoms.iter().map(line).collect::<String>() + more))
    }

    #[test]
    fn ions_are_joined_only_by_the_file() {
        let atoms = [("ZN", "ZN", 1, 0.0), (" S", "CYS", 2, 2.3), (" C", "CYS", 2, 4.1), ("CL", "CL", 3, 5.8)];
        assert_eq!(pairs(&pdb(&atoms, "")), [[1, 2]]);
        assert_eq!(pairs(&pdb(&atoms[..2], "")), [[0, 1]], "each atom is a residue of its own");
        let mut listed = pdb(&[("ZN", "ZN", 1, 0.0), (" S", "CYS", 2, 2.3)], "CONECT    1    2\n");
        assert_eq!(pairs(&listed), [[0, 1]]);
        let three = pdb(&[("ZN", "ZN", 1, 0.0), (" S", "CYS", 2, 9.3), (" C", "CYS", 2, 7.5)], "CONECT    1    2\n");
        assert_eq!(three.bonds.len(), 0, "two atoms have the number 2");
        listed.keep(&[true, false]);
        assert!(listed.bonds.is_empty());
    }

    #[test]
    fn bonds_of_the_file_need_no_elements() {
        let header = "made\n\n3 atoms\n2 bonds\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\n";
        let chain = "Atoms # bond\n\n1 1 1 0 0 0\n2 1 1 4 0 0\n3 1 1 8.5 0 0\n\nBonds\n\n1 1 1 2\n2 1 1 3\n";
        let beads = read("a.data", &format!("{header}{chain}"));
        assert_eq!(pairs(&beads), [[0, 1], [0, 2]]);
        let masses = |mass: f64| read("a.data", &format!("{header}Masses\n\n1 {mass}\n\n{chain}"));
        assert_eq!(pairs(&masses(12.011)), [[0, 1], [0, 2]]);
        assert!(bonded_pairs(&read("a.data", &format!("{header}{}", chain.split("\nBonds").next().unwrap()))).is_err());
    }

    /// The file lists all bonds of what is partly not an element; distances would join more.
    #[test]
    fn complete_lists_are_enough_without_elements() {
        let molecule = |symbol: &str, bonds: &str| {
            let atom = |x: f64, symbol: &str| format!("{x:10.4}    0.0000    0.0000 {symbol:<3} 0  0\n");
            let atoms = [atom(0.0, "C"), atom(1.5, "C"), atom(2.9, symbol)].concat();
            read(
                "a.mol",
                &format!("a\n\n\n  3  {}  0  0  0  0            999 V2000\n{atoms}{bonds}M  END\n", bonds.len() / 10),
            )
        };
        assert_eq!(pairs(&molecule("O", "  2  3  1\n")), [[0, 1], [1, 2]]);
        assert_eq!(pairs(&molecule("R#", "  2  3  1\n")), [[1, 2]]);
        assert_eq!(pairs(&molecule("R#", "")), [[0, 1]]);
    }
}
