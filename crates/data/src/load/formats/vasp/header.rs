//! Reads the lines of a POSCAR file before its positions: the comment, the scale, the lattice, and the numbers of atoms.

use std::io;

use glam::{DMat3, DVec3};

use crate::load::elements::element;
use crate::load::error::LoadError;
use crate::load::numbers::number;
use crate::load::rows::Values;
use pinhole::internals::text::{listed, shortened, without_byte_order_mark};

/// Returns the next line without its line end; `None` at the end of the file.
pub(super) type NextLine<'a> = &'a mut dyn FnMut() -> io::Result<Option<Vec<u8>>>;

#[derive(Debug)]
pub(super) struct Header {
    /// The lattice vectors in Å.
    pub(super) edges: [[f64; 3]; 3],
    /// Factors of the x, y and z of Cartesian positions.
    pub(super) scale: [f64; 3],
    /// Symbols of the elements, in the order of the positions, with the numbers of their atoms.
    pub(super) kinds: Vec<(String, usize)>,
    /// Number of all atoms.
    pub(super) atoms: usize,
    /// Line of the numbers of atoms, which is the last of the header.
    pub(super) line: usize,
    pub(super) note: Option<String>,
}

impl Header {
    /// Reads the lines from the comment to the numbers of atoms.
    pub(super) fn read(next: NextLine<'_>, lines_before: usize) -> Result<Self, LoadError> {
        let mut lines = HeaderLines { next, line: lines_before };
        let comment = lines.take("the comment")?;
        let scale = lines.scale()?;
        let first_edge = lines.line + 1;
        let edges = [lines.edge('a')?, lines.edge('b')?, lines.edge('c')?];
        let (edges, scale) = scaled(edges, &scale).map_err(|message| LoadError::line(first_edge, message))?;
        let text = lines.take("the symbols of the elements")?;
        let words = words_of(&text);
        // VASP 4 wrote no symbols.
        let is_old = words.first().is_some_and(|word| word.parse::<usize>().is_ok());
        let (symbols, counts, note) = if is_old {
            let symbols = symbols_of_comment(&comment, words.len()).ok_or_else(|| no_symbols(lines.line, &words))?;
            let line = lines_before + 1;
            let note = format!(
                "the elements are those of the comment on line {line}: {}",
                listed(symbols.iter().cloned(), 16)
            );
            (symbols, words, Some(note))
        } else {
            let (symbols, note) = plain_symbols(&words);
            (symbols, words_of(&lines.take("the numbers of atoms")?), note)
        };
        let line = lines.line;
        let (kinds, atoms) = kinds_of(symbols, &counts).map_err(|message| LoadError::line(line, message))?;
        Ok(Self { edges, scale, kinds, atoms, line, note })
    }
}

struct HeaderLines<'a> {
    next: NextLine<'a>,
    /// Number of lines read.
    line: usize,
}

impl HeaderLines<'_> {
    fn take(&mut self, what: &str) -> Result<Vec<u8>, LoadError> {
        let text = (self.next)()?.ok_or_else(|| LoadError::new(format!("the file ends before {what}")))?;
        self.line += 1;
        Ok(text)
    }

    /// The numbers at the start of a line. Comments may follow.
    fn numbers(&mut self, what: &str) -> Result<Vec<f64>, LoadError> {
        let text = self.take(what)?;
        let numbers = Values { rest: &text }.map_while(number).take(4).collect::<Vec<f64>>();
        match numbers.iter().all(|number| number.is_finite()) {
            true => Ok(numbers),
            false => Err(LoadError::line(self.line, format!("{what} must be finite"))),
        }
    }

    fn scale(&mut self) -> Result<Vec<f64>, LoadError> {
        let scale = self.numbers("the scale")?;
        let is_valid = match scale.as_slice() {
            [all] => *all != 0.0,
            [_, _, _] => scale.iter().all(|factor| *factor > 0.0),
            _ => false,
        };
        is_valid.then_some(scale).ok_or_else(|| {
            let message = "the scale must be a number other than 0, or three numbers greater than 0; a negative number is \
                           the volume of the cell";
            LoadError::line(self.line, message)
        })
    }

    fn edge(&mut self, name: char) -> Result<[f64; 3], LoadError> {
        let numbers = self.numbers(&format!("the lattice vector {name}"))?;
        numbers
            .first_chunk()
            .copied()
            .ok_or_else(|| LoadError::line(self.line, format!("three numbers belong here: the lattice vector {name}")))
    }
}

/// Scales the lattice, and returns the factors of x, y and z as well.
fn scaled(edges: [[f64; 3]; 3], scale: &[f64]) -> Result<([[f64; 3]; 3], [f64; 3]), &'static str> {
    let lattice = DMat3::from_cols_array_2d(&edges);
    let volume = lattice.determinant().abs();
    let factors = match *scale {
        [volume_wanted] if volume_wanted < 0.0 => DVec3::splat((-volume_wanted / volume).cbrt()),
        [all] => DVec3::splat(all),
        [x, y, z] => DVec3::new(x, y, z),
        _ => DVec3::ONE,
    };
    let edges = (DMat3::from_diagonal(factors) * lattice).to_cols_array_2d();
    if volume > 0.0 && volume.is_finite() && edges.as_flattened().iter().all(|length| length.is_finite()) {
        Ok((edges, factors.to_array()))
    } else {
        Err("the lattice vectors from here on enclose no volume; they must not lie in one plane")
    }
}

/// The words of a line before a comment.
fn words_of(text: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(without_byte_order_mark(text));
    let end = text.find(['!', '#']).unwrap_or(text.len());
    text[..end].split_whitespace().map(str::to_owned).collect()
}

/// Removes what follows the symbols in files of VASP: the kind of a potential (`Fe_pv`), and its checksum (`Si/5b3…`).
/// Returns a note if that changes a name.
fn plain_symbols(words: &[String]) -> (Vec<String>, Option<String>) {
    let plain = |word: &String| {
        let symbol = word.split(['_', '/']).next().unwrap_or_default();
        if element(symbol).is_some() { symbol.to_owned() } else { word.clone() }
    };
    let symbols: Vec<String> = words.iter().map(plain).collect();
    let changed = words.iter().zip(&symbols).filter(|(word, symbol)| word != symbol);
    let changed: Vec<String> =
        changed.map(|(word, symbol)| format!("{} is {}", shortened(word), shortened(symbol))).collect();
    let is_changed = !changed.is_empty();
    let note = || format!("names of potentials are taken as chemical elements: {}", listed(changed.into_iter(), 16));
    (symbols, is_changed.then(note))
}

/// The words of the comment, if they are as many elements as there are numbers of atoms.
fn symbols_of_comment(comment: &[u8], wanted: usize) -> Option<Vec<String>> {
    let words = words_of(comment);
    let is_symbol = |word: &String| word.bytes().all(|byte| byte.is_ascii_alphabetic()) && element(word).is_some();
    (words.len() == wanted && words.iter().all(is_symbol)).then_some(words)
}

fn no_symbols(line: usize, counts: &[String]) -> LoadError {
    let message = format!(
        "`{}` are numbers of atoms, but no line before them has the symbols of the elements; insert such a line before \
         this one, such as `Si O`",
        shortened(&counts.join(" "))
    );
    LoadError::line(line, message)
}

/// Joins symbols with numbers of atoms, and returns the sum of these.
fn kinds_of(symbols: Vec<String>, counts: &[String]) -> Result<(Vec<(String, usize)>, usize), String> {
    if symbols.is_empty() || symbols.len() != counts.len() {
        return Err(format!(
            "each element must have one number of atoms, but the line before has {} symbols, and this one {} numbers",
            symbols.len(),
            counts.len()
        ));
    }
    let mut kinds = Vec::with_capacity(symbols.len());
    let mut atoms = 0_usize;
    for (symbol, text) in symbols.into_iter().zip(counts) {
        let count = text.parse().map_err(|_| format!("`{}` is not a valid number of atoms", shortened(text)))?;
        atoms = atoms.checked_add(count).ok_or("the numbers of atoms are too large")?;
        kinds.push((symbol, count));
    }
    if atoms == 0 {
        return Err("there must be at least one atom".to_owned());
    }
    Ok((kinds, atoms))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_have_no_control_characters() {
        let (symbols, note) = plain_symbols(&["H\u{11}~/5b3".to_owned(), "Fe_pv".to_owned()]);
        assert_eq!(symbols, ["H\u{11}~", "Fe"]);
        assert!(!note.unwrap().contains('\u{11}'));
    }
}
