//! Judging operations whose results must be exact, and the treatment of subnormal numbers.

use super::float::is_neighbour;
use super::records::{Exact, Values};
use super::report::{PropertyOutcome, Tally, TestedProperty, percent};

pub(super) fn judge(values: &[Values], answers: &[Exact]) -> Vec<TestedProperty> {
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
                format!(
                    "the {operation} of {v:?} is {got:e}, which is neither kept nor flushed to zero"
                )
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

/// All operations, and whether their results are the same as on the CPU.
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
        // In WGSL the result for zero is all ones.
        ("firstTrailingBit(i)", got.lowest == if i == 0 { u32::MAX } else { i.trailing_zeros() }),
    ]
}
