//! Reads the header of an `.npy` file, as NumPy Enhancement Proposal 1 defines it.
//!
//! The crate npyz reads headers too, but trusts them: it multiplies the dimensions of a shape before it gives access
//! to them, and allocates as many bytes as the header declares. Only the parser of the header's text, `py_literal`,
//! is the same.

use py_literal::Value;

use super::dtype::Dtype;
use crate::load::error::{LoadError, LoadErrorKind};
use crate::load::numbers::component_names;
use pinhole::internals::text::shortened;

const MAGIC: &[u8] = b"\x93NUMPY";

/// The longest header in bytes that is parsed. This is also NumPy's own default limit.
const MAX_TEXT: usize = 10_000;

/// The deepest nesting of brackets that is parsed. The parser is recursive and parses nested brackets more than once.
/// An array of plain numbers needs two levels, and a structured array a few more.
const MAX_DEPTH: usize = 8;

/// The most columns that an array makes.
const MAX_COLUMNS: usize = 1024;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    pub(super) elements: Elements,
    pub(super) fortran_order: bool,
    pub(super) shape: Vec<u64>,
}

/// The elements of an array.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Elements {
    /// Values of one type, with the type's name.
    Plain(String),
    /// Structures with named fields.
    Structures {
        fields: Vec<Field>,
        /// Number of bytes of a structure.
        size: usize,
    },
}

/// A field of a structure. A field of several values or fields becomes several fields, such as `pos.x`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) dtype: Dtype,
    /// Offset of the field in its structure, in bytes.
    pub(super) offset: usize,
}

impl Elements {
    /// Name of the type, for messages.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Plain(name) => name.clone(),
            Self::Structures { .. } => "a structure of fields".to_owned(),
        }
    }
}

/// Adds the fields of a structure that begins at `offset`, and returns its end. An error is the end of a sentence.
fn add_fields(
    list: &[Value],
    prefix: &str,
    mut offset: usize,
    steps: &mut usize,
    fields: &mut Vec<Field>,
) -> Result<usize, String> {
    for field in list {
        let bad = || "has a field without a name or a valid type".to_owned();
        let Value::Tuple(parts) = field else { return Err(bad()) };
        let (name, of, shape) = match parts.as_slice() {
            [name, of] => (name, of, None),
            [name, of, shape] => (name, of, Some(shape)),
            _ => return Err(bad()),
        };
        let name = match name {
            Value::String(name) => name,
            // A title may precede the name.
            Value::Tuple(both) => both.get(1).and_then(Value::as_string).ok_or_else(bad)?,
            _ => return Err(bad()),
        };
        let count = match shape {
            None => Some(1),
            Some(Value::Tuple(dimensions)) => dimensions
                .iter()
                .try_fold(1, |all: usize, dimension| all.checked_mul(usize::try_from(dimension.as_integer()?).ok()?)),
            Some(dimension) => dimension.as_integer().and_then(|count| usize::try_from(count).ok()),
        };
        let too_many = || format!("has more than {MAX_COLUMNS} columns");
        let count = count.filter(|count| *count <= MAX_COLUMNS).ok_or_else(too_many)?;
        for name in component_names(name, count) {
            // Fields that consist of nothing are counted too.
            *steps += 1;
            if *steps > 2 * MAX_COLUMNS {
                return Err(too_many());
            }
            let full = format!("{prefix}{name}");
            match of {
                Value::String(of) => {
                    let dtype = Dtype::parse(of).ok_or_else(bad)?;
                    let size = dtype.size;
                    // A field without a name only fills a gap.
                    if !name.is_empty() {
                        let name = shortened(&full);
                        fields.push(Field { name, dtype, offset });
                    }
                    offset = offset.checked_add(size).ok_or_else(bad)?;
                }
                Value::List(list) => {
                    offset = add_fields(list, &format!("{full}."), offset, steps, fields)?;
                }
                _ => return Err(bad()),
            }
            if fields.len() > MAX_COLUMNS {
                return Err(too_many());
            }
        }
    }
    Ok(offset)
}

/// Splits a file into its header and the data after it.
pub(super) fn split(bytes: &[u8]) -> Result<(Header, &[u8]), LoadError> {
    let bad = |message: &str| LoadError::new(format!("the .npy header {message}; write the file with numpy.save"));
    let cut_off = || bad("is cut off").of_kind(LoadErrorKind::CutOff);
    let rest = bytes.strip_prefix(MAGIC).ok_or_else(|| {
        LoadError::new("this is not an .npy file: it does not start with \\x93NUMPY; write the file with numpy.save")
    })?;
    let (version, rest) = rest.split_first_chunk().ok_or_else(cut_off)?;
    let (length, rest) = match *version {
        [1, 0] => {
            let (length, rest) = rest.split_first_chunk().ok_or_else(cut_off)?;
            (usize::from(u16::from_le_bytes(*length)), rest)
        }
        [2 | 3, 0] => {
            let (length, rest) = rest.split_first_chunk().ok_or_else(cut_off)?;
            (u32::from_le_bytes(*length) as usize, rest)
        }
        [major, minor] => {
            return Err(bad(&format!("has the unknown version {major}.{minor}")));
        }
    };
    if length > MAX_TEXT {
        return Err(bad(&format!("is {length} bytes long, more than the limit of {MAX_TEXT} bytes")));
    }
    let (text, data) = rest.split_at_checked(length).ok_or_else(cut_off)?;
    let text = str::from_utf8(text).map_err(|_| bad("is not valid text"))?;
    Ok((parse(text).map_err(|message| bad(&message))?, data))
}

/// Parses the text of a header, such as `{'descr': '<f4', 'fortran_order': False, 'shape': (10, 4), }`.
fn parse(text: &str) -> Result<Header, String> {
    if depth(text) > MAX_DEPTH {
        return Err(format!("has brackets nested more than {MAX_DEPTH} levels deep"));
    }
    let not_a_dictionary = || format!("is not a valid Python dictionary: `{}`", shortened(text));
    let Ok(Value::Dict(entries)) = text.trim_end().parse() else { return Err(not_a_dictionary()) };
    let value = |name: &str| {
        let mut named = entries.iter().filter(|(key, _)| key.as_string().is_some_and(|k| k == name));
        named.next().map(|(_, value)| value).ok_or_else(|| format!("has no key `{name}`"))
    };
    let elements = match value("descr")? {
        Value::String(dtype) => Elements::Plain(dtype.clone()),
        Value::List(list) => {
            let mut fields = Vec::new();
            let size = add_fields(list, "", 0, &mut 0, &mut fields)?;
            Elements::Structures { fields, size }
        }
        _ => return Err("has a `descr` that is not a valid type".to_owned()),
    };
    let Value::Boolean(fortran_order) = *value("fortran_order")? else {
        return Err("has a `fortran_order` that is neither True nor False".to_owned());
    };
    let Value::Tuple(dimensions) = value("shape")? else {
        return Err("has a `shape` that is not a tuple".to_owned());
    };
    let count = |dimension: &Value| u64::try_from(dimension.as_integer()?).ok();
    let shape: Option<Vec<u64>> = dimensions.iter().map(count).collect();
    let shape = shape.ok_or("has a `shape` with a dimension that is not a valid number of elements")?;
    Ok(Header { elements, fortran_order, shape })
}

/// Returns the deepest nesting of brackets. Brackets within strings count too.
fn depth(text: &str) -> usize {
    let (mut depth, mut deepest) = (0_usize, 0);
    for c in text.chars() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}
