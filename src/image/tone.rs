//! Tone curves, which map light of any strength into the range of a display.

/// A tone curve, which maps linear light that may exceed 1 to light that a display can show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ToneCurve {
    /// No change. Values above 1 are clamped later. A flat colour comes out as the bytes that went in.
    #[default]
    None,
    /// A fit of the filmic curve of ACES, applied to each component separately: Narkowicz, "ACES Filmic Tone Mapping
    /// Curve", 2016, as printed there, without the factor of 0.6 that would bring it closer to ACES.
    Filmic,
    /// AgX by Troy Sobotka, with its base look. Strong light loses its colour as it approaches white. It uses the
    /// polynomial of Benjamin Wrensch ("Minimal AgX Implementation", 2023), whose mean squared error is 3.7 · 10⁻⁶.
    Agx,
}

impl ToneCurve {
    /// All tone curves.
    pub const ALL: &'static [Self] = &[Self::None, Self::Filmic, Self::Agx];

    /// Maps linear light of the scene to linear light of a display, both with the Rec. 709 primaries. All curves except
    /// [`ToneCurve::None`] return values in [0, 1] and treat negative values and NaN as 0.
    #[must_use]
    pub fn apply(self, linear: [f32; 3]) -> [f32; 3] {
        match self {
            Self::None => linear,
            Self::Filmic => linear.map(|x| filmic(bounded(x))),
            Self::Agx => agx(linear.map(bounded)),
        }
    }

    /// The smallest and the largest light of a display for scene light between the ends of a range.
    pub(crate) fn range(self, ends: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
        match self {
            Self::None => ends,
            Self::Filmic => {
                let [low, high] = ends.map(|linear| linear.map(|x| filmic(bounded(x))));
                // Mathematically, the curve rises. Each of its roundings is at most half an ULP.
                [low.map(|x| x * (1.0 - 1e-6)), high.map(|x| (x * (1.0 + 1e-6)).min(1.0))]
            }
            Self::Agx => agx_range(ends.map(|linear| linear.map(bounded))),
        }
    }
}

/// The value at which inputs are clamped. Everything brighter is white, and squares stay finite.
const BRIGHTEST: f32 = 1e6;

fn bounded(x: f32) -> f32 {
    // The comparison is false for NaN as well.
    if x > 0.0 { x.min(BRIGHTEST) } else { 0.0 }
}

/// Narkowicz's curve with his five constants.
fn filmic(x: f32) -> f32 {
    let (a, b, c, d, e) = (2.51, 0.03, 2.43, 0.59, 0.14);
    (x * (a * x + b) / (x * (c * x + d) + e)).min(1.0)
}

/// The first and the last matrix of AgX.
const INSET: [[f32; 3]; 3] = [
    [0.842_479_06, 0.078_433_6, 0.079_223_745],
    [0.042_328_242, 0.878_468_64, 0.079_166_13],
    [0.042_375_655, 0.078_433_6, 0.879_143],
];
const OUTSET: [[f32; 3]; 3] = [
    [1.196_879, -0.098_020_88, -0.099_029_74],
    [-0.052_896_85, 1.151_903_1, -0.098_961_18],
    [-0.052_971_636, -0.098_043_45, 1.151_073_7],
];

/// AgX in Wrensch's steps: inset, logarithm, sigmoid, outset, and a power of 2.2 that makes light linear again.
fn agx(linear: [f32; 3]) -> [f32; 3] {
    product(&OUTSET, agx_encoded(linear)).map(decoded)
}

/// The steps of AgX before the outset. Each of them rises.
fn agx_encoded(linear: [f32; 3]) -> [f32; 3] {
    const MIN_EV: f32 = -12.473_93;
    const MAX_EV: f32 = 4.026_069;
    product(&INSET, linear).map(|x| {
        // The logarithm of 0 is −∞, which is clamped to the range.
        let ev = x.log2().clamp(MIN_EV, MAX_EV);
        sigmoid((ev - MIN_EV) / (MAX_EV - MIN_EV))
    })
}

fn decoded(x: f32) -> f32 {
    x.clamp(0.0, 1.0).powf(2.2)
}

/// The range of [`agx`]. Because the outset has negative numbers, the maximum of a channel needs the minimum of others.
fn agx_range(ends: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    /// An upper bound of the rounding errors of the polynomial, whose coefficients add up to 95, and of the outset.
    const ERROR: f32 = 95.0 * 16.0 * f32::EPSILON;
    let [low, high] = ends.map(agx_encoded);
    let end = |a: [f32; 3], b: [f32; 3], error: f32| {
        OUTSET.map(|row| {
            let terms = (0..3).map(|i| row[i] * if row[i] > 0.0 { a[i] } else { b[i] });
            decoded(terms.sum::<f32>() + error)
        })
    };
    [end(low, high, -ERROR), end(high, low, ERROR)]
}

/// The contrast curve of AgX, as a polynomial.
fn sigmoid(x: f32) -> f32 {
    const COEFFICIENTS: [f32; 7] = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.002_32];
    COEFFICIENTS.iter().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

fn product(rows: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    rows.map(|[a, b, c]| a * x + b * y + c * z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::color::to_srgb8;

    fn grey(curve: ToneCurve, x: f32) -> f32 {
        curve.apply([x; 3])[1]
    }

    #[test]
    fn nothing_is_changed_by_none() {
        let color = [-1.0, 0.25, f32::INFINITY];
        assert_eq!(ToneCurve::None.apply(color).map(f32::to_bits), color.map(f32::to_bits));
    }

    /// Known values, computed by hand from the formulas.
    #[test]
    fn known_answers() {
        assert!((grey(ToneCurve::Filmic, 0.18) - 0.266_9).abs() < 1e-4);
        assert!((grey(ToneCurve::Filmic, 1.0) - 0.803_8).abs() < 1e-4);
        // Middle grey lies 10 stops above the lower end of the range, at the pivot of the curve, which is half-way up.
        let encoded = grey(ToneCurve::Agx, 0.18).powf(1.0 / 2.2);
        assert!((encoded - 0.5).abs() < 5e-3, "{encoded}");
        for curve in [ToneCurve::Filmic, ToneCurve::Agx] {
            assert_eq!(to_srgb8(curve.apply([0.0; 3])), [0; 3], "{curve:?}");
            assert_eq!(to_srgb8(curve.apply([1e4; 3])), [255; 3], "{curve:?}");
        }
    }

    #[test]
    fn more_light_is_never_darker_and_grey_stays_grey() {
        for curve in [ToneCurve::Filmic, ToneCurve::Agx] {
            let mut before = 0.0;
            for step in 0..4000 {
                let x = (step as f32 / 100.0 - 20.0).exp2();
                let [r, g, b] = curve.apply([x; 3]);
                assert!(g >= before - 1e-6 && g <= 1.0, "{curve:?} {x}: {g} after {before}");
                assert!((r - g).abs() < 1e-3 && (b - g).abs() < 1e-3, "{curve:?} {x}: {r} {g} {b}");
                before = g;
            }
        }
    }

    #[test]
    fn a_range_holds_what_is_between_its_ends() {
        for curve in ToneCurve::ALL {
            for step in 0..20_000_u32 {
                let at = |salt: u32| (step.wrapping_mul(salt) >> 8) as f32 / (1 << 24) as f32;
                let low = [2_654_435_761, 2_246_822_519, 3_266_489_917].map(|salt| (14.0 * at(salt) - 10.0).exp2());
                let width = (-20.0 * at(668_265_263)).exp2();
                let high = low.map(|x| x * (1.0 + width));
                let between = [374_761_393, 2_869_860_233, 1_181_783_497].map(at);
                let color = std::array::from_fn(|i| (low[i] + between[i] * (high[i] - low[i])).clamp(low[i], high[i]));
                let [least, most] = curve.range([low, high]);
                for ((found, least), most) in curve.apply(color).into_iter().zip(least).zip(most) {
                    assert!(least <= found && found <= most, "{curve:?} {color:?} {low:?} {high:?}");
                    assert!(width > 1e-4 || most - least < 2e-3, "{curve:?}: {least} {most}");
                }
            }
        }
    }

    #[test]
    fn strong_light_loses_its_color_with_agx_alone() {
        let red = [64.0, 0.0, 0.0];
        let [r, g, b] = ToneCurve::Agx.apply(red);
        assert!(r > 0.9 && g > 0.2 && b > 0.2, "{r} {g} {b}");
        assert_eq!(to_srgb8(ToneCurve::Filmic.apply(red)), [255, 0, 0]);
    }

    #[test]
    fn what_is_no_light_is_black_or_white() {
        for curve in [ToneCurve::Filmic, ToneCurve::Agx] {
            assert_eq!(to_srgb8(curve.apply([f32::NAN; 3])), [0; 3]);
            assert_eq!(to_srgb8(curve.apply([-1.0; 3])), [0; 3]);
            assert_eq!(to_srgb8(curve.apply([f32::INFINITY; 3])), [255; 3]);
        }
    }
}
