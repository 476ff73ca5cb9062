//! Roots, exponentials and angles. The WGSL twins are `shaders/math/trigonometry.wgsl`, `turns.wgsl` and
//! `trigonometry_inverse.wgsl`.

use super::Number;
use crate::verify::choices::Choices;
use crate::verify::rounding::{FLUSH, Interval, PAD, SQRT, U};

impl Number {
    /// The square root. The root of zero is zero. Negative values in the interval are ignored.
    pub(crate) fn sqrt(self) -> Self {
        let Interval { low, high } = self.interval();
        let (low, high) = (low.max(0.0).sqrt(), high.max(0.0).sqrt());
        Self::between(low * (1.0 - SQRT) / PAD, high * (1.0 + SQRT) * PAD)
    }

    /// The exponential, to within 3 + 2|x| ULP.
    pub(crate) fn exp(self) -> Self {
        let Interval { low, high } = self.interval();
        let relative = |x: f64| PAD * (3.0 + 2.0 * x.abs()) * U;
        let (least, most) = (low.exp(), high.exp());
        Self::between((least * (1.0 - relative(low)) - FLUSH).max(0.0), most * (1.0 + relative(high)) + FLUSH).bounded()
    }

    /// The polynomial c0 + x (c1 + x (c2 + …)) with constants from the kernel's text. A compiler may expand it, so that
    /// powers pass through additional roundings.
    fn polynomial(self, coefficients: &[f64]) -> Self {
        let sum = coefficients.iter().rev().fold(Self::ZERO, |sum, c| Self::constant(*c) + self * sum);
        Self { products: sum.products + coefficients.len() as u32, ..sum }
    }

    /// The lowest and the highest whole number that `floor` may return.
    pub(crate) fn floor(self) -> [f64; 2] {
        let Interval { low, high } = self.interval();
        [low.floor(), high.floor()]
    }
}

/// Sine and cosine of an angle of at most an eighth of a turn.
pub(crate) fn sin_cos_eighth(angle: Number) -> [Number; 2] {
    let angle = angle.fence();
    let z = angle.squared().fence();
    let sine = z * z.polynomial(&[-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0]);
    let cosine = z * z.polynomial(&[-0.5, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0, -1.0 / 3_628_800.0]);
    [(angle + (angle * sine).fence()).fence(), (Number::ONE + cosine.fence()).fence()]
}

/// Sine and cosine of an angle in turns.
pub(crate) fn sin_cos_turns(turns: Number, choices: &mut Choices) -> [Number; 2] {
    let quarter = choices.pick((Number::known(4.0) * turns + Number::HALF).floor());
    // The difference of numbers that are nearly equal is exact, unless a compiler rearranges it.
    let Interval { low, high } = turns.interval();
    let rest = Number { products: 1, ..Number::between(low - 0.25 * quarter, high - 0.25 * quarter) };
    let rest = rest.fence();
    let square = rest.squared().fence();
    let sine = (rest * square.polynomial(&[6.283_185_5, -41.341_663, 81.592_35, -75.393_56])).fence();
    let cosine = square.polynomial(&[1.0, -19.739_208, 64.939_31, -85.442_3, 59.202_797]).fence();
    match quarter.rem_euclid(4.0) as u32 {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        2 => [-sine, -cosine],
        _ => [-cosine, sine],
    }
}

/// The angle of a vector in turns.
pub(crate) fn atan2_turns(y: Number, x: Number, choices: &mut Choices) -> Number {
    const SERIES: [f64; 9] = [
        0.159_154_94,
        -0.053_051_233,
        0.031_819_243,
        -0.022_605_801,
        0.016_935_57,
        -0.011_943_451,
        0.006_794_562_1,
        -0.002_557_399_4,
        0.000_453_573_59,
    ];
    let (y, x) = (y.fence(), x.fence());
    let (across, up) = (x.abs(), y.abs());
    let smallest = Number::known(2.0_f64.powi(-100));
    let ratio = (across.min(up) / across.max(up).max(smallest)).fence().min(Number::around(1.0, 4.0 * U));
    let square = ratio.squared().fence();
    let octant = (ratio * square.polynomial(&SERIES)).fence();
    let is_steep = choices.decide(up.is_more(across));
    let quadrant = if is_steep { (Number::known(0.25) - octant).fence() } else { octant };
    let is_behind = choices.decide(x.is_less(Number::ZERO));
    let half = if is_behind { (Number::HALF - quadrant).fence() } else { quadrant };
    if choices.decide(y.is_less(Number::ZERO)) { -half } else { half }
}
