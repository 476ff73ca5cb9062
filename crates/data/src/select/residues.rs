//! The kinds of residues, by their names and atoms.

use crate::load::Residue;

pub(super) const PROTEIN: u16 = 1;
pub(super) const DNA: u16 = 2;
pub(super) const RNA: u16 = 4;
pub(super) const WATER: u16 = 8;
pub(super) const ION: u16 = 16;
pub(super) const LIPID: u16 = 32;
pub(super) const SUGAR: u16 = 64;
/// A residue with carbon.
pub(super) const CARBON: u16 = 128;
pub(super) const NUCLEIC: u16 = DNA | RNA;
pub(super) const POLYMER: u16 = PROTEIN | NUCLEIC;

const BACKBONE: [&str; 7] = ["N", "CA", "C", "O", "OXT", "OT1", "OT2"];
const BACKBONE_OF_NUCLEIC: [&str; 10] = ["P", "OP1", "OP2", "O1P", "O2P", "O5'", "C5'", "C4'", "C3'", "O3'"];
const HYDROGEN_OF_BACKBONE: [&str; 14] =
    ["H", "HN", "HA", "HA1", "HA2", "HA3", "H1", "H2", "H3", "HT1", "HT2", "HT3", "D", "HXT"];
const HYDROGEN_OF_NUCLEIC: [&str; 10] = ["H5'", "H5''", "H5'1", "H5'2", "H4'", "H3'", "HO3'", "HO5'", "H3T", "H5T"];

/// Ions by the names of their residues, as VMD has them, and some more of force fields.
const IONS: [&str; 49] = [
    "AL", "BA", "CA", "CAL", "CD", "CES", "CLA", "CL", "CL-", "CO", "CS", "CU", "CU1", "CUA", "HG", "IN", "IOD", "K",
    "K+", "LIT", "LI", "MG", "MN", "MN3", "MO3", "MO4", "MO5", "MO6", "NA", "NA+", "NAW", "OC7", "PB", "POT", "PT",
    "RB", "RUB", "BAR", "SOD", "TB", "TL", "WO4", "YB", "ZN", "ZN1", "ZN2", "FE", "FE2", "BR",
];
const LIPIDS: [&str; 16] = [
    "DLPE", "DMPC", "DPPC", "GPC", "LPPC", "PALM", "PC", "PGCL", "POPC", "POPE", "DOPC", "DOPE", "POPG", "POPS",
    "CHOL", "CHL1",
];
const SUGARS: [&str; 7] = ["AGLC", "NAG", "MAN", "BMA", "FUC", "GAL", "GLC"];
const WATERS: [&str; 11] = ["HOH", "WAT", "H2O", "DOD", "SOL", "SPC", "T3P", "T4P", "T5P", "OH2", "PW"];

/// Classes that are the names of residues, as VMD has them.
pub(super) fn names_of_class(class: &str) -> Option<&'static [&'static str]> {
    Some(match class {
        "acidic" => &["ASP", "GLU"],
        "basic" => &["ARG", "HIS", "LYS", "HSP"],
        "charged" => &["ASP", "GLU", "ARG", "HIS", "LYS", "HSP"],
        "hydrophobic" => &["ALA", "LEU", "VAL", "ILE", "PRO", "PHE", "MET", "TRP"],
        "aromatic" => &["HIS", "PHE", "TRP", "TYR"],
        "aliphatic" => &["ALA", "GLY", "ILE", "LEU", "VAL"],
        "small" => &["ALA", "GLY", "SER"],
        "purine" => &["ADE", "A", "GUA", "G", "DA", "DG"],
        "pyrimidine" => &["CYT", "C", "THY", "T", "URA", "U", "DC", "DT", "DU"],
        _ => return None,
    })
}

fn is_amino_acid(name: &str) -> bool {
    let is_known = |name: &str| Residue::of(name) == Residue::AminoAcid || matches!(name, "SEP" | "TPO" | "PTR");
    // Amber marks the ends of chains.
    is_known(name) || (name.len() == 4 && name.strip_prefix(['N', 'C']).is_some_and(is_known))
}

/// The kind of nucleotide, of which both are possible for some names.
fn nucleotide(name: &str) -> u16 {
    let base = name.strip_suffix(['3', '5']).unwrap_or(name);
    match base {
        "DA" | "DC" | "DG" | "DT" | "DU" | "DI" | "DN" | "T" | "THY" => DNA,
        "RA" | "RC" | "RG" | "RU" | "U" | "URA" => RNA,
        "A" | "C" | "G" | "I" | "N" | "ADE" | "CYT" | "GUA" => NUCLEIC,
        _ => 0,
    }
}

/// The kinds that follow from the name of a residue.
pub(super) fn kind_of(name: &str) -> u16 {
    let name = name.trim().to_ascii_uppercase();
    let name = name.as_str();
    match name {
        _ if is_amino_acid(name) => PROTEIN,
        _ if nucleotide(name) != 0 => nucleotide(name),
        _ if WATERS.contains(&name) || name == "W" || name.starts_with("TIP") => WATER,
        _ if IONS.contains(&name) => ION,
        _ if LIPIDS.contains(&name) => LIPID,
        _ if SUGARS.contains(&name) => SUGAR,
        _ => 0,
    }
}

const AMINO_ACID: u16 = 0b111;
const NUCLEOTIDE: u16 = 0b1_1111_1000;
const HYDROXYL: u16 = 0b10_0000_0000;

/// The bit of an atom that shows the kind of its residue; 0 for others.
pub(super) fn bit_of_atom(name: &str) -> u16 {
    let names = ["N", "CA", "C", "P", "O5'", "C5'", "C4'", "C3'", "O3'", "O2'"];
    let name = name.trim().replace('*', "'");
    names.iter().position(|known| *known == name).map_or(0, |place| 1 << place)
}

/// The kind of a residue by its name and the bits of its atoms.
pub(super) fn kind_with_atoms(kind: u16, bits: u16) -> u16 {
    let kind = match kind {
        0 if bits & AMINO_ACID == AMINO_ACID => PROTEIN,
        0 if bits & NUCLEOTIDE == NUCLEOTIDE => NUCLEIC,
        _ => kind,
    };
    match kind {
        NUCLEIC if bits & HYDROXYL != 0 => RNA,
        NUCLEIC => DNA,
        _ => kind,
    }
}

/// Returns true if an atom of this name belongs to the backbone of a residue of this kind.
pub(super) fn is_backbone(name: &str, kind: u16) -> bool {
    let name = name.trim().replace('*', "'");
    (kind & PROTEIN != 0 && BACKBONE.contains(&name.as_str()))
        || (kind & NUCLEIC != 0 && BACKBONE_OF_NUCLEIC.contains(&name.as_str()))
}

/// Returns true if an atom of this name is hydrogen of the backbone of a residue of this kind.
pub(super) fn is_hydrogen_of_backbone(name: &str, kind: u16) -> bool {
    let name = name.trim().replace('*', "'");
    (kind & PROTEIN != 0 && HYDROGEN_OF_BACKBONE.contains(&name.as_str()))
        || (kind & NUCLEIC != 0 && HYDROGEN_OF_NUCLEIC.contains(&name.as_str()))
}
