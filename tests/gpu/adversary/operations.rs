//! Tests that the operations of an adversary are legal, and that their results are not always the nearest numbers.

#![expect(clippy::float_cmp, reason = "the results of roundings are compared for equality")]

use dashu_float::FBig;
use dashu_float::round::mode;
use pinhole::gpu::Headless;

use crate::any_rounding::{Adversary, Rounding};
use crate::parts;

const FENCE: &str = include_str!("../../../shaders/math/fence.wgsl");

/// The source of zero that `FENCE` needs: the last word of each question, which is zero.
const RUNTIME_ZERO: &str = "fn runtime_zero() -> u32 { return questions[0].w; }";

type Exact = FBig<mode::HalfEven, 2>;

/// A number in a precision in which no operation rounds.
fn exact(value: f32) -> Exact {
    Exact::try_from(value).unwrap().with_precision(400).value()
}

/// Whether a number is one of the two neighbours of an exact number, or zero in place of a subnormal one.
fn is_neighbour(found: f32, exactly: &Exact) -> bool {
    let above = exact(found.next_up());
    let below = exact(found.next_down());
    let is_small = found == 0.0 && exactly.to_f64().value().abs() < f64::from(f32::MIN_POSITIVE);
    is_small || (below < *exactly && *exactly < above)
}

/// Error of a number in ULP of the exact number.
fn error_in_ulp(found: f32, exactly: f64) -> f64 {
    let (_, exponent) = (exactly, exactly.abs().log2().floor());
    (f64::from(found) - exactly).abs() / 2_f64.powf(exponent - 23.0)
}

/// Random numbers. Some are nearly equal, so that sums cancel. Some have few digits, so that results are exact.
fn operands(count: usize) -> Vec<[u32; 4]> {
    let mut random = fastrand::Rng::with_seed(5);
    let number = |random: &mut fastrand::Rng| {
        let bits = random.u32(..) & 0x807f_ffff | random.u32(97..157) << 23;
        if random.u32(0..4) == 0 { bits & 0xffff_f000 } else { bits }
    };
    (0..count)
        .map(|_| {
            let [a, b, c] = [0; 3].map(|_| number(&mut random));
            let near = |bits: u32, random: &mut fastrand::Rng| bits ^ 0x8000_0000 ^ random.u32(0..64);
            match random.u32(0..4) {
                0 => [a, near(a, &mut random), c, 0],
                1 => {
                    let product = f32::from_bits(a) * f32::from_bits(b);
                    [a, b, near(product.to_bits(), &mut random), 0]
                }
                _ => [a, b, c, 0],
            }
        })
        .collect()
}

/// Computes several results in kernels with the operations of an adversary.
fn answers(headless: &Headless, adversary: Adversary, questions: &[[u32; 4]]) -> [Vec<[f32; 4]>; 2] {
    let operations = adversary.operations(adversary.seed);
    let of = |results: &str| {
        let answer = format!(
            "fn answer(q: vec4u) -> vec4u {{
                adv_begin(q.x);
                let a = bitcast<f32>(q.x);
                let b = bitcast<f32>(q.y);
                let c = bitcast<f32>(q.z);
                return bitcast<vec4u>(vec4f({results}));
            }}"
        );
        let parts = [RUNTIME_ZERO, FENCE, &operations, &answer];
        let answers = parts::answers(headless, &parts, &[], questions);
        answers.into_iter().map(|answer| answer.map(f32::from_bits)).collect()
    };
    [
        of("adv_add(a, b), adv_mul(a, b), adv_div(a, b), adv_fma(a, b, c)"),
        of("adv_sqrt(abs(a)), adv_sub(a, c), adv_mul(b, c), adv_div_inverse(a, b)"),
    ]
}

pub(super) fn are_legal(headless: &Headless, rounding: Rounding) {
    let questions = operands(1 << 14);
    let [first, second] = answers(headless, Adversary::new(rounding, 7), &questions);
    let (mut otherwise, mut inexact) = ([0; 2], [0; 2]);
    let mut farthest = [0.0_f64; 3];
    for ((question, first), second) in questions.iter().zip(&first).zip(&second) {
        let [a, b, c, _] = question.map(f32::from_bits);
        let [wide_a, wide_b] = [a, b].map(f64::from);
        let product = exact(a) * exact(b);
        let results = [
            ("a + b", first[0], exact(a) + exact(b)),
            ("a - c", second[1], exact(a) - exact(c)),
            ("a * b", first[1], product.clone()),
            ("b * c", second[2], exact(b) * exact(c)),
        ];
        for (at, (name, found, exactly)) in results.into_iter().enumerate() {
            assert!(is_neighbour(found, &exactly), "{rounding:?}: {name} of {a:e}, {b:e}, {c:e}: {found:e}");
            let nearest = exactly.to_f32().value();
            otherwise[at / 2] += u32::from(found != nearest);
            inexact[at / 2] += u32::from(exact(nearest) != exactly);
        }
        let apart = first[1];
        let fused = product + exact(c);
        assert!(
            is_neighbour(first[3], &fused) || first[3] == apart + c,
            "{rounding:?}: fma of {a:e}, {b:e}, {c:e}: {:e}",
            first[3]
        );
        let errors = [
            error_in_ulp(first[2], wide_a / wide_b),
            error_in_ulp(second[0], wide_a.abs().sqrt()),
            (f64::from(second[3]) / (wide_a / wide_b) - 1.0).abs() / f64::from(f32::EPSILON),
        ];
        for (farthest, error) in farthest.iter_mut().zip(errors) {
            *farthest = farthest.max(error);
        }
    }
    let share = [0, 1].map(|at| f64::from(otherwise[at]) / f64::from(inexact[at]));
    println!(
        "{rounding:?}: {share:.2?} of inexact sums and products are not the nearest, ÷, √ and · 1/: {farthest:.2?} ULP"
    );
    assert!(share.iter().all(|share| (0.4..0.6).contains(share)), "{share:?}");
    let limits = [(2.4, 2.5), (4.4, 5.0), (2.4, 3.5)];
    for (error, (least, most)) in farthest.into_iter().zip(limits) {
        assert!(least <= error && error <= most, "{farthest:?}");
    }
}
