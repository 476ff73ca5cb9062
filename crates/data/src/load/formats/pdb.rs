//! Reads PDB files, as version 3.3 of the format of the wwPDB describes them.
//!
//! A PDB file is text in fixed columns. The records ATOM and HETATM become spheres with the van der Waals
//! radii and the colours of their elements; CRYST1 becomes the periodic cell; MODEL and ENDMDL enclose a
//! frame; CONECT lists bonds, which belong to every frame if they follow the last; every other record is skipped. Lengths are taken as they are, in Å.
//!
//! The columns are `species`, `name`, `residue`, `chain`, `residue_number`, `b_factor`, `occupancy` and
//! `record`. One location of an atom with alternate locations is kept.
//!
//! PDBQT files of AutoDock have the columns `charge` and `type` as well.
//!
//! Many programs deviate from the format, so this reader also accepts residue names of four characters,
//! residue numbers in hybrid-36, and lines that end after the coordinates.

mod links;
mod record;

use std::io;

use crate::load::Dataset;
use crate::load::atoms::{Atom, Atoms};
use crate::load::error::{LoadError, Place};
use crate::load::format::{FrameIndex, FrameSpan, FrameText, Frames, Options, read_from_memory};
use crate::load::source::LineReader;
use links::Links;
use pinhole::internals::text::without_byte_order_mark;
use record::{Kind, Lines, Record, cell_of, hybrid36};

/// Reads one frame of a PDB file. A frame is a model, counted from 0 in the order of the file.
///
/// A file without MODEL records has one frame. The file is read to its end, so that
/// [`Dataset::frames`] is known, but atoms of other models are not checked.
///
/// # Errors
/// Returns an error if the text is not a valid PDB file, or has no such frame.
pub fn read(bytes: &[u8], frame: usize) -> Result<Dataset, LoadError> {
    read_from_memory(bytes, FRAMES, &Options::default().with_frame(frame), None)
}

pub(super) const FRAMES: Frames = Frames::Lines { find, read: |frame, _| read_frame(frame, false) };

/// Files of AutoDock, PDBQT, which have a partial charge and a type in the place of the element.
pub(super) const DOCKING: Frames = Frames::Lines { find, read: |frame, _| read_frame(frame, true) };

/// Finds frames by their MODEL records, and checks the order of all records. The lines before the first are read with
/// every frame.
fn find(lines: &mut LineReader<'_>, _: Option<usize>) -> io::Result<FrameIndex> {
    let mut found = FrameIndex { is_whole: true, ..FrameIndex::default() };
    // No frame is read.
    let mut reader = Reader { frame: usize::MAX, ..Reader::default() };
    loop {
        let (offset, lines_before) = (lines.offset, lines.line);
        let Some(text) = lines.next()? else { break };
        let text = if lines_before == 0 { without_byte_order_mark(text) } else { text };
        let models = reader.models;
        if let Err(problem) = reader.take(lines_before + 1, text) {
            found.problem = Some(problem);
            found.frames.pop();
            found.tail = FrameSpan::default();
            return Ok(found);
        }
        if Kind::of(text) == Kind::Bonds && reader.open.is_none() && found.tail.bytes.end == 0 {
            found.tail = FrameSpan { bytes: offset..u64::MAX, lines_before };
        }
        if reader.models > models {
            found.tail = FrameSpan::default();
            match found.frames.last_mut() {
                Some(before) => before.bytes.end = offset,
                None => found.head = 0..offset,
            }
            found.frames.push(FrameSpan { bytes: offset..offset, lines_before });
        }
    }
    match found.frames.last_mut() {
        Some(last) if found.tail.bytes.end > 0 => {
            last.bytes.end = found.tail.bytes.start;
            found.tail.bytes.end = lines.offset;
        }
        Some(last) => last.bytes.end = lines.offset,
        // A file without models is one frame.
        None => {
            found.frames.push(FrameSpan { bytes: 0..lines.offset, lines_before: 0 });
            found.tail = FrameSpan::default();
        }
    }
    if reader.first_atom.is_none() {
        found.frames.clear();
        found.problem = Some(no_atoms());
    }
    Ok(found)
}

fn read_frame(frame: &FrameText<'_>, is_docking: bool) -> Result<Dataset, LoadError> {
    let head = without_byte_order_mark(frame.head);
    let text = without_byte_order_mark(frame.text);
    // Lines of atoms are rarely shorter than this: they end after the B-factor, which is in columns 61 to 66.
    let atoms = Atoms::with_capacity(text.len() / 67);
    let mut reader = Reader { atoms, is_docking, ..Reader::default() };
    let text = Lines::new(text).map(|(line, text)| (frame.lines_before + line, text));
    for (line, text) in Lines::new(head).chain(text) {
        reader.take(line, text)?;
    }
    for (line, text) in Lines::new(frame.tail) {
        reader.take(frame.lines_before_tail + line, text)?;
    }
    reader.finish(frame.index)
}

/// Whether the first line is one with which PDB files start.
pub(super) fn starts(bytes: &[u8]) -> bool {
    const FIRST: [&[u8]; 10] =
        [b"HEADER", b"TITLE ", b"REMARK", b"COMPND", b"CRYST1", b"MODEL ", b"ATOM  ", b"HETATM", b"OBSLTE", b"CAVEAT"];
    FIRST.iter().any(|name| bytes.starts_with(name))
}

/// The state of reading after some lines. Lines are counted from 1.
#[derive(Default)]
struct Reader {
    /// The frame to read.
    frame: usize,
    /// Whether a line was read that is neither blank nor a comment.
    begun: bool,
    /// Number of MODEL records so far.
    models: usize,
    /// Line of the first MODEL record.
    first_model: usize,
    /// Line of the MODEL record of the model that has not ended.
    open: Option<usize>,
    /// Line of the MODEL record of the frame to read.
    wanted: usize,
    /// Line of the first atom.
    first_atom: Option<usize>,
    /// Whether a file without models has reached an END or ENDMDL record after its atoms.
    ended: bool,
    /// Line of the first atom after this record.
    after_end: Option<usize>,
    cell: Option<[[f64; 3]; 3]>,
    /// True if the space group of the cell is another than P 1.
    has_symmetry: bool,
    atoms: Atoms,
    links: Links,
    /// True if the file is one of AutoDock.
    is_docking: bool,
}

impl Reader {
    fn take(&mut self, line: usize, text: &[u8]) -> Result<(), LoadError> {
        if !self.begun {
            self.begin(text)?;
        }
        match Kind::of(text) {
            Kind::Atom => self.atom(line, text, "ATOM"),
            Kind::Hetatm => self.atom(line, text, "HETATM"),
            Kind::Cryst1 if self.before_end_of_frame() => {
                let record = Record::new(line, text, "CRYST1")?;
                self.cell = cell_of(&record)?;
                self.has_symmetry = record.text(56, 66) != b"P 1";
                Ok(())
            }
            Kind::Model => self.model(line),
            Kind::Endmdl | Kind::End => {
                if self.models == 0 {
                    self.ended = self.first_atom.is_some();
                } else if Kind::of(text) == Kind::Endmdl {
                    self.open = None;
                }
                Ok(())
            }
            // While frames are found, no frame is read.
            Kind::Bonds if self.frame != usize::MAX => {
                self.links.take(line, text);
                Ok(())
            }
            Kind::AtomSite if self.first_atom.is_none() => Err(mmcif()),
            _ => Ok(()),
        }
    }

    /// Refuses mmCIF, which is recognised by the first line that is neither blank nor a comment of that format.
    fn begin(&mut self, text: &[u8]) -> Result<(), LoadError> {
        let text = text.trim_ascii_start();
        self.begun = !(text.is_empty() || text.starts_with(b"#"));
        match text.first_chunk::<5>() {
            Some(start) if start.eq_ignore_ascii_case(b"data_") => Err(mmcif()),
            _ => Ok(()),
        }
    }

    /// Whether the frame to read has not ended. Programs that write trajectories put a CRYST1 record before or into
    /// each model.
    fn before_end_of_frame(&self) -> bool {
        match self.models {
            0 => !self.ended,
            models => models <= self.frame || (models == self.frame + 1 && self.open.is_some()),
        }
    }

    fn atom(&mut self, line: usize, text: &[u8], record: &'static str) -> Result<(), LoadError> {
        self.first_atom.get_or_insert(line);
        if self.models > 0 && self.open.is_none() {
            return Err(outside_model(line, self.first_model));
        }
        if self.ended {
            self.after_end.get_or_insert(line);
            return Ok(());
        }
        if self.models.saturating_sub(1) != self.frame {
            return Ok(());
        }
        push(&mut self.atoms, &Record::new(line, text, record)?, self.is_docking)
    }

    fn model(&mut self, line: usize) -> Result<(), LoadError> {
        if let Some(outer_line) = self.open {
            let message = format!(
                "mixed models: this MODEL record is inside the model that begins on line {outer_line}; ENDMDL must end a \
                 model before another begins"
            );
            return Err(LoadError::line(line, message));
        }
        if self.models == 0 {
            self.first_model = line;
            if let Some(atom_line) = self.first_atom {
                return Err(outside_model(atom_line, line));
            }
        }
        if self.models == self.frame {
            self.wanted = line;
        }
        self.open = Some(line);
        self.models += 1;
        Ok(())
    }

    /// Returns the atoms of the frame, which has this index in the file.
    fn finish(self, index: usize) -> Result<Dataset, LoadError> {
        if self.atoms.is_empty() {
            let message = format!(
                "frame {index} is the model that begins here, which has no ATOM or HETATM records; choose another frame"
            );
            return Err(LoadError::line(self.wanted, message));
        }
        let Self { mut atoms, links, .. } = self;
        let notes = links.add_to(&mut atoms);
        let mut loaded = atoms.into_loaded();
        loaded.notes.extend(notes);
        loaded.cell = self.cell;
        loaded.is_part_of_crystal = self.has_symmetry;
        if let Some(line) = self.after_end {
            loaded.notes.push(format!(
                "the atoms from line {line} on are left out, because they follow the end of the structure; if they \
                 are further frames, enclose each frame with MODEL and ENDMDL"
            ));
        }
        Ok(loaded)
    }
}

/// The symbol of the element of a type of AutoDock, in which the second letter may be that of acceptors and donors of
/// bonds of hydrogen; blank for others, such as the ends of open rings.
fn element_of_docking(kind: &[u8]) -> [u8; 2] {
    match *kind {
        [b'A' | b'C'] | [b'C', b'G', ..] => *b" C",
        [b'O' | b'W'] | [b'O', b'A'] => *b" O",
        [b'N', b'A' | b'S'] => *b" N",
        [b'S', b'A'] => *b" S",
        [b'H', b'D' | b'S'] => *b" H",
        [a] => [b' ', a],
        [a, b] if !(a == b'G' && b.is_ascii_digit()) => [a, b],
        _ => *b"  ",
    }
}

fn no_atoms() -> LoadError {
    LoadError::new("there are no ATOM or HETATM records; a PDB file has one for each atom")
}

/// The error of a file in mmCIF, the successor of PDB.
fn mmcif() -> LoadError {
    LoadError::new("this is an mmCIF file, not a PDB file; call it .cif, or read it as the format mmcif")
}

fn outside_model(line: usize, model_line: usize) -> LoadError {
    let message = format!(
        "mixed models: this atom does not belong to a model, although the file has MODEL records (the first on line \
         {model_line}); every atom must then stand between MODEL and ENDMDL"
    );
    LoadError::line(line, message)
}

/// Fields that an atom must have, each with its first and last column.
const NEEDED: [(&str, usize, usize); 6] = [
    ("atom name", 13, 16),
    ("residue name", 18, 20),
    ("residue number", 23, 26),
    ("x coordinate", 31, 38),
    ("y coordinate", 39, 46),
    ("z coordinate", 47, 54),
];

/// The number of a residue, in hybrid-36 or, as VMD writes it after 9999, in hexadecimal digits. `before` is the number of the
/// atom before.
fn residue_number(text: &[u8], before: Option<f64>) -> Option<i32> {
    let is_hexadecimal = text.len() == 4
        && text[0].is_ascii_digit()
        && text.iter().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f'));
    let hexadecimal = || i32::from_str_radix(std::str::from_utf8(text).ok()?, 16).ok().filter(|_| is_hexadecimal);
    // Digits alone may be either.
    let follows = |number: &i32| {
        before.is_some_and(|before| before >= 9999.0 && (0.0..=1.0).contains(&(f64::from(*number) - before)))
    };
    hexadecimal().filter(follows).or_else(|| hybrid36(text)).or_else(hexadecimal)
}

/// Appends the atom of an ATOM or HETATM record.
fn push(atoms: &mut Atoms, record: &Record<'_>, is_docking: bool) -> Result<(), LoadError> {
    record.must_have(&NEEDED)?;
    let text = record.text(23, 26);
    let number = residue_number(text, atoms.last_residue_number()).ok_or_else(|| {
        let found = record::not_valid(text, "a valid residue number");
        let place = Place::Columns { line: record.line, first: 23, last: 26 };
        let message = format!(
            "the residue number is {found}; a number such as 142, or a hybrid-36 number such as A000, belongs there"
        );
        LoadError::at(place, message)
    })?;
    let place = [
        record.number("x coordinate", 31, 38)?,
        record.number("y coordinate", 39, 46)?,
        record.number("z coordinate", 47, 54)?,
    ];
    let ([letter], [insertion]) = (record.bytes(17), record.bytes(27));
    // A number of six digits begins within the name of the record, after ATOM.
    let first_of_serial = if record.bytes::<1>(6)[0].is_ascii_digit() { 6 } else { 7 };
    let kind = record.text(77, 80);
    let docking = match is_docking {
        true => Some((record.number_or(0.0, "partial charge", 67, 76)?, kind)),
        false => None,
    };
    let symbol = if is_docking { element_of_docking(kind) } else { record.bytes(77) };
    atoms.push(&Atom {
        place,
        occupancy: record.number_or(1.0, "occupancy", 55, 60)?,
        b_factor: record.number_or(0.0, "B-factor", 61, 66)?,
        residue_number: f64::from(number),
        name: record.bytes::<4>(13).trim_ascii(),
        name_field: record.bytes(13),
        symbol,
        // The format has residue names of three characters and a blank column 21. Other programs use all four columns.
        residue: record.bytes::<4>(18).trim_ascii(),
        chain: record.bytes::<1>(22).trim_ascii(),
        record: record.name.as_bytes(),
        entity: None,
        docking,
        letter,
        insertion,
        serial: hybrid36(record.text(first_of_serial, 11)).map_or(f64::NAN, f64::from),
    });
    Ok(())
}
