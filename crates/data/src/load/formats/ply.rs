//! Reads the vertices of PLY files: text, and binary data in either byte order.
//!
//! The properties of the element `vertex` are columns: `x`, `y` and `z` are the centres; a radius, colours and
//! opacities are used as in every table. Other elements, such as faces, are not used, and a note says so. Elements
//! after the vertices are not even looked at, and vertices are stored only as numbers in the columns. A reader that
//! hands out elements one by one, such as the crate ply-rs-bw, would take more memory and time.

use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, LoadErrorKind, Place};
use crate::load::format::Options;
use crate::load::numbers::{Order, Scalar};
use crate::load::table::{Table, TableColumn};
use pinhole::internals::parallel;
use pinhole::internals::text::{one_line, shortened};

pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Dataset, LoadError> {
    let header = read_header(bytes)?;
    let data = &bytes[header.bytes..];
    let vertex = header.elements.iter().position(|element| element.name == "vertex");
    let Some(vertex) = vertex else {
        let found: Vec<_> = header.elements.iter().take(8).map(|e| e.name.as_str()).collect();
        let found = if found.is_empty() { "none".to_owned() } else { found.join(", ") };
        return Err(LoadError::new(format!(
            "the header declares no `element vertex`, which has the positions; its elements are {found}"
        )));
    };
    let columns = match header.encoding {
        Encoding::Ascii => of_text(data, &header, vertex)?,
        _ => of_binary(data, &header, vertex)?,
    };
    let mut loaded = Table { columns }.into_loaded(options)?;
    let lists = header.elements[vertex].properties.iter().filter(|p| p.list.is_some());
    loaded.notes.extend(lists.map(|property| {
        let name = shortened(&property.name);
        format!("the property {name} of the vertices is a list, and is not used")
    }));
    let others = header.elements.iter().enumerate().filter(|(at, e)| *at != vertex && e.count > 0);
    let others: Vec<_> = others.take(8).map(|(_, e)| format!("{} of {}", e.count, e.name)).collect();
    if !others.is_empty() {
        let others = others.join(", ");
        loaded.notes.push(format!("vertices become spheres; not used are {others}"));
    }
    Ok(loaded)
}

/// Makes the columns of the properties that are not lists. `values` has one entry for each property.
fn columns(element: &Element, values: Vec<Option<Vec<f64>>>) -> Vec<TableColumn> {
    let named = element.properties.iter().zip(values);
    let column = |(property, values): (&Property, Option<Vec<f64>>)| {
        let full = property.scalar.full();
        Some(TableColumn { full, ..TableColumn::numbers(&property.name, values?) })
    };
    named.filter_map(column).collect()
}

/// Reads the vertices of a text file, each from a line of its own.
fn of_text(data: &[u8], header: &Header, vertex: usize) -> Result<Vec<TableColumn>, LoadError> {
    let lines = data.split(|byte| *byte == b'\n').zip(header.lines + 1..);
    let mut lines = lines.filter(|(line, _)| !line.trim_ascii().is_empty());
    for element in &header.elements[..vertex] {
        for found in 0..element.count {
            lines.next().ok_or_else(|| too_few_lines(element, found))?;
        }
    }
    let element = &header.elements[vertex];
    let mut values: Vec<_> = element.properties.iter().map(|p| p.list.is_none().then(Vec::new)).collect();
    for found in 0..element.count {
        let (text, line) = lines.next().ok_or_else(|| too_few_lines(element, found))?;
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        for (property, values) in element.properties.iter().zip(&mut values) {
            let refused = |found: Option<&[u8]>| {
                let what = found.map_or_else(
                    || "is missing; a vertex has one value for each property".to_owned(),
                    |found| format!("is `{}`, which is not a number", shown(found)),
                );
                let property = shortened(&property.name);
                LoadError::line(line, format!("the property {property} {what}"))
            };
            let mut number = || {
                let word = words.next().ok_or_else(|| refused(None))?;
                let text = std::str::from_utf8(word).unwrap_or_default();
                property.scalar.parse(text).ok_or_else(|| refused(Some(word)))
            };
            let first = number()?;
            match values {
                Some(values) => values.push(first),
                // A list starts with its length; the line must have all of its numbers.
                None => {
                    for _ in 0..first as u64 {
                        number()?;
                    }
                }
            }
        }
        if let Some(word) = words.next() {
            let message = format!(
                "there are more values than the {} that the header declares; the first is `{}`",
                element.properties.len(),
                shown(word)
            );
            return Err(LoadError::line(line, message));
        }
    }
    if header.elements.len() == vertex + 1
        && let Some((_, line)) = lines.next()
    {
        return Err(too_many(Place::Line(line), element));
    }
    Ok(columns(element, values))
}

/// Reads the vertices of a binary file.
fn of_binary(data: &[u8], header: &Header, vertex: usize) -> Result<Vec<TableColumn>, LoadError> {
    let is_little = header.encoding == Encoding::LittleEndian;
    let order = if is_little { Order::Little } else { Order::Big };
    let mut rest = data;
    let at = |rest: &[u8]| header.bytes + data.len() - rest.len();
    for element in &header.elements[..vertex] {
        let before = rest;
        rest = walk(rest, element, order, |_, _| {}).map_err(|index| too_few_bytes(at(before), element, index))?;
    }
    let element = &header.elements[vertex];
    let memory = |_| LoadError::new(format!("there is not enough memory for {} vertices", element.count));
    let too_few = |index| too_few_bytes(at(rest), element, index);
    let mut values = Vec::with_capacity(element.properties.len());
    let rest = if let Some(size) = element.size().filter(|size| *size > 0) {
        let there = (rest.len() / size) as u64;
        if there < element.count {
            return Err(too_few(there));
        }
        let (vertices, after) = rest.split_at(element.count as usize * size);
        let mut offset = 0;
        for property in &element.properties {
            let (scalar, from) = (property.scalar, offset);
            let number = |row: usize| scalar.decode(&vertices[row * size + from..], order);
            values.push(Some(parallel::try_map(element.count as usize, number).map_err(memory)?));
            offset += scalar.size();
        }
        after
    } else {
        values.extend(element.properties.iter().map(|p| p.list.is_none().then(Vec::new)));
        walk(rest, element, order, |index, value| {
            if let Some(values) = &mut values[index] {
                values.push(value);
            }
        })
        .map_err(too_few)?
    };
    if header.elements.len() == vertex + 1 && !rest.is_empty() {
        return Err(too_many(Place::Byte(at(rest) as u64), element));
    }
    Ok(columns(element, values))
}

fn shown(value: &[u8]) -> String {
    shortened(&String::from_utf8_lossy(value))
}

fn too_few_lines(Element { name, count, .. }: &Element, found: u64) -> LoadError {
    let declared = format!("the header declares `element {name} {count}`");
    let message = format!("{declared}, but the file ends after {found} of them; it is cut off");
    LoadError::new(message).of_kind(LoadErrorKind::CutOff)
}

fn too_few_bytes(byte: usize, Element { name, count, .. }: &Element, index: u64) -> LoadError {
    let message = format!(
        "the header declares `element {name} {count}`, which begin here, but the file ends within number {index}, counted \
         from 0; it is cut off"
    );
    LoadError::byte(byte as u64, message).of_kind(LoadErrorKind::CutOff)
}

fn too_many(place: Place, Element { name, count, .. }: &Element) -> LoadError {
    let message =
        format!("there are more data after those of `element {name} {count}`, the last that the header declares");
    LoadError::at(place, message)
}

/// Goes through elements, calls `number` with the index of the property for every number that is not in a list, and
/// returns the data after them.
///
/// # Errors
/// Returns the index of the first element that is incomplete.
fn walk<'a>(
    data: &'a [u8],
    element: &Element,
    order: Order,
    mut number: impl FnMut(usize, f64),
) -> Result<&'a [u8], u64> {
    // Elements without properties take no bytes, so the file may declare any number of them.
    if element.properties.is_empty() {
        return Ok(data);
    }
    let mut rest = data;
    for index in 0..element.count {
        for (at, property) in element.properties.iter().enumerate() {
            let first = property.list.unwrap_or(property.scalar);
            let value = (rest.len() >= first.size()).then(|| first.decode(rest, order));
            let value = value.ok_or(index)?;
            rest = &rest[first.size()..];
            if property.list.is_some() {
                let bytes = (value as usize).saturating_mul(property.scalar.size());
                rest = rest.get(bytes..).ok_or(index)?;
            } else {
                number(at, value);
            }
        }
    }
    Ok(rest)
}

/// The encoding of the data after the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

#[derive(Debug)]
struct Property {
    name: String,
    scalar: Scalar,
    /// The type of a list's length, if the property is a list.
    list: Option<Scalar>,
}

#[derive(Debug)]
struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

#[derive(Debug)]
struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    /// Number of lines.
    lines: usize,
    /// Number of bytes.
    bytes: usize,
}

fn scalar_of_name(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => Scalar::I8,
        "uchar" | "uint8" => Scalar::U8,
        "short" | "int16" => Scalar::I16,
        "ushort" | "uint16" => Scalar::U16,
        "int" | "int32" => Scalar::I32,
        "uint" | "uint32" => Scalar::U32,
        "float" | "float32" => Scalar::F32,
        "double" | "float64" => Scalar::F64,
        _ => return None,
    })
}

impl Element {
    /// The number of bytes of an element, if all elements have the same.
    fn size(&self) -> Option<usize> {
        let is_list = self.properties.iter().any(|property| property.list.is_some());
        (!is_list).then(|| self.properties.iter().map(|property| property.scalar.size()).sum())
    }
}

/// Whether the first line is `ply`.
pub(super) fn starts(bytes: &[u8]) -> bool {
    bytes.strip_prefix(b"ply").is_some_and(|rest| matches!(rest.first(), Some(b'\n' | b'\r')))
}

fn read_header(bytes: &[u8]) -> Result<Header, LoadError> {
    if !starts(bytes) {
        return Err(LoadError::new("this is not a PLY file: its first line is not `ply`"));
    }
    let (mut encoding, mut elements) = (None, Vec::<Element>::new());
    let (mut rest, mut line) = (bytes, 0);
    loop {
        let end = rest.iter().position(|byte| *byte == b'\n').ok_or_else(|| {
            let message = "the header has no line `end_header`; the file is cut off or is not a PLY file";
            LoadError::new(message).of_kind(LoadErrorKind::CutOff)
        })?;
        let text = String::from_utf8_lossy(&rest[..end]);
        rest = &rest[end + 1..];
        line += 1;
        let refused = |message: String| LoadError::line(line, message);
        let words: Vec<&str> = text.split_whitespace().collect();
        match *words.as_slice() {
            ["end_header"] => break,
            ["ply"] if line == 1 => {}
            ["format", name, version] => {
                let wanted = match name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => {
                        return Err(refused(format!(
                            "the format `{}` is not one of ascii, binary_little_endian, binary_big_endian",
                            shortened(name)
                        )));
                    }
                };
                if version != "1.0" {
                    let version = shortened(version);
                    return Err(refused(format!("the version `{version}` is not 1.0")));
                }
                encoding = Some(wanted);
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| {
                    let count = shortened(count);
                    refused(format!("`{count}` is not a valid number of elements"))
                })?;
                let name = shortened(name);
                elements.push(Element { name, count, properties: Vec::new() });
            }
            ["property", ref words @ ..] => {
                let (list, scalar, name) = match *words {
                    ["list", count, scalar, name] => (Some(count), scalar, name),
                    [scalar, name] => (None, scalar, name),
                    _ => return Err(refused("write `property TYPE NAME`".to_owned())),
                };
                let of_name = |name: &str| {
                    scalar_of_name(name).ok_or_else(|| {
                        refused(format!(
                            "`{}` is not a type of PLY; these are char, uchar, short, ushort, int, uint, float, double, \
                             and int8 to uint32, float32 and float64",
                            shortened(name)
                        ))
                    })
                };
                let (list, scalar) = (list.map(of_name).transpose()?, of_name(scalar)?);
                if list.is_some_and(|count| matches!(count, Scalar::F32 | Scalar::F64)) {
                    return Err(refused("the length of a list cannot be a fraction".to_owned()));
                }
                let element = elements
                    .last_mut()
                    .ok_or_else(|| refused("a property must come after the element that has it".to_owned()))?;
                element.properties.push(Property { name: one_line(name), scalar, list });
            }
            ["comment" | "obj_info", ..] => {}
            _ => {
                return Err(refused(format!(
                    "`{}` is not a line of a PLY header, which are format, comment, obj_info, element, property, \
                     end_header",
                    shortened(&text)
                )));
            }
        }
    }
    let encoding = encoding.ok_or_else(|| {
        let message = "the header ends without a line `format`, such as `format ascii 1.0`";
        LoadError::line(line, message)
    })?;
    Ok(Header { encoding, elements, lines: line, bytes: bytes.len() - rest.len() })
}
