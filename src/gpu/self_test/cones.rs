//! The judgement of where a device finds hits of rays with cones.

use crate::gpu::self_test::report::{Tally, TestedProperty, percent};
use crate::parallel;
use crate::recording::NO_HIT;
use crate::recording::cone_rays::{ConeAnswer, RayAndCone};
use crate::verify::cone::LegalConeHits;

/// Judges where a device finds hits, and their normals.
pub(super) fn judge(inputs: &[RayAndCone], answers: &[ConeAnswer]) -> TestedProperty {
    let mut tally = Tally::default();
    let legal = parallel::map(inputs.len(), |at| {
        let RayAndCone { origin, direction, cone, .. } = &inputs[at];
        LegalConeHits::new(*origin, *direction, cone)
    });
    let (mut decided, mut hits) = (0, 0);
    for ((input, answer), legal) in inputs.iter().zip(answers).zip(&legal) {
        let is_miss = answer.t >= NO_HIT;
        tally.check(legal.allows(answer.t, answer.normal), || format!("{input:?}, which gives {answer:?}"));
        hits += usize::from(!is_miss);
        decided += usize::from(legal.is_decided());
    }
    let decided = percent(decided, inputs.len());
    let words = format!(
        "all of {} rays that were tested with cones have legal answers, {hits} of them hits; {decided:.1} % can only have \
         one",
        tally.tested()
    );
    tally.property("cones", words, vec![("hits", hits as f64), ("decided_percent", decided)])
}
