//! Comparing an f32 with a more exact f64.

/// Bound of the errors of f64 quotients and roots, which are less than 2⁻⁵⁰ of the value, in ULP of f32.
pub(super) const PAD: f64 = 1.0 / (1_u64 << 26) as f64;

/// Whether `got` is one of the two f32 that enclose the exact value, or the value itself.
pub(super) fn is_neighbour(got: f32, exact: f64) -> bool {
    let value = f64::from(got);
    if value < exact {
        f64::from(got.next_up()) > exact
    } else if value > exact {
        f64::from(got.next_down()) < exact
    } else {
        // This is false for NaN.
        value <= exact
    }
}

/// The largest f32 that is not greater than the exact value, and the smallest that is not less.
pub(super) fn neighbours(exact: f64) -> [f32; 2] {
    let nearest = exact as f32;
    let value = f64::from(nearest);
    if value < exact {
        [nearest, nearest.next_up()]
    } else if value > exact {
        [nearest.next_down(), nearest]
    } else {
        [nearest; 2]
    }
}

/// The distance between neighbouring f32 in the binade of a value.
fn ulp(value: f64) -> f64 {
    let exponent = ((value.to_bits() >> 52) & 0x7ff).max(1023 - 126);
    f64::from_bits((exponent - 23) << 52)
}

/// The error of `got` in ULP.
pub(super) fn error_in_ulp(got: f32, exact: f64) -> f64 {
    (f64::from(got) - exact).abs() / ulp(exact)
}

/// The error of `got`, in units of 2⁻²³ of the exact value, which is not zero.
pub(super) fn relative_error(got: f32, exact: f64) -> f64 {
    (f64::from(got) - exact).abs() / (exact.abs() * f64::from(f32::EPSILON))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TINY: f64 = 1e-12;

    #[test]
    fn neighbours_of_what_lies_between() {
        for one in [1.0_f32, -3.5, 1e-30, f32::MIN_POSITIVE, f32::MIN_POSITIVE / 4.0] {
            let [below, above] = [one, one.next_up()];
            let between = (f64::from(below) + f64::from(above)) / 2.0;
            assert_eq!(neighbours(between), [below, above]);
            for got in [below, above] {
                assert!(is_neighbour(got, between));
                assert!(is_neighbour(got, f64::from(got)));
            }
            assert!(!is_neighbour(below.next_down(), between), "{one}");
            assert!(!is_neighbour(above.next_up(), between), "{one}");
            // A value that f32 represents exactly must not be rounded.
            assert!(!is_neighbour(above, f64::from(below)), "{one}");
        }
        assert!(!is_neighbour(f32::NAN, 1.0));
        assert!(!is_neighbour(f32::INFINITY, 1.0));
        assert!(is_neighbour(-0.0, 0.0));
    }

    #[test]
    fn errors_in_ulp() {
        let ulp = f64::from(f32::EPSILON);
        assert!((error_in_ulp(1.0, 1.0 + 2.5 * ulp) - 2.5).abs() < TINY);
        assert!((error_in_ulp(-6.0, -6.0 + 4.0 * ulp) - 1.0).abs() < TINY);
        assert!((relative_error(-6.0, -6.0 * (1.0 + 2.5 * ulp)) - 2.5).abs() < 1e-5);
        assert!(relative_error(f32::NAN, 1.0).is_nan());
        let least = f64::from(f32::from_bits(1));
        assert!((error_in_ulp(0.0, least) - 1.0).abs() < TINY);
        assert!(error_in_ulp(f32::NAN, 1.0).is_nan());
        assert!(error_in_ulp(f32::INFINITY, 1.0).is_infinite());
    }
}
