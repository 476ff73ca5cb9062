//! Splits a PDB file into lines, and reads fields by their columns: numbers, residue numbers in hybrid-36, and the cell.

use crate::load::atoms::cell_edges;
use crate::load::error::{LoadError, Place};
use crate::load::numbers::number;

/// Kinds of lines that the reader distinguishes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Atom,
    Hetatm,
    Cryst1,
    Model,
    Endmdl,
    End,
    Bonds,
    /// A name of mmCIF, which stands before the atoms of such files. It is not a PDB record.
    AtomSite,
    Other,
}

impl Kind {
    /// Returns the kind of a line from the record name in columns 1 to 6.
    ///
    /// A serial number of six digits may begin in column 6.
    pub(super) fn of(line: &[u8]) -> Self {
        let is = |name: &[u8]| line.strip_prefix(name).is_some_and(|rest| matches!(rest.first(), None | Some(b' ')));
        // Most lines of most files are atoms, and the first letter rules out most other lines.
        match line.first() {
            Some(b'A') if is(b"ATOM") => Self::Atom,
            Some(b'H') if line.starts_with(b"HETATM") => Self::Hetatm,
            Some(b'C') if line.starts_with(b"CRYST1") => Self::Cryst1,
            Some(b'C') if line.starts_with(b"CONECT") => Self::Bonds,
            Some(b'M') if is(b"MODEL") => Self::Model,
            Some(b'E') if is(b"ENDMDL") => Self::Endmdl,
            Some(b'E') if is(b"END") => Self::End,
            Some(b'_') if line.starts_with(b"_atom_site.") => Self::AtomSite,
            _ => Self::Other,
        }
    }
}

/// The lines of a file without their line ends, each with its number from 1.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes, line: 0 }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        self.line += 1;
        let end = memchr::memchr(b'\n', self.rest).unwrap_or(self.rest.len());
        let (text, rest) = self.rest.split_at_checked(end)?;
        self.rest = rest.strip_prefix(b"\n").unwrap_or(rest);
        Some((self.line, text.strip_suffix(b"\r").unwrap_or(text)))
    }
}

/// One line whose fields are read. Columns are counted from 1, and a field includes its last column.
pub(super) struct Record<'a> {
    pub(super) line: usize,
    pub(super) name: &'static str,
    /// The text of the line, which is only ASCII.
    text: &'a [u8],
}

impl<'a> Record<'a> {
    pub(super) fn new(line: usize, bytes: &'a [u8], name: &'static str) -> Result<Self, LoadError> {
        // The format has 80 columns; anything after them is ignored.
        let text = bytes.get(..80).unwrap_or(bytes);
        if text.is_ascii() {
            return Ok(Self { line, name, text });
        }
        let offset = text.iter().position(|byte| !byte.is_ascii()).unwrap_or_default();
        let byte = text.get(offset).copied().unwrap_or_default();
        let message = format!("the byte 0x{byte:02x} is not ASCII; ATOM, HETATM and CRYST1 records must be ASCII text");
        Err(LoadError::at(Place::Column { line, column: offset + 1 }, message))
    }

    /// Refuses a line that ends before one of the fields. Each field has a name, a first and a last column.
    pub(super) fn must_have(&self, fields: &[(&'static str, usize, usize)]) -> Result<(), LoadError> {
        let columns = self.text.len();
        match fields.iter().find(|(_, _, last)| *last > columns) {
            None => Ok(()),
            Some((what, first, last)) => {
                let record = self.name;
                let article = if record == "ATOM" { "an" } else { "a" };
                let message = format!(
                    "the {what} (columns {first}-{last}) is missing, because the line ends after {columns} columns; \
                     {article} {record} record has at least 54 columns"
                );
                Err(LoadError::line(self.line, message))
            }
        }
    }

    /// Returns the text of a field without the blanks around it; it is empty if the line ends before the field.
    pub(super) fn text(&self, first: usize, last: usize) -> &'a [u8] {
        let last = last.min(self.text.len());
        self.text.get(first - 1..last).unwrap_or_default().trim_ascii()
    }

    /// Returns the bytes of a field with the blanks around it; bytes after the end of the line are blanks.
    pub(super) fn bytes<const WIDTH: usize>(&self, first: usize) -> [u8; WIDTH] {
        let rest = self.text.get(first - 1..).unwrap_or_default();
        rest.first_chunk().copied().unwrap_or_else(|| {
            let mut field = [b' '; WIDTH];
            field.iter_mut().zip(rest).for_each(|(to, from)| *to = *from);
            field
        })
    }

    pub(super) fn number(&self, what: &'static str, first: usize, last: usize) -> Result<f64, LoadError> {
        let text = self.text(first, last);
        number(text).filter(|number| number.is_finite()).ok_or_else(|| {
            let found = not_valid(text, "a finite number");
            let place = Place::Columns { line: self.line, first, last };
            let message = format!("the {what} is {found}; a number such as 11.104 belongs there");
            LoadError::at(place, message)
        })
    }

    /// Returns the number in a field, or `absent` if the field is blank.
    pub(super) fn number_or(
        &self,
        absent: f64,
        what: &'static str,
        first: usize,
        last: usize,
    ) -> Result<f64, LoadError> {
        // Few fields are blank, so that is tested only if there is no number.
        self.number(what, first, last).or_else(
            |error| {
                if self.text(first, last).is_empty() { Ok(absent) } else { Err(error) }
            },
        )
    }
}

/// Ends a sentence about the ASCII text of a field that is not valid.
pub(super) fn not_valid(text: &[u8], kind: &str) -> String {
    match text {
        b"" => "blank".to_owned(),
        _ => {
            let found = String::from_utf8_lossy(text);
            format!("`{}`, which is not {kind}", found.escape_debug())
        }
    }
}

/// The number of four-digit numbers in base 36 with the same first digit.
const BLOCK: i32 = 36 * 36 * 36;

/// Decodes a field that has no blanks around it; `None` if it is not a valid number.
pub(super) fn hybrid36(text: &[u8]) -> Option<i32> {
    match *text {
        [b'A'..=b'Z', _, _, _] => base36(text, b'A').map(|number| number - 10 * BLOCK + 10_000),
        [b'a'..=b'z', _, _, _] => base36(text, b'a').map(|number| number + 16 * BLOCK + 10_000),
        [b'A'..=b'Z', _, _, _, _] => base36(text, b'A').map(|number| number - 360 * BLOCK + 100_000),
        [b'a'..=b'z', _, _, _, _] => base36(text, b'a').map(|number| number + 576 * BLOCK + 100_000),
        _ => std::str::from_utf8(text).ok()?.parse().ok(),
    }
}

/// Decodes at most five digits in base 36. The digit 10 is the letter `ten`, and the letters after it follow.
fn base36(digits: &[u8], ten: u8) -> Option<i32> {
    digits.iter().try_fold(0, |number, &digit| {
        let value = match digit {
            b'0'..=b'9' => digit - b'0',
            _ => digit.checked_sub(ten).filter(|letter| *letter < 26)? + 10,
        };
        Some(number * 36 + i32::from(value))
    })
}

/// Returns the edge vectors of the cell, the first along x and the second in the plane of x and y; or `None` if the
/// record is only a placeholder, as in files of structures that are not crystals.
pub(super) fn cell_of(record: &Record<'_>) -> Result<Option<[[f64; 3]; 3]>, LoadError> {
    const FIELDS: [(&str, usize, usize); 6] = [
        ("length of the cell's edge a", 7, 15),
        ("length of the cell's edge b", 16, 24),
        ("length of the cell's edge c", 25, 33),
        ("cell's angle alpha", 34, 40),
        ("cell's angle beta", 41, 47),
        ("cell's angle gamma", 48, 54),
    ];
    record.must_have(&FIELDS)?;
    let mut values = [0.0; 6];
    for (value, (what, first, last)) in values.iter_mut().zip(FIELDS) {
        *value = record.number(what, first, last)?;
    }
    let [a, b, c, alpha, beta, gamma] = values;
    let (lengths, angles) = ([a, b, c], [alpha, beta, gamma]);
    cell_edges(lengths, angles).map_err(|message| LoadError::line(record.line, message))
}
