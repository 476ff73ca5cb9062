//! Tests that compare single shader parts with their twins.

use std::f64::consts::TAU;

use libtest_mimic::Trial;
use pinhole::PixelFilter;
use pinhole::camera::{filter, sampling};
use pinhole::glam::DVec3;
use pinhole::gpu::{Headless, wgpu};
use pinhole::light::environment::Environment;
use wgpu::util::DeviceExt;

use crate::support::maps::{AS_IT_IS, direction, random_map};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("parts::sample_points_are_the_same_bits", sample_points),
        trial("parts::seeds_of_pixels_are_the_same_bits", pixel_seeds),
        trial("parts::unit_numbers_are_the_same", unit_numbers),
        trial("parts::offsets_within_a_filter_agree", filter_offsets),
        trial("parts::sines_and_cosines_of_turns", sines),
        trial("parts::angles_of_vectors", angles),
        trial("parts::light_of_directions_is_the_same", environment_lookup),
        trial("parts::sampled_light_is_the_same", environment_samples),
        trial("parts::a_black_map_has_no_light_to_sample", black_environment),
    ]
}

const SAMPLING: &str = include_str!("../../shaders/math/sampling.wgsl");
const FILTER: &str = include_str!("../../shaders/camera/filter.wgsl");
const FENCE: &str = include_str!("../../shaders/math/fence.wgsl");

const TURNS: &str = include_str!("../../shaders/math/turns.wgsl");
const INVERSE: &str = include_str!("../../shaders/math/trigonometry_inverse.wgsl");
const ENVIRONMENT: &str = include_str!("../../shaders/scene/environment.wgsl");

/// The source of zero that `FENCE` needs: the last word of each question, which is zero.
const RUNTIME_ZERO: &str = "fn runtime_zero() -> u32 { return questions[0].w; }";

/// Words that may overflow, be truncated or be interpreted as signed.
const EXTREMES: [u32; 8] = [0, 1, 0x00ff_ffff, 0x0100_0000, 0x7fff_ffff, 0x8000_0000, 0xffff_fffe, u32::MAX];

/// All combinations of extreme words, and random words: small words, as in pictures, and arbitrary ones.
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
    let answers = answers(headless, &[SAMPLING, &source], &[], &questions);
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

/// The allowed error is a few ULP: if each result may be either neighbour of the exact result, the relative errors of
/// the difference, the product and the sum are at most 2⁻²³ each.
fn filter_offsets(headless: &'static Headless) {
    let questions = questions(1 << 16);
    for &filter in PixelFilter::ALL {
        let table = filter.offset_table();
        let words: Vec<_> = table.iter().map(|x| x.to_bits()).chain([0; 3]).collect();
        let source = "
@group(0) @binding(2) var<storage, read> table: array<vec4f, 65>;
fn filter_table(index: u32) -> f32 { return table[index >> 2u][index & 3u]; }
fn answer(q: vec4u) -> vec4u { return vec4u(bitcast<vec2u>(filter_offset(q.xy)), 0u, 0u); }";
        let parts = [FILTER, FENCE, RUNTIME_ZERO, source];
        let answers = answers(headless, &parts, &[(0, 2, &words)], &questions);
        for (question, answer) in questions.iter().zip(answers) {
            for axis in 0..2 {
                let u = question[axis];
                let [low, high] = [0, 1].map(|k| f64::from(table[(u >> 24) as usize + k]));
                let expected = filter::offset(&table, u);
                let bound = 2_f64.powi(-23) * (2.0 * (expected - low) + expected.abs());
                let found = f64::from(f32::from_bits(answer[axis]));
                assert!((found - expected).abs() <= bound * 1.0001, "{filter:?}, {u:x}: {found}");
                assert!((low..=high).contains(&found), "{filter:?}, {u:x}: {found}");
            }
        }
    }
}

/// Questions with the given numbers.
fn packed<const N: usize>(numbers: impl Iterator<Item = [f32; N]>) -> Vec<[u32; 4]> {
    numbers
        .map(|numbers| {
            let mut question = [0; 4];
            for (word, number) in question.iter_mut().zip(numbers) {
                *word = number.to_bits();
            }
            question
        })
        .collect()
}

fn numbers(answer: [u32; 4]) -> [f64; 4] {
    answer.map(|bits| f64::from(f32::from_bits(bits)))
}

fn sines(headless: &'static Headless) {
    let mut random = fastrand::Rng::with_seed(2);
    let eighths = (-512..512).map(|i| i as f32 / 8.0);
    let small = (0..1024).map(|i| 2_f32.powi(-(i % 60)) * if i % 120 < 60 { 1.0 } else { -1.0 });
    let any = (0..1 << 18).map(|i| {
        let range = if i % 2 == 0 { 1.0 } else { 1000.0 };
        range * (2.0 * random.f32() - 1.0)
    });
    let questions = packed(eighths.chain(small).chain(any).map(|turns| [turns]));
    let source = "fn answer(q: vec4u) -> vec4u {
    return vec4u(bitcast<vec2u>(sin_cos_turns(bitcast<f32>(q.x))), 0u, 0u);
}";
    let answers = answers(headless, &[TURNS, FENCE, RUNTIME_ZERO, source], &[], &questions);
    let mut worst = 0.0_f64;
    for (question, answer) in questions.into_iter().zip(answers) {
        let turns = numbers(question)[0];
        // In f64, whole turns can be subtracted exactly.
        let (sine, cosine) = (TAU * (turns - turns.round())).sin_cos();
        let [found_sine, found_cosine, ..] = numbers(answer);
        worst = worst.max((found_sine - sine).abs()).max((found_cosine - cosine).abs());
        // The errors of small angles are small.
        assert!((found_sine - sine).abs() <= 2_f64.powi(-20) * sine.abs() + 1e-15, "{turns}");
    }
    assert!(worst < 2_f64.powi(-22), "{worst:e}");
}

fn angles(headless: &'static Headless) {
    let mut random = fastrand::Rng::with_seed(2);
    let corners = [-1.0, -1e-6, 0.0, 1e-6, 1.0_f32];
    let corners = corners.map(|y| corners.map(|x| [y, x])).concat();
    let any = (0..(1 << 18) + 39).map(|_| {
        let size = 2_f32.powi(random.i32(-40..40));
        [(); 2].map(|()| size * (2.0 * random.f32() - 1.0) * 2_f32.powi(-random.i32(0..20)))
    });
    let questions = packed(corners.into_iter().chain(any));
    let source = "fn answer(q: vec4u) -> vec4u {
    return vec4u(bitcast<u32>(atan2_turns(bitcast<f32>(q.x), bitcast<f32>(q.y))), 0u, 0u, 0u);
}";
    let answers = answers(headless, &[INVERSE, FENCE, RUNTIME_ZERO, source], &[], &questions);
    let mut worst = 0.0_f64;
    for (question, answer) in questions.into_iter().zip(answers) {
        let [y, x, ..] = numbers(question);
        let (found, expected) = (numbers(answer)[0], y.atan2(x) / TAU);
        worst = worst.max((found - expected).abs());
        if x > 0.0 {
            assert!((found - expected).abs() <= 2_f64.powi(-20) * expected.abs(), "{y:e}, {x:e}");
        }
    }
    assert!(worst < 2_f64.powi(-23), "{worst:e}");
}

/// Evaluates radiance and density of directions in a rotated environment map, or takes samples of it.
fn ask_environment(
    headless: &Headless,
    map: &Environment,
    rotation: [f32; 2],
    samples: bool,
    questions: &[[u32; 4]],
) -> Vec<[f64; 4]> {
    let source = "
struct Lighting { environment_size: vec2u, environment_rotation: vec2f, samples: u32 }
@group(0) @binding(2) var<storage, read> lighting: Lighting;
fn answer(q: vec4u) -> vec4u {
    let sampled = sample_environment(q.xy);
    let d = bitcast<vec3f>(q.xyz);
    let found = vec4f(environment_radiance(d), environment_density(d));
    return bitcast<vec4u>(select(found, vec4f(sampled.direction, sampled.density), lighting.samples != 0u));
}";
    let [cosine, sine] = rotation.map(f32::to_bits);
    let lighting = [map.width(), map.height(), cosine, sine, u32::from(samples), 0];
    let texels: Vec<u32> = map.texels().iter().flat_map(|[r, g, b]| [*r, *g, *b, 0.0].map(f32::to_bits)).collect();
    let shares: Vec<u32> = map.rows().iter().chain(map.columns()).map(|share| share.to_bits()).collect();
    let tables = [(0, 2, &lighting[..]), (3, 0, &texels), (3, 1, &shares[..])];
    let parts = [ENVIRONMENT, TURNS, INVERSE, FENCE, RUNTIME_ZERO, source];
    let answers = answers(headless, &parts, &tables, questions);
    answers.into_iter().map(numbers).collect()
}

const SIZES: [[u32; 2]; 7] = [[1, 1], [16, 8], [7, 13], [1, 64], [200, 1], [1024, 512], [4096, 64]];

fn rotations() -> [[f32; 2]; 3] {
    [AS_IT_IS, Environment::rotation(0.7), Environment::rotation(-2.9)]
}

/// Distance from the edge of a texel, in turns, within which a device may assign a direction to the neighbouring texel.
/// It includes the error of the angles and of the rounding of their arguments.
const EDGE: f64 = 1.0 / (1 << 21) as f64;

fn environment_lookup(headless: &'static Headless) {
    let mut random = fastrand::Rng::with_seed(6);
    let directions = || {
        // Half of the directions are uniformly distributed, and half are near the poles.
        let down: f64 = random.f64();
        let down = if random.bool() { down } else { down.powi(3) };
        let d = direction(random.f64(), if random.bool() { down } else { 1.0 - down });
        d.as_vec3().to_array()
    };
    let questions = packed(std::iter::repeat_with(directions).take(1 << 14));
    for (seed, size) in (0..).zip(SIZES) {
        let map = random_map(seed, size);
        for rotation in rotations() {
            let mut near_edges = 0;
            let answers = ask_environment(headless, &map, rotation, false, &questions);
            for (question, answer) in questions.iter().zip(answers) {
                let [x, y, z, _] = numbers(*question);
                let d = DVec3::new(x, y, z);
                let [cosine, sine] = rotation.map(f64::from);
                let in_map = DVec3::new(cosine * x - sine * z, y, cosine * z + sine * x);
                let around = in_map.x.atan2(-in_map.z) / TAU + 0.5;
                let down = in_map.x.hypot(in_map.z).atan2(y) / TAU;
                let is_near = |turns: f64, count: u32| {
                    let place = turns * f64::from(count);
                    (place - place.round()).abs() < EDGE * f64::from(count)
                };
                if is_near(around, size[0]) || is_near(down, 2 * size[1]) {
                    near_edges += 1;
                    continue;
                }
                let [red, green, blue] = map.radiance(d, rotation);
                assert_eq!(answer[..3], [red, green, blue], "{size:?}, {d}");
                let density = map.density(d, rotation);
                let bound = DENSITY * density;
                assert!((answer[3] - density).abs() <= bound, "{size:?}, {d}: {answer:?}, {density}");
            }
            assert!(near_edges < questions.len() / 8, "{size:?}: {near_edges}");
        }
    }
}

/// Maximum error of a sampled direction: a longitude rounded to 2⁻²⁴ turns, its sine to 2⁻²², and some roundings.
const DIRECTION: f64 = 1.0 / (1 << 20) as f64;

/// Maximum relative error of a density: two sines with errors of 2⁻²⁰ and six roundings.
const DENSITY: f64 = 1.0 / (1 << 18) as f64;

fn environment_samples(headless: &'static Headless) {
    let questions: Vec<_> = questions(1 << 14).into_iter().map(|[x, y, ..]| [x, y, 0, 0]).collect();
    for (seed, size) in (0..).zip(SIZES) {
        let map = random_map(seed, size);
        for rotation in rotations() {
            let answers = ask_environment(headless, &map, rotation, true, &questions);
            for ([u, v, ..], answer) in questions.iter().zip(answers) {
                let (direction, density) = map.sample([*u, *v], rotation);
                let [x, y, z, found] = answer;
                let bound = DENSITY * density;
                assert!((found - density).abs() <= bound, "{size:?}, {u:x}, {v:x}: {found}, {density}");
                let found = DVec3::new(x, y, z);
                // Heights are computed from one pole. Near the other pole they have the resolution of f32 near 1, which
                // matters for a map with a single row.
                let error = if size[1] == 1 { (y - direction.y).abs() } else { (found - direction).length() };
                assert!(error < DIRECTION, "{size:?}, {u:x}, {v:x}: {found}, {direction}");
            }
        }
    }
}

fn black_environment(headless: &'static Headless) {
    let map = Environment::new(5, 3, vec![[0.0; 3]; 15]).unwrap();
    for answer in ask_environment(headless, &map, AS_IT_IS, true, &questions(1 << 10)) {
        let [x, y, z, density] = answer;
        assert_eq!(density.to_bits(), 0);
        assert!((DVec3::new(x, y, z).length() - 1.0).abs() < 1e-5, "{answer:?}");
    }
}

/// The WGSL before the parts. It declares the buffers of questions and answers.
const BINDINGS: &str = "
@group(0) @binding(0) var<storage, read> questions: array<vec4u>;
@group(0) @binding(1) var<storage, read_write> answers: array<vec4u>;
";

/// Returns the results of `fn answer(question: vec4u) -> vec4u`, which one of the parts must provide, for all
/// questions.
///
/// `tables` are storage buffers of words, with their groups and bindings.
pub(crate) fn answers(
    headless: &Headless,
    parts: &[&str],
    tables: &[(u32, u32, &[u32])],
    questions: &[[u32; 4]],
) -> Vec<[u32; 4]> {
    assert_eq!(questions.len() % 64, 0, "whole workgroups");
    let main = "
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) invocation: vec3u,
        @builtin(num_workgroups) workgroups: vec3u) {
    let index = invocation.y * workgroups.x * 64u + invocation.x;
    if (index < arrayLength(&questions)) {
        answers[index] = answer(questions[index]);
    }
}";
    let source = [BINDINGS, &parts.join("\n"), main].concat();
    let (device, queue) = (headless.device(), headless.queue());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("part"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("part"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let filled = |bytes: &[u8]| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytes,
            usage: wgpu::BufferUsages::STORAGE,
        })
    };
    let size = size_of_val(questions) as u64;
    let empty = |usage| {
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        device.create_buffer(&descriptor)
    };
    let written = empty(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = empty(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let mut buffers = vec![(0, 0, filled(bytemuck::cast_slice(questions))), (0, 1, written)];
    for (group, binding, words) in tables {
        buffers.push((*group, *binding, filled(bytemuck::cast_slice(words))));
    }
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    for group in buffers.iter().map(|(group, ..)| *group) {
        let of_group = buffers.iter().filter(|(of, ..)| *of == group);
        let entries: Vec<_> = of_group
            .map(|(_, binding, buffer)| wgpu::BindGroupEntry {
                binding: *binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let layout = pipeline.get_bind_group_layout(group);
        let bound =
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
        pass.set_bind_group(group, &bound, &[]);
    }
    let workgroups = questions.len() as u32 / 64;
    // There may be at most 65,535 workgroups along an axis.
    pass.dispatch_workgroups(workgroups.min(4096), workgroups.div_ceil(4096), 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&buffers[1].2, 0, &read, 0, size);
    queue.submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let mapped = read.get_mapped_range(..).unwrap();
    bytemuck::cast_slice(&mapped).to_vec()
}
