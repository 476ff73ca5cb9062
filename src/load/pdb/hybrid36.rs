//! Decodes residue numbers of four characters, also beyond 9999.
//!
//! In hybrid-36 (R. W. Grosse-Kunstleve, `cci.lbl.gov/hybrid_36`), 9999 is followed by A000 to ZZZZ, where every
//! character is a digit in base 36, and then by a000 to zzzz.

/// Count of the four-digit numbers in base 36 that begin with a given digit.
const BLOCK: i32 = 36 * 36 * 36;

/// Decodes a field that has no blanks around it; `None` if it is not a valid number.
pub(super) fn decode(text: &[u8]) -> Option<i32> {
    match *text {
        [first @ b'A'..=b'Z', b, c, d] => {
            base36([first, b, c, d], b'A').map(|number| number - 10 * BLOCK + 10_000)
        }
        [first @ b'a'..=b'z', b, c, d] => {
            base36([first, b, c, d], b'a').map(|number| number + 16 * BLOCK + 10_000)
        }
        _ => std::str::from_utf8(text).ok()?.parse().ok(),
    }
}

/// Decodes four digits in base 36. The digit 10 is the letter `ten`, and the letters after it follow.
fn base36(digits: [u8; 4], ten: u8) -> Option<i32> {
    digits.into_iter().try_fold(0, |number, digit| {
        let value = match digit {
            b'0'..=b'9' => digit - b'0',
            _ => digit.checked_sub(ten).filter(|letter| *letter < 26)? + 10,
        };
        Some(number * 36 + i32::from(value))
    })
}

#[cfg(test)]
mod tests {
    use super::decode;

    #[test]
    fn decimal_then_capitals_then_small_letters() {
        for (text, number) in [
            ("0", 0),
            ("-999", -999),
            ("9999", 9999),
            ("A000", 10_000),
            ("A001", 10_001),
            ("A00Z", 10_035),
            ("A010", 10_036),
            ("ZZZZ", 1_223_055),
            ("a000", 1_223_056),
            ("zzzz", 2_436_111),
        ] {
            assert_eq!(decode(text.as_bytes()), Some(number), "{text}");
        }
    }

    #[test]
    fn neither() {
        for text in ["", "A00", "A0a0", "a0A0", "A 00", "1A00", "A00-", "*", "****", "1.5", "--1"] {
            assert_eq!(decode(text.as_bytes()), None, "{text}");
        }
    }
}
