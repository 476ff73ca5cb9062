//! Judging operations whose results may be rounded.

use super::float::{PAD, error_in_ulp, is_neighbour, neighbours, relative_error};
use super::records::{Arithmetic, Operands};
use super::report::{Tally, TestedProperty, percent};
use crate::verify::{DIVIDE_UNITS, SQRT_ULP, gamma};

/// Maximum allowed error of 1/√x in ULP. The bounds of other operations are those of the checker.
const INVERSE_SQRT: f64 = 2.0;

/// Maximum allowed error of a dot product of three components, relative to the sum of the absolute products.
const DOT: f64 = gamma(3);

/// Bound of the rounding errors of the sums in f64.
const DOT_PAD: f64 = 4.0 * f64::EPSILON;

type Pair<'a> = (&'a Operands, &'a Arithmetic);

/// All properties of operations whose results may be rounded.
pub(super) fn judge(operands: &[Operands], answers: &[Arithmetic]) -> Vec<TestedProperty> {
    let pairs: Vec<Pair<'_>> = operands.iter().zip(answers).collect();
    vec![
        fence(&pairs),
        add_multiply(&pairs),
        divide(&pairs),
        sqrt(&pairs),
        inverse_sqrt(&pairs),
        dot(&pairs),
    ]
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
        tally.check(wide(back) == wide(sum) - wide(a), || {
            format!("({a:e} + {b:e}) - {a:e}, which gives {back:e}")
        });
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
    let words = format!(
        "fenced sums, differences and products are as written, {} of them; {reassociates}",
        tally.tested()
    );
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

/// How the error of a result is measured.
struct Measure {
    of: fn(f32, f64) -> f64,
    /// In words, after the number.
    unit: &'static str,
    /// The names of figures: the largest that was found, and the largest that is allowed.
    figures: [&'static str; 2],
}

const IN_ULP: Measure =
    Measure { of: error_in_ulp, unit: "ULP", figures: ["worst_ulp", "allowed_ulp"] };

/// Errors of quotients, which may be products of two rounded numbers.
const RELATIVE: Measure =
    Measure {
        of: relative_error, unit: "· 2⁻²³ of it", figures: ["worst_units", "allowed_units"]
    };

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
        let error = if exact == 0.0 {
            if got == 0.0 { 0.0 } else { f64::INFINITY }
        } else {
            of(got, exact)
        };
        // A NaN fails this comparison.
        tally.check(error <= bound + PAD, || {
            format!("{} = {got:e}, off by {error:.2} {unit}", what())
        });
        worst = worst.max(error);
    }
    let words =
        format!("the worst of {} is off by {worst:.2} {unit}; {bound} are allowed", tally.tested());
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
    let results = pairs.iter().map(|&(o, answer)| {
        (move || format!("sqrt({:e})", o.radicand), answer.root, f64::from(o.radicand).sqrt())
    });
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
        tally.check(error <= DOT + DOT_PAD, || {
            format!("dot({:?}, {:?}) = {:e}", o.u, o.v, answer.dot)
        });
        worst = worst.max(error);
    }
    let share = 100.0 * worst / DOT;
    let words = format!(
        "the worst of {} errors is {share:.0} % of the largest allowed, 3 roundings",
        tally.tested()
    );
    tally.property("dot", words, vec![("worst_percent_of_allowed", share)])
}
