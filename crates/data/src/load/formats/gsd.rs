//! Reads files of HOOMD-blue (GSD with the schema `hoomd`).
//!
//! A frame has positions and any data that changed since the first frame. Other data are those of the first frame, or
//! else the schema's default. Lengths are taken as they are. <https://gsd.readthedocs.io/en/stable/schema-hoomd.html>

mod index;

pub(super) use index::starts;

use std::collections::BTreeSet;

use crate::load::bonds::ordered;
use crate::load::dataset::{Column, ColumnValues, Dataset, Labels};
use crate::load::elements::appearance;
use crate::load::error::LoadError;
use crate::load::format::{FrameIndex, FrameReader, FrameSpan, Frames, Options};
use crate::load::numbers::{Order, Reader, component_names, shown, wrong_position, wrong_start};
use crate::load::source::Bytes;
use crate::load::table::{Table, TableColumn};
use index::{Chunk, Index};

pub(super) const FRAMES: Frames = Frames::Bytes { find };

/// Vectors with more components than this do not become columns.
const MOST_COMPONENTS: u32 = 64;

/// Quantities of particles that become columns: name of the chunk, name of the column, number of components.
const QUANTITIES: [(&str, &str, u32); 6] = [
    ("particles/velocity", "velocity", 3),
    ("particles/mass", "mass", 1),
    ("particles/charge", "charge", 1),
    ("particles/body", "body", 1),
    ("particles/image", "image", 3),
    ("particles/diameter", "diameter", 1),
];

/// Chunks that describe the others, or are read by themselves.
const OTHERS: [&str; 8] = [
    "particles/N",
    "particles/position",
    "particles/types",
    "particles/typeid",
    "bonds/N",
    "bonds/types",
    "bonds/typeid",
    BONDS,
];

/// The chunk with the particles of bonds.
const BONDS: &str = "bonds/group";

const LOGGED: &str = "log/particles/";

fn find(source: &mut dyn Bytes, _: Option<usize>, _: &Options) -> Result<FrameIndex, LoadError> {
    let mut reader = Reader::new(source, Order::Little)?;
    let mut index = Index::read(&mut reader)?;
    let bytes = |frame| {
        let chunks = index.chunks(frame).filter_map(|(_, chunk)| chunk.bytes());
        chunks.fold(0, u64::saturating_add)
    };
    let span = |frame| FrameSpan { bytes: 0..bytes(frame), lines_before: 0 };
    let frames: Vec<_> = (0..index.frames()).map(span).collect();
    let problem = index.problem.take();
    if frames.is_empty() && problem.is_none() {
        return Err(wrong_start("gsd", "the file has no frames"));
    }
    let is_whole = problem.is_none();
    Ok(FrameIndex {
        frames,
        is_whole,
        stands_alone: true,
        problem,
        reader: Some(Box::new(Gsd { index })),
        ..FrameIndex::default()
    })
}

#[derive(Debug)]
struct Gsd {
    index: Index,
}

impl FrameReader for Gsd {
    fn read(
        &self,
        source: &mut dyn Bytes,
        frame: usize,
        _: &FrameSpan,
        options: &Options,
    ) -> Result<Dataset, LoadError> {
        let mut reader = Reader::new(source, Order::Little)?;
        let index = &self.index;
        let particles = |frame: u64, reader: &mut Reader<'_>| match index.chunk(frame, "particles/N") {
            Some(chunk) => Ok(chunk.numbers(reader, "particles/N")?.first().copied()),
            None => Ok::<_, LoadError>(None),
        };
        let frame = frame as u64;
        let in_first = particles(0, &mut reader)?.unwrap_or_default() as u64;
        let count = particles(frame, &mut reader)?.map_or(in_first, |count| count as u64);
        let left = reader.size;
        Frame { index, reader, frame, count, is_like_first: count == in_first, left }.read(options)
    }
}

/// A frame that is being read.
struct Frame<'a> {
    index: &'a Index,
    reader: Reader<'a>,
    frame: u64,
    /// Number of particles.
    count: u64,
    /// Whether there are as many particles as in the first frame.
    is_like_first: bool,
    /// Maximum number of bytes that may still be read. Overlapping chunks could take much more memory than the file.
    left: u64,
}

impl Frame<'_> {
    fn read(mut self, options: &Options) -> Result<Dataset, LoadError> {
        let mut columns = self.positions()?;
        let mut notes = Vec::new();
        let species = self.species()?;
        for (name, column, components) in QUANTITIES {
            if let Some(chunk) = self.particle_chunk(name)? {
                self.expect(chunk, name, components)?;
                columns.extend(self.columns(chunk, name, column)?);
            }
        }
        // Types are often called A, B and C, and B and C happen to be chemical elements.
        let are_elements = !species.names.is_empty()
            && species
                .names
                .iter()
                .all(|name| name.starts_with(|c: char| c.is_ascii_alphabetic()) && appearance(name).is_element);
        let has_diameters = columns.iter().any(|column| column.name == "diameter");
        let has_default = self.index.has_name("particles/diameter") || !are_elements;
        if !has_diameters && options.radius.is_none() && !has_default {
            notes.push(
                "there are no diameters; the types are chemical elements, and have their radii in ångström; --radius \
                 sets one for all"
                    .to_owned(),
            );
        } else if !has_diameters && options.radius.is_none() {
            // The schema has this default.
            columns.push(TableColumn::numbers("diameter", vec![1.0; self.count as usize]));
        }
        let mut others = Vec::new();
        if are_elements {
            columns.push(TableColumn::labels("species", species));
        } else {
            others.push(Column { name: "species".to_owned(), values: ColumnValues::Labels(species) });
        }
        let unused = self.logged(&mut columns)?;
        if !unused.is_empty() {
            let unused: Vec<_> = unused.into_iter().collect();
            notes.push(format!("these parts of the file are not used: {}", unused.join(", ")));
        }
        let mut loaded = Table { columns }.into_loaded(options)?;
        others.append(&mut loaded.columns);
        loaded.columns = others;
        loaded.notes.extend(notes);
        loaded.bonds = self.bonds()?;
        loaded.has_all_bonds = !loaded.bonds.is_empty();
        loaded.cell = self.cell()?;
        // The box of HOOMD-blue is centred at the origin.
        if let Some([a, b, c]) = loaded.cell {
            loaded.cell_origin = std::array::from_fn(|axis| -0.5 * (a[axis] + b[axis] + c[axis]));
        }
        Ok(loaded)
    }

    /// Returns the chunk of this frame with this name, or else that of the first frame.
    fn chunk(&self, name: &str) -> Option<Chunk> {
        self.index.chunk(self.frame, name).or_else(|| self.index.chunk(0, name))
    }

    /// Returns the same for data of particles, which apply only to frames with as many particles as the first.
    fn particle_chunk(&self, name: &str) -> Result<Option<Chunk>, LoadError> {
        let own = self.index.chunk(self.frame, name);
        let inherited = || self.index.chunk(0, name).filter(|_| self.is_like_first);
        Ok(own.or_else(inherited))
    }

    fn expect(&self, chunk: Chunk, name: &str, components: u32) -> Result<(), LoadError> {
        if chunk.rows == self.count && chunk.columns == components {
            return Ok(());
        }
        let message = format!(
            "frame {}: the chunk {name} has {} × {} numbers, but must have {} × {components}",
            self.frame, chunk.rows, chunk.columns, self.count
        );
        Err(LoadError::byte(chunk.location, message))
    }

    fn numbers(&mut self, chunk: Chunk, name: &str) -> Result<Vec<f64>, LoadError> {
        let bytes = chunk.bytes().unwrap_or(u64::MAX);
        self.left = self.left.checked_sub(bytes).ok_or_else(|| {
            let message = format!("frame {}: its chunks take more bytes than the file has", self.frame);
            LoadError::byte(chunk.location, message)
        })?;
        chunk.numbers(&mut self.reader, name)
    }

    fn columns(&mut self, chunk: Chunk, name: &str, column: &str) -> Result<Vec<TableColumn>, LoadError> {
        let numbers = self.numbers(chunk, name)?;
        let names = component_names(column, chunk.columns as usize);
        let step = names.len().max(1);
        let values = |first: usize| numbers.iter().skip(first).step_by(step).copied().collect();
        let named = names.into_iter().enumerate();
        Ok(named.map(|(first, name)| TableColumn::numbers(name, values(first))).collect())
    }

    fn positions(&mut self) -> Result<Vec<TableColumn>, LoadError> {
        const NAME: &str = "particles/position";
        let Some(chunk) = self.particle_chunk(NAME)? else {
            if self.count == 0 {
                return Ok(["x", "y", "z"].map(|axis| TableColumn::numbers(axis, vec![])).into());
            }
            let message = format!("frame {} declares {} particles, but has no {NAME}", self.frame, self.count);
            return Err(LoadError::byte(0, message));
        };
        self.expect(chunk, NAME, 3)?;
        let columns = self.columns(chunk, NAME, "position")?;
        let width = chunk.bytes().unwrap_or_default() / (self.count * 3).max(1);
        for (axis, column) in columns.iter().enumerate() {
            let ColumnValues::Numbers(numbers) = &column.values else { continue };
            if let Some(atom) = numbers.iter().position(|number| !number.is_finite()) {
                let byte = chunk.location + (3 * atom + axis) as u64 * width;
                let (axis, found) = (['x', 'y', 'z'][axis], numbers[atom]);
                return Err(wrong_position(byte, self.frame as usize, atom, axis, found));
            }
        }
        Ok(columns)
    }

    /// The type of each particle.
    fn species(&mut self) -> Result<Labels, LoadError> {
        let mut names = match self.chunk("particles/types") {
            Some(chunk) => chunk.texts(&mut self.reader, "particles/types")?,
            None => Vec::new(),
        };
        if names.is_empty() {
            names.push("A".to_owned());
        }
        let Some(chunk) = self.particle_chunk("particles/typeid")? else {
            return Ok(Labels { names, indices: vec![0; self.count as usize] });
        };
        self.expect(chunk, "particles/typeid", 1)?;
        let ids = self.numbers(chunk, "particles/typeid")?;
        let is_known = |id: &f64| (0.0..names.len() as f64).contains(id);
        if let Some(particle) = ids.iter().position(|id| !is_known(id)) {
            let message = format!(
                "frame {}: particle {particle} has the type {}, but there are {} types",
                self.frame,
                ids[particle],
                names.len()
            );
            return Err(LoadError::byte(chunk.location, message));
        }
        Ok(Labels { names, indices: ids.into_iter().map(|id| id as u32).collect() })
    }

    /// Adds columns for quantities that were logged for each particle, and returns the names of unused chunks.
    fn logged(&mut self, columns: &mut Vec<TableColumn>) -> Result<BTreeSet<String>, LoadError> {
        let index = self.index;
        let mut seen = BTreeSet::new();
        let mut unused = BTreeSet::new();
        let is_like_first = self.is_like_first;
        let first = index.chunks(0).map(|chunk| (chunk, is_like_first));
        for ((name, chunk), is_for_all) in index.chunks(self.frame).map(|chunk| (chunk, true)).chain(first) {
            let is_known = name.starts_with("configuration/")
                || OTHERS.contains(&name)
                || QUANTITIES.iter().any(|(chunk, ..)| *chunk == name);
            if is_known || chunk.rows == 0 || !seen.insert(name) {
                continue;
            }
            let quantity = name
                .strip_prefix(LOGGED)
                .filter(|_| chunk.rows == self.count && (1..=MOST_COMPONENTS).contains(&chunk.columns) && is_for_all);
            let Some(quantity) = quantity else {
                // Nothing about angles is used, so a note names only the kind.
                let is_bonded = !name.starts_with("particles/") && !name.starts_with("log/");
                let part = name.split('/').next().filter(|_| is_bonded).unwrap_or(name);
                unused.insert(shown(part.as_bytes()));
                continue;
            };
            let short = quantity.rsplit('/').next().unwrap_or(quantity);
            let of_name = |column: &TableColumn| {
                column.name.strip_prefix(short).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
            };
            let is_taken = columns.iter().any(of_name);
            let column = shown(if is_taken { quantity } else { short }.as_bytes());
            columns.extend(self.columns(chunk, name, &column)?);
        }
        Ok(unused)
    }

    /// The bonds between particles.
    fn bonds(&mut self) -> Result<Vec<[u32; 2]>, LoadError> {
        if let Some(chunk) = self.index.chunk(self.frame, "bonds/N")
            && self.numbers(chunk, "bonds/N")?.iter().all(|count| *count <= 0.0)
        {
            return Ok(Vec::new());
        }
        let Some(chunk) = self.particle_chunk(BONDS)? else { return Ok(Vec::new()) };
        let frame = self.frame;
        let wrong = |what: String| {
            let message = format!("frame {frame}: the chunk {BONDS} {what}");
            Err(LoadError::byte(chunk.location, message))
        };
        if chunk.columns != 2 {
            return wrong(format!("has {} numbers for each bond, but must have those of two particles", chunk.columns));
        }
        let ends = self.numbers(chunk, BONDS)?;
        if let Some(place) = ends.iter().position(|end| !(0.0..self.count as f64).contains(end)) {
            let count = self.count;
            return wrong(format!(
                "has the particle {} in bond {}, but there are {count} particles",
                ends[place],
                place / 2
            ));
        }
        Ok(ordered(ends.chunks_exact(2).map(|ends| [ends[0] as u32, ends[1] as u32])))
    }

    /// The edges of the periodic box, if it has a volume.
    fn cell(&mut self) -> Result<Option<[[f64; 3]; 3]>, LoadError> {
        const NAME: &str = "configuration/box";
        let Some(chunk) = self.chunk(NAME) else { return Ok(None) };
        let numbers = self.numbers(chunk, NAME)?;
        match *numbers {
            [lx, ly, lz, xy, xz, yz] if numbers.iter().all(|number| number.is_finite()) => {
                let has_volume = lx > 0.0 && ly > 0.0 && lz > 0.0;
                let edges = [[lx, 0.0, 0.0], [xy * ly, ly, 0.0], [xz * lz, yz * lz, lz]];
                Ok(has_volume.then_some(edges))
            }
            _ => {
                let message = format!("frame {}: the box is not six finite numbers", self.frame);
                Err(LoadError::byte(chunk.location, message))
            }
        }
    }
}
