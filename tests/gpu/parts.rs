//! Shader parts against their twins, by themselves.

use libtest_mimic::Trial;
use pinhole::gpu::Headless;
use pinhole::sampling;

use crate::{compute, trial};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("parts::sample_points_are_the_same_bits", sample_points),
        trial("parts::seeds_of_pixels_are_the_same_bits", pixel_seeds),
        trial("parts::unit_numbers_are_the_same", unit_numbers),
    ]
}

const SAMPLING: &str = include_str!("../../shaders/sampling.wgsl");

/// Words at which something may overflow, be cut off or be taken for signed.
const EXTREMES: [u32; 8] =
    [0, 1, 0x00ff_ffff, 0x0100_0000, 0x7fff_ffff, 0x8000_0000, 0xffff_fffe, u32::MAX];

/// Every combination of extremes, and what chance gives: small numbers, as pictures have them, and any.
fn questions(count: usize) -> Vec<[u32; 4]> {
    let mut random = fastrand::Rng::with_seed(7);
    let at = |i: usize, digit: u32| EXTREMES[i / EXTREMES.len().pow(digit) % EXTREMES.len()];
    let extremes = (0..EXTREMES.len().pow(3)).map(|i| [at(i, 0), at(i, 1), at(i, 2), 0]);
    let mut questions: Vec<_> = extremes.collect();
    while questions.len() < count {
        let bits = random.u32(0..=32);
        questions.push([0; 4].map(|_: u32| random.u32(..).checked_shr(bits).unwrap_or(0)));
    }
    questions
}

fn check(headless: &Headless, answer: &str, expected: impl Fn([u32; 4]) -> [u32; 4]) {
    let questions = questions(1 << 18);
    let source = format!("fn answer(q: vec4u) -> vec4u {{ return {answer}; }}");
    let answers = compute::answers(headless, &[SAMPLING, &source], &[], &questions);
    for (question, answer) in questions.into_iter().zip(answers) {
        assert_eq!(answer, expected(question), "{question:x?}");
    }
}

fn sample_points(headless: &'static Headless) {
    check(headless, "vec4u(sample_pair(q.x, q.y, q.z), 0u, 0u)", |[seed, sample, pair, _]| {
        let [x, y] = sampling::pair(seed, sample, pair);
        [x, y, 0, 0]
    });
}

fn pixel_seeds(headless: &'static Headless) {
    check(headless, "vec4u(pixel_seed(q.xy, q.z), 0u, 0u, 0u)", |[column, row, seed, _]| {
        [sampling::pixel_seed([column, row], seed), 0, 0, 0]
    });
}

fn unit_numbers(headless: &'static Headless) {
    check(headless, "vec4u(bitcast<vec2u>(unit2(q.xy)), 0u, 0u)", |[x, y, ..]| {
        let [x, y] = [x, y].map(|bits| {
            let unit = sampling::unit(bits);
            assert!((0.0..1.0).contains(&unit), "{bits:x}");
            (unit as f32).to_bits()
        });
        [x, y, 0, 0]
    });
}
