//! Reads the points of VTK's XML files: `PolyData` (`.vtp`) and `UnstructuredGrid` (`.vtu`).
//!
//! The points of all pieces are the centres, and the arrays of point data are columns: one of three components is
//! `name.x`, `name.y` and `name.z`. An array of bytes with three or four components is a colour, whatever its name. Cells,
//! and arrays of cells, are not used, and a note says so.

mod document;

use std::borrow::Cow;
use std::collections::HashSet;
use std::io::Read as _;

use data_encoding::BASE64;
use flate2::bufread::ZlibDecoder;

use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, Place};
use crate::load::format::Options;
use crate::load::numbers::{Number, Scalar};
use crate::load::table::{Table, TableColumn};
use document::{Array, Data, Document, Encoding};
use pinhole::internals::parallel;
use pinhole::internals::text::{one_line, shortened, without_byte_order_mark};

const LEGACY: &[u8] = b"# vtk DataFile";

/// Whether the first bytes are XML with the element `VTKFile`, or a legacy file, which is refused with advice.
pub(super) fn starts(bytes: &[u8]) -> bool {
    const NAME: &[u8] = b"<VTKFile";
    let text = without_byte_order_mark(bytes).trim_ascii_start();
    let first = &text[..text.len().min(1 << 10)];
    text.starts_with(LEGACY) || (first.starts_with(b"<") && first.windows(NAME.len()).any(|window| window == NAME))
}

pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Dataset, LoadError> {
    let bytes = without_byte_order_mark(bytes);
    if bytes.starts_with(LEGACY) {
        return Err(LoadError::new(
            "this is a legacy VTK file, which is not read; save it as .vtp or .vtu, such as with PyVista: \
             pyvista.read('a.vtk').save('a.vtp')",
        ));
    }
    let document = document::read(bytes)?;
    let mut notes: Vec<String> = document.unused.iter().take(8).map(|what| format!("not used: {what}")).collect();
    if document.unused.len() > 8 {
        notes.push(format!("not used: {} more arrays", document.unused.len() - 8));
    }
    let columns = columns(&document, &mut notes)?;
    let mut loaded = Table { columns }.into_loaded(options)?;
    loaded.notes.extend(notes);
    Ok(loaded)
}

fn columns(document: &Document<'_>, notes: &mut Vec<String>) -> Result<Vec<TableColumn>, LoadError> {
    let mut pieces = document.pieces.iter().enumerate().filter(|(_, piece)| piece.points > 0);
    let Some((index, first)) = pieces.next() else {
        return Ok(["x", "y", "z"].map(|name| TableColumn::numbers(name, Vec::new())).into());
    };
    let no_points = |piece, points| {
        move || {
            let message = format!(
                "it declares NumberOfPoints={points}, but has no array in an element Points, which holds their positions"
            );
            LoadError::at(Place::Piece(piece), message)
        }
    };
    let positions = first.positions.as_ref().ok_or_else(no_points(index, first.points))?;
    if positions.components != 3 {
        let message = format!("it must have 3 components, but has {}", positions.components);
        return Err(in_array(index, "Points", &message));
    }
    // A repeated name would be read with the array of the first.
    let mut names = HashSet::new();
    let mut kept: Vec<&Array<'_>> = Vec::new();
    kept.extend(first.arrays.iter().filter(|array| names.insert(array.name.as_str())));
    let mut groups = vec![group(document, index, positions, "Points")?];
    for array in &kept {
        groups.push(group(document, index, array, &array.name)?);
    }
    for (index, piece) in pieces {
        let positions = piece.positions.as_ref().ok_or_else(no_points(index, piece.points))?;
        append(&mut groups[0], group(document, index, positions, "Points")?, index, "Points")?;
        for at in (0..kept.len()).rev() {
            let name = &kept[at].name;
            match piece.arrays.iter().find(|array| array.name == *name) {
                Some(array) => {
                    let more = group(document, index, array, name)?;
                    append(&mut groups[at + 1], more, index, name)?;
                }
                None => {
                    let name = shortened(name);
                    notes.push(format!("not used: the array {name}, which piece {index} lacks"));
                    kept.remove(at);
                    groups.remove(at + 1);
                }
            }
        }
    }
    let has_colors = kept.iter().any(|array| {
        let name = array.name.to_lowercase();
        ["color", "colour", "colors", "rgb", "rgba"].contains(&name.as_str())
    });
    let bytes = |array: &Array<'_>| array.scalar == Scalar::U8 && matches!(array.components, 3 | 4);
    let color = kept.iter().position(|array| bytes(array)).filter(|_| !has_colors);
    let mut columns = Vec::new();
    for (at, group) in groups.into_iter().enumerate() {
        let array = if at == 0 { positions } else { kept[at - 1] };
        let full = array.scalar.full();
        let parts = ["red", "green", "blue", "alpha"];
        for (component, numbers) in group.into_iter().enumerate() {
            let name = if at == 0 {
                ["x", "y", "z"][component.min(2)].to_owned()
            } else if color.is_some_and(|color| color + 1 == at) {
                parts[component.min(3)].to_owned()
            } else {
                component_name(array, component)
            };
            columns.push(TableColumn { full, ..TableColumn::numbers(name, numbers) });
        }
    }
    Ok(columns)
}

fn component_name(Array { name, components, .. }: &Array<'_>, component: usize) -> String {
    let is_color = ["rgb", "rgba"].contains(&name.to_lowercase().as_str());
    match components {
        1 => name.clone(),
        2 | 3 if !is_color => format!("{name}.{}", ["x", "y", "z"][component.min(2)]),
        _ => format!("{name}.{component}"),
    }
}

/// Returns the numbers of an array of one piece, component by component.
fn group(document: &Document<'_>, piece: usize, array: &Array<'_>, name: &str) -> Result<Vec<Vec<f64>>, LoadError> {
    let points = document.pieces.get(piece).map_or(0, |piece| piece.points);
    numbers(array, points, document).map_err(|message| in_array(piece, name, &message))
}

fn in_array(piece: usize, name: &str, message: &str) -> LoadError {
    let name = shortened(name);
    LoadError::at(Place::Piece(piece), format!("the array {name}: {message}"))
}

fn append(all: &mut [Vec<f64>], more: Vec<Vec<f64>>, piece: usize, name: &str) -> Result<(), LoadError> {
    if all.len() != more.len() {
        let (all, more) = (all.len(), more.len());
        let message = format!("it has {more} components, but that of the first piece has {all}");
        return Err(in_array(piece, name, &message));
    }
    all.iter_mut().zip(more).for_each(|(all, more)| all.extend(more));
    Ok(())
}

/// Reads an array of a piece with this number of points: one list of numbers for each component.
fn numbers(array: &Array<'_>, points: u64, document: &Document<'_>) -> Result<Vec<Vec<f64>>, String> {
    let components = array.components;
    let count = usize::try_from(points).ok().and_then(|points| points.checked_mul(components));
    let count = count.ok_or_else(|| format!("{points} points are too many"))?;
    let Encoding { order, .. } = document.encoding;
    let (text, is_base64) = match &array.data {
        Data::Ascii(text) => return of_text(text, array, count),
        Data::Base64(text) => {
            let text = text.trim_ascii();
            let is_whole = !text.bytes().any(|byte| byte.is_ascii_whitespace());
            let whole: Cow<'_, [u8]> = if is_whole {
                text.as_bytes().into()
            } else {
                text.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect()
            };
            (whole, true)
        }
        Data::Appended(offset) => {
            let offset = usize::try_from(*offset).ok();
            let rest = offset.and_then(|offset| document.appended.get(offset..));
            let rest = rest.ok_or("its offset is behind the end of the appended data")?;
            (rest.into(), document.appended_is_base64)
        }
    };
    let mut stream = Stream { rest: &text, is_base64, decoded: Vec::new() };
    let size = array.scalar.size();
    let wanted = count.checked_mul(size).ok_or_else(|| format!("{points} points are too many"))?;
    let bytes = stream.array(wanted, document.encoding)?.into_owned();
    if let Data::Appended(_) = array.data {
        let taken = document.taken.get() + (text.len() - stream.rest.len());
        if taken > document.appended.len() {
            return Err("its data overlap with those of another array".to_owned());
        }
        document.taken.set(taken);
    }
    let column = |component: usize| {
        let number = |row: usize| array.scalar.decode(&bytes[(row * components + component) * size..], order);
        parallel::try_map(count / components, number)
            .map_err(|_| format!("there is not enough memory for {points} points"))
    };
    (0..components).map(column).collect()
}

fn of_text(text: &str, array: &Array<'_>, count: usize) -> Result<Vec<Vec<f64>>, String> {
    let components = array.components;
    // Each number takes at least two bytes, so a count that is too large is noticed before lists are allocated.
    if count > text.len() {
        return Err(format!(
            "it must have {count} numbers, but its text of {} bytes is too short for them",
            text.len()
        ));
    }
    let mut columns = vec![Vec::with_capacity(count / components); components];
    let mut words = text.split_ascii_whitespace();
    for index in 0..count {
        let word = words.next();
        let word = word.ok_or_else(|| format!("it must have {count} numbers, but has {index}"))?;
        let number = array.scalar.parse(word).ok_or_else(|| {
            format!("number {index}, counted from 0, is `{}`, which is not a number", shortened(word))
        })?;
        columns[index % components].push(number);
    }
    match words.next() {
        Some(_) => Err(format!("it must have {count} numbers, but has more")),
        None => Ok(columns),
    }
}

/// Bytes that may be encoded in base64.
struct Stream<'a> {
    rest: &'a [u8],
    is_base64: bool,
    /// Decoded bytes that were not taken yet.
    decoded: Vec<u8>,
}

impl Stream<'_> {
    /// Takes bytes from the start.
    fn take(&mut self, count: usize) -> Result<Cow<'_, [u8]>, String> {
        let cut_off = || format!("its data are cut off where {count} more bytes must follow");
        if !self.is_base64 {
            let (taken, rest) = self.rest.split_at_checked(count).ok_or_else(cut_off)?;
            self.rest = rest;
            return Ok(taken.into());
        }
        let mut taken = std::mem::take(&mut self.decoded);
        while taken.len() < count {
            let digits = (count - taken.len()).div_ceil(3).saturating_mul(4);
            let digits = digits.min(self.rest.len() / 4 * 4);
            if digits == 0 {
                return Err(cut_off());
            }
            let (now, rest) = self.rest.split_at(digits);
            // The lengths before the data may have padding of their own, which is not an error for this decoder.
            let bytes = BASE64
                .decode(now)
                .map_err(|error| format!("its data are not base64: {}", one_line(&error.to_string())))?;
            taken.extend_from_slice(&bytes);
            self.rest = rest;
        }
        self.decoded = taken.split_off(count);
        Ok(taken.into())
    }

    /// Takes numbers of the type that lengths have.
    fn lengths<const N: usize>(&mut self, encoding: Encoding) -> Result<[usize; N], String> {
        let scalar = if encoding.is_wide { Scalar::U64 } else { Scalar::U32 };
        let bytes = self.take(N * scalar.size())?;
        let mut lengths = [0; N];
        for (length, bytes) in lengths.iter_mut().zip(bytes.chunks_exact(scalar.size())) {
            let length_of = match encoding.is_wide {
                true => u64::decode(bytes, encoding.order),
                false => u32::decode(bytes, encoding.order).into(),
            };
            *length = usize::try_from(length_of).unwrap_or(usize::MAX);
        }
        Ok(lengths)
    }

    /// Takes the bytes of an array, with the lengths before them.
    fn array(&mut self, wanted: usize, encoding: Encoding) -> Result<Cow<'_, [u8]>, String> {
        let other = |found: usize| format!("its data have {found} bytes, but its points and its type take {wanted}");
        if !encoding.is_compressed {
            let [found] = self.lengths(encoding)?;
            return if found == wanted { self.take(wanted) } else { Err(other(found)) };
        }
        let [blocks, size, last] = self.lengths(encoding)?;
        if blocks == 0 {
            return if wanted == 0 { Ok(Cow::Borrowed(&[])) } else { Err(other(0)) };
        }
        // The last block is shorter if it has a length of its own.
        let full = if last == 0 { blocks } else { blocks - 1 };
        let found = full.saturating_mul(size).saturating_add(last);
        if found != wanted {
            return Err(other(found));
        }
        // Each length takes at least one byte of the file.
        if blocks > self.rest.len() {
            return Err(format!(
                "it declares {blocks} compressed blocks, but its data are cut off after {} bytes",
                self.rest.len()
            ));
        }
        let mut lengths = Vec::with_capacity(blocks);
        for _ in 0..blocks {
            let [length] = self.lengths(encoding)?;
            lengths.push(length);
        }
        // Lengths and blocks are encoded in base64 separately, and padding leaves no bytes of the first part.
        let mut all = Vec::new();
        for (block, length) in lengths.into_iter().enumerate() {
            let compressed = self.take(length)?;
            let size = if block < full { size } else { last };
            let before = all.len();
            let mut decoder = ZlibDecoder::new(&*compressed).take(size as u64);
            let read = decoder.read_to_end(&mut all);
            read.map_err(|error| format!("its compressed block {block}: {error}"))?;
            if all.len() - before != size {
                let found = all.len() - before;
                return Err(format!("its compressed block {block} has {found} bytes, not {size}"));
            }
        }
        Ok(all.into())
    }
}
