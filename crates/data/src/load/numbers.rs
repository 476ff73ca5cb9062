//! Reads numbers from bytes, in either order and never more than the file has, and from text. Errors in binary data
//! have a byte offset.

use std::io::{self, SeekFrom};

use super::error::{LoadError, LoadErrorKind};
use super::source::Bytes;
use pinhole::internals::text::shortened;

/// The error of a file that does not start as its format requires.
pub(super) fn wrong_start(format: &str, message: impl std::fmt::Display) -> LoadError {
    LoadError::new(format!("this is not a {format} file: {message}"))
}

/// The error of a position that is not finite. `byte` is its offset, or that of all positions if they are compressed.
pub(super) fn wrong_position(byte: u64, frame: usize, atom: usize, axis: char, found: f64) -> LoadError {
    let message = format!("frame {frame}: the {axis} coordinate of atom {atom} is {found}; a position must be finite");
    LoadError::byte(byte, message)
}

/// The order of the bytes of numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Order {
    #[default]
    Little,
    Big,
}

/// A number in a file.
pub(super) trait Number: Copy {
    const WIDTH: usize;
    fn decode(bytes: &[u8], order: Order) -> Self;
}

macro_rules! number {
    ($($name:ty)*) => {$(
        impl Number for $name {
            const WIDTH: usize = size_of::<Self>();

            fn decode(bytes: &[u8], order: Order) -> Self {
                let array = bytes.first_chunk().copied().unwrap_or_default();
                match order {
                    Order::Little => Self::from_le_bytes(array),
                    Order::Big => Self::from_be_bytes(array),
                }
            }
        }
    )*};
}

number!(u8 i8 u16 i16 u32 i32 u64 i64 f32 f64);

/// Decodes all numbers of a range of bytes.
pub(super) fn numbers<T: Number>(bytes: &[u8], order: Order) -> impl ExactSizeIterator<Item = T> {
    bytes.chunks_exact(T::WIDTH).map(move |bytes| T::decode(bytes, order))
}

/// A file of binary data, read from an offset on.
pub(super) struct Reader<'a> {
    source: &'a mut dyn Bytes,
    pub(super) order: Order,
    /// Size of the file in bytes.
    pub(super) size: u64,
    /// Offset of the next byte to read.
    pub(super) offset: u64,
}

impl<'a> Reader<'a> {
    /// Reads from the start of a file.
    pub(super) fn new(source: &'a mut dyn Bytes, order: Order) -> Result<Self, LoadError> {
        let size = source.seek(SeekFrom::End(0))?;
        source.rewind()?;
        Ok(Self { source, order, size, offset: 0 })
    }

    /// Goes to an offset, which may be after the end.
    pub(super) fn seek(&mut self, offset: u64) -> Result<(), LoadError> {
        // Nearby offsets are often in memory.
        match i64::try_from(i128::from(offset) - i128::from(self.offset)) {
            Ok(by) if by.unsigned_abs() < 1 << 10 => self.source.seek_relative(by)?,
            _ => _ = self.source.seek(SeekFrom::Start(offset))?,
        }
        self.offset = offset;
        Ok(())
    }

    /// Number of bytes that follow.
    pub(super) fn left(&self) -> u64 {
        self.size.saturating_sub(self.offset)
    }

    /// Checks that `wanted` bytes follow.
    pub(super) fn check(&self, wanted: u64, what: impl Into<String>) -> Result<(), LoadError> {
        let (offset, left) = (self.offset, self.left());
        if wanted <= left {
            return Ok(());
        }
        let what: String = what.into();
        let message = format!(
            "{what} takes {wanted} bytes, but the file ends after {left}; it is cut off or still being written"
        );
        Err(LoadError::byte(offset, message).of_kind(LoadErrorKind::CutOff))
    }

    /// Reads this number of bytes, which the file must have.
    pub(super) fn bytes(&mut self, count: u64, what: impl Into<String>) -> Result<Vec<u8>, LoadError> {
        self.check(count, what)?;
        let mut bytes = Vec::new();
        let reserved = usize::try_from(count).ok().and_then(|n| bytes.try_reserve_exact(n).ok());
        reserved.ok_or(io::Error::from(io::ErrorKind::OutOfMemory))?;
        // The count fits, because memory for it was reserved.
        bytes.resize(count as usize, 0);
        self.source.read_exact(&mut bytes)?;
        self.offset += count;
        Ok(bytes)
    }

    /// Reads one number.
    pub(super) fn number<T: Number>(&mut self, what: &str) -> Result<T, LoadError> {
        self.check(T::WIDTH as u64, what)?;
        let mut bytes = [0; 8];
        self.source.read_exact(&mut bytes[..T::WIDTH])?;
        self.offset += T::WIDTH as u64;
        Ok(T::decode(&bytes, self.order))
    }
}

/// Returns the text of a file up to the first NUL, to be shown in a message.
pub(super) fn shown(bytes: &[u8]) -> String {
    let text = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
    shortened(&String::from_utf8_lossy(text))
}

/// Names of the components of a vector, such as `velocity.x`; only the name itself if there is one component.
pub(super) fn component_names(name: &str, count: usize) -> Vec<String> {
    match count {
        1 => vec![name.to_owned()],
        2 | 3 => ["x", "y", "z"][..count].iter().map(|axis| format!("{name}.{axis}")).collect(),
        _ => (0..count).map(|index| format!("{name}.{index}")).collect(),
    }
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Scalar {
    /// Number of bytes of a number.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The value of full intensity, for the types that colours have.
    pub(super) const fn full(self) -> Option<f64> {
        match self {
            Self::U8 => Some(255.0),
            Self::U16 => Some(65535.0),
            _ => None,
        }
    }

    /// Decodes the number at the start of `bytes`; the result is 0 if there are too few, which readers check before.
    pub(super) fn decode(self, bytes: &[u8], order: Order) -> f64 {
        match self {
            Self::I8 => i8::decode(bytes, order).into(),
            Self::U8 => u8::decode(bytes, order).into(),
            Self::I16 => i16::decode(bytes, order).into(),
            Self::U16 => u16::decode(bytes, order).into(),
            Self::I32 => i32::decode(bytes, order).into(),
            Self::U32 => u32::decode(bytes, order).into(),
            Self::I64 => i64::decode(bytes, order) as f64,
            Self::U64 => u64::decode(bytes, order) as f64,
            Self::F32 => f32::decode(bytes, order).into(),
            Self::F64 => f64::decode(bytes, order),
        }
    }

    /// Reads a number from text as a binary file would have it.
    pub(super) fn parse(self, text: &str) -> Option<f64> {
        match self {
            Self::F32 => text.parse::<f32>().ok().map(f64::from),
            _ => text.parse().ok(),
        }
    }
}

/// Parses a number, also with an exponent as Fortran writes it (`1.5D-3`), `nan` and `inf`.
#[inline]
pub(super) fn number(text: &[u8]) -> Option<f64> {
    short_decimal(text).or_else(|| any_number(text))
}

fn any_number(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?;
    text.parse().or_else(|_| text.replace(['d', 'D'], "e").parse()).ok()
}

/// Parses a decimal number with at most 15 digits and no exponent. f64 holds its digits, as an integer, and the power
/// of ten exactly, so one division rounds correctly. (W. D. Clinger, "How to read floating point numbers accurately",
/// PLDI 1990.)
#[inline]
fn short_decimal(text: &[u8]) -> Option<f64> {
    const TENS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let (is_negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        digits => (false, digits),
    };
    // A dot counts as one of the bytes.
    if digits.len() > 16 {
        return None;
    }
    let (mut integer, mut count, mut decimals) = (0_u64, 0, None);
    for byte in digits {
        match byte {
            b'0'..=b'9' => {
                integer = 10 * integer + u64::from(byte - b'0');
                count += 1;
            }
            b'.' if decimals.is_none() => decimals = Some(count),
            _ => return None,
        }
    }
    if count == 0 || count > 15 {
        return None;
    }
    let decimals: usize = decimals.map_or(0, |before| count - before);
    let value = integer as f64 / TENS[decimals];
    Some(if is_negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_standard_library() {
        let mut random = fastrand::Rng::with_seed(5);
        for _ in 0..200_000 {
            let digits = random.usize(1..19);
            let mut text: String = (0..digits).map(|_| random.digit(10)).collect();
            if random.bool() {
                text.insert(random.usize(..=digits), '.');
            }
            if random.bool() {
                text.insert(0, '-');
            }
            let wanted: f64 = text.parse().unwrap();
            assert_eq!(number(text.as_bytes()).map(f64::to_bits), Some(wanted.to_bits()), "{text}");
        }
    }

    #[test]
    fn ways_to_write_a_number() {
        for (text, wanted) in [
            ("1e3", 1e3),
            ("1.5D-3", 1.5e-3),
            ("-0", 0.0),
            ("+2.5", 2.5),
            (".5", 0.5),
            ("5.", 5.0),
            ("inf", f64::INFINITY),
        ] {
            assert!(number(text.as_bytes()) == Some(wanted), "{text}");
        }
        assert!(number(b"NaN").is_some_and(f64::is_nan));
        for text in ["", "-", ".", "1,5", "1 2", "x", "1.2.3", "--1", "0x10", "\u{e9}"] {
            assert_eq!(number(text.as_bytes()), None, "{text}");
        }
    }
}
