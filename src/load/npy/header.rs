//! The header of an `.npy` file, as NumPy Enhancement Proposal 1 lays it down.
//!
//! npyz reads headers too, but believes what they say: it multiplies the sides of a shape before it can
//! be asked for them, and takes the header's length for memory that it has. So only the parser of the
//! header's text, `py_literal`, is shared with it.

use py_literal::Value;

use super::SpheresError;
use crate::text::{one_line, shortened};

const MAGIC: &[u8] = b"\x93NUMPY";

/// The longest text that is parsed; the longest that NumPy itself reads if it is not told otherwise.
const MAX_TEXT: usize = 10_000;

/// The deepest nesting of brackets that is parsed. The parser recurses, and tries what is nested more
/// than once; an array of plain numbers needs two levels, a structured one some more.
const MAX_DEPTH: usize = 8;

/// What a header says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    pub(super) dtype: String,
    pub(super) fortran_order: bool,
    pub(super) shape: Vec<u64>,
}

/// Cuts a file into its header and what follows.
pub(super) fn split(bytes: &[u8]) -> Result<(Header, &[u8]), SpheresError> {
    let bad = |message: &str| SpheresError::Header { message: message.to_owned() };
    let rest = bytes.strip_prefix(MAGIC).ok_or(SpheresError::NoNpy)?;
    let (version, rest) = rest.split_first_chunk().ok_or_else(|| bad("is cut off"))?;
    let (length, rest) = match *version {
        [1, 0] => {
            let (length, rest) = rest.split_first_chunk().ok_or_else(|| bad("is cut off"))?;
            (usize::from(u16::from_le_bytes(*length)), rest)
        }
        [2 | 3, 0] => {
            let (length, rest) = rest.split_first_chunk().ok_or_else(|| bad("is cut off"))?;
            (u32::from_le_bytes(*length) as usize, rest)
        }
        [major, minor] => {
            return Err(bad(&format!("has the unknown version {major}.{minor}")));
        }
    };
    if length > MAX_TEXT {
        return Err(bad(&format!("is {length} bytes long; {MAX_TEXT} are read")));
    }
    let (text, data) = rest.split_at_checked(length).ok_or_else(|| bad("is cut off"))?;
    let text = str::from_utf8(text).map_err(|_| bad("is no text"))?;
    Ok((parse(text).map_err(|message| SpheresError::Header { message })?, data))
}

/// `{'descr': '<f4', 'fortran_order': False, 'shape': (10, 4), }`
fn parse(text: &str) -> Result<Header, String> {
    if depth(text) > MAX_DEPTH {
        return Err("nests brackets too deeply".to_owned());
    }
    let no_dictionary = || format!("is no Python dictionary: `{}`", shortened(&one_line(text)));
    let Ok(Value::Dict(entries)) = text.trim_end().parse() else { return Err(no_dictionary()) };
    let value = |name: &str| {
        let mut named =
            entries.iter().filter(|(key, _)| key.as_string().is_some_and(|k| k == name));
        named.next().map(|(_, value)| value).ok_or_else(|| format!("lacks `{name}`"))
    };
    let dtype = match value("descr")? {
        Value::String(dtype) => dtype.clone(),
        // Fields and their types. Nothing else is needed to refuse them.
        Value::List(_) => "a structure of fields".to_owned(),
        _ => return Err("has a `descr` that is no type".to_owned()),
    };
    let Value::Boolean(fortran_order) = *value("fortran_order")? else {
        return Err("has a `fortran_order` that is neither True nor False".to_owned());
    };
    let Value::Tuple(sides) = value("shape")? else {
        return Err("has a `shape` that is no tuple".to_owned());
    };
    let side = |side: &Value| u64::try_from(side.as_integer()?).ok();
    let shape: Option<Vec<u64>> = sides.iter().map(side).collect();
    let shape = shape.ok_or("has a `shape` with a side that is no number of elements")?;
    Ok(Header { dtype, fortran_order, shape })
}

/// How deeply brackets are nested, at most: those within strings count too.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_as_numpy_writes_them() {
        let header = parse("{'descr': '<f4', 'fortran_order': False, 'shape': (10, 4), }     \n");
        let expected = Header { dtype: "<f4".to_owned(), fortran_order: false, shape: vec![10, 4] };
        assert_eq!(header, Ok(expected));
        let header = parse("{'shape': (), 'fortran_order': True, 'descr': [('a', '<f4', (2,))]}");
        assert_eq!(header.unwrap().dtype, "a structure of fields");
    }

    #[test]
    fn headers_that_are_none() {
        for (text, expected) in [
            ("", "is no Python dictionary: ``"),
            ("{'descr': '<f4'", "is no Python dictionary: `{'descr': '<f4'`"),
            ("[1, 2]", "is no Python dictionary: `[1, 2]`"),
            ("{}", "lacks `descr`"),
            ("{'descr': '<f4', 'shape': (1, 4)}", "lacks `fortran_order`"),
            ("{'descr': 4, 'fortran_order': True, 'shape': ()}", "has a `descr` that is no type"),
            (
                "{'descr': '<f4', 'fortran_order': 0, 'shape': ()}",
                "has a `fortran_order` that is neither True nor False",
            ),
            (
                "{'descr': '<f4', 'fortran_order': True, 'shape': 3}",
                "has a `shape` that is no tuple",
            ),
            (
                "{'descr': '<f4', 'fortran_order': True, 'shape': (-1, 4)}",
                "has a `shape` with a side that is no number of elements",
            ),
            (
                "{'descr': '<f4', 'fortran_order': True, 'shape': (18446744073709551616, 4)}",
                "has a `shape` with a side that is no number of elements",
            ),
        ] {
            assert_eq!(parse(text), Err(expected.to_owned()), "{text}");
        }
        // A recursive parser would take long for this, or run out of stack.
        let nested = "(".repeat(9000);
        assert_eq!(parse(&nested), Err("nests brackets too deeply".to_owned()));
    }
}
