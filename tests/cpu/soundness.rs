//! The set of legal answers holds the exact answer, by arithmetic without rounding, and whatever a device may
//! come to that uses all the freedom of WGSL.

use dashu_float::round::mode;
use dashu_float::{Context, FBig};
use fastrand::Rng;
use pinhole::internals::NO_HIT;
use pinhole::verify::{Checker, LegalHits, TracedRay};
use pinhole::{LinearRgb, Scene};

use crate::hostile_rays::{Case, case};
use crate::legal_device::{Habit, LegalDevice};
use crate::support::effort::tries;

/// How many cases there are if all run.
const CASES: u32 = 1_000_000;

/// Numbers of any length: sums and products are exact.
type Exact = FBig<mode::HalfEven, 2>;

/// Where a square root is cut off: far beyond what any bound could tell.
const ROOT_BITS: usize = 160;

fn exact(value: f32) -> Exact {
    Exact::try_from(value).unwrap().with_precision(0).value()
}

fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The ray's parameter at the first point of a sphere in front of its origin, from inside at the far side.
fn exact_hit(origin: &[Exact; 3], direction: &[Exact; 3], sphere: [f32; 4]) -> Option<Exact> {
    let [x, y, z, radius] = sphere.map(exact);
    let l = [&x - &origin[0], &y - &origin[1], &z - &origin[2]];
    let s = dot(direction, direction);
    let b = dot(&l, direction);
    let c = dot(&l, &l) - &radius * &radius;
    let discriminant = &b * &b - &s * &c;
    if discriminant < Exact::ZERO {
        return None;
    }
    let context = Context::<mode::HalfEven>::new(ROOT_BITS);
    let root: Exact = context.sqrt(discriminant.repr()).unwrap().value();
    let is_outside = c > Exact::ZERO;
    let numerator = if is_outside { b.clone() - root } else { b.clone() + root };
    if numerator <= Exact::ZERO || (is_outside && b <= Exact::ZERO) {
        return None;
    }
    Some(context.div(numerator.repr(), s.repr()).unwrap().value())
}

/// Whether the exact nearest sphere, at its exact distance, is legal.
fn holds_exact(case: &Case, scene: &Scene, legal: &LegalHits) -> bool {
    let (origin, direction) = (case.origin.map(exact), case.direction.map(exact));
    let hits: Vec<_> = (0..)
        .zip(scene.spheres())
        .filter_map(|(id, sphere)| Some((exact_hit(&origin, &direction, *sphere)?, id)))
        .collect();
    let nearest = hits.iter().min_by(|a, b| a.partial_cmp(b).unwrap());
    let Some((t, id)) = nearest else { return legal.miss };
    // The parameter, and the length along a direction that is nearly a unit vector, are both exact answers.
    let s = dot(&direction, &direction);
    let context = Context::<mode::HalfEven>::new(ROOT_BITS);
    let length: Exact = context.sqrt(s.repr()).unwrap().value();
    [t.clone(), t * length].iter().all(|t| legal.allows(*id, t.to_f64().value()))
}

/// Whether what a device answers is legal.
fn allows(device: &mut LegalDevice, case: &Case, scene: &Scene, legal: &LegalHits) -> bool {
    let ray = TracedRay { origin: case.origin, direction: case.direction, distance: 0.0 };
    let mut nearest = (NO_HIT, u32::MAX);
    for (id, sphere) in (0..).zip(scene.spheres()) {
        // Of spheres that are the same the kernel finds the same, which chance would not.
        if scene.spheres()[..id as usize].contains(sphere) {
            continue;
        }
        let t = device.intersect(&ray, *sphere);
        if t < nearest.0 {
            nearest = (t, id);
        }
    }
    match nearest {
        (_, u32::MAX) => legal.miss,
        (t, id) => legal.allows(id, t.into()),
    }
}

/// Runs `judge` on many cases, on two threads, and shows the first that it refuses.
fn on_cases(seed: u64, judge: impl Fn(&Case, &Scene, &LegalHits, &mut Rng) -> bool + Sync) {
    let cases = u64::from(tries(CASES));
    let undecided: u64 = std::thread::scope(|scope| {
        let run = |thread: u64| {
            let mut random = Rng::with_seed(seed + thread);
            let mut undecided = 0;
            for _ in 0..cases.div_ceil(2) {
                let case = case(&mut random);
                // In the scene's own frame, whichever that is.
                let Ok(scene) = Scene::from_f32(case.spheres.clone(), LinearRgb::WHITE) else {
                    continue;
                };
                let moved = scene.origin().to_array();
                let origin = [0, 1, 2].map(|k| (f64::from(case.origin[k]) - moved[k]) as f32);
                let case = Case { origin, ..case };
                let legal = Checker::new(&scene).unwrap().legal_hits(case.origin, case.direction);
                undecided += u64::from(legal.count() != 1);
                assert!(
                    judge(&case, &scene, &legal, &mut random),
                    "{case:?}\nspheres in the scene's frame: {:?}\nlegal: {legal}",
                    scene.spheres()
                );
            }
            undecided
        };
        let handles = [0, 1].map(|thread| scope.spawn(move || run(thread)));
        handles.into_iter().map(|handle| handle.join().unwrap()).sum()
    });
    // They are hostile, and yet most have one answer: a set of everything would be sound as well.
    assert!(undecided < cases / 2, "{undecided}");
    assert!(undecided > cases / 100, "{undecided}");
}

#[test]
fn the_exact_answer_is_legal() {
    on_cases(1, |case, scene, legal, _| holds_exact(case, scene, legal));
}

#[test]
fn no_conforming_device_is_accused() {
    on_cases(3, |case, scene, legal, random| {
        [Habit::Nearest, Habit::Up, Habit::Down, Habit::Random].into_iter().all(|habit| {
            let mut device = LegalDevice { habit, random: random.fork() };
            allows(&mut device, case, scene, legal)
        })
    });
}
