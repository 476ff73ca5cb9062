//! Tests that numbers contain the exact result, and the results of devices that round arbitrarily.

use dashu_float::round::mode;
use dashu_float::{Context, FBig};
use fastrand::Rng;

use super::*;
use crate::verify::choices::Choices;
use crate::verify::rounding::SQRT_ULP;

type Exact = FBig<mode::HalfEven, 2>;

/// A precision far beyond every bound.
const BITS: usize = 200;

#[derive(Debug)]
enum Formula {
    Leaf(f32),
    Sum(Vec<Self>),
    Product(Vec<Self>),
    Negative(Box<Self>),
    Quotient(Box<Self>, Box<Self>),
    Root(Box<Self>),
    Fence(Box<Self>),
    Largest(Box<Self>, Box<Self>),
}

/// A random formula. There are few different leaves, so that sums cancel.
fn formula(random: &mut Rng, leaves: &[f32], depth: u32) -> Formula {
    let part = |random: &mut Rng| formula(random, leaves, depth - 1);
    match if depth == 0 { 0 } else { random.u32(0..9) } {
        0 => Formula::Leaf(leaves[random.usize(0..leaves.len())]),
        1..=3 => Formula::Sum((0..random.usize(2..5)).map(|_| part(random)).collect()),
        4 => Formula::Product((0..random.usize(2..4)).map(|_| part(random)).collect()),
        5 => Formula::Negative(Box::new(part(random))),
        6 => {
            let above = Box::new(part(random));
            Formula::Quotient(above, Box::new(part(random)))
        }
        7 if random.bool() => Formula::Root(Box::new(part(random))),
        7 => Formula::Fence(Box::new(part(random))),
        _ => {
            let first = Box::new(part(random));
            Formula::Largest(first, Box::new(part(random)))
        }
    }
}

fn leaf(random: &mut Rng) -> f32 {
    let size = (1.0 + random.f32()) * 2_f32.powi(random.i32(-12..12));
    if random.bool() { size } else { -size }
}

impl Formula {
    fn number(&self) -> Number {
        let all =
            |parts: &[Self], join: fn(Number, Number) -> Number| parts.iter().map(Self::number).reduce(join).unwrap();
        match self {
            Self::Leaf(value) => Number::recorded(*value),
            Self::Sum(parts) => all(parts, |a, b| a + b),
            Self::Product(parts) => all(parts, |a, b| a * b),
            Self::Negative(part) => -part.number(),
            Self::Quotient(a, b) => a.number() / b.number(),
            Self::Root(part) => part.number().sqrt(),
            Self::Fence(part) => part.number().fence(),
            Self::Largest(a, b) => a.number().max(b.number()),
        }
    }

    /// The exact value; `None` if there is a division by zero.
    fn exact(&self) -> Option<Exact> {
        let context = Context::<mode::HalfEven>::new(BITS);
        let of = |value: f32| Exact::try_from(value).unwrap().with_precision(BITS).value();
        Some(match self {
            Self::Leaf(value) => of(*value),
            Self::Sum(parts) => parts.iter().map(Self::exact).try_fold(of(0.0), |sum, part| Some(sum + part?))?,
            Self::Product(parts) => parts.iter().map(Self::exact).try_fold(of(1.0), |all, part| Some(all * part?))?,
            Self::Negative(part) => -part.exact()?,
            Self::Quotient(a, b) => {
                let (a, b) = (a.exact()?, b.exact()?);
                if b == Exact::ZERO {
                    return None;
                }
                context.div(a.repr(), b.repr()).unwrap().value()
            }
            Self::Root(part) => {
                let part = part.exact()?;
                if part <= Exact::ZERO {
                    return Some(of(0.0));
                }
                context.sqrt(part.repr()).unwrap().value()
            }
            Self::Fence(part) => part.exact()?,
            Self::Largest(a, b) => {
                let (a, b) = (a.exact()?, b.exact()?);
                if a < b { b } else { a }
            }
        })
    }

    /// The result of a device. It is NaN after a division by zero, which no kernel does.
    fn device(&self, random: &mut Rng) -> f32 {
        match self {
            Self::Leaf(value) => *value,
            Self::Sum(_) => self.sum(random),
            Self::Product(parts) => {
                let mut factors: Vec<f32> = parts.iter().map(|part| part.device(random)).collect();
                random.shuffle(&mut factors);
                factors.into_iter().reduce(|a, b| round(random, wide(a) * wide(b))).unwrap()
            }
            Self::Negative(part) => -part.device(random),
            Self::Quotient(a, b) => {
                let (a, b) = (a.device(random), b.device(random));
                if b == 0.0 {
                    return f32::NAN;
                }
                quotient(random, a, b)
            }
            Self::Root(part) => {
                let part = part.device(random);
                let part = if part < 0.0 { 0.0 } else { part };
                off(random, wide(part).sqrt(), SQRT_ULP)
            }
            Self::Fence(part) => part.device(random),
            Self::Largest(a, b) => {
                let (a, b) = (a.device(random), b.device(random));
                if a > b || a.is_nan() { a } else { b }
            }
        }
    }

    /// Evaluates nested sums as one sum, with terms in random order. Products of two factors are fused at random.
    fn sum(&self, random: &mut Rng) -> f32 {
        let mut terms = Vec::new();
        self.terms(1.0, &mut terms);
        random.shuffle(&mut terms);
        let mut sum: Option<f32> = None;
        for (sign, term) in terms {
            sum = Some(match (sum, term) {
                (Some(sum), Self::Product(parts)) if parts.len() == 2 && random.bool() => {
                    let [a, b] = [&parts[0], &parts[1]].map(|part| part.device(random));
                    round(random, sign * wide(a) * wide(b) + wide(sum))
                }
                (None, term) => sign as f32 * term.device(random),
                (Some(sum), term) => {
                    let term = term.device(random);
                    round(random, sign * wide(term) + wide(sum))
                }
            });
        }
        sum.unwrap()
    }

    fn terms<'a>(&'a self, sign: f64, terms: &mut Vec<(f64, &'a Self)>) {
        match self {
            Self::Sum(parts) => parts.iter().for_each(|part| part.terms(sign, terms)),
            Self::Negative(part) => part.terms(-sign, terms),
            other => terms.push((sign, other)),
        }
    }
}

fn wide(value: f32) -> f64 {
    value.into()
}

/// Rounds to one of the two neighbours at random.
fn round(random: &mut Rng, exact: f64) -> f32 {
    let nearest = exact as f32;
    let other = match wide(nearest).total_cmp(&exact) {
        std::cmp::Ordering::Less => nearest.next_up(),
        std::cmp::Ordering::Equal => nearest,
        std::cmp::Ordering::Greater => nearest.next_down(),
    };
    let rounded = if random.bool() { nearest } else { other };
    if rounded.is_subnormal() && random.bool() { 0.0 } else { rounded }
}

/// A quotient within 2.5 ULP, or the product with such a reciprocal, if the reciprocal is a normal number.
fn quotient(random: &mut Rng, a: f32, b: f32) -> f32 {
    let inverse = off(random, 1.0 / wide(b), 2.5);
    if inverse.is_normal() && random.bool() {
        return round(random, wide(a) * wide(inverse));
    }
    off(random, wide(a) / wide(b), 2.5)
}

fn off(random: &mut Rng, exact: f64, ulps: f64) -> f32 {
    let rounded = exact as f32;
    if rounded == 0.0 || !rounded.is_finite() {
        return rounded;
    }
    let ulp = wide(rounded.abs().next_up()) - wide(rounded.abs());
    (exact + (random.f64() * 2.0 - 1.0) * (ulps - 0.5) * ulp * 0.99) as f32
}

#[test]
fn numbers_hold_exact_results_and_those_of_any_device() {
    let mut random = Rng::with_seed(12);
    let (mut narrow, mut tried) = (0, 0);
    for _ in 0..60_000 {
        let mut leaves: Vec<f32> = (0..3).map(|_| leaf(&mut random)).collect();
        leaves.push(leaves[0].next_up());
        leaves.push(1.0);
        let formula = formula(&mut random, &leaves, 4);
        let Interval { low, high } = formula.number().interval();
        assert!(low <= high);
        if let Some(exact) = formula.exact() {
            let exact = exact.to_f64().value();
            assert!(low <= exact && exact <= high, "{exact} in [{low}, {high}]");
        }
        for _ in 0..4 {
            let found = wide(formula.device(&mut random));
            if found.is_finite() {
                assert!(low <= found && found <= high, "{found} in [{low}, {high}]: {formula:?}");
            }
        }
        tried += 1;
        narrow += u32::from(high - low <= 1e-4 * low.abs().max(high.abs()));
    }
    // An interval of all numbers would be sound too, so most must be narrow.
    assert!(narrow > tried / 2, "{narrow} of {tried}");
}

/// A device's result for the polynomial c0 + x (c1 + …).
fn polynomial(random: &mut Rng, x: f32, coefficients: &[f64]) -> f32 {
    let mut sum = 0.0_f32;
    for c in coefficients.iter().rev() {
        let c = round(random, *c);
        sum = if random.bool() {
            round(random, wide(x) * wide(sum) + wide(c))
        } else {
            let product = round(random, wide(x) * wide(sum));
            round(random, wide(product) + wide(c))
        };
    }
    sum
}

#[test]
fn angles_hold_those_of_any_device() {
    let mut random = Rng::with_seed(13);
    for _ in 0..50_000 {
        let angle = (random.f32() - 0.5) * std::f32::consts::FRAC_PI_2;
        let [sine, cosine] = sin_cos_eighth(Number::recorded(angle)).map(Number::interval);
        let z = round(&mut random, wide(angle) * wide(angle));
        let series = polynomial(&mut random, z, &[0.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0]);
        let rest = round(&mut random, wide(angle) * wide(series));
        let found = round(&mut random, wide(angle) + wide(rest));
        assert!(sine.contains(found.into()), "{angle}: {found} in {sine}");
        assert!((wide(found) - wide(angle).sin()).abs() < 1e-6);
        assert!(sine.contains(wide(angle).sin()) || sine.high - sine.low < 1e-8);
        assert!(sine.high - sine.low < 1e-6 && cosine.high - cosine.low < 2e-6);

        let turns = (random.f32() - 0.5) * 3.0;
        let mut choices = Choices::default();
        let [sine, cosine] = sin_cos_turns(Number::recorded(turns), &mut choices).map(Number::interval);
        let (s, c) = (wide(turns) * std::f64::consts::TAU).sin_cos();
        // The error of the polynomials is below 2^-28.
        let near = |interval: Interval, exact: f64| interval.low - 5e-9 <= exact && exact <= interval.high + 5e-9;
        assert!(choices.were_open() || (near(sine, s) && near(cosine, c)), "{turns}");
        // The magnitudes of the cosine's terms add up to at most 4/3, and each passes through at most 19 roundings: 2 *
        // 19 * 2^-23 * 4/3.
        assert!(sine.high - sine.low < 6.1e-6 && cosine.high - cosine.low < 6.1e-6);

        let (y, x) = (random.f32() - 0.5, random.f32() - 0.5);
        let mut choices = Choices::default();
        let found = atan2_turns(Number::recorded(y), Number::recorded(x), &mut choices).interval();
        let exact = wide(y).atan2(x.into()) / std::f64::consts::TAU;
        assert!(choices.were_open() || near(found, exact), "{y}, {x}: {exact} in {found}");
        assert!(found.high - found.low < 4e-6);
    }
}
