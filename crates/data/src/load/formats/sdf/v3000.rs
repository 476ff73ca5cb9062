//! Reads the molecule of a record in V3000: lines that start with `M  V30`, in blocks between BEGIN and END.

use super::molecule::{Molecule, NumberedLines};
use crate::load::error::{LoadError, Place};
use crate::load::numbers::number;
use crate::load::rows::Values;
use pinhole::internals::text::shortened;

/// Reads the atoms, their charges, and the bonds, up to the end of the molecule.
pub(super) fn read(molecule: &mut Molecule, lines: &mut NumberedLines<'_>) -> Result<(), LoadError> {
    let mut declared = None;
    let mut block = Vec::new();
    let mut others = 0_usize;
    while let Some((line, text)) = next(lines)? {
        let words: Vec<&[u8]> = Values { rest: &text }.collect();
        match words.as_slice() {
            [b"BEGIN", name, ..] => block = name.to_vec(),
            [b"END", b"CTAB", ..] => {
                check(molecule, declared.take())?;
                block = b"other".to_vec();
                others += 1;
            }
            [b"END", ..] => block = Vec::new(),
            [b"COUNTS", atoms, ..] if others == 0 => {
                let atoms = std::str::from_utf8(atoms).ok().and_then(|atoms| atoms.parse::<usize>().ok());
                let atoms = atoms.ok_or_else(|| LoadError::line(line, "COUNTS must begin with the number of atoms"))?;
                declared = Some((line, atoms));
            }
            words if block == b"ATOM" && others == 0 => take_atom(molecule, line, words)?,
            _ if block == b"ATOM" => others += 1,
            // The type 10 is a bond of hydrogen.
            [_, b"10", ..] if block == b"BOND" => {}
            words if block == b"BOND" && others == 0 && !words.is_empty() => {
                let numbers: Option<Vec<i64>> = words.iter().skip(2).take(2).map(|word| whole(word)).collect();
                let Some(&[a, b]) = numbers.as_deref() else {
                    let message = "a bond has an index, a type, and the numbers of two atoms";
                    return Err(LoadError::line(line, message));
                };
                molecule.bonds.push((line, [a, b]));
            }
            _ => {}
        }
    }
    // A molecule without an end has counts as well.
    check(molecule, declared)?;
    if others > 1 {
        molecule.notes.push("only the first molecule of the record is used, without the atoms of templates".to_owned());
    }
    Ok(())
}

/// Refuses a number of atoms other than the declared one, which has a line.
fn check(molecule: &Molecule, declared: Option<(usize, usize)>) -> Result<(), LoadError> {
    let found = molecule.lines.len();
    match declared {
        Some((line, declared)) if declared != found => {
            Err(LoadError::line(line, format!("{declared} atoms are declared, but the molecule has {found}")))
        }
        _ => Ok(()),
    }
}

/// Returns the next line of the molecule, with those that continue it, and its number; `None` after its end.
fn next(lines: &mut NumberedLines<'_>) -> Result<Option<(usize, Vec<u8>)>, LoadError> {
    let Some(first) = lines.next() else { return Ok(None) };
    let line = lines.line;
    if first.starts_with(b"M  END") {
        return Ok(None);
    }
    let Some(text) = first.strip_prefix(b"M  V30") else {
        if first.trim_ascii().is_empty() {
            return Ok(Some((line, Vec::new())));
        }
        let message = "a line of a molecule in V3000 must start with `M V30`, and `M END` must end the molecule";
        return Err(LoadError::line(line, message));
    };
    let mut text = text.trim_ascii_end().to_vec();
    while text.last() == Some(&b'-') {
        text.pop();
        let more = lines.next().and_then(|more| more.strip_prefix(b"M  V30"));
        let more = more.ok_or_else(|| LoadError::line(line, "the line that continues this one is missing"))?;
        text.extend_from_slice(more.strip_prefix(b" ").unwrap_or(more).trim_ascii_end());
    }
    Ok(Some((line, text)))
}

/// Appends an atom: its index, its symbol, x, y, z, the number of a mapped atom, and perhaps `CHG=` and other keys.
fn take_atom(molecule: &mut Molecule, line: usize, words: &[&[u8]]) -> Result<(), LoadError> {
    let [index, symbol, x, y, z, more @ ..] = words else {
        if words.is_empty() {
            return Ok(());
        }
        let message = "an atom has an index, a symbol and three coordinates";
        return Err(LoadError::line(line, message));
    };
    let wrong = |name: &str, column: usize, found: &[u8]| {
        let found = shortened(&String::from_utf8_lossy(found));
        LoadError::at(Place::Column { line, column }, format!("{name} is `{found}`; a finite number belongs there"))
    };
    let mut place = [0.0; 3];
    for (index, (value, found)) in place.iter_mut().zip([x, y, z]).enumerate() {
        let parsed = number(found).filter(|number| number.is_finite());
        // The words `M` and `V30` come before.
        *value = parsed.ok_or_else(|| wrong(["x", "y", "z"][index], index + 5, found))?;
    }
    let mut charge = 0.0;
    if let Some((index, found)) = more.iter().enumerate().find(|(_, word)| word.starts_with(b"CHG=")) {
        let parsed = number(&found[4..]).filter(|number| number.is_finite());
        charge = parsed.ok_or_else(|| wrong("the charge", index + 8, found))?;
    }
    // Without a number, an atom has the one of its row.
    molecule.numbers.push(whole(index).unwrap_or(molecule.lines.len() as i64 + 1));
    molecule.push(line, place, symbol, charge);
    Ok(())
}

fn whole(text: &[u8]) -> Option<i64> {
    std::str::from_utf8(text).ok()?.parse().ok()
}
