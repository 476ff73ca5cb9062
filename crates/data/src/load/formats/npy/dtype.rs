//! Types of NumPy's arrays, and decoding of columns.

use std::collections::HashMap;

use crate::load::dataset::Labels;
use crate::load::numbers::{Number, Order, Scalar};
use crate::load::table::TableColumn;
use pinhole::internals::text::shortened;

/// The type of the elements of an array, such as `<f4`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Dtype {
    /// NumPy's name of the type.
    pub(super) name: String,
    kind: char,
    /// Number of bytes of an element.
    pub(super) size: usize,
    order: Order,
}

/// The place of a column's values in the data of an array.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Byte of the first value.
    pub(super) first: usize,
    /// Bytes from one value to the next.
    pub(super) stride: usize,
    pub(super) rows: usize,
}

impl Dtype {
    /// Reads the name of a type; `None` if it has no size.
    pub(super) fn parse(name: &str) -> Option<Self> {
        let rest = name.strip_prefix(['<', '>', '|', '=']).unwrap_or(name);
        let order = if name.starts_with('>') { Order::Big } else { Order::Little };
        let mut letters = rest.chars();
        let kind = letters.next().filter(char::is_ascii_alphabetic)?;
        // Dates have their unit in brackets after the size.
        let digits = letters.as_str().split('[').next()?;
        let size: usize = match (kind, digits) {
            ('O', "") => 8,
            _ => digits.parse().ok()?,
        };
        // Text has four bytes for each character.
        let size = size.checked_mul(if kind == 'U' { 4 } else { 1 })?;
        Some(Self { name: name.to_owned(), kind, size, order })
    }

    /// Whether the elements are real numbers.
    pub(super) fn is_real(&self) -> bool {
        (self.kind, self.size) == ('f', 2) || self.scalar().is_some()
    }

    /// Whether the elements can be a column: real numbers, truth values as 0 and 1, or text.
    pub(super) fn is_column(&self) -> bool {
        self.is_real() || (self.kind == 'b' && self.size == 1) || (self.is_text() && self.size > 0)
    }

    fn is_text(&self) -> bool {
        matches!(self.kind, 'S' | 'a' | 'U')
    }

    /// The type of the elements as other formats have it; `None` if it exists only in NumPy.
    fn scalar(&self) -> Option<Scalar> {
        Some(match (self.kind, self.size) {
            ('f', 4) => Scalar::F32,
            ('f', 8) => Scalar::F64,
            ('i', 1) => Scalar::I8,
            ('i', 2) => Scalar::I16,
            ('i', 4) => Scalar::I32,
            ('i', 8) => Scalar::I64,
            ('u', 1) => Scalar::U8,
            ('u', 2) => Scalar::U16,
            ('u', 4) => Scalar::U32,
            ('u', 8) => Scalar::U64,
            _ => return None,
        })
    }

    /// Decodes a column. The type must satisfy [`Dtype::is_column`], and the data must contain the place.
    pub(super) fn column(&self, name: String, data: &[u8], place: Place) -> TableColumn {
        let values = (0..place.rows).map(|row| {
            let first = place.first + row * place.stride;
            data.get(first..first + self.size).unwrap_or_default()
        });
        if self.is_text() {
            return TableColumn::labels(name, self.labels(values));
        }
        let mut column = TableColumn::numbers(name, values.map(|value| self.number(value)).collect());
        column.full = self.scalar().and_then(Scalar::full);
        column
    }

    /// Decodes an integer of 32 or 64 bits.
    pub(super) fn integer(&self, bytes: &[u8]) -> i128 {
        let order = self.order;
        match (self.kind, self.size) {
            ('i', 4) => i32::decode(bytes, order).into(),
            ('i', _) => i64::decode(bytes, order).into(),
            (_, 4) => u32::decode(bytes, order).into(),
            _ => u64::decode(bytes, order).into(),
        }
    }

    pub(super) fn number(&self, bytes: &[u8]) -> f64 {
        match self.scalar() {
            Some(scalar) => scalar.decode(bytes, self.order),
            None if self.kind == 'f' => half(u16::decode(bytes, self.order)),
            // Truth values.
            None => u8::decode(bytes, self.order).into(),
        }
    }

    fn text(&self, bytes: &[u8]) -> String {
        let text = match self.kind {
            'U' => {
                let codes = bytes.chunks_exact(4).map(|code| u32::decode(code, self.order));
                codes.take_while(|code| *code != 0).map(|code| char::from_u32(code).unwrap_or('?')).collect()
            }
            _ => String::from_utf8_lossy(bytes.split(|byte| *byte == 0).next().unwrap_or_default()).into_owned(),
        };
        shortened(&text)
    }

    fn labels<'a>(&self, values: impl Iterator<Item = &'a [u8]>) -> Labels {
        let mut labels = Labels::default();
        let mut known: HashMap<&[u8], u32> = HashMap::new();
        for value in values {
            let index = *known.entry(value).or_insert_with(|| {
                labels.names.push(self.text(value));
                // There are no more names than spheres, whose number is less than 2³².
                labels.names.len() as u32 - 1
            });
            labels.indices.push(index);
        }
        labels
    }
}

/// Decodes a number in half precision from its bits.
fn half(bits: u16) -> f64 {
    let fraction = f64::from(bits & 0x3ff) / 1024.0;
    let size = match i32::from(bits >> 10 & 0x1f) {
        0 => fraction * 2_f64.powi(-14),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1.0 + fraction) * 2_f64.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
}
