//! The bonds of an mmCIF file: the rows of `_struct_conn` that are covalent bonds or those of metals.

use memchr::memmem;

use super::tokens::{Token, Tokens, decimal, is_unknown};
use crate::load::atoms::AtomKey;
use crate::load::error::LoadError;

const CATEGORY: &[u8] = b"_struct_conn.";

/// Kinds of connections that are bonds, by the start of their names. PDB files list the same in CONECT records. Bonds of
/// hydrogen, salt bridges and mismatches are others.
const KINDS: [&[u8]; 4] = [b"covale", b"disulf", b"metalc", b"modres"];

/// The items of one end, each with its names in the order of preference.
const ITEMS: [&[&str]; 7] = [
    &["ptnr#_auth_asym_id", "ptnr#_label_asym_id"],
    &["ptnr#_auth_comp_id", "ptnr#_label_comp_id"],
    &["ptnr#_auth_seq_id", "ptnr#_label_seq_id"],
    &["ptnr#_label_atom_id"],
    &["pdbx_ptnr#_pdb_ins_code"],
    &["pdbx_ptnr#_label_alt_id"],
    &["ptnr#_symmetry"],
];

/// The part of a text that belongs to the block at its end.
pub(super) fn last_block(text: &[u8]) -> &[u8] {
    memmem::rfind(text, b"\ndata_").map_or(text, |start| &text[start..])
}

/// The part of a text that belongs to the block at its start.
pub(super) fn first_block(text: &[u8]) -> &[u8] {
    if text.starts_with(b"data_") {
        // The rows of atoms end their block.
        return &[];
    }
    memmem::find(text, b"\ndata_").map_or(text, |start| &text[..start])
}

/// Returns true if a text may list bonds.
pub(super) fn are_in(text: &[u8]) -> bool {
    memmem::find(text, CATEGORY).is_some()
}

/// Returns the atoms of all bonds in the text of a block, which may have a loop of connections or only one. The number of
/// lines is that before the end of the text.
///
/// # Errors
/// Returns an error if the last row lacks values.
pub(super) fn links(text: &[u8], lines_up_to_end: usize) -> Result<Vec<[AtomKey<'_>; 2]>, LoadError> {
    let is_start = |at: &usize| *at == 0 || text[at - 1].is_ascii_whitespace();
    let Some(start) = memmem::find_iter(text, CATEGORY).find(is_start) else { return Ok(Vec::new()) };
    let lines = lines_up_to_end.saturating_sub(memchr::memchr_iter(b'\n', &text[start..]).count());
    let mut tokens = Tokens::new(text, 0);
    tokens.go_to(start, lines);
    // Values follow all names of a loop; without a loop each follows its name. Their order is the same.
    let (mut names, mut values) = (Vec::new(), Vec::new());
    let end = loop {
        let place = tokens.place();
        match tokens.next_at(place)? {
            Some(Token::Name(name)) if name.starts_with(CATEGORY) => {
                names.push(String::from_utf8_lossy(&name[CATEGORY.len()..]).to_ascii_lowercase());
            }
            Some(Token::Value(value)) => values.push(value),
            _ => break place,
        }
    };
    let rows = values.chunks_exact(names.len());
    if !rows.remainder().is_empty() {
        let message = format!(
            "the row of _struct_conn that ends before this line has {} of {} values; add those that are missing",
            rows.remainder().len(),
            names.len()
        );
        return Err(LoadError::line(end.lines_before + 1, message));
    }
    let column = |wanted: &str| names.iter().position(|name| name == wanted);
    let items = [b'1', b'2'].map(|end| {
        let named = |name: &&str| column(&name.replace('#', char::from(end).encode_utf8(&mut [0; 4])));
        ITEMS.map(|wanted| wanted.iter().find_map(named))
    });
    Ok(rows.filter_map(|row| link(row, column("conn_type_id"), items)).collect())
}

/// Returns the atoms of a connection if it is a bond between two that are there.
fn link<'a>(row: &[&'a [u8]], kind: Option<usize>, items: [[Option<usize>; 7]; 2]) -> Option<[AtomKey<'a>; 2]> {
    let value = |column: Option<usize>| column.map(|column| row[column]).filter(|value| !is_unknown(value));
    let letter = |column| value(column).and_then(|text| text.first().copied()).unwrap_or(b' ');
    let kind = value(kind)?.to_ascii_lowercase();
    // Images of atoms by the symmetry of the crystal are not there.
    let is_here = value(items[0][6]) == value(items[1][6]);
    let is_bond = is_here && KINDS.iter().any(|known| kind.starts_with(known));
    is_bond.then(|| {
        items.map(|[chain, residue, number, name, insertion, alternate, _]| AtomKey {
            chain: value(chain).unwrap_or_default(),
            residue: value(residue).unwrap_or_default(),
            residue_number: value(number).and_then(decimal).unwrap_or(f64::NAN),
            name: value(name).unwrap_or_default(),
            insertion: letter(insertion),
            letter: letter(alternate),
        })
    })
}
