//! The text of a CIF file: its tokens, as syntax 1.1 of CIF describes them, and the text around the rows of atoms,
//! with the names of their columns and the cell.

use memchr::{memchr, memmem};

use crate::load::atoms::cell_edges;
use crate::load::error::{self, LoadError};
use crate::load::numbers::number;
use pinhole::internals::text::shortened;

/// A token, without its quotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    Value(&'a [u8]),
    /// The name of an item, with the `_` in front.
    Name(&'a [u8]),
    Loop,
    /// Begins a data block.
    Data,
    /// Any other reserved word.
    Other,
}

/// The tokens of a text.
#[derive(Clone, Debug)]
pub(super) struct Tokens<'a> {
    text: &'a [u8],
    /// Offset at which the search for the next token begins.
    pub(super) at: usize,
    /// Number of line ends before this offset.
    lines: usize,
    /// Offset of the line of the next token.
    line_start: usize,
}

/// The start of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) offset: usize,
    /// Number of lines before it.
    pub(super) lines_before: usize,
    /// Number of bytes before it in its line.
    pub(super) column: usize,
}

impl Place {
    pub(super) fn of_error(self) -> error::Place {
        error::Place::Column { line: self.lines_before + 1, column: self.column + 1 }
    }
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a [u8], lines_before: usize) -> Self {
        Self { text, at: 0, lines: lines_before, line_start: 0 }
    }

    /// Continues at the start of a line.
    pub(super) fn go_to(&mut self, offset: usize, lines_before: usize) {
        (self.at, self.lines, self.line_start) = (offset, lines_before, offset);
    }

    /// Skips white space and comments, and returns the start of the next token.
    #[inline]
    pub(super) fn place(&mut self) -> Place {
        while let Some(byte) = self.text.get(self.at) {
            match byte {
                b'\n' => {
                    self.at += 1;
                    self.lines += 1;
                    self.line_start = self.at;
                }
                b' ' | b'\t' | b'\r' => self.at += 1,
                b'#' => {
                    let rest = &self.text[self.at..];
                    self.at += memchr(b'\n', rest).unwrap_or(rest.len());
                }
                _ => break,
            }
        }
        Place { offset: self.at, lines_before: self.lines, column: self.at - self.line_start }
    }

    /// Returns the next token; `None` at the end of the text.
    #[inline]
    pub(super) fn next(&mut self) -> Result<Option<Token<'a>>, LoadError> {
        let place = self.place();
        self.next_at(place)
    }

    /// Returns the token at the place that [`Tokens::place`] has found.
    #[inline]
    pub(super) fn next_at(&mut self, place: Place) -> Result<Option<Token<'a>>, LoadError> {
        let rest = &self.text[self.at..];
        let Some(first) = rest.first() else { return Ok(None) };
        match first {
            b'\'' | b'"' => return self.quoted(*first, place).map(Some),
            b';' if place.column == 0 => return self.lines_of_text(place).map(Some),
            _ => {}
        }
        let end = rest.iter().position(|byte| *byte <= b' ').unwrap_or(rest.len());
        let word = &rest[..end];
        // Only white space ends a token. A control character is a token of its own, so it is not skipped either.
        self.at += end.max(1);
        Ok(Some(match first {
            b'_' => Token::Name(word),
            b'd' | b'D' | b'l' | b'L' | b's' | b'S' | b'g' | b'G' => reserved(word),
            _ => Token::Value(word),
        }))
    }

    /// Reads a quoted text. A quote ends it only before white space or at the end of the file.
    fn quoted(&mut self, quote: u8, place: Place) -> Result<Token<'a>, LoadError> {
        let rest = &self.text[self.at + 1..];
        let mut from = 0;
        while let Some(found) = memchr::memchr2(quote, b'\n', &rest[from..]) {
            let end = from + found;
            if rest[end] == b'\n' {
                break;
            }
            if rest.get(end + 1).is_none_or(|byte| *byte <= b' ') {
                self.at += end + 2;
                return Ok(Token::Value(&rest[..end]));
            }
            from = end + 1;
        }
        let message = "the quoted text that begins here does not end on its line";
        Err(LoadError::at(place.of_error(), message))
    }

    /// Reads a text of several lines, which begins and ends with `;` at the start of a line.
    fn lines_of_text(&mut self, place: Place) -> Result<Token<'a>, LoadError> {
        let rest = &self.text[self.at + 1..];
        let end = memmem::find(rest, b"\n;").ok_or_else(|| {
            LoadError::line(
                place.lines_before + 1,
                "the text that begins here with ; does not end; a line that begins with ; must end it",
            )
        })?;
        let text = &rest[..end];
        self.lines += memchr::memchr_iter(b'\n', text).count() + 1;
        self.at += end + 3;
        self.line_start = self.at - 1;
        Ok(Token::Value(text))
    }
}

fn reserved(word: &[u8]) -> Token<'_> {
    let starts = |name: &[u8]| word.get(..name.len()).is_some_and(|w| w.eq_ignore_ascii_case(name));
    if word.eq_ignore_ascii_case(b"loop_") {
        Token::Loop
    } else if starts(b"data_") {
        Token::Data
    } else if starts(b"save_") || word.eq_ignore_ascii_case(b"global_") || word.eq_ignore_ascii_case(b"stop_") {
        Token::Other
    } else {
        Token::Value(word)
    }
}

/// The error of a loop whose last row has too few values.
pub(super) fn cut_row(place: Place, values: usize, columns: usize) -> LoadError {
    let message = format!(
        "the row of _atom_site that begins here has {values} values, but the loop names {columns} columns; a value is \
         missing in this row or in one before it, or the file is cut off"
    );
    LoadError::line(place.lines_before + 1, message)
}

pub(super) fn not_a_number(text: &[u8], place: Place, what: &str) -> LoadError {
    let found = shortened(&String::from_utf8_lossy(text));
    LoadError::at(place.of_error(), format!("{what} is `{found}`, which is not a finite number"))
}

/// Values of an atom that the reader uses, each with its names in the order of preference. Names given by the authors
/// come first, because PDB files have them.
pub(super) const SLOTS: [&[&str]; 18] = [
    &["cartn_x"],
    &["cartn_y"],
    &["cartn_z"],
    &["fract_x"],
    &["fract_y"],
    &["fract_z"],
    &["type_symbol"],
    &["auth_atom_id", "label_atom_id", "label"],
    &["auth_comp_id", "label_comp_id"],
    &["auth_asym_id", "label_asym_id"],
    &["auth_seq_id", "label_seq_id"],
    &["b_iso_or_equiv", "u_iso_or_equiv"],
    &["occupancy"],
    &["group_pdb"],
    &["label_alt_id"],
    &["pdbx_pdb_ins_code"],
    &["label_entity_id"],
    &["id"],
];

/// The columns of a loop of atoms.
#[derive(Debug)]
pub(super) struct Columns {
    pub(super) count: usize,
    /// For each column, the slot for its values.
    pub(super) slots: Vec<Option<usize>>,
    /// The column with the number of the model.
    pub(super) model: Option<usize>,
    /// Whether positions are fractions of the cell.
    pub(super) is_fractional: bool,
    /// For each slot, whether it has a column.
    pub(super) has: [bool; SLOTS.len()],
}

impl Columns {
    /// Returns the columns if these are names of a loop that has positions of atoms.
    pub(super) fn of_names(names: &[&[u8]]) -> Option<Self> {
        let names: Vec<String> = names.iter().map(|name| item_of(name, "atom_site")).collect::<Option<_>>()?;
        let position = |name: &str| names.iter().position(|found| found == name);
        let all = |names: [&str; 3]| names.iter().all(|name| position(name).is_some());
        let is_fractional = match (all(["cartn_x", "cartn_y", "cartn_z"]), all(["fract_x", "fract_y", "fract_z"])) {
            (true, _) => false,
            (false, true) => true,
            (false, false) => return None,
        };
        let mut slots = vec![None; names.len()];
        let mut has = [false; SLOTS.len()];
        for (slot, wanted) in SLOTS.iter().enumerate() {
            if let Some(column) = wanted.iter().find_map(|name| position(name)) {
                slots[column] = Some(slot);
                has[slot] = true;
            }
        }
        let model = position("pdbx_pdb_model_num");
        Some(Self { count: names.len(), slots, model, is_fractional, has })
    }
}

/// The name of an item within its category, in lower case: `_cell.length_a` and `_cell_length_a` are `length_a`.
fn item_of(name: &[u8], category: &str) -> Option<String> {
    let name = std::str::from_utf8(name).ok()?.to_ascii_lowercase();
    let item = name.strip_prefix('_')?.strip_prefix(category)?.strip_prefix(['.', '_'])?;
    Some(item.to_owned())
}

/// The columns and the cell, from the text before or after the rows of a block.
#[derive(Debug, Default)]
pub(super) struct Header {
    pub(super) columns: Option<Columns>,
    lengths: [Option<f64>; 3],
    angles: [Option<f64>; 3],
}

impl Header {
    /// Reads a text that ends where rows begin. Values of an earlier block are forgotten.
    pub(super) fn before(text: &[u8], lines_before: usize) -> Result<Self, LoadError> {
        let mut header = Self::default();
        header.read(text, lines_before, false)?;
        Ok(header)
    }

    /// Adds values from the text after the rows, up to the next block.
    pub(super) fn add_after(&mut self, text: &[u8], lines_before: usize) -> Result<(), LoadError> {
        let columns = self.columns.take();
        let mut after = Self::default();
        after.read(text, lines_before, true)?;
        for (mine, other) in [(&mut self.lengths, after.lengths), (&mut self.angles, after.angles)] {
            mine.iter_mut().zip(other).for_each(|(mine, other)| *mine = mine.or(other));
        }
        self.columns = columns;
        Ok(())
    }

    /// Reads a text. Another block ends it if `to_block` is true; otherwise values before the block are forgotten.
    fn read(&mut self, text: &[u8], lines_before: usize, to_block: bool) -> Result<(), LoadError> {
        let mut tokens = Tokens::new(text, lines_before);
        let mut name = None;
        let mut names: Option<Vec<&[u8]>> = None;
        loop {
            let place = tokens.place();
            let Some(token) = tokens.next()? else { break };
            if let (Some(list), Token::Name(name)) = (&mut names, token) {
                list.push(name);
                continue;
            }
            match token {
                Token::Data if to_block => return Ok(()),
                Token::Data => *self = Self::default(),
                Token::Loop => {
                    names = Some(Vec::new());
                    continue;
                }
                Token::Name(found) => name = item_of(found, "cell"),
                Token::Value(value) => {
                    if let Some(name) = name.take() {
                        let invalid = |what| not_a_number(value, place, what);
                        self.set(&name, value).map_err(invalid)?;
                    }
                }
                Token::Other => {}
            }
            names = None;
        }
        self.columns = names.and_then(|names| Columns::of_names(&names));
        Ok(())
    }

    /// Stores a value of the cell.
    fn set(&mut self, name: &str, value: &[u8]) -> Result<(), &'static str> {
        let (place, what) = match name {
            "length_a" => (&mut self.lengths[0], "_cell.length_a"),
            "length_b" => (&mut self.lengths[1], "_cell.length_b"),
            "length_c" => (&mut self.lengths[2], "_cell.length_c"),
            "angle_alpha" => (&mut self.angles[0], "_cell.angle_alpha"),
            "angle_beta" => (&mut self.angles[1], "_cell.angle_beta"),
            "angle_gamma" => (&mut self.angles[2], "_cell.angle_gamma"),
            _ => return Ok(()),
        };
        if !is_unknown(value) {
            *place = Some(decimal(value).ok_or(what)?);
        }
        Ok(())
    }

    /// The edges of the cell; `None` if the file has none.
    pub(super) fn cell(&self) -> Result<Option<[[f64; 3]; 3]>, LoadError> {
        let ([Some(a), Some(b), Some(c)], [Some(alpha), Some(beta), Some(gamma)]) = (self.lengths, self.angles) else {
            return Ok(None);
        };
        let (lengths, angles) = ([a, b, c], [alpha, beta, gamma]);
        cell_edges(lengths, angles).map_err(LoadError::new)
    }
}

/// Whether a value stands for an unknown or missing one.
pub(super) fn is_unknown(value: &[u8]) -> bool {
    matches!(value, b"." | b"?")
}

/// Parses a finite number. Its uncertainty may follow in parentheses: `0.1234(5)`.
#[inline]
pub(super) fn decimal(text: &[u8]) -> Option<f64> {
    let text = match text {
        [number @ .., b')'] => number.split(|byte| *byte == b'(').next().unwrap_or_default(),
        number => number,
    };
    number(text).filter(|number| number.is_finite())
}
