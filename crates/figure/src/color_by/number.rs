//! Short texts of numbers for notes and legends.

/// Writes a number with at most six significant digits, as C's `%g` does.
///
/// ```
/// use pinhole_figure::color_by::number::short;
/// assert_eq!([0.1 + 0.2, 1234567.0, 2.5e-7, -3.0].map(short), ["0.3", "1.23457e6", "2.5e-7", "-3"]);
/// ```
#[must_use]
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { value.to_string() };
    }
    let scientific = format!("{value:.5e}");
    let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..6).contains(&exponent) {
        let decimals = (5 - exponent) as usize;
        return trimmed(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{exponent}", trimmed(digits))
}

/// Removes the zeros at the end of a decimal number.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_are_short_and_can_be_read_back() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (100_000.0, "100000"),
            (999_999.7, "1e6"),
            (1e-4, "0.0001"),
            (1.5e-5, "1.5e-5"),
            (-12.3456789, "-12.3457"),
            (1e300, "1e300"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(short(value), text);
        }
        assert_eq!(short(2.0 / 3.0).parse(), Ok(0.666667));
    }
}
