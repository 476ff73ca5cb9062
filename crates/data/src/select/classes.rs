//! Classes of spheres, such as `protein`, `water` and `metal`.

use std::rc::Rc;

use super::data::{Data, Values};
use super::error::SelectError;
use super::residues::{
    CARBON, DNA, ION, LIPID, NUCLEIC, POLYMER, PROTEIN, RNA, SUGAR, WATER, bit_of_atom, is_backbone,
    is_hydrogen_of_backbone, kind_of, kind_with_atoms, names_of_class,
};
use super::tree::Word;
use crate::load::{Family, Labels, covalent, element_symbol, is_metal};

impl<'a> Data<'a> {
    /// Returns the spheres of a class.
    pub(super) fn class(&mut self, word: &Word) -> Result<Vec<bool>, SelectError> {
        let at = word.at;
        match word.text.as_str() {
            "all" => Ok(vec![true; self.len()]),
            "none" => Ok(vec![false; self.len()]),
            "protein" | "polymer.protein" => self.of_kind(at, |kind| kind & PROTEIN != 0),
            "nucleic" | "polymer.nucleic" => self.of_kind(at, |kind| kind & NUCLEIC != 0),
            "dna" => self.of_kind(at, |kind| kind & DNA != 0),
            "rna" => self.of_kind(at, |kind| kind & RNA != 0),
            "polymer" => self.of_kind(at, |kind| kind & POLYMER != 0),
            "hetero" => self.of_kind(at, |kind| kind & POLYMER == 0),
            "hetatm" | "het" => self.hetatm(word),
            "backbone" | "bb." => self.by_name(at, is_backbone),
            "sidechain" | "sc." => self.by_name(at, |name, kind| {
                kind & POLYMER != 0 && !is_backbone(name, kind) && !is_hydrogen_of_backbone(name, kind)
            }),
            "alpha" => self.by_name(at, |name, kind| kind & PROTEIN != 0 && name == "CA"),
            "guide" => self.by_name(at, |name, kind| {
                (kind & PROTEIN != 0 && name == "CA") || (kind & NUCLEIC != 0 && name == "P")
            }),
            "water" | "waters" => self.water(word),
            "solvent" => {
                self.note("solvent is water, as in PyMOL; not polymer has all that VMD calls so".to_owned());
                self.water(word)
            }
            "ion" | "ions" => self.of_kind(at, |kind| kind & ION != 0),
            "lipid" => self.of_kind(at, |kind| kind & LIPID != 0),
            "sugar" => self.of_kind(at, |kind| kind & SUGAR != 0),
            "ligand" => self.of_kind(at, |kind| kind & (POLYMER | WATER | ION | LIPID) == 0),
            "organic" => self.of_kind(at, |kind| kind & (POLYMER | WATER) == 0 && kind & CARBON != 0),
            "inorganic" => self.of_kind(at, |kind| kind & (POLYMER | WATER | CARBON) == 0),
            "hydrogen" | "hydrogens" | "hydro" => self.by_element(at, is_hydrogen),
            "noh" | "heavy" => self.by_element(at, |symbol| !is_hydrogen(symbol)),
            "metal" | "metals" => self.by_element(at, |species| element_symbol(species).is_some_and(is_metal)),
            "polar" => {
                let hydrophobic = names_of_class("hydrophobic").unwrap_or_default();
                let names = self.by_residue_name(word, hydrophobic)?;
                let protein = self.of_kind(at, |kind| kind & PROTEIN != 0)?;
                Ok(protein.into_iter().zip(names).map(|(is, not)| is && !not).collect())
            }
            "helix" | "sheet" | "coil" => {
                let problem = format!(
                    "{} cannot be selected: records of HELIX and SHEET are not read; give residues, such as resid 4 to 18",
                    word.text
                );
                Err(self.error(at, problem))
            }
            other => match names_of_class(other) {
                Some(names) => self.by_residue_name(word, names),
                None => Err(self.unknown(word)),
            },
        }
    }

    fn labels(&mut self, key: &'static str) -> Option<&'a Labels> {
        match self.optional(key)?.values {
            Values::Labels(labels) => Some(labels),
            Values::Numbers(_) => None,
        }
    }

    fn of_kind(&mut self, at: usize, is_in: impl Fn(u16) -> bool) -> Result<Vec<bool>, SelectError> {
        let kinds = self.kinds(at)?;
        let residues = self.residues(at)?;
        Ok(residues.iter().map(|residue| is_in(kinds[*residue as usize])).collect())
    }

    /// Chooses by the name of an atom and the kind of its residue. Kinds have few values, so a table is made for each.
    fn by_name(&mut self, at: usize, is_in: impl Fn(&str, u16) -> bool) -> Result<Vec<bool>, SelectError> {
        let kinds = self.kinds(at)?;
        let residues = self.residues(at)?;
        let Some(names) = self.labels("name") else { return Err(self.error(at, "the file has no names of atoms")) };
        let all: Vec<u16> = vec![PROTEIN, DNA, RNA];
        let tables: Vec<Vec<bool>> =
            all.iter().map(|kind| names.names.iter().map(|name| is_in(name.trim(), *kind)).collect()).collect();
        let of = |(residue, name): (&u32, &u32)| {
            let kind = kinds[*residue as usize];
            let table = all.iter().position(|known| kind & known != 0);
            table.is_some_and(|table| tables[table].get(*name as usize).copied().unwrap_or(false))
        };
        Ok(residues.iter().zip(&names.indices).map(of).collect())
    }

    fn by_element(&mut self, at: usize, is_in: impl Fn(&str) -> bool) -> Result<Vec<bool>, SelectError> {
        let Some(labels) = self.labels("element") else {
            let problem = self.no_elements();
            return Err(self.error(at, problem));
        };
        if labels.names.iter().all(|name| element_symbol(name).is_none()) && !labels.names.is_empty() {
            let problem = self.no_elements();
            return Err(self.error(at, problem));
        }
        Ok(chosen(labels, is_in))
    }

    fn by_residue_name(&mut self, word: &Word, names: &[&str]) -> Result<Vec<bool>, SelectError> {
        match self.labels("resname") {
            Some(labels) => Ok(chosen(labels, |name| names.contains(&name.trim().to_ascii_uppercase().as_str()))),
            None => Err(self.missing("resname", word)),
        }
    }

    fn hetatm(&mut self, word: &Word) -> Result<Vec<bool>, SelectError> {
        match self.labels("record") {
            Some(labels) => Ok(chosen(labels, |record| record == "HETATM")),
            None => Err(self.missing("record", word)),
        }
    }

    /// Water by the names of residues; without residues, the molecules of water.
    fn water(&mut self, word: &Word) -> Result<Vec<bool>, SelectError> {
        if self.optional("resname").is_some() || self.optional("resid").is_some() {
            return self.of_kind(word.at, |kind| kind & WATER != 0);
        }
        let pieces = self.graph(word)?.fragments();
        let Some(labels) = self.labels("element") else { return Err(self.missing("element", word)) };
        let symbols: Vec<Option<&str>> = labels.names.iter().map(|name| element_symbol(name)).collect();
        // The numbers of oxygen, of hydrogen and of other atoms in each piece.
        let mut counts = vec![[0_u32; 3]; pieces.iter().max().map_or(0, |last| *last as usize + 1)];
        for (piece, index) in pieces.iter().zip(&labels.indices) {
            let symbol = symbols.get(*index as usize).and_then(|symbol| *symbol);
            let place = match symbol {
                Some("O") => 0,
                Some("H") => 1,
                _ => 2,
            };
            counts[*piece as usize][place] += 1;
        }
        Ok(pieces.iter().map(|piece| matches!(counts[*piece as usize], [1, 0..=3, 0])).collect())
    }

    /// The kind of each residue.
    fn kinds(&mut self, at: usize) -> Result<Rc<Vec<u16>>, SelectError> {
        if let Some(kinds) = &self.kinds {
            return Ok(Rc::clone(kinds));
        }
        let residues = self.residues(at)?;
        let [names, atoms, elements] = ["resname", "name", "element"].map(|key| self.labels(key));
        let table = |labels: Option<&Labels>, of: &dyn Fn(&str) -> u16| -> Vec<u16> {
            labels.map_or(Vec::new(), |labels| labels.names.iter().map(|name| of(name)).collect())
        };
        let (kind_of_name, bits_of_name) = (table(names, &kind_of), table(atoms, &bit_of_atom));
        let symbols = table(elements, &|name| match element_symbol(name) {
            Some("C") => 2,
            Some("H" | "N" | "O") => 1,
            Some(_) => 0,
            None => 1,
        });
        let at = |labels: Option<&Labels>, table: &[u16], index: usize| {
            let place = labels.and_then(|labels| labels.indices.get(index));
            place.and_then(|place| table.get(*place as usize)).copied()
        };
        let mut all: Vec<(u16, u16, u16)> = vec![(0, 0, 0); residues.last().map_or(0, |last| *last as usize + 1)];
        for (index, residue) in residues.iter().enumerate() {
            let (kind, bits, count) = &mut all[*residue as usize];
            let symbol = at(elements, &symbols, index).unwrap_or(1);
            *kind |= at(names, &kind_of_name, index).unwrap_or(0) | if symbol == 2 { CARBON } else { 0 };
            *bits |= at(atoms, &bits_of_name, index).unwrap_or(0);
            // The sum is 1 for a single atom that may be an ion, and for nothing else.
            *count = count.saturating_add(if symbol == 0 { 1 } else { 2 });
        }
        let kind = |(kind, bits, count): (u16, u16, u16)| match kind_with_atoms(kind & !CARBON, bits) | (kind & CARBON)
        {
            0 if count == 1 => ION,
            kind => kind,
        };
        let kinds = Rc::new(all.into_iter().map(kind).collect());
        self.kinds = Some(Rc::clone(&kinds));
        Ok(kinds)
    }
}

fn is_hydrogen(species: &str) -> bool {
    covalent(species).is_some_and(|known| known.family == Family::Hydrogen)
}

fn chosen(labels: &Labels, is_in: impl Fn(&str) -> bool) -> Vec<bool> {
    let table: Vec<bool> = labels.names.iter().map(|name| is_in(name)).collect();
    labels.indices.iter().map(|index| table.get(*index as usize).copied().unwrap_or(false)).collect()
}
