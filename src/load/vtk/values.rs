//! The numbers of an array of a VTK file: as text, as bytes in base64, or as bytes; the bytes may be compressed with zlib.

use std::borrow::Cow;
use std::io::Read as _;

use data_encoding::BASE64;
use flate2::bufread::ZlibDecoder;

use super::document::{Array, Data, Document, Encoding};
use crate::load::binary::Number;
use crate::load::scalar::Scalar;
use crate::parallel;
use crate::text::{one_line, shortened};

/// Reads an array of a piece with this number of points: one list of numbers for each component.
pub(super) fn numbers(
    array: &Array<'_>,
    points: u64,
    document: &Document<'_>,
) -> Result<Vec<Vec<f64>>, String> {
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
        let number = |row: usize| {
            array.scalar.decode(&bytes[(row * components + component) * size..], order)
        };
        parallel::try_map(count / components, number)
            .map_err(|_| format!("there is not enough memory for {points} points"))
    };
    (0..components).map(column).collect()
}

fn of_text(text: &str, array: &Array<'_>, count: usize) -> Result<Vec<Vec<f64>>, String> {
    let components = array.components;
    // Each number takes two bytes, so a count that is too large shows before there are lists.
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
            format!(
                "number {index}, counted from 0, is `{}`, which is not a number",
                shortened(&one_line(word))
            )
        })?;
        columns[index % components].push(number);
    }
    match words.next() {
        Some(_) => Err(format!("it must have {count} numbers, but has more")),
        None => Ok(columns),
    }
}

/// Bytes that may be written in base64.
struct Stream<'a> {
    rest: &'a [u8],
    is_base64: bool,
    /// Bytes that are decoded, but not taken yet.
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
            // The lengths may have padding of their own before the data, which is no error of this decoder.
            let bytes = BASE64.decode(now).map_err(|error| {
                format!("its data are not base64: {}", one_line(&error.to_string()))
            })?;
            taken.extend_from_slice(&bytes);
            self.rest = rest;
        }
        self.decoded = taken.split_off(count);
        Ok(taken.into())
    }

    /// Takes numbers of the type of lengths.
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
        let other = |found: usize| {
            format!("its data have {found} bytes, but its points and its type take {wanted}")
        };
        if !encoding.is_compressed {
            let [found] = self.lengths(encoding)?;
            return if found == wanted { self.take(wanted) } else { Err(other(found)) };
        }
        let [blocks, size, last] = self.lengths(encoding)?;
        if blocks == 0 {
            return if wanted == 0 { Ok(Cow::Borrowed(&[])) } else { Err(other(0)) };
        }
        // The last block is shorter, if it has a length of its own.
        let full = if last == 0 { blocks } else { blocks - 1 };
        let found = full.saturating_mul(size).saturating_add(last);
        if found != wanted {
            return Err(other(found));
        }
        // Each length takes bytes of the file.
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
        // Lengths and blocks are two pieces of base64, and what padding left of the first is nothing.
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
