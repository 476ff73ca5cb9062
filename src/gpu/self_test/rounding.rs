//! Judging operations whose results may be rounded, and operations whose results must be exact.

use crate::gpu::self_test::records::{Arithmetic, Exact, Operands, Values};
use crate::gpu::self_test::report::{PropertyOutcome, Tally, TestedProperty, percent};
use crate::verify::{DIVIDE_UNITS, SQRT_ULP, gamma};

/// Maximum allowed error of 1/√x in ULP. Other operations have the bounds of the checker.
const INVERSE_SQRT: f64 = 2.0;

/// Maximum allowed error of a dot product of three components, relative to the sum of the absolute products.
const DOT: f64 = gamma(3);

/// Bound of the rounding errors of the sums in f64.
const DOT_PAD: f64 = 4.0 * f64::EPSILON;

type Pair<'a> = (&'a Operands, &'a Arithmetic);

/// All properties of operations whose results may be rounded.
pub(super) fn judge(operands: &[Operands], answers: &[Arithmetic]) -> Vec<TestedProperty> {
    let pairs: Vec<Pair<'_>> = operands.iter().zip(answers).collect();
    vec![fence(&pairs), add_multiply(&pairs), divide(&pairs), sqrt(&pairs), inverse_sqrt(&pairs), dot(&pairs)]
}

fn fence(pairs: &[Pair<'_>]) -> TestedProperty {
    let mut tally = Tally::default();
    let (mut unfenced, mut tested) = (0, 0);
    for (o, answer) in pairs {
        let Operands { a, b, p, q, factor, .. } = **o;
        let Arithmetic { sum, back, error, unfenced_error, scaled, .. } = **answer;
        let wide = f64::from;
        tally.check(wide(sum) + wide(error) == wide(a) + wide(b), || {
            format!("TwoSum of {a:e} and {b:e}, which gives {sum:e} and {error:e}")
        });
        // This difference is exact, because |a| >= |b|.
        tally.check(wide(back) == wide(sum) - wide(a), || format!("({a:e} + {b:e}) - {a:e}, which gives {back:e}"));
        tally.check(is_sum_of_products(scaled, p, q, factor), || {
            format!("{p:e}*{factor:e} + {q:e}*{factor:e}, which gives {scaled:e}")
        });
        // If the sum has no rounding error, zero is the right result.
        if error != 0.0 {
            tested += 1;
            unfenced += usize::from(unfenced_error != error);
        }
    }
    let rewritten = percent(unfenced, tested);
    let reassociates = if unfenced == 0 {
        "this compiler does not rewrite unfenced ones".to_owned()
    } else {
        format!("this compiler reassociates: {rewritten:.1} % of unfenced sums that round")
    };
    let words =
        format!("fenced sums, differences and products are as written, {} of them; {reassociates}", tally.tested());
    tally.property("fence", words, vec![("unfenced_rewritten_percent", rewritten)])
}

/// Whether a result is p d + q d with a rounding after each of the three operations.
fn is_sum_of_products(got: f32, p: f32, q: f32, d: f32) -> bool {
    let product = |v: f32| neighbours(f64::from(v) * f64::from(d)).map(f64::from);
    let second = product(q);
    product(p).iter().any(|p| second.iter().any(|q| is_neighbour(got, p + q)))
}

fn add_multiply(pairs: &[Pair<'_>]) -> TestedProperty {
    let mut tally = Tally::default();
    let mut nearest = 0;
    for (Operands { a, b, .. }, answer) in pairs {
        let (wide_a, wide_b) = (f64::from(*a), f64::from(*b));
        for (sign, got, exact) in [
            ('+', answer.sum, wide_a + wide_b),
            ('-', answer.difference, wide_a - wide_b),
            ('*', answer.product, wide_a * wide_b),
        ] {
            tally.check(is_neighbour(got, exact), || format!("{a:e} {sign} {b:e} = {got:e}"));
            nearest += usize::from(got == exact as f32);
        }
    }
    let nearest = percent(nearest, tally.tested());
    let words = format!(
        "all of {} sums, differences and products are neighbours of the exact one; {nearest:.1} % are the \
         nearest",
        tally.tested()
    );
    tally.property("add_multiply", words, vec![("nearest_percent", nearest)])
}

/// A measure of the error of a result.
struct Measure {
    of: fn(f32, f64) -> f64,
    /// The unit in words, which follow the number.
    unit: &'static str,
    /// The names of two figures: the largest error that was found, and the largest that is allowed.
    figures: [&'static str; 2],
}

const IN_ULP: Measure = Measure { of: error_in_ulp, unit: "ULP", figures: ["worst_ulp", "allowed_ulp"] };

/// Errors of quotients, which may be products of two rounded numbers.
const RELATIVE: Measure =
    Measure { of: relative_error, unit: "· 2⁻²³ of it", figures: ["worst_units", "allowed_units"] };

/// Judges results whose errors are bounded. Each has a description, the result of the device and the exact value.
fn within<W: Fn() -> String>(
    name: &'static str,
    bound: f64,
    Measure { of, unit, figures: [found, allowed] }: Measure,
    results: impl Iterator<Item = (W, f32, f64)>,
) -> TestedProperty {
    let mut tally = Tally::default();
    let mut worst = 0.0_f64;
    for (what, got, exact) in results {
        let error = if exact == 0.0 { if got == 0.0 { 0.0 } else { f64::INFINITY } } else { of(got, exact) };
        // A NaN fails this comparison.
        tally.check(error <= bound + PAD, || format!("{} = {got:e}, off by {error:.2} {unit}", what()));
        worst = worst.max(error);
    }
    let words = format!("the worst of {} is off by {worst:.2} {unit}; {bound} are allowed", tally.tested());
    tally.property(name, words, vec![(found, worst), (allowed, bound)])
}

fn divide(pairs: &[Pair<'_>]) -> TestedProperty {
    let results = pairs.iter().map(|&(o, answer)| {
        let exact = f64::from(o.dividend) / f64::from(o.divisor);
        (move || format!("{:e} / {:e}", o.dividend, o.divisor), answer.quotient, exact)
    });
    within("divide", DIVIDE_UNITS, RELATIVE, results)
}

fn sqrt(pairs: &[Pair<'_>]) -> TestedProperty {
    let results = pairs
        .iter()
        .map(|&(o, answer)| (move || format!("sqrt({:e})", o.radicand), answer.root, f64::from(o.radicand).sqrt()));
    within("sqrt", SQRT_ULP, IN_ULP, results)
}

fn inverse_sqrt(pairs: &[Pair<'_>]) -> TestedProperty {
    // The kernel replaces 0 by 1.
    let results = pairs.iter().filter(|(o, _)| o.radicand != 0.0).map(|&(o, answer)| {
        let exact = 1.0 / f64::from(o.radicand).sqrt();
        (move || format!("inverseSqrt({:e})", o.radicand), answer.inverse_root, exact)
    });
    within("inverse_sqrt", INVERSE_SQRT, IN_ULP, results)
}

fn dot(pairs: &[Pair<'_>]) -> TestedProperty {
    let mut tally = Tally::default();
    let mut worst = 0.0_f64;
    for (o, answer) in pairs {
        let products = [0, 1, 2].map(|axis| f64::from(o.u[axis]) * f64::from(o.v[axis]));
        let size: f64 = products.iter().map(|product| product.abs()).sum();
        let error = (f64::from(answer.dot) - products.iter().sum::<f64>()).abs() / size;
        tally.check(error <= DOT + DOT_PAD, || format!("dot({:?}, {:?}) = {:e}", o.u, o.v, answer.dot));
        worst = worst.max(error);
    }
    let share = 100.0 * worst / DOT;
    let words = format!("the worst of {} errors is {share:.0} % of the largest allowed, 3 roundings", tally.tested());
    tally.property("dot", words, vec![("worst_percent_of_allowed", share)])
}

pub(super) fn judge_exact(values: &[Values], answers: &[Exact]) -> Vec<TestedProperty> {
    vec![subnormals(values, answers), comparison_and_conversion(values, answers)]
}

/// The results of three operations with subnormal numbers, and the exact results.
fn of_subnormals(v: &Values, answer: &Exact) -> [(&'static str, f32, f64); 3] {
    let wide = f64::from;
    [
        ("difference", answer.tiny_difference, wide(v.small) - wide(v.other)),
        ("product", answer.tiny_product, wide(v.small) * wide(v.scale)),
        ("sum", answer.tiny_sum, wide(v.tiny) + wide(v.speck)),
    ]
}

fn subnormals(values: &[Values], answers: &[Exact]) -> TestedProperty {
    let mut tally = Tally::default();
    // For each operation, the number of results that were kept and the number of all results.
    let mut kept = [(0, 0); 3];
    for (v, answer) in values.iter().zip(answers) {
        for (count, (operation, got, exact)) in kept.iter_mut().zip(of_subnormals(v, answer)) {
            // A device may flush one subnormal operand of a sum, or both.
            let is_operand = operation == "sum" && (got == v.tiny || got == v.speck);
            tally.check(got == 0.0 || is_operand || is_neighbour(got, exact), || {
                format!("the {operation} of {v:?} is {got:e}, which is neither kept nor flushed to zero")
            });
            if exact.abs() >= f64::from(f32::from_bits(1)) {
                count.0 += usize::from(got != 0.0);
                count.1 += 1;
            }
        }
    }
    let shares = kept.map(|(kept, all)| percent(kept, all));
    let words = match kept.map(|(kept, all)| (kept == 0, kept == all)) {
        all if all.iter().all(|(_, is_kept)| *is_kept) => "are kept".to_owned(),
        all if all.iter().all(|(is_flushed, _)| *is_flushed) => "are flushed to zero".to_owned(),
        _ => format!(
            "are kept of {:.1} % of differences, {:.1} % of products and {:.1} % of sums, and else flushed \
             to zero",
            shares[0], shares[1], shares[2]
        ),
    };
    let [differences, products, sums] = shares;
    let figures = vec![
        ("kept_differences_percent", differences),
        ("kept_products_percent", products),
        ("kept_sums_percent", sums),
    ];
    let words = format!("subnormal numbers {words}; either is legal");
    let mut property = tally.property("subnormals", words, figures);
    if property.passed() {
        property.outcome = PropertyOutcome::Noted;
    }
    property
}

fn comparison_and_conversion(values: &[Values], answers: &[Exact]) -> TestedProperty {
    let mut tally = Tally::default();
    for (v, got) in values.iter().zip(answers) {
        for (operation, holds) in operations(v, got) {
            tally.check(holds, || format!("{operation} of {v:?}"));
        }
    }
    let words = format!("all of {} results are exact", tally.tested());
    tally.property("comparison_and_conversion", words, Vec::new())
}

/// All exact operations, and whether their results are the same as on the CPU.
fn operations(v: &Values, got: &Exact) -> [(&'static str, bool); 19] {
    let Values { f, g, whole, i, j, .. } = *v;
    let orders = [f < g, f <= g, f == g, f != g, f >= g, f > g];
    let comparisons = (0..).zip(orders).fold(0, |bits, (bit, is)| bits | u32::from(is) << bit);
    // The kernel shifts by these numbers of bits.
    let shift = j & 31;
    [
        ("f32(whole)", f64::from(got.from_whole) == f64::from(whole)),
        ("i32(f)", got.truncated == f as i32),
        ("u32(max(f, 0))", got.unsigned == f.max(0.0) as u32),
        ("floor(f)", got.floored == f.floor()),
        ("min(f, g)", got.smaller == f.min(g)),
        ("max(f, g)", got.larger == f.max(g)),
        ("select(f, g, i < j)", got.selected == if i < j { g } else { f }),
        ("a comparison of f and g", got.comparisons == comparisons),
        ("bitcast<u32>(f) + 1", got.bits == f.to_bits() + 1),
        ("bitcast<f32>(bits of -g)", got.from_bits == -g),
        ("i + j", got.added == i.wrapping_add(j)),
        ("i - j", got.subtracted == i.wrapping_sub(j)),
        ("i * j", got.multiplied == i.wrapping_mul(j)),
        ("i / j", i.checked_div(j) == Some(got.divided)),
        ("i % j", i.checked_rem(j) == Some(got.remainder)),
        ("i << j", got.shifted_left == i << shift),
        ("i >> j", got.shifted_right == i >> shift),
        ("countOneBits(i)", got.ones == i.count_ones()),
        // In WGSL, the result for zero has all bits set.
        ("firstTrailingBit(i)", got.lowest == if i == 0 { u32::MAX } else { i.trailing_zeros() }),
    ]
}

/// Bound of the errors of f64 quotients and roots, which are less than 2⁻⁵⁰ of the value, in ULP of f32.
pub(super) const PAD: f64 = 1.0 / (1_u64 << 26) as f64;

/// Whether `got` is the exact value, or one of the two f32 that enclose it.
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

/// The largest f32 that is not greater than the exact value, and the smallest f32 that is not less.
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
