//! Round numbers on a scale, and their texts.

use crate::color_by::Scale;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Numbers with texts, in ascending order.
    pub(super) labeled: Vec<(f64, String)>,
    /// Numbers without texts, between the labelled numbers of a logarithmic scale.
    pub(super) minor: Vec<f64>,
    /// The power of ten by which the texts must be multiplied, if it is not 0.
    pub(super) exponent: i32,
}

impl Ticks {
    /// Chooses at most `most` labelled ticks, but at least 2.
    pub(super) fn of(scale: &Scale, most: usize) -> Self {
        let most = most.max(2);
        let range = scale.range();
        let log = if scale.is_log() { logarithmic(range, most) } else { None };
        log.unwrap_or_else(|| linear(range, most))
    }
}

/// The largest number that is at most `value` and 1, 2 or 5 times a power of ten. `value` is positive.
pub(super) fn round_down(value: f64) -> f64 {
    let power = 10_f64.powi(exponent_of(value));
    let mantissa = value / power;
    // The margin makes a rounded quotient count as the number that it should be.
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| mantissa >= step * (1.0 - 1e-12));
    step.unwrap_or(1.0) * power
}

/// The exponent of a positive number in scientific notation.
fn exponent_of(value: f64) -> i32 {
    let text = format!("{value:e}");
    text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// Ticks at multiples of 1, 2, 2.5 or 5 times a power of ten.
fn linear([low, high]: [f64; 2], most: usize) -> Ticks {
    let span = (high - low).min(f64::MAX);
    let least = span / most as f64;
    let power = 10_f64.powi(exponent_of(least));
    let factors = [1.0, 2.0, 2.5, 5.0, 10.0, 20.0];
    let ticks_of = |step: f64| -> Vec<f64> {
        // Allow for rounding at the ends, which are often ticks.
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let count = (last - first + 1.0).clamp(0.0, 1000.0) as usize;
        (0..count).map(|i| ((first + i as f64) * step).clamp(low, high)).collect()
    };
    let fitting = factors.map(|factor| factor * power).into_iter().map(|step| (step, ticks_of(step)));
    let (step, values) = fitting.into_iter().find(|(_, ticks)| ticks.len() <= most).unwrap_or((span, vec![low, high]));
    let largest = low.abs().max(high.abs());
    let is_plain = (1e-3..1e5).contains(&largest) || largest / step > 1e5;
    let exponent = if is_plain { 0 } else { exponent_of(largest) };
    // The division has two steps, because a power below the smallest normal number loses digits.
    let scaled = |value: f64| value / 10_f64.powi(exponent / 2) / 10_f64.powi(exponent - exponent / 2);
    // The fewest decimals that write the step exactly.
    let is_whole = |value: f64| (value - value.round()).abs() < 1e-6 * value;
    let decimals = (0..=12).find(|digits| is_whole(scaled(step) * 10_f64.powi(*digits)));
    let decimals = decimals.unwrap_or(3) as usize;
    let text = |value: f64| minus(&format!("{:.decimals$}", scaled(value)));
    Ticks { labeled: values.iter().map(|value| (*value, text(*value))).collect(), minor: Vec::new(), exponent }
}

/// Ticks at powers of ten and, within less than two powers, at 2 and 5 times these. `None` for fewer than two.
fn logarithmic([low, high]: [f64; 2], most: usize) -> Option<Ticks> {
    let (first, last) = (exponent_of(low), exponent_of(high));
    let is_inside = |value: &f64| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value);
    let of = |factors: &[f64], every: usize| -> Vec<(i32, f64)> {
        let decades = (first..=last).filter(|e| e.rem_euclid(every as i32) == 0);
        let values = decades.flat_map(|e| factors.iter().map(move |f| (e, f * 10_f64.powi(e))));
        values.filter(|(_, value)| is_inside(value)).collect()
    };
    let decades = of(&[1.0], 1).len();
    let mut values = match decades {
        0..=2 => of(&[1.0, 2.0, 5.0], 1),
        count => of(&[1.0], count.div_ceil(most)),
    };
    if values.len() > most {
        values = of(&[1.0], 1);
    }
    if values.len() < 2 {
        return None;
    }
    let is_plain = first >= -3 && last <= 4;
    let text = |(exponent, value): (i32, f64)| {
        let digits = (-exponent).max(0) as usize;
        match value / 10_f64.powi(exponent) {
            _ if is_plain => format!("{value:.digits$}"),
            mantissa if mantissa > 1.5 => format!("{mantissa:.0}·10{}", raised(exponent)),
            _ => format!("10{}", raised(exponent)),
        }
    };
    let shown: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
    let minor = if decades <= 6 { of(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0], 1) } else { of(&[1.0], 1) };
    let minor = minor.into_iter().map(|(_, value)| value.clamp(low, high));
    Some(Ticks {
        minor: minor.filter(|value| !shown.contains(value)).collect(),
        labeled: values.iter().map(|v| (v.1.clamp(low, high), text(*v))).collect(),
        exponent: 0,
    })
}

pub(super) fn raised(exponent: i32) -> String {
    let raised = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(digit),
    };
    exponent.to_string().chars().map(raised).collect()
}

/// Replaces the hyphen of a number by a minus sign, and removes that of zero.
pub(super) fn minus(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(digits) if digits.contains(|c: char| ('1'..='9').contains(&c)) => format!("−{digits}"),
        Some(digits) => digits.to_owned(),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(range: [f64; 2], is_log: bool, most: usize) -> (Vec<String>, i32) {
        let ticks = Ticks::of(&Scale::new(range, is_log).unwrap(), most);
        (ticks.labeled.into_iter().map(|(_, text)| text).collect(), ticks.exponent)
    }

    #[test]
    fn linear_ticks_are_round() {
        for (range, labels, exponent) in [
            ([0.0, 1.0], "0.0 0.2 0.4 0.6 0.8 1.0", 0),
            ([-1.0, 1.0], "−1.0 −0.5 0.0 0.5 1.0", 0),
            ([3.7, 81.2], "20 40 60 80", 0),
            ([0.0, 10.0], "0 2 4 6 8 10", 0),
            ([0.0, 12.5], "0.0 2.5 5.0 7.5 10.0 12.5", 0),
            ([0.0, 2_000_000.0], "0.0 0.5 1.0 1.5 2.0", 6),
            ([0.0, 3e-5], "0 1 2 3", -5),
            ([1e6, 1e6 + 10.0], "1000000 1000002 1000004 1000006 1000008 1000010", 0),
        ] {
            let (found, power) = texts(range, false, 6);
            assert_eq!((found.join(" ").as_str(), power), (labels, exponent), "{range:?}");
        }
    }

    #[test]
    fn logarithmic_ticks_are_powers_of_ten() {
        for (range, labels) in [
            ([0.01, 100.0], "0.01 0.1 1 10 100"),
            ([1e-8, 1e8], "10⁻⁶ 10⁻³ 10⁰ 10³ 10⁶"),
            ([1.0, 30.0], "1 2 5 10 20"),
            ([3e5, 4e6], "5·10⁵ 10⁶ 2·10⁶"),
            ([3.0, 4.5], "3.0 3.5 4.0 4.5"),
        ] {
            assert_eq!(texts(range, true, 6).0.join(" "), labels, "{range:?}");
        }
        let ticks = Ticks::of(&Scale::new([1.0, 100.0], true).unwrap(), 3);
        assert_eq!(ticks.minor.len(), 16);
    }

    /// Whatever the range, there are few ticks, in order and inside the range.
    #[test]
    fn ticks_lie_in_the_range() {
        let mut random = fastrand::Rng::with_seed(7);
        for _ in 0..20_000 {
            let size = 10_f64.powi(random.i32(-300..300));
            let low = (random.f64() - 0.5) * size;
            let high = low + random.f64() * size * 10_f64.powi(random.i32(-3..3));
            let is_log = random.bool() && low > 0.0;
            let Ok(scale) = Scale::new([low, high], is_log) else { continue };
            let most = random.usize(2..12);
            let Ticks { labeled, minor, .. } = Ticks::of(&scale, most);
            assert!(labeled.len() <= most.max(2) && !labeled.is_empty(), "{scale:?} {labeled:?}");
            assert!(labeled.is_sorted_by(|a, b| a.0 < b.0), "{scale:?} {labeled:?}");
            let all = labeled.iter().map(|(value, _)| *value).chain(minor);
            for value in all {
                assert!((low..=high).contains(&value), "{scale:?} {value}");
            }
        }
    }

    #[test]
    fn round_numbers() {
        for (value, round) in [(1.0, 1.0), (9.9, 5.0), (0.049, 0.02), (2000.0, 2000.0), (5e-9, 5e-9)] {
            assert!((round_down(value) / round - 1.0).abs() < 1e-12, "{value}");
        }
    }
}
