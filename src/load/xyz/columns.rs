//! What the comment line of a frame declares: the columns, and the periodic cell.

use crate::load::rows::{Field, Kind, number};
use crate::text::shortened;

/// The columns of the lines of atoms.
pub(super) struct Declared {
    pub(super) fields: Vec<Field>,
    /// Whether the comment names no columns, so that a line begins with `species x y z`.
    pub(super) is_plain: bool,
}

impl Declared {
    pub(super) fn of_comment(comment: &str) -> Result<Self, String> {
        let Some(properties) = value_of("Properties", comment) else {
            let numbers = ["x", "y", "z"].map(|name| Field::new(name, Kind::Number));
            let species = Field::new("species", Kind::Text);
            return Ok(Self {
                fields: [species].into_iter().chain(numbers).collect(),
                is_plain: true,
            });
        };
        let mut fields = Vec::new();
        let mut atomic_numbers = None;
        for property in properties.split(':').collect::<Vec<_>>().chunks(3) {
            let &[name, kind, count] = property else {
                return Err(format!(
                    "Properties={} is not a list of name:type:columns triples",
                    shortened(properties)
                ));
            };
            let count: usize = count.parse().map_err(|_| {
                let (count, name) = (shortened(count), shortened(name));
                format!("Properties: `{count}` is not a valid number of columns for {name}")
            })?;
            if let ("z" | "numbers", "I", 1) = (name.to_ascii_lowercase().as_str(), kind, count) {
                atomic_numbers.get_or_insert(fields.len());
            }
            add_fields(name, kind, count, &mut fields)?;
        }
        let has_symbols =
            fields.iter().any(|field| field.name.to_ascii_lowercase().trim() == "species");
        if let (false, Some(field)) = (has_symbols, atomic_numbers.and_then(|i| fields.get_mut(i)))
        {
            *field = Field::new("species", Kind::Text);
        }
        Ok(Self { fields, is_plain: false })
    }
}

/// Appends the columns of one property.
fn add_fields(name: &str, kind: &str, count: usize, fields: &mut Vec<Field>) -> Result<(), String> {
    /// More than any program writes, and few enough to be listed.
    const MAX_COLUMNS: usize = 1024;
    let kind = match kind {
        "S" | "L" => Kind::Text,
        "R" | "I" => Kind::Number,
        _ => {
            return Err(format!(
                "Properties: {} has the type `{}`, which is none of R, I, S and L",
                shortened(name),
                shortened(kind)
            ));
        }
    };
    let name = shortened(name);
    if count > MAX_COLUMNS - fields.len().min(MAX_COLUMNS) {
        return Err(format!(
            "Properties: with the {count} of {name} there are more columns than {MAX_COLUMNS}, which are the most"
        ));
    }
    fields.extend((0..count).map(|i| {
        let name = match (count, i) {
            (1, _) => name.clone(),
            (2 | 3, i) => format!("{name}.{}", ["x", "y", "z"][i]),
            (_, i) => format!("{name}.{i}"),
        };
        Field::new(name, kind)
    }));
    Ok(())
}

/// Finds the value of `key=value` or `key="value"` in an extended XYZ comment.
fn value_of<'a>(key: &str, comment: &'a str) -> Option<&'a str> {
    let mut rest = comment;
    loop {
        rest = rest.trim_start();
        if rest.is_empty() {
            return None;
        }
        let name_end = rest.find(|c: char| c == '=' || c.is_whitespace()).unwrap_or(rest.len());
        let name = &rest[..name_end];
        rest = &rest[name_end..];
        let Some(after) = rest.strip_prefix('=') else {
            continue;
        };
        let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''));
        let value = match quote {
            Some(quote) => after[1..].split(quote).next().unwrap_or_default(),
            None => after.split(char::is_whitespace).next().unwrap_or_default(),
        };
        if name.eq_ignore_ascii_case(key) {
            return Some(value);
        }
        let quotes = if quote.is_some() { 2 } else { 0 };
        rest = after.get(value.len() + quotes..).unwrap_or_default();
    }
}

/// The periodic cell of a comment line: `Lattice` has the three components of each edge vector, one edge after the other.
pub(super) fn cell_of(comment: &str) -> Result<Option<[[f64; 3]; 3]>, String> {
    let Some(text) = value_of("Lattice", comment) else {
        return Ok(None);
    };
    match numbers_of(text).as_deref() {
        Some(&[ax, ay, az, bx, by, bz, cx, cy, cz]) => {
            Ok(Some([[ax, ay, az], [bx, by, bz], [cx, cy, cz]]))
        }
        _ => Err(format!("Lattice={} is not a list of nine finite numbers", shortened(text))),
    }
}

/// The corner of the cell, which OVITO writes as `Origin`.
pub(super) fn origin_of(comment: &str) -> Result<Option<[f64; 3]>, String> {
    let Some(text) = value_of("Origin", comment) else {
        return Ok(None);
    };
    match numbers_of(text).as_deref() {
        Some(&[x, y, z]) => Ok(Some([x, y, z])),
        _ => Err(format!("Origin={} is not a list of three finite numbers", shortened(text))),
    }
}

/// Finite numbers with white space between them.
fn numbers_of(text: &str) -> Option<Vec<f64>> {
    let number = |text: &str| number(text.as_bytes()).filter(|number| number.is_finite());
    text.split_whitespace().map(number).collect()
}
