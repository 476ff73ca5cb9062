//! Tests that a device that computes like the CPU passes, and that a fault in one result makes the right property fail.

use crate::gpu::self_test::records::{Arithmetic, Exact, Operands, Values};
use crate::gpu::self_test::report::{PropertyOutcome, TestedProperty};
use crate::gpu::self_test::{records, rounding};

const COUNT: usize = 256;

fn two_sum(a: f32, b: f32) -> [f32; 3] {
    let sum = a + b;
    let back = sum - a;
    [sum, back, (a - (sum - back)) + (b - back)]
}

fn honest_arithmetic(o: &Operands) -> Arithmetic {
    let [sum, back, error] = two_sum(o.a, o.b);
    let inverted = if o.radicand == 0.0 { 1.0 } else { o.radicand };
    Arithmetic {
        sum,
        back,
        error,
        unfenced_error: 0.0,
        scaled: o.p * o.factor + o.q * o.factor,
        difference: o.a - o.b,
        product: o.a * o.b,
        quotient: o.dividend / o.divisor,
        root: o.radicand.sqrt(),
        inverse_root: (1.0 / f64::from(inverted).sqrt()) as f32,
        dot: o.u[0] * o.v[0] + o.u[1] * o.v[1] + o.u[2] * o.v[2],
    }
}

fn honest_exact(v: &Values) -> Exact {
    let Values { f, g, i, j, .. } = *v;
    let orders = [f < g, f <= g, f == g, f != g, f >= g, f > g];
    Exact {
        from_whole: v.whole as f32,
        truncated: f as i32,
        unsigned: f as u32,
        floored: f.floor(),
        smaller: if g < f { g } else { f },
        larger: if g > f { g } else { f },
        selected: if i < j { g } else { f },
        comparisons: orders.iter().rev().fold(0, |bits, is| bits << 1 | u32::from(*is)),
        bits: f.to_bits() + 1,
        from_bits: -g,
        added: i.wrapping_add(j),
        subtracted: i.wrapping_sub(j),
        multiplied: i.wrapping_mul(j),
        divided: i / j,
        remainder: i % j,
        shifted_left: i.wrapping_shl(j),
        shifted_right: i.wrapping_shr(j),
        ones: i.count_ones(),
        lowest: i.checked_ilog2().map_or(u32::MAX, |_| i.trailing_zeros()),
        tiny_difference: v.small - v.other,
        tiny_product: v.small * v.scale,
        tiny_sum: v.tiny + v.speck,
    }
}

/// The properties that fail after `plant` has changed one result.
fn failing_arithmetic(at: usize, plant: impl Fn(&Operands, &mut Arithmetic)) -> Vec<&'static str> {
    let operands = records::operands(COUNT);
    let mut answers: Vec<_> = operands.iter().map(honest_arithmetic).collect();
    plant(&operands[at], &mut answers[at]);
    names_of_failing(&rounding::judge(&operands, &answers))
}

fn failing_exact(at: usize, plant: impl Fn(&Values, &mut Exact)) -> Vec<&'static str> {
    let values = records::values(COUNT);
    let mut answers: Vec<_> = values.iter().map(honest_exact).collect();
    plant(&values[at], &mut answers[at]);
    names_of_failing(&rounding::judge_exact(&values, &answers))
}

fn names_of_failing(properties: &[TestedProperty]) -> Vec<&'static str> {
    properties.iter().filter(|property| !property.passed()).map(|property| property.name).collect()
}

/// Moves a number away from zero by `neighbours` steps of f32.
fn off(number: &mut f32, neighbours: u32) {
    *number = f32::from_bits(number.to_bits() + neighbours);
}

#[test]
fn an_honest_device_passes() {
    assert!(failing_arithmetic(0, |_, _| ()).is_empty());
    assert!(failing_exact(0, |_, _| ()).is_empty());
}

#[test]
fn no_answers_fail() {
    for properties in [rounding::judge(&[], &[]), rounding::judge_exact(&[], &[])] {
        assert_eq!(names_of_failing(&properties).len(), properties.len());
    }
}

/// Tests results of compilers that rewrite expressions as if there were no fences.
#[test]
fn fences_that_leak_are_found() {
    let is_fence = |names: Vec<&str>| names == ["fence"];
    let found = |plant: fn(&Operands, &mut Arithmetic)| {
        (0..COUNT).filter(|at| is_fence(failing_arithmetic(*at, plant))).count()
    };
    // A few sums have no rounding error, and a few products do not change.
    assert!(found(|_, answer| answer.error = 0.0) > COUNT * 9 / 10);
    assert!(found(|o, answer| answer.back = o.b) > COUNT * 9 / 10);
    assert!(found(|o, answer| answer.scaled = (o.p + o.q) * o.factor) > COUNT * 9 / 10);
    assert!(found(|o, answer| answer.scaled = o.p.mul_add(o.factor, o.q * o.factor)) > COUNT / 2);
    assert!(found(|_, answer| answer.error = f32::NAN) == COUNT);
}

#[test]
fn unfenced_sums_are_counted_and_may_be_anything() {
    let operands = records::operands(COUNT);
    let mut answers: Vec<_> = operands.iter().map(honest_arithmetic).collect();
    let share = |answers: &[Arithmetic]| {
        let fence = &rounding::judge(&operands, answers)[0];
        assert!(fence.passed());
        let (_, percent) = fence.figures.iter().find(|(name, _)| *name == "unfenced_rewritten_percent").unwrap();
        (*percent, fence.words.contains("reassociates"))
    };
    assert_eq!(share(&answers), (100.0, true));
    answers.iter_mut().for_each(|answer| answer.unfenced_error = answer.error);
    assert_eq!(share(&answers), (0.0, false));
}

#[test]
fn a_sum_a_difference_and_a_product_beyond_the_neighbours_are_found() {
    let off_by_two: [fn(&mut Arithmetic); 3] = [
        |answer| off(&mut answer.sum, 2),
        |answer| off(&mut answer.difference, 2),
        |answer| off(&mut answer.product, 2),
    ];
    for plant in off_by_two {
        let names = failing_arithmetic(5, |_, answer| plant(answer));
        assert!(names.contains(&"add_multiply"), "{names:?}");
    }
}

/// A device may round down. Half of its results are then not the nearest numbers.
#[test]
fn rounding_down_is_legal() {
    let operands = records::operands(COUNT);
    let mut answers: Vec<_> = operands.iter().map(honest_arithmetic).collect();
    for (o, answer) in operands.iter().zip(&mut answers) {
        let (a, b) = (f64::from(o.a), f64::from(o.b));
        if f64::from(answer.product) > a * b {
            answer.product = answer.product.next_down();
        }
        if f64::from(answer.sum) > a + b {
            answer.sum = answer.sum.next_down();
            answer.back = answer.sum - o.a;
            answer.error = (o.a - (answer.sum - answer.back)) + (o.b - answer.back);
        }
    }
    let properties = rounding::judge(&operands, &answers);
    assert_eq!(names_of_failing(&properties), [""; 0]);
    let nearest = properties[1].figures.iter().find(|(name, _)| *name == "nearest_percent");
    assert!((50.0..90.0).contains(&nearest.unwrap().1), "{nearest:?}");
}

#[test]
fn errors_beyond_their_bounds_are_found() {
    type Field = fn(&mut Arithmetic) -> &mut f32;
    let bounded: [(&str, u32, Field); 2] =
        [("sqrt", 4, |answer| &mut answer.root), ("inverse_sqrt", 1, |answer| &mut answer.inverse_root)];
    for (name, allowed, field) in bounded {
        let failing = |neighbours| failing_arithmetic(3, |_, a| off(field(a), neighbours));
        assert!(failing(allowed).is_empty(), "{name}");
        // The error of the correct result may have the opposite sign.
        assert_eq!(failing(allowed + 2), [name]);
        for wrong in [f32::NAN, f32::INFINITY, 0.0] {
            assert_eq!(failing_arithmetic(3, |_, answer| *field(answer) = wrong), [name], "{wrong}");
        }
    }
    // The error of a quotient is measured relative to the quotient, not in ULP.
    let divide = |units: f32| failing_arithmetic(3, |_, answer| answer.quotient *= 1.0 + units * f32::EPSILON);
    assert!(divide(3.0).is_empty() && divide(-3.0).is_empty());
    for wrong in [5.0, -5.0, f32::NAN, f32::INFINITY] {
        assert_eq!(divide(wrong), ["divide"], "{wrong}");
    }
    // The first radicand is zero, whose root must be zero of either sign.
    assert_eq!(failing_arithmetic(0, |_, answer| answer.root = f32::MIN_POSITIVE), ["sqrt"]);
    assert!(failing_arithmetic(0, |_, answer| answer.root = -0.0).is_empty());
}

#[test]
fn a_dot_product_of_less_precision_is_found() {
    // The mantissa is cut to the width of an f16's mantissa.
    let narrowed = |v: f32| f32::from_bits(v.to_bits() & !0x1fff);
    let names = (0..COUNT).map(|at| failing_arithmetic(at, |_, a| a.dot = narrowed(a.dot)));
    assert!(names.filter(|names| names == &["dot"]).count() > COUNT / 2);
    assert_eq!(failing_arithmetic(3, |_, answer| answer.dot = f32::NAN), ["dot"]);
}

#[test]
fn every_operation_that_is_not_exact_is_found() {
    let faults: [fn(&mut Exact); 19] = [
        |answer| off(&mut answer.from_whole, 1),
        |answer| answer.truncated += 1,
        |answer| answer.unsigned += 1,
        |answer| answer.floored -= 1.0,
        |answer| off(&mut answer.smaller, 1),
        |answer| off(&mut answer.larger, 1),
        |answer| off(&mut answer.selected, 1),
        |answer| answer.comparisons ^= 4,
        |answer| answer.bits += 1,
        |answer| off(&mut answer.from_bits, 1),
        |answer| answer.added ^= 1,
        |answer| answer.subtracted ^= 1,
        |answer| answer.multiplied ^= 1,
        |answer| answer.divided ^= 1,
        |answer| answer.remainder ^= 1,
        |answer| answer.shifted_left ^= 1,
        |answer| answer.shifted_right ^= 1,
        |answer| answer.ones += 1,
        |answer| answer.lowest ^= 1,
    ];
    // An input whose f is so small that its floor can change by one.
    let values = records::values(COUNT);
    let at = values.iter().position(|v| v.f.abs() < 1000.0).unwrap();
    for (index, fault) in faults.iter().enumerate() {
        let names = failing_exact(at, |_, answer| fault(answer));
        assert_eq!(names, ["comparison_and_conversion"], "fault {index}");
    }
}

#[test]
fn subnormals_may_be_flushed_and_nothing_else() {
    let values = records::values(COUNT);
    let judged = |answers: &[Exact]| rounding::judge_exact(&values, answers).swap_remove(0);
    let mut answers: Vec<_> = values.iter().map(honest_exact).collect();
    let kept = judged(&answers);
    assert_eq!((kept.name, kept.outcome), ("subnormals", PropertyOutcome::Noted));
    assert!(kept.words.contains("are kept;"), "{kept}");
    for answer in &mut answers {
        (answer.tiny_difference, answer.tiny_product) = (0.0, -0.0);
    }
    let mixed = judged(&answers);
    assert!(mixed.passed() && mixed.words.contains("0.0 % of differences"), "{mixed}");
    answers.iter_mut().for_each(|answer| answer.tiny_sum = 0.0);
    let flushed = judged(&answers);
    assert!(flushed.passed() && flushed.words.contains("flushed to zero;"), "{flushed}");
    for plant in [
        (|answer| answer.tiny_difference = f32::MIN_POSITIVE) as fn(&mut Exact),
        |answer| answer.tiny_product = f32::MIN_POSITIVE,
        |answer| answer.tiny_sum = f32::MIN_POSITIVE,
    ] {
        assert_eq!(failing_exact(2, |_, answer| plant(answer)), ["subnormals"]);
    }
}
