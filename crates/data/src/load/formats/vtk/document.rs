//! The XML of a VTK file: its arrays, and the places of their numbers.

use std::borrow::Cow;
use std::cell::Cell;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use crate::load::error::{LoadError, LoadErrorKind};
use crate::load::numbers::{Order, Scalar};
use pinhole::internals::text::{one_line, shortened};

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Encoding {
    pub(super) order: Order,
    /// Whether lengths before the data are u64 rather than u32.
    pub(super) is_wide: bool,
    pub(super) is_compressed: bool,
}

/// The parts of a file that describe its points.
#[derive(Debug, Default)]
pub(super) struct Document<'a> {
    pub(super) encoding: Encoding,
    pub(super) pieces: Vec<Piece<'a>>,
    /// Unused parts of the file, such as arrays that are not about points, each as the start of a sentence.
    pub(super) unused: Vec<String>,
    /// The data after the XML; offsets count from its start.
    pub(super) appended: &'a [u8],
    pub(super) appended_is_base64: bool,
    /// Number of appended bytes that arrays have taken. Arrays must not overlap, or a small file could take any memory.
    pub(super) taken: Cell<usize>,
}

#[derive(Debug, Default)]
pub(super) struct Piece<'a> {
    pub(super) points: u64,
    pub(super) positions: Option<Array<'a>>,
    pub(super) arrays: Vec<Array<'a>>,
}

#[derive(Debug)]
pub(super) struct Array<'a> {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    pub(super) components: usize,
    pub(super) data: Data<'a>,
}

#[derive(Debug)]
pub(super) enum Data<'a> {
    Ascii(Cow<'a, str>),
    Base64(Cow<'a, str>),
    /// Offset of the data in the appended data.
    Appended(u64),
}

/// Arrays with more components are not used, because each component would become a column.
const MOST_COMPONENTS: usize = 64;

const APPENDED: &[u8] = b"<AppendedData";

fn scalar_of_name(name: &str) -> Option<Scalar> {
    Some(match name {
        "Int8" => Scalar::I8,
        "UInt8" => Scalar::U8,
        "Int16" => Scalar::I16,
        "UInt16" => Scalar::U16,
        "Int32" => Scalar::I32,
        "UInt32" => Scalar::U32,
        "Int64" => Scalar::I64,
        "UInt64" => Scalar::U64,
        "Float32" => Scalar::F32,
        "Float64" => Scalar::F64,
        _ => return None,
    })
}

pub(super) fn read(bytes: &[u8]) -> Result<Document<'_>, LoadError> {
    // Appended data need not be XML.
    let end = bytes.windows(APPENDED.len()).position(|window| window == APPENDED);
    let xml = &bytes[..end.unwrap_or(bytes.len())];
    let xml = std::str::from_utf8(xml)
        .map_err(|error| LoadError::byte(error.valid_up_to() as u64, "this is not UTF-8 text"))?;
    let mut parser = Parser::default();
    parser.read(xml)?;
    if !parser.is_vtk {
        let message = "this is not a VTK XML file: it has no element VTKFile";
        return Err(LoadError::new(message));
    }
    if let Some(end) = end {
        (parser.document.appended, parser.document.appended_is_base64) = appended(bytes, end)?;
    } else if let Some(element) = parser.open.pop() {
        return Err(cut_off(&element));
    }
    Ok(parser.document)
}

fn cut_off(element: &str) -> LoadError {
    let message = format!("the file ends within the element {element}; it is cut off");
    LoadError::new(message).of_kind(LoadErrorKind::CutOff)
}

/// Finds the data of the element `AppendedData`, which start after an underscore.
fn appended(bytes: &[u8], start: usize) -> Result<(&[u8], bool), LoadError> {
    let rest = &bytes[start..];
    let tag = rest.iter().position(|byte| *byte == b'>');
    let tag = tag.ok_or_else(|| cut_off("AppendedData"))?;
    let (tag, data) = rest.split_at(tag + 1);
    let is_base64 = tag.windows(6).any(|window| window == b"base64");
    let data = data.trim_ascii_start().strip_prefix(b"_").ok_or_else(|| {
        let byte = (start + tag.len()) as u64;
        LoadError::byte(byte, "appended data must start with an underscore")
    })?;
    Ok((data, is_base64))
}

#[derive(Default)]
struct Parser<'a> {
    document: Document<'a>,
    is_vtk: bool,
    /// Names of the elements that are open, from the outermost.
    open: Vec<String>,
    /// Whether the last array that began is the last one of the last piece.
    is_in_array: bool,
    cells: u64,
    points: u64,
}

impl<'a> Parser<'a> {
    fn read(&mut self, xml: &'a str) -> Result<(), LoadError> {
        let mut reader = Reader::from_str(xml);
        loop {
            let byte = reader.buffer_position();
            let refused = |message: String| LoadError::byte(byte, one_line(&message));
            let event = reader.read_event().map_err(|error| refused(error.to_string()))?;
            match event {
                Event::Start(element) => {
                    self.start(&element).map_err(|error| at(error, byte))?;
                    self.open.push(shortened(&element_name(&element)));
                }
                Event::Empty(element) => {
                    self.start(&element).map_err(|error| at(error, byte))?;
                }
                Event::End(_) => {
                    self.open.pop();
                }
                Event::Text(text) => self.text(text.into_inner()),
                Event::CData(text) => self.text(text.into_inner()),
                Event::Eof => break,
                _ => {}
            }
        }
        let points = self.points;
        if self.cells > 0 {
            let cells = self.cells;
            self.document.unused.push(format!("{cells} cells; the {points} points become spheres"));
        }
        Ok(())
    }

    fn start(&mut self, element: &BytesStart<'_>) -> Result<(), Problem> {
        let parent = self.open.last().map_or("", String::as_str);
        let name = element_name(element);
        if name == "DataArray" {
            self.is_in_array = false;
        }
        match (parent, name.as_str()) {
            (_, "VTKFile") if !self.is_vtk => {
                self.is_vtk = true;
                self.file(element)?;
            }
            ("PolyData" | "UnstructuredGrid", "Piece") => {
                let points = number(element, "NumberOfPoints")?.unwrap_or_default();
                self.points = self.points.saturating_add(points);
                for kind in ["NumberOfLines", "NumberOfStrips", "NumberOfPolys"] {
                    self.cells = self.cells.saturating_add(number(element, kind)?.unwrap_or(0));
                }
                // A grid of particles has a cell for each point, which needs no note.
                let cells = number(element, "NumberOfCells")?.unwrap_or_default();
                self.cells = self.cells.saturating_add(if cells == points { 0 } else { cells });
                self.document.pieces.push(Piece { points, ..Piece::default() });
            }
            ("Points", "DataArray") | ("PointData", "DataArray" | "Array") => {
                let Some(piece) = self.document.pieces.last_mut() else { return Ok(()) };
                match array(element)? {
                    Ok(array) => {
                        if parent == "Points" {
                            piece.positions = Some(array);
                        } else {
                            piece.arrays.push(array);
                        }
                        self.is_in_array = true;
                    }
                    Err(unused) => self.document.unused.push(unused),
                }
            }
            ("CellData" | "FieldData", "DataArray" | "Array") => {
                let what = if parent == "CellData" { "cells" } else { "the whole file" };
                let name = attribute(element, "Name")?.unwrap_or_default();
                self.document.unused.push(format!("the array {} of {what}", shortened(&name)));
            }
            _ => {}
        }
        Ok(())
    }

    fn file(&mut self, element: &BytesStart<'_>) -> Result<(), Problem> {
        let one_of = |name: &str, known: [&str; 2]| {
            let value = attribute(element, name)?;
            match value.as_deref() {
                None => Ok(false),
                Some(value) if value == known[0] => Ok(false),
                Some(value) if value == known[1] => Ok(true),
                Some(value) => Err(Problem::Message(format!(
                    "{name} is `{}`, but it must be {} or {}",
                    shortened(value),
                    known[0],
                    known[1]
                ))),
            }
        };
        let encoding = &mut self.document.encoding;
        let is_big = one_of("byte_order", ["LittleEndian", "BigEndian"])?;
        encoding.order = if is_big { Order::Big } else { Order::Little };
        encoding.is_wide = one_of("header_type", ["UInt32", "UInt64"])?;
        let kind = attribute(element, "type")?.unwrap_or_default();
        if !["PolyData", "UnstructuredGrid"].contains(&kind.as_str()) {
            let is_list = kind.starts_with('P') || kind.contains("MultiBlock") || kind == "Collection";
            let advice = if is_list { "; name one of the files that it lists" } else { "" };
            return Err(Problem::Error(LoadError::new(format!(
                "the file is of the type {}, but only PolyData (.vtp) and UnstructuredGrid (.vtu) can be read{advice}",
                shortened(&kind)
            ))));
        }
        match attribute(element, "compressor")?.as_deref() {
            None | Some("") => {}
            Some("vtkZLibDataCompressor") => encoding.is_compressed = true,
            Some(found) => {
                let found = shortened(found);
                return Err(Problem::Error(LoadError::new(format!(
                    "the data are compressed with {found}, but only vtkZLibDataCompressor can be read; save the file with \
                     zlib or without compression"
                ))));
            }
        }
        Ok(())
    }

    /// Takes the text of an inline array.
    fn text(&mut self, text: Cow<'a, str>) {
        // An array may contain other elements, whose text is not data.
        let is_data = self.is_in_array && self.open.last().is_some_and(|name| name == "DataArray");
        let Some(piece) = self.document.pieces.last_mut().filter(|_| is_data) else {
            return;
        };
        let is_position = self.open.iter().rev().nth(1).is_some_and(|name| name == "Points");
        let array = if is_position { piece.positions.as_mut() } else { piece.arrays.last_mut() };
        if let Some(Array { data: Data::Ascii(data) | Data::Base64(data), .. }) = array {
            if data.is_empty() {
                *data = text;
            } else {
                data.to_mut().push_str(&text);
            }
        }
    }
}

/// A fault of an element: a complete error, or a message without its place.
enum Problem {
    Error(LoadError),
    Message(String),
}

fn at(problem: Problem, byte: u64) -> LoadError {
    match problem {
        Problem::Error(error) => error,
        Problem::Message(message) => LoadError::byte(byte, message),
    }
}

fn element_name(element: &BytesStart<'_>) -> String {
    let name = element.local_name();
    let name: &str = name.as_ref();
    name.to_owned()
}

fn attribute(element: &BytesStart<'_>, name: &str) -> Result<Option<String>, Problem> {
    let message = |error: &dyn std::fmt::Display| Problem::Message(one_line(&error.to_string()));
    let found = element.try_get_attribute(name).map_err(|error| message(&error))?;
    let value = found.map(|found| found.normalized_value(XmlVersion::Implicit1_0).map(Cow::into_owned));
    value.transpose().map_err(|error| message(&error))
}

fn number(element: &BytesStart<'_>, name: &str) -> Result<Option<u64>, Problem> {
    let parsed = attribute(element, name)?.map(|text| {
        text.trim().parse().map_err(|_| {
            let text = shortened(&text);
            Problem::Message(format!("{name} is `{text}`, which is not a valid number"))
        })
    });
    parsed.transpose()
}

/// Reads the attributes of an array. The inner error describes an array that is not used.
fn array<'a>(element: &BytesStart<'_>) -> Result<Result<Array<'a>, String>, Problem> {
    let name = attribute(element, "Name")?.unwrap_or_default();
    let shown = match name.is_empty() {
        true => "without a name".to_owned(),
        false => shortened(&name),
    };
    let kind = attribute(element, "type")?.unwrap_or_default();
    let Some(scalar) = scalar_of_name(&kind) else {
        if kind == "String" {
            return Ok(Err(format!("the array {shown}, which is text")));
        }
        let kind = shortened(&kind);
        return Err(Problem::Message(format!(
            "the array {shown} has the type `{kind}`, but it must be Int8 to UInt64, Float32 or Float64"
        )));
    };
    let components = number(element, "NumberOfComponents")?.unwrap_or(1).max(1);
    let Some(components) = usize::try_from(components).ok().filter(|n| *n <= MOST_COMPONENTS) else {
        return Ok(Err(format!("the array {shown}, which has {components} components")));
    };
    let data = match attribute(element, "format")?.as_deref() {
        None | Some("ascii") => Data::Ascii(Cow::Borrowed("")),
        Some("binary") => Data::Base64(Cow::Borrowed("")),
        Some("appended") => {
            let offset = number(element, "offset")?;
            let missing = || Problem::Message(format!("the array {shown} has no offset"));
            Data::Appended(offset.ok_or_else(missing)?)
        }
        Some(other) => {
            return Err(Problem::Message(format!(
                "the array {shown} has the format `{}`, but it must be ascii, binary or appended",
                shortened(other)
            )));
        }
    };
    Ok(Ok(Array { name, scalar, components, data }))
}
