//! Collects the atoms of one model of a molecule, as PDB and mmCIF have them.

pub(super) mod element;
mod links;

pub(super) use links::AtomKey;

use std::collections::{HashMap, HashSet};

use super::bonds;
use super::dataset::{labels_in, retain};
use super::elements::{Appearance, UnknownSpecies, appearance};
use super::labels::{LabelsBuilder, Memo};
use super::{Column, ColumnValues, Dataset, Labels};
use element::{Residue, unaligned};
use pinhole::image::color::LinearRgb;
use pinhole::internals::text::{listed, shortened};
use pinhole::scene::sphere_array::SphereArray;

pub(super) struct Atom<'a> {
    pub(super) place: [f64; 3],
    pub(super) occupancy: f64,
    pub(super) b_factor: f64,
    pub(super) residue_number: f64,
    pub(super) name: &'a [u8],
    /// The name as in columns 13-16 of a PDB file, where its position shows the element.
    pub(super) name_field: [u8; 4],
    /// The symbol of the element; blank if the file does not have it.
    pub(super) symbol: [u8; 2],
    pub(super) residue: &'a [u8],
    pub(super) chain: &'a [u8],
    /// The name of the record: ATOM or HETATM.
    pub(super) record: &'a [u8],
    /// The molecule that the atom belongs to, in mmCIF.
    pub(super) entity: Option<&'a [u8]>,
    /// The partial charge and the type of AutoDock, in PDBQT files.
    pub(super) docking: Option<(f64, &'a [u8])>,
    /// The letter of the alternate location, or a blank.
    pub(super) letter: u8,
    /// The insertion code of the residue, or a blank.
    pub(super) insertion: u8,
    /// The number of the atom in the file, or NaN.
    pub(super) serial: f64,
}

/// The atoms that were read so far, in the order of the file.
#[derive(Default)]
pub(super) struct Atoms {
    spheres: Vec<[f64; 4]>,
    colors: Vec<LinearRgb>,
    species: Species,
    name: LabelsBuilder,
    residue: LabelsBuilder,
    residues: Vec<Residue>,
    chain: LabelsBuilder,
    record: LabelsBuilder,
    entity: LabelsBuilder,
    charge: Vec<f64>,
    kind: LabelsBuilder,
    residue_number: Vec<f64>,
    occupancy: Vec<f64>,
    b_factor: Vec<f64>,
    /// The letter of the alternate location and the insertion code of the residue, for each atom.
    letters: Vec<[u8; 2]>,
    serial: Vec<f64>,
    /// Bonds between atoms, in any order.
    bonds: Vec<[u32; 2]>,
    has_alternates: bool,
    /// Indices of atoms without a symbol whose name means calcium or, in the wrong columns, the alpha carbon.
    doubtful: Vec<usize>,
}

impl Atoms {
    pub(super) fn with_capacity(atoms: usize) -> Self {
        let labels = || LabelsBuilder::with_capacity(atoms);
        Self {
            species: Species { labels: labels(), ..Species::default() },
            name: labels(),
            residue: labels(),
            chain: labels(),
            record: labels(),
            spheres: Vec::with_capacity(atoms),
            colors: Vec::with_capacity(atoms),
            residue_number: Vec::with_capacity(atoms),
            occupancy: Vec::with_capacity(atoms),
            b_factor: Vec::with_capacity(atoms),
            letters: Vec::with_capacity(atoms),
            serial: Vec::with_capacity(atoms),
            ..Self::default()
        }
    }

    /// The residue number of the atom that was read last.
    pub(super) fn last_residue_number(&self) -> Option<f64> {
        self.residue_number.last().copied()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.spheres.is_empty()
    }

    pub(super) fn push(&mut self, atom: &Atom<'_>) {
        self.occupancy.push(atom.occupancy);
        self.b_factor.push(atom.b_factor);
        self.residue_number.push(atom.residue_number);
        self.name.push(atom.name);
        let index = self.residue.push(atom.residue) as usize;
        if let (true, Some(name)) = (index == self.residues.len(), self.residue.names.get(index)) {
            self.residues.push(Residue::of(name));
        }
        let residue = self.residues.get(index).copied().unwrap_or(Residue::Other);
        self.chain.push(atom.chain);
        self.record.push(atom.record);
        if let Some(entity) = atom.entity {
            self.entity.push(entity);
        }
        if let Some((charge, kind)) = atom.docking {
            self.charge.push(charge);
            self.kind.push(kind);
        }
        if element::is_doubtful(atom.name_field, atom.symbol, residue, atom.residue) {
            self.doubtful.push(self.spheres.len());
        }
        let appearance = self.species.push(atom.name_field, atom.symbol, residue);
        let [x, y, z] = atom.place;
        self.spheres.push([x, y, z, appearance.radius]);
        self.colors.push(appearance.color);
        self.letters.push([atom.letter, atom.insertion]);
        self.serial.push(atom.serial);
        self.has_alternates |= atom.letter != b' ';
    }

    /// Decides which doubtful atoms are carbon: those whose residue has other atoms of a backbone. The others are
    /// calcium. Returns notes.
    fn decide_doubtful(&mut self) -> Vec<String> {
        let residue_of = |atom: usize| {
            let labels = (self.chain.indices[atom], self.residue.indices[atom]);
            (labels, self.residue_number[atom].to_bits(), self.letters[atom][1])
        };
        let is_backbone = |atom: &usize| {
            let name = &self.name.names[self.name.indices[*atom] as usize];
            name == "C" || name == "N"
        };
        let backbones: HashSet<_> = match self.doubtful.as_slice() {
            [] => return Vec::new(),
            _ => (0..self.spheres.len()).filter(is_backbone).map(residue_of).collect(),
        };
        let is_carbon = |atom: &usize| backbones.contains(&residue_of(*atom));
        let (carbon, calcium): (Vec<_>, Vec<_>) = self.doubtful.iter().partition(|atom| is_carbon(atom));
        let named = |atoms: &[usize]| {
            let mut names: Vec<_> = atoms.iter().map(|atom| self.residue.indices[*atom]).collect();
            names.sort_unstable();
            names.dedup();
            listed(names.iter().map(|index| shortened(&self.residue.names[*index as usize])), 5)
        };
        let note = |atoms: &[usize], is: &str, why: &str| {
            (!atoms.is_empty()).then(|| {
                format!(
                    "{} atoms CA of the residues {} have no element and are taken as {is}, because {why}",
                    atoms.len(),
                    named(atoms)
                )
            })
        };
        let notes = [
            note(&carbon, "carbon", "these residues have atoms C or N as well"),
            note(&calcium, "calcium", "the place of the name says so"),
        ];
        for atom in carbon {
            let (index, appearance) = self.species.of_text("C", true);
            self.species.labels.indices[atom] = index;
            self.spheres[atom][3] = appearance.radius;
            self.colors[atom] = appearance.color;
        }
        notes.into_iter().flatten().collect()
    }

    /// Keeps one location of each atom. Returns a note if others were left out.
    fn keep_one_location(&mut self) -> Option<String> {
        if !self.has_alternates {
            return None;
        }
        let keep = kept(self.candidates());
        let left_out = keep.iter().filter(|kept| !**kept).count();
        if left_out == 0 {
            return None;
        }
        retain(&mut self.spheres, &keep);
        retain(&mut self.colors, &keep);
        retain(&mut self.residue_number, &keep);
        retain(&mut self.occupancy, &keep);
        retain(&mut self.b_factor, &keep);
        retain(&mut self.letters, &keep);
        retain(&mut self.serial, &keep);
        self.species.retain(&keep);
        for labels in [&mut self.name, &mut self.residue, &mut self.chain, &mut self.record] {
            labels.retain(&keep);
        }
        self.entity.retain(&keep);
        self.kind.retain(&keep);
        retain(&mut self.charge, &keep);
        self.bonds = bonds::kept(&self.bonds, &keep);
        let atoms = if left_out == 1 { "1 atom is" } else { &format!("{left_out} atoms are") };
        Some(format!(
            "{atoms} left out as alternate {}; the locations with the highest occupancy are kept",
            if left_out == 1 { "location of another atom" } else { "locations of other atoms" }
        ))
    }

    fn candidates(&self) -> impl Iterator<Item = Candidate> + Clone {
        let indices = self.chain.indices.iter().zip(&self.residue.indices).zip(&self.name.indices);
        let numbers = self.residue_number.iter().zip(&self.occupancy);
        indices.zip(numbers).zip(&self.letters).map(
            |((((chain, residue), name), (number, occupancy)), [letter, insertion])| Candidate {
                key: (*chain, number.to_bits(), *insertion),
                residue: *residue,
                name: *name,
                letter: *letter,
                occupancy: *occupancy,
            },
        )
    }

    /// Returns the atoms as a dataset without a cell and without a number of frames.
    pub(super) fn into_loaded(mut self) -> Dataset {
        let doubtful = self.decide_doubtful();
        let left_out = self.keep_one_location();
        let unknown = self.species.unknown();
        let mut loaded = Dataset::new(SphereArray::F64(self.spheres));
        loaded.colors = Some(self.colors);
        loaded.bonds = bonds::ordered(self.bonds);
        loaded.columns = [
            ("species", self.species.labels.into_values()),
            ("name", self.name.into_values()),
            ("residue", self.residue.into_values()),
            ("chain", self.chain.into_values()),
            ("residue_number", ColumnValues::Numbers(self.residue_number)),
            ("b_factor", ColumnValues::Numbers(self.b_factor)),
            ("occupancy", ColumnValues::Numbers(self.occupancy)),
            ("record", self.record.into_values()),
        ]
        .map(|(name, values)| Column { name: name.to_owned(), values })
        .into();
        if !self.entity.indices.is_empty() {
            let values = self.entity.into_values();
            loaded.columns.push(Column { name: "entity".to_owned(), values });
        }
        if !self.charge.is_empty() {
            loaded.columns.push(Column { name: "charge".to_owned(), values: ColumnValues::Numbers(self.charge) });
            loaded.columns.push(Column { name: "type".to_owned(), values: self.kind.into_values() });
        }
        // Columns that say nothing are left out: no insertion codes, and numbers that follow each other from 1.
        if self.letters.iter().any(|letters| letters[1] != b' ') {
            let mut codes = LabelsBuilder::with_capacity(self.letters.len());
            for letters in &self.letters {
                codes.push(letters[1..].trim_ascii());
            }
            loaded.columns.push(Column { name: "icode".to_owned(), values: codes.into_values() });
        }
        let is_usual = |(index, serial): (usize, &f64)| (*serial - index as f64).to_bits() == 1.0_f64.to_bits();
        let is_known = self.serial.iter().all(|serial| serial.is_finite());
        if is_known && !self.serial.iter().enumerate().all(is_usual) {
            loaded.columns.push(Column { name: "serial".to_owned(), values: ColumnValues::Numbers(self.serial) });
        }
        loaded.notes = unknown.iter().map(UnknownSpecies::note).chain(doubtful).chain(left_out).collect();
        loaded.unknown = unknown;
        loaded
    }
}

/// The elements of atoms with the columns `name` and `residue`.
pub(super) fn species_of(columns: &[Column]) -> Option<Labels> {
    let (names, residues) = (labels_in(columns, "name")?, labels_in(columns, "residue")?);
    let kinds: Vec<Residue> = residues.names.iter().map(|name| Residue::of(name)).collect();
    let mut species = Species::default();
    for (name, residue) in names.indices.iter().zip(&residues.indices) {
        let (name, index) = (names.names.get(*name as usize)?, *residue as usize);
        let (field, symbol) = unaligned(name.as_bytes(), residues.names.get(index)?.as_bytes());
        species.push(field, symbol, *kinds.get(index)?);
    }
    Some(species.labels.into_labels())
}

#[derive(Default)]
struct Species {
    labels: LabelsBuilder,
    /// The appearance of each name in `labels`.
    appearances: Vec<Appearance>,
    /// The index in `labels` of a name with a symbol and a kind of residue.
    known: Memo,
}

impl Species {
    fn push(&mut self, name: [u8; 4], symbol: [u8; 2], residue: Residue) -> Appearance {
        let [a, b, c, d] = name;
        let [e, f] = symbol;
        let key = u64::from_le_bytes([a, b, c, d, e, f, residue as u8, 0]);
        let index = self.known.get(key).unwrap_or_else(|| {
            let (text, is_element) = element::symbol(name, symbol, residue);
            let (index, _) = self.of_text(&text, is_element);
            self.known.insert(key, index);
            index
        });
        self.labels.indices.push(index);
        self.appearances.get(index as usize).copied().unwrap_or_else(|| appearance(""))
    }

    fn of_text(&mut self, text: &str, is_element: bool) -> (u32, Appearance) {
        let index = self.labels.index(text.as_bytes());
        // An empty text gives the appearance of a species that is not an element.
        let new = || appearance(if is_element { text } else { "" });
        if index as usize == self.appearances.len() {
            self.appearances.push(new());
        }
        (index, self.appearances.get(index as usize).copied().unwrap_or_else(new))
    }

    fn retain(&mut self, keep: &[bool]) {
        let former = self.labels.retain(keep);
        let appearance = |index: &u32| self.appearances.get(*index as usize).copied();
        self.appearances = former.iter().filter_map(appearance).collect();
    }

    fn unknown(&self) -> Option<UnknownSpecies> {
        let appearances = self.labels.names.iter().zip(&self.appearances);
        let unknown = appearances.filter(|(_, appearance)| !appearance.is_element);
        UnknownSpecies::new(unknown.map(|(name, _)| name.clone()).collect(), true, true)
    }
}

/// An atom record, reduced to the fields that identify the atom and one of its alternate locations.
#[derive(Clone, Copy)]
struct Candidate {
    /// The residue: its chain, its number and its insertion code.
    key: (u32, u64, u8),
    /// The index of the residue's name. Two residues can be alternatives for the same place in the chain.
    residue: u32,
    /// The index of the atom's name.
    name: u32,
    /// The letter of the location, or a blank.
    letter: u8,
    /// The occupancy of this location, usually from 0 to 1.
    occupancy: f64,
}

/// The atoms of one residue that share a location letter.
struct Location {
    letter: u8,
    residue: u32,
    /// The highest occupancy of these atoms.
    occupancy: f64,
}

/// Returns for each atom record whether it is kept, so that each atom has one location.
///
/// In each residue the letters are ranked by the highest occupancy of their atoms; letters of equal occupancy keep
/// their order in the file. The blank precedes all letters. Each atom keeps the best-ranked of its locations, so that
/// neighbouring atoms come from the same location. If another residue name than that of the best letter occurs at the
/// same place in the chain, its atoms are not kept.
fn kept(atoms: impl Iterator<Item = Candidate> + Clone) -> Vec<bool> {
    let mut residues: HashMap<_, Vec<Location>> = HashMap::new();
    for Candidate { key, residue, letter, occupancy, .. } in atoms.clone().filter(|a| a.letter != b' ') {
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
            atom.letter == b' ' || rank(&atom).is_some_and(|rank| best.get(&(atom.key, atom.name)) == Some(&rank))
        })
        .collect()
}

/// Returns the edge vectors of the cell, the first along x and the second in the plane of x and y; `None` if the
/// values are only placeholders, as in files of structures that are not crystals.
///
/// # Errors
/// Returns an error if lengths and angles cannot be those of a cell.
pub(super) fn cell_edges(lengths: [f64; 3], angles: [f64; 3]) -> Result<Option<[[f64; 3]; 3]>, String> {
    let all = |values: [f64; 3], wanted| values.iter().all(|value| same(*value, wanted));
    // Programs write zeros for a structure without a cell.
    if all(lengths, 0.0) || (all(lengths, 1.0) && all(angles, 90.0)) {
        return Ok(None);
    }
    let possible =
        lengths.iter().all(|length| *length > 0.0) && angles.iter().all(|angle| 0.0 < *angle && *angle < 180.0);
    let edges = edges_of(lengths, angles.map(cos_degrees)).filter(|_| possible);
    edges.map(Some).ok_or_else(|| {
        format!(
            "no periodic cell has edges of the lengths {lengths:?} and the angles {angles:?}; lengths must be greater than \
             0, and the angles in degrees must belong to three edges that are not in one plane"
        )
    })
}

/// The edges with these lengths and these cosines of the angles, the first along x and the second in the plane of x and
/// y; `None` if they lie in one plane.
pub(super) fn edges_of([a, b, c]: [f64; 3], [alpha, beta, gamma]: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    let sin_gamma = (1.0 - gamma * gamma).sqrt();
    let y = (alpha - beta * gamma) / sin_gamma;
    let z_squared = 1.0 - beta * beta - y * y;
    (z_squared > 0.0).then(|| [[a, 0.0, 0.0], [b * gamma, b * sin_gamma, 0.0], [c * beta, c * y, c * z_squared.sqrt()]])
}

/// The cosine of an angle in degrees: exactly 0 at a right angle, which most cells have.
fn cos_degrees(angle: f64) -> f64 {
    if same(angle, 90.0) { 0.0 } else { angle.to_radians().cos() }
}

/// Whether two values are equal but for the few decimals of the formats.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}
