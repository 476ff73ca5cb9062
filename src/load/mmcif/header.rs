//! What stands around the rows of atoms: the names of their columns, and the cell.

use super::errors::not_a_number;
use super::tokens::{Token, Tokens};
use crate::load::atoms::cell;
use crate::load::error::LoadError;
use crate::load::rows::number;

/// Values of an atom that the reader uses, each with its names in the order of preference: those that the authors gave
/// come first, because PDB files have them.
pub(super) const SLOTS: [&[&str]; 17] = [
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
];

/// The columns of a loop of atoms.
#[derive(Debug)]
pub(super) struct Columns {
    pub(super) count: usize,
    /// For each column, the slot that its values go to.
    pub(super) slots: Vec<Option<usize>>,
    /// The column with the number of the model.
    pub(super) model: Option<usize>,
    /// Whether positions are fractions of the cell.
    pub(super) is_fractional: bool,
    /// Which slots have a column.
    pub(super) has: [bool; SLOTS.len()],
}

impl Columns {
    /// Returns the columns if these are names of a loop that has positions of atoms.
    pub(super) fn of_names(names: &[&[u8]]) -> Option<Self> {
        let names: Vec<String> =
            names.iter().map(|name| item_of(name, "atom_site")).collect::<Option<_>>()?;
        let position = |name: &str| names.iter().position(|found| found == name);
        let all = |names: [&str; 3]| names.iter().all(|name| position(name).is_some());
        let is_fractional = match (
            all(["cartn_x", "cartn_y", "cartn_z"]),
            all(["fract_x", "fract_y", "fract_z"]),
        ) {
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

/// What the text before the rows of a block, or after them, says.
#[derive(Debug, Default)]
pub(super) struct Header {
    pub(super) columns: Option<Columns>,
    lengths: [Option<f64>; 3],
    angles: [Option<f64>; 3],
}

impl Header {
    /// Reads a text that ends where rows begin. What belongs to an earlier block is forgotten.
    pub(super) fn before(text: &[u8], lines_before: usize) -> Result<Self, LoadError> {
        let mut header = Self::default();
        header.read(text, lines_before, false)?;
        Ok(header)
    }

    /// Adds what stands after the rows, up to the next block.
    pub(super) fn add_after(&mut self, text: &[u8], lines_before: usize) -> Result<(), LoadError> {
        let columns = self.columns.take();
        let mut after = Self::default();
        after.read(text, lines_before, true)?;
        for (mine, other) in [(&mut self.lengths, after.lengths), (&mut self.angles, after.angles)]
        {
            mine.iter_mut().zip(other).for_each(|(mine, other)| *mine = mine.or(other));
        }
        self.columns = columns;
        Ok(())
    }

    /// Another block ends the text, or what was read before it is forgotten.
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

    /// Keeps a value of the cell.
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
        let ([Some(a), Some(b), Some(c)], [Some(alpha), Some(beta), Some(gamma)]) =
            (self.lengths, self.angles)
        else {
            return Ok(None);
        };
        let (lengths, angles) = ([a, b, c], [alpha, beta, gamma]);
        cell::edges(lengths, angles).map_err(LoadError::new)
    }
}

/// Whether a value says that there is none.
pub(super) fn is_unknown(value: &[u8]) -> bool {
    matches!(value, b"." | b"?")
}

/// A finite number, after which its uncertainty may stand in parentheses: `0.1234(5)`.
#[inline]
pub(super) fn decimal(text: &[u8]) -> Option<f64> {
    let text = match text {
        [number @ .., b')'] => number.split(|byte| *byte == b'(').next().unwrap_or_default(),
        number => number,
    };
    number(text).filter(|number| number.is_finite())
}
