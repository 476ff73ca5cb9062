//! Determines the chemical element of an atom.

use crate::load::elements::appearance;

/// Kinds of residues. Atoms of the known kinds are of few elements, whatever their names suggest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Residue {
    AminoAcid,
    NucleotideOrWater,
    Other,
}

impl Residue {
    /// Returns the kind of a residue by its name. Names that molecular dynamics programs use are included.
    pub(crate) fn of(name: &str) -> Self {
        match name {
            "ALA" | "ARG" | "ASN" | "ASP" | "CYS" | "GLN" | "GLU" | "GLY" | "HIS" | "ILE" | "LEU" | "LYS" | "MET"
            | "PHE" | "PRO" | "SER" | "THR" | "TRP" | "TYR" | "VAL" | "ASX" | "GLX" | "MSE" | "SEC" | "PYL" | "UNK"
            | "HID" | "HIE" | "HIP" | "HSD" | "HSE" | "HSP" | "CYX" | "CYM" | "ASH" | "GLH" | "LYN" => Self::AminoAcid,
            "A" | "C" | "G" | "U" | "I" | "DA" | "DC" | "DG" | "DT" | "DU" | "DI" | "HOH" | "DOD" | "WAT" | "H2O"
            | "SOL" | "TIP" | "TIP3" | "TIP4" | "SPC" => Self::NucleotideOrWater,
            _ => Self::Other,
        }
    }
}

/// Returns the symbol of an atom's element, such as `Fe`, and true. For other atoms it is the best name, and false.
///
/// `name` is columns 13-16 and `symbol` is columns 77-78, which may be blank.
pub(super) fn symbol(name: [u8; 4], symbol: [u8; 2], residue: Residue) -> (String, bool) {
    if residue == Residue::AminoAcid && name.trim_ascii() == b"CA" {
        return ("C".to_owned(), true);
    }
    if let Some(element) = element(symbol.trim_ascii()).or_else(|| by_name(name, residue)) {
        return (element, true);
    }
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes.trim_ascii()).into_owned();
    let is_word = |word: &[u8]| !word.is_empty() && word.iter().all(u8::is_ascii_alphabetic);
    if is_word(symbol.trim_ascii()) {
        (text(&symbol), false)
    } else if name.iter().any(u8::is_ascii_alphabetic) {
        (text(&name), false)
    } else {
        // The wwPDB gives this symbol to atoms of unknown elements.
        ("X".to_owned(), false)
    }
}

/// Returns the name as in columns 13-16 of a PDB file, and the symbol of the element, for files in which the place of a
/// name says nothing. The symbol is blank if the name says enough.
///
/// A name of two letters is carbon and the like (`CA`, `HG`, `NA`), unless its residue has the name of this ion, its
/// second letter is in lower case, or a molecule hardly ever has such a name for another element.
pub(crate) fn unaligned(name: &[u8], residue: &[u8]) -> ([u8; 4], [u8; 2]) {
    let letters = name.iter().position(u8::is_ascii_alphabetic).map_or(name, |first| &name[first..]);
    let mut field = [b' '; 4];
    field[1..].iter_mut().zip(letters).for_each(|(to, from)| *to = *from);
    let word = |text: &'_ [u8]| {
        let end = text.iter().position(|byte| !byte.is_ascii_alphabetic()).unwrap_or(text.len());
        text[..end].to_ascii_uppercase()
    };
    let symbol = word(letters);
    let is_ion = symbol == word(residue);
    let symbol = match (symbol.as_slice(), letters) {
        // Names of ions in the force fields of CHARMM.
        (b"SOD", _) if is_ion => *b"NA",
        (b"POT", _) if is_ion => *b"K ",
        (b"CLA", _) if is_ion => *b"CL",
        (b"CAL", _) if is_ion => *b"CA",
        (b"LIT", _) if is_ion => *b"LI",
        (b"RUB", _) if is_ion => *b"RB",
        (b"CES", _) if is_ion => *b"CS",
        (b"BAR", _) if is_ion => *b"BA",
        ([a, b], [_, second, ..]) if is_ion || second.is_ascii_lowercase() => [*a, *b],
        (b"CL" | b"BR" | b"FE" | b"SI" | b"CU" | b"PT", _) => [symbol[0], symbol[1]],
        _ => *b"  ",
    };
    (field, symbol)
}

/// Whether an atom's name may mean calcium or, in the wrong columns, the alpha carbon. The atom has no symbol, and its
/// residue is neither known nor the calcium ion.
pub(super) fn is_doubtful(name: [u8; 4], symbol: [u8; 2], kind: Residue, residue: &[u8]) -> bool {
    &name == b"CA  "
        && symbol.trim_ascii().is_empty()
        && kind == Residue::Other
        && !residue.to_ascii_uppercase().starts_with(b"CA")
}

/// Returns the element that an atom's name shows. Old files have no symbols, but the first two characters of a name
/// are the right-justified symbol.
fn by_name(name: [u8; 4], residue: Residue) -> Option<String> {
    let [first, second, third, fourth] = name;
    if residue != Residue::Other
        && let Some(element) = in_known_residue(name)
    {
        return Some(element);
    }
    if !first.is_ascii_alphabetic() {
        // A symbol of two letters in the wrong columns (` MG `) is accepted only if nothing else fits.
        return element(&[second]).or_else(|| element(&[second, third]));
    }
    // Names of four characters have no blank before a symbol of one letter. Hydrogen often has such names, but
    // mercury, holmium and dysprosium hardly ever do.
    if fourth != b' ' && matches!(first, b'H' | b'D') {
        return element(&[first]);
    }
    element(&[first, second]).or_else(|| element(&[first]))
}

/// Returns the element of an atom in a known residue, by the first letter of the atom's name.
fn in_known_residue(name: [u8; 4]) -> Option<String> {
    let mut letters = name.into_iter().skip_while(|byte| !byte.is_ascii_alphabetic());
    let (first, second) = (letters.next()?, letters.next());
    match (first, second) {
        // Selenomethionine and selenocysteine.
        (b'S', Some(b'E')) => element(b"SE"),
        (b'H' | b'D' | b'C' | b'N' | b'O' | b'P' | b'S', _) => element(&[first]),
        _ => None,
    }
}

/// Returns the symbol of an element in its usual case, or `None` if there is no such element.
fn element(symbol: &[u8]) -> Option<String> {
    let mut text = String::new();
    for (i, byte) in symbol.iter().enumerate() {
        if !byte.is_ascii_alphabetic() {
            return None;
        }
        let letter = if i == 0 { byte.to_ascii_uppercase() } else { byte.to_ascii_lowercase() };
        text.push(char::from(letter));
    }
    (!text.is_empty() && appearance(&text).is_element).then_some(text)
}
