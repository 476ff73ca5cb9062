//! Reads mmCIF files, and CIF files of small molecules.
//!
//! Atoms are the rows of the loop with the positions of `_atom_site`. A frame is a model; models of several data blocks
//! follow each other. Columns and the choice between alternate locations are those of PDB files, so that an entry in
//! either format gives the same result, but for the numbers of its atoms. Where the authors' names and numbers (`auth_…`) differ from those of the
//! dictionary (`label_…`), the authors' count. Lengths are taken as they are, in Å.
//!
//! Bonds are the connections of `_struct_conn` that are covalent or those of metals, in the block of the atoms.
//!
//! Positions that are fractions of the cell are repeated by the operators of symmetry that the block lists, so that the
//! cell is full.

mod links;
mod symmetry;
mod tokens;

use std::collections::HashSet;
use std::io::SeekFrom;

use memchr::memchr;

use crate::load::Dataset;
use crate::load::atoms::{Atom, Atoms};
use crate::load::error::LoadError;
use crate::load::format::{FrameIndex, FrameReader, FrameSpan, Frames, Options};
use crate::load::source::{Bytes, bytes};
use pinhole::internals::text::{shortened, without_byte_order_mark};
use symmetry::Symmetry;
use tokens::{Columns, Header, Place, SLOTS, Token, Tokens, cut_row, decimal, is_unknown, not_a_number};

pub(super) const FRAMES: Frames = Frames::Bytes { find };

/// Whether the first line that is neither blank nor a comment begins a data block.
pub(super) fn starts(bytes: &[u8]) -> bool {
    let mut lines = without_byte_order_mark(bytes).split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"));
    first.and_then(|line| line.get(..5)).is_some_and(|name| name.eq_ignore_ascii_case(b"data_"))
}

/// Finds the models. The whole file must be in memory, because a row may go over several lines.
fn find(source: &mut dyn Bytes, _: Option<usize>, _: &Options) -> Result<FrameIndex, LoadError> {
    let mut text = Vec::new();
    source.seek(SeekFrom::Start(0))?;
    source.read_to_end(&mut text)?;
    let (models, problem) = models_of(&text);
    let frames: Vec<FrameSpan> = models
        .into_iter()
        .map(|model| FrameSpan { bytes: model.start as u64..model.end as u64, lines_before: model.lines_before })
        .collect();
    let problem = problem.or_else(|| frames.is_empty().then(no_atoms));
    let reader = MmCif { models: frames.clone(), end: text.len() as u64, is_whole: problem.is_none() };
    Ok(FrameIndex { frames, is_whole: true, problem, reader: Some(Box::new(reader)), ..FrameIndex::default() })
}

/// Reads models. The text around them has the names of their columns, and the cell.
#[derive(Debug)]
struct MmCif {
    models: Vec<FrameSpan>,
    /// Size of the file in bytes.
    end: u64,
    /// Whether the file is valid after its last model.
    is_whole: bool,
}

impl FrameReader for MmCif {
    fn read(&self, source: &mut dyn Bytes, wanted: usize, span: &FrameSpan, _: &Options) -> Result<Dataset, LoadError> {
        let frames = &self.models;
        let FrameSpan { bytes: rows, lines_before } = span;
        // Models of a block follow each other without a gap. The text between blocks has their names and cells.
        let is_first = |frame: usize| frame == 0 || frames[frame - 1].bytes.end != frames[frame].bytes.start;
        let first = (0..=wanted).rev().find(|frame| is_first(*frame)).unwrap_or_default();
        let last = (wanted..frames.len()).find(|frame| frame + 1 == frames.len() || is_first(frame + 1));
        let last = last.unwrap_or(wanted);
        let start = if first == 0 { 0 } else { frames[first - 1].bytes.end };
        let before = bytes(source, &(start..frames[first].bytes.start))?;
        let count_lines = |text: &[u8]| memchr::memchr_iter(b'\n', text).count();
        let lines_of_rows = frames[first].lines_before;
        let lines = lines_of_rows.saturating_sub(count_lines(&before));
        let mut header = Header::before(without_byte_order_mark(&before), lines)?;
        let end = frames.get(last + 1).map_or(self.end, |next| next.bytes.start);
        let after = bytes(source, &(frames[last].bytes.end..end))?;
        let mut links = links::links(links::last_block(&before), lines_of_rows)?;
        let is_fractional = header.columns.as_ref().is_some_and(|columns| columns.is_fractional);
        let mut symmetry = Symmetry::default();
        if is_fractional {
            symmetry.add(without_byte_order_mark(&before), lines, false)?;
        }
        if self.is_whole && (is_fractional || header.cell()?.is_none() || links::are_in(&after)) {
            let lines = frames[last].lines_before + count_lines(&bytes(source, &frames[last].bytes)?);
            header.add_after(&after, lines)?;
            let block = links::first_block(&after);
            links.extend(links::links(block, lines + count_lines(block))?);
            if is_fractional {
                symmetry.add(&after, lines, true)?;
            }
        }
        let cell = header.cell()?;
        let columns = header.columns.ok_or_else(no_atoms)?;
        let text = bytes(source, rows)?;
        let mut atoms = read_rows(&text, *lines_before, &columns, cell)?;
        let missing = atoms.bond_by_name(&links);
        let mut loaded = atoms.into_loaded();
        if missing > 0 {
            loaded
                .notes
                .push(format!("bonds of _struct_conn are left out, because their atoms are not there: {missing}"));
        }
        loaded.cell = cell;
        loaded.is_part_of_crystal = !is_fractional;
        if is_fractional {
            symmetry.fill(&mut loaded)?;
        }
        Ok(loaded)
    }
}

fn no_atoms() -> LoadError {
    LoadError::new(
        "there are no atoms: no loop_ has _atom_site.Cartn_x, _atom_site.Cartn_y and _atom_site.Cartn_z, or \
         _atom_site_fract_x, _y and _z, with rows below",
    )
}

/// The values of an atom, each with its position in the text.
type Values<'a> = [(Place, &'a [u8]); SLOTS.len()];

fn read_rows(
    text: &[u8],
    lines_before: usize,
    columns: &Columns,
    cell: Option<[[f64; 3]; 3]>,
) -> Result<Atoms, LoadError> {
    let mut tokens = Tokens::new(text, lines_before);
    // Rows are hardly ever shorter than this.
    let mut atoms = Atoms::with_capacity(text.len() / 80);
    let none = Place { offset: 0, lines_before, column: 0 };
    let mut values: Values<'_> = [(none, &b"."[..]); SLOTS.len()];
    loop {
        let row = tokens.place();
        for (column, slot) in columns.slots.iter().enumerate() {
            let place = tokens.place();
            let Some(Token::Value(value)) = tokens.next_at(place)? else {
                if column == 0 {
                    return Ok(atoms);
                }
                return Err(cut_row(row, column, columns.count));
            };
            if let Some(slot) = slot {
                values[*slot] = (place, value);
            }
        }
        push(&mut atoms, &values, columns, cell)?;
    }
}

fn push(
    atoms: &mut Atoms,
    values: &Values<'_>,
    columns: &Columns,
    cell: Option<[[f64; 3]; 3]>,
) -> Result<(), LoadError> {
    let number = |slot: usize, what| {
        let (place, text): (Place, &[u8]) = values[slot];
        decimal(text).ok_or_else(|| not_a_number(text, place, what))
    };
    let number_or = |slot: usize, absent, what| {
        if is_unknown(values[slot].1) { Ok(absent) } else { number(slot, what) }
    };
    let text = |slot: usize| if is_unknown(values[slot].1) { &[][..] } else { values[slot].1 };
    let letter = |slot: usize| text(slot).first().copied().unwrap_or(b' ');
    let place = if columns.is_fractional {
        let [u, v, w] = [number(3, "fract_x")?, number(4, "fract_y")?, number(5, "fract_z")?];
        let line = values[3].0.lines_before + 1;
        let [a, b, c] = cell.ok_or_else(|| {
            LoadError::line(
                line,
                "the positions are fractions of the cell, but there are no _cell_length_a, _b, _c and _cell_angle_alpha, \
                 _beta, _gamma",
            )
        })?;
        [0, 1, 2].map(|axis| u * a[axis] + v * b[axis] + w * c[axis])
    } else {
        [number(0, "Cartn_x")?, number(1, "Cartn_y")?, number(2, "Cartn_z")?]
    };
    let (name, residue) = (text(7), text(8));
    let mut symbol = symbol_of(text(6));
    if symbol == *b"  " && residue.is_empty() {
        // A label of a small molecule is a symbol and a number.
        symbol = symbol_of(name);
    }
    atoms.push(&Atom {
        place,
        occupancy: number_or(12, 1.0, "occupancy")?,
        b_factor: number_or(11, 0.0, "B_iso_or_equiv")?,
        residue_number: number_or(10, f64::NAN, "auth_seq_id")?,
        name,
        name_field: field_of(name, residue),
        symbol,
        residue,
        chain: text(9),
        record: if columns.has[13] { text(13) } else { b"HETATM" },
        entity: columns.has[16].then(|| text(16)),
        docking: None,
        letter: letter(14),
        insertion: letter(15),
        serial: decimal(values[17].1).unwrap_or(f64::NAN),
    });
    Ok(())
}

/// The first letters of a text, at most two, as a symbol in its field.
fn symbol_of(text: &[u8]) -> [u8; 2] {
    match text {
        [a, b, rest @ ..]
            if a.is_ascii_alphabetic()
                && b.is_ascii_alphabetic()
                && !rest.first().is_some_and(u8::is_ascii_alphabetic) =>
        {
            [*a, *b]
        }
        [a, rest @ ..] if a.is_ascii_alphabetic() && !rest.first().is_some_and(u8::is_ascii_alphabetic) => [b' ', *a],
        _ => *b"  ",
    }
}

/// The name as in a PDB file. There, a name of up to three characters begins in the second column, unless it is the
/// name of an ion, which equals that of its residue and begins in the first.
fn field_of(name: &[u8], residue: &[u8]) -> [u8; 4] {
    let mut field = [b' '; 4];
    let skipped = usize::from(name.len() < 4 && name != residue);
    field[skipped..].iter_mut().zip(name).for_each(|(to, from)| *to = *from);
    field
}

/// Range and first line of a model's rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Model {
    start: usize,
    end: usize,
    lines_before: usize,
}

/// Returns the models of a text, and the fault after them.
fn models_of(text: &[u8]) -> (Vec<Model>, Option<LoadError>) {
    let mut models = Vec::new();
    let problem = search(text, &mut models).err();
    (models, problem)
}

fn search(text: &[u8], models: &mut Vec<Model>) -> Result<(), LoadError> {
    let mut tokens = Tokens::new(text, 0);
    let mut names: Option<Vec<&[u8]>> = None;
    loop {
        let place = tokens.place();
        let mut next = tokens.clone();
        match (next.next()?, &mut names) {
            (None, _) => return Ok(()),
            (Some(Token::Loop), _) => names = Some(Vec::new()),
            (Some(Token::Name(name)), Some(names)) => names.push(name),
            (Some(Token::Value(_)), Some(of_loop)) => {
                let columns = Columns::of_names(of_loop);
                names = None;
                if let Some(columns) = columns {
                    let found = Rows { text, columns: &columns, first: place };
                    next = match found.by_lines(models)? {
                        Some(tokens) => tokens,
                        None => found.by_values(models)?,
                    };
                }
            }
            _ => names = None,
        }
        tokens = next;
    }
}

/// The rows of a loop.
struct Rows<'a, 'c> {
    text: &'a [u8],
    columns: &'c Columns,
    first: Place,
}

/// The models of a loop that were found so far.
struct LoopModels<'a> {
    models: Vec<Model>,
    names: HashSet<&'a [u8]>,
    current: &'a [u8],
}

impl<'a> LoopModels<'a> {
    fn new() -> Self {
        Self { models: Vec::new(), names: HashSet::new(), current: b"" }
    }

    fn begin(&mut self, name: &'a [u8], place: Place) -> Result<(), LoadError> {
        if !self.names.insert(name) {
            let model = shortened(&String::from_utf8_lossy(name));
            let message = format!("the model {model} begins again; all atoms of a model must follow each other");
            return Err(LoadError::line(place.lines_before + 1, message));
        }
        self.current = name;
        self.end(place.offset);
        let Place { offset, lines_before, .. } = place;
        self.models.push(Model { start: offset, end: offset, lines_before });
        Ok(())
    }

    fn end(&mut self, offset: usize) {
        if let Some(last) = self.models.last_mut() {
            last.end = offset;
        }
    }
}

impl<'a> Rows<'a, '_> {
    /// Finds models where each row is a line that ends with the model's number, as in the archives of the wwPDB; `None`
    /// if the rows are different.
    fn by_lines(&self, models: &mut Vec<Model>) -> Result<Option<Tokens<'a>>, LoadError> {
        let Self { text, columns, first } = *self;
        if columns.model != Some(columns.count - 1) || first.column != 0 {
            return Ok(None);
        }
        let mut found = LoopModels::new();
        let (mut at, mut lines_before) = (first.offset, first.lines_before);
        while at < text.len() {
            let rest = &text[at..];
            let end = memchr(b'\n', rest).unwrap_or(rest.len());
            let line = rest[..end].trim_ascii_end();
            match line.first() {
                Some(b';') => return Ok(None),
                Some(b'#' | b'_') | None => break,
                Some(_) => {}
            }
            let last = line.rsplit(|byte| *byte <= b' ').next().unwrap_or_default();
            if found.models.is_empty() || last != found.current {
                let mut tokens = Tokens::new(line, 0);
                let mut values = 0;
                // A fault in the line is found later value by value, with its place.
                while let Ok(Some(Token::Value(_))) = tokens.next() {
                    values += 1;
                }
                // Another loop or block follows the rows.
                if values == 0 {
                    break;
                }
                if values != columns.count {
                    return Ok(None);
                }
                found.begin(last, Place { offset: at, lines_before, column: 0 })?;
            }
            at = (at + end + 1).min(text.len());
            lines_before += 1;
        }
        let mut tokens = Tokens::new(text, 0);
        tokens.go_to(at, lines_before);
        // A value must not follow, or else rows are not lines.
        tokens.place();
        if let Some(Token::Value(_)) = tokens.clone().next()? {
            return Ok(None);
        }
        found.end(at);
        models.append(&mut found.models);
        Ok(Some(tokens))
    }

    /// Finds models value by value.
    fn by_values(&self, models: &mut Vec<Model>) -> Result<Tokens<'a>, LoadError> {
        let Self { text, columns, first } = *self;
        let mut tokens = Tokens::new(text, first.lines_before);
        tokens.go_to(first.offset, first.lines_before);
        let mut found = LoopModels::new();
        let result = loop {
            let row = tokens.place();
            let mut name: &[u8] = b"";
            let mut values = 0;
            let mut last = tokens.clone();
            while values < columns.count {
                last = tokens.clone();
                let Some(Token::Value(value)) = tokens.next()? else { break };
                if Some(values) == columns.model {
                    name = value;
                }
                values += 1;
            }
            if values == 0 {
                found.end(row.offset);
                break Ok(last);
            }
            if values < columns.count {
                found.end(row.offset);
                break Err(cut_row(row, values, columns.count));
            }
            if (found.models.is_empty() || name != found.current)
                && let Err(error) = found.begin(name, row)
            {
                found.end(row.offset);
                break Err(error);
            }
        };
        models.extend(found.models.into_iter().filter(|model| model.end > model.start));
        result
    }
}
