//! The header of a PLY file: which elements follow, and what each consists of.

use crate::load::error::{LoadError, LoadErrorKind};
use crate::load::scalar::Scalar;
use crate::text::{one_line, shortened};

/// How the data after the header are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    /// The type of the number of values, if this is a list.
    pub(super) list: Option<Scalar>,
}

#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Number of lines.
    pub(super) lines: usize,
    /// Number of bytes.
    pub(super) bytes: usize,
}

/// Returns the type of this name.
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
    /// The number of bytes of each, if all have the same.
    pub(super) fn size(&self) -> Option<usize> {
        let is_list = self.properties.iter().any(|property| property.list.is_some());
        (!is_list).then(|| self.properties.iter().map(|property| property.scalar.size()).sum())
    }
}

/// Whether the first line is `ply`.
pub(in crate::load) fn starts(bytes: &[u8]) -> bool {
    bytes.strip_prefix(b"ply").is_some_and(|rest| matches!(rest.first(), Some(b'\n' | b'\r')))
}

/// Reads the header.
pub(super) fn read(bytes: &[u8]) -> Result<Header, LoadError> {
    if !starts(bytes) {
        return Err(LoadError::new("this is not a PLY file: its first line is not `ply`"));
    }
    let (mut encoding, mut elements) = (None, Vec::<Element>::new());
    let (mut rest, mut line) = (bytes, 0);
    loop {
        let end = rest.iter().position(|byte| *byte == b'\n').ok_or_else(|| {
            let message =
                "the header has no line `end_header`; the file is cut off or is not a PLY file";
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
                            shortened(&one_line(name))
                        )));
                    }
                };
                if version != "1.0" {
                    let version = shortened(&one_line(version));
                    return Err(refused(format!("the version `{version}` is not 1.0")));
                }
                encoding = Some(wanted);
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| {
                    let count = shortened(&one_line(count));
                    refused(format!("`{count}` is not a valid number of elements"))
                })?;
                let name = shortened(&one_line(name));
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
                            shortened(&one_line(name))
                        ))
                    })
                };
                let (list, scalar) = (list.map(of_name).transpose()?, of_name(scalar)?);
                if list.is_some_and(|count| matches!(count, Scalar::F32 | Scalar::F64)) {
                    return Err(refused("the length of a list cannot be a fraction".to_owned()));
                }
                let element = elements.last_mut().ok_or_else(|| {
                    refused("a property must come after the element that has it".to_owned())
                })?;
                element.properties.push(Property { name: one_line(name), scalar, list });
            }
            ["comment" | "obj_info", ..] => {}
            _ => {
                return Err(refused(format!(
                    "`{}` is not a line of a PLY header, which are format, comment, obj_info, element, property, \
                     end_header",
                    shortened(&one_line(&text))
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
