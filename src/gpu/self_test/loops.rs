//! Judging whether loops run to their end.

use crate::gpu::self_test::records::{Loop, SelfTest};
use crate::gpu::self_test::report::{PropertyOutcome, Tally, TestedProperty};

/// Number of invocations of the single workgroup.
pub(super) const INVOCATIONS: u32 = 64;

/// Number of iterations of the longest loop, on every device.
pub(super) const LONGEST: u32 = 1_000_000;

/// Maximum total number of iterations of nested loops. On a GPU that runs invocations in groups, the total is
/// multiplied by the number of invocations in a group.
const NESTED: u32 = 1 << 16;

/// The runs of the kernel, one after another: a loop up to the iteration limit, two nested loops, and the longest loop,
/// which a device may leave early.
pub(super) fn runs(limit: u32) -> [SelfTest; 3] {
    let inner = limit.min(NESTED).saturating_sub(INVOCATIONS);
    [
        SelfTest { single: limit.min(LONGEST), ..SelfTest::default() },
        SelfTest { outer: INVOCATIONS, inner, ..SelfTest::default() },
        SelfTest { single: LONGEST, ..SelfTest::default() },
    ]
}

/// Judges the results of [`runs`].
pub(super) fn judge(limit: u32, answers: &[Vec<Loop>]) -> TestedProperty {
    let mut tally = Tally::default();
    let runs = runs(limit);
    let [single, nested, _] = runs;
    for (what, run, answers) in [("a loop", single, answers.first()), ("two nested loops", nested, answers.get(1))] {
        // Either `single` or `inner` is zero.
        let expected = run.single + run.inner;
        for index in 0..INVOCATIONS {
            let got = answers.and_then(|answers| answers.get(index as usize));
            tally.check(got == Some(&after(index, expected)), || match got {
                Some(got) if got.count < expected => {
                    format!("{what} of {expected} iterations, which stops after {}", got.count)
                }
                _ => format!("{what} of {expected} iterations, which counts wrongly"),
            });
        }
    }
    let longest = longest(answers.get(2).map_or(&[], Vec::as_slice));
    let inner = nested.inner;
    let mut words = format!(
        "loops of {} iterations, and nested ones of {inner} for each invocation, run to their end",
        single.single
    );
    let ends = longest == Some(LONGEST);
    if !ends {
        let stops = match longest {
            Some(count) => format!("silently stops after {count}"),
            None => "loses count".to_owned(),
        };
        words += &format!("; one of {LONGEST} {stops}: a trap below which pinhole's limit of {limit} iterations stays");
    }
    let figures = vec![("limit_iterations", f64::from(limit)), ("longest_iterations", f64::from(longest.unwrap_or(0)))];
    let mut property = tally.property("loops", words, figures);
    if property.passed() && !ends {
        property.outcome = PropertyOutcome::Noted;
    }
    property
}

/// Number of iterations of the longest loop, if all invocations agree on it.
fn longest(answers: &[Loop]) -> Option<u32> {
    let is_true = (0..).zip(answers).all(|(index, got)| *got == after(index, got.count));
    let shortest = answers.iter().map(|got| got.count).min();
    shortest.filter(|_| is_true && answers.len() == INVOCATIONS as usize)
}

/// The state of an invocation after `count` iterations of `step` in `shaders/self_test/loops.wgsl`, computed by
/// repeated squaring of the linear function.
fn after(index: u32, count: u32) -> Loop {
    let (mut factor, mut summand) = (1_664_525_u32, 1_013_904_223_u32);
    let (mut state, mut left) = (index, count);
    while left > 0 {
        if left & 1 == 1 {
            state = state.wrapping_mul(factor).wrapping_add(summand);
        }
        summand = summand.wrapping_mul(factor).wrapping_add(summand);
        factor = factor.wrapping_mul(factor);
        left >>= 1;
    }
    Loop { count, state }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_the_step() {
        let mut state = 5_u32;
        for count in 0..100 {
            assert_eq!(after(5, count), Loop { count, state });
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        }
    }

    fn answers(limit: u32) -> Vec<Vec<Loop>> {
        let run = |run: SelfTest| (0..INVOCATIONS).map(|i| after(i, run.single + run.inner)).collect();
        runs(limit).map(run).to_vec()
    }

    #[test]
    fn loops_that_end_pass() {
        for limit in [8_000, 1 << 24] {
            let property = judge(limit, &answers(limit));
            assert_eq!(property.outcome, PropertyOutcome::Passed, "{property}");
        }
    }

    #[test]
    fn one_invocation_that_stops_early_fails() {
        for run in 0..2 {
            let mut answers = answers(8_000);
            answers[run][17] = after(17, answers[run][17].count - 1);
            assert_eq!(judge(8_000, &answers).outcome, PropertyOutcome::Failed);
        }
        // The count is right, but the iterations were not executed.
        let mut made_up = answers(8_000);
        made_up[0][3].state ^= 1;
        assert_eq!(judge(8_000, &made_up).outcome, PropertyOutcome::Failed);
        for missing in [Vec::new(), answers(8_000)[..1].to_vec()] {
            assert_eq!(judge(8_000, &missing).outcome, PropertyOutcome::Failed);
        }
    }

    #[test]
    fn a_loop_beyond_the_limit_that_stops_is_noted() {
        let mut answers = answers(8_000);
        answers[2] = (0..INVOCATIONS).map(|i| after(i, 65_535)).collect();
        let property = judge(8_000, &answers);
        assert_eq!(property.outcome, PropertyOutcome::Noted);
        assert!(property.words.contains("stops after 65535"), "{property}");
        answers[2][0].state ^= 1;
        let property = judge(8_000, &answers);
        assert!(property.passed() && property.words.contains("loses count"), "{property}");
    }
}
