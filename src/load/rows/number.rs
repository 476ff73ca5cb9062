//! Parses numbers.

/// Parses a number, also with an exponent as Fortran writes it (`1.5D-3`), `nan` and `inf`.
#[inline]
pub(in crate::load) fn number(text: &[u8]) -> Option<f64> {
    short_decimal(text).or_else(|| any_number(text))
}

fn any_number(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?;
    text.parse().or_else(|_| text.replace(['d', 'D'], "e").parse()).ok()
}

/// Parses a decimal number with at most 15 digits and no exponent: its digits are an integer that f64 holds exactly, as it
/// does the power of ten, so one division rounds correctly. (W. D. Clinger, "How to read floating point numbers
/// accurately", PLDI 1990.)
#[inline]
fn short_decimal(text: &[u8]) -> Option<f64> {
    const TENS: [f64; 16] =
        [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
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
