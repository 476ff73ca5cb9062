//! Judging fences in a kernel that traces rays, which has the frame of a picture, and in which a compiler may make all
//! the optimisations that it makes in such kernels.

use crate::gpu::edit::ShaderEdit;
use crate::gpu::self_test::report::{Tally, TestedProperty, percent};
use crate::gpu::shader::Part;
use crate::recording::{TracedPixel, TracedRay};

/// The edit that turns the kernel that records rays into the kernel that probes fences.
pub(crate) fn edit() -> ShaderEdit {
    let recorded = Part::named("primary/entry.wgsl#recorded");
    let probed = Part::named("primary/entry.wgsl#probed");
    ShaderEdit {
        file: recorded.name.to_owned(),
        find: recorded.source.into_owned(),
        replace: probed.source.into_owned(),
    }
}

/// Judges the values that the kernel recorded in place of rays.
pub(crate) fn judge(pixels: &[TracedPixel]) -> TestedProperty {
    let mut tally = Tally::default();
    let (mut rounded, mut rewritten) = (0, 0);
    for TracedRay { origin: [sum, back, error], direction: [a, b, _], distance: unfenced } in
        pixels.iter().filter_map(|pixel| pixel.ray)
    {
        let [wide_sum, wide_back, wide_error, wide_a, wide_b] = [sum, back, error, a, b].map(f64::from);
        // The error of a sum with a term that is much smaller need not be an f32 if it is not rounded to nearest.
        if !(1e-3..=1.0).contains(&(wide_b / wide_a).abs()) {
            continue;
        }
        tally.check(wide_sum + wide_error == wide_a + wide_b, || {
            format!("TwoSum of {a:e} and {b:e}, which gives {sum:e} and {error:e}")
        });
        tally.check(wide_back == wide_sum - wide_a, || format!("({a:e} + {b:e}) - {a:e}, which gives {back:e}"));
        if error != 0.0 {
            rounded += 1;
            rewritten += usize::from(unfenced != error);
        }
    }
    let percent = percent(rewritten, rounded);
    let words = format!(
        "fences hold in a kernel that traces rays, {} of them; {percent:.1} % of unfenced sums are rewritten",
        tally.tested()
    );
    tally.property("fence_in_trace", words, vec![("unfenced_rewritten_percent", percent)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probed(a: f32, b: f32, fences: bool) -> TracedPixel {
        let sum = a + b;
        let back = if fences { sum - a } else { b };
        let error = if fences { (a - (sum - back)) + (b - back) } else { 0.0 };
        let ray = TracedRay { origin: [sum, back, error], direction: [a, b, 0.0], distance: 0.0 };
        TracedPixel { ray: Some(ray), t: 0.0, id: 0, shading_ray: None }
    }

    #[test]
    fn fences_that_leak_are_found() {
        let of = |fences| -> Vec<_> {
            (0..100).map(|i| probed(4.0 + 0.01 * i as f32, 0.9 - 0.013 * i as f32, fences)).collect()
        };
        let sound = judge(&of(true));
        assert!(sound.passed(), "{sound}");
        assert!(sound.figures.contains(&("unfenced_rewritten_percent", 100.0)));
        assert!(!judge(&of(false)).passed());
        assert!(!judge(&[]).passed(), "nothing was tested");
    }
}
