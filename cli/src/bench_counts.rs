//! What rays do in a structure: counted on the CPU, beside what was expected before the structure was built.

use serde::Serialize;

use super::bench_scene::BenchScene;
use pinhole::accel::{Accel, Candidate, Counts};
use pinhole::glam::{DVec3, Vec3};
use pinhole::internals::RayF32;

/// The number of rows and columns of pixels whose rays are counted.
const SIDE: u32 = 64;

/// Numbers for each ray of the picture; rays that miss the scene's box do nothing.
#[derive(Clone, Copy, Serialize)]
pub(super) struct CountsReport {
    /// The share of rays that meet the scene's box.
    share_in_box: f64,
    counted: Numbers,
    /// What was expected of rays that meet the box, times their share.
    expected: Option<Numbers>,
    /// The expected time of a ray, in nanoseconds.
    expected_nanoseconds: Option<f64>,
}

#[derive(Clone, Copy, Serialize)]
struct Numbers {
    steps: f64,
    elements: f64,
    spheres: f64,
}

impl CountsReport {
    /// Counts what rays through pixels that are spread over the picture do.
    pub(super) fn of(scene: &BenchScene, accel: &Accel, candidate: Option<&Candidate>) -> Self {
        let (counts, share_in_box) = count(scene, accel);
        let of_ray = candidate.map(|candidate| candidate.expected.times(share_in_box));
        Self {
            share_in_box,
            counted: Numbers::of(counts),
            expected: of_ray.map(Numbers::of),
            expected_nanoseconds: candidate.map(|candidate| candidate.ray * share_in_box),
        }
    }

    /// The cells of a table: counted and expected of each kind, and the expected time.
    pub(super) fn row(&self) -> [String; 7] {
        let Numbers { steps, elements, spheres } = self.counted;
        let number = |x: f64| format!("{x:.1}");
        let expected = |of: fn(&Numbers) -> f64| {
            self.expected.as_ref().map_or("-".to_owned(), |numbers| number(of(numbers)))
        };
        [
            number(steps),
            expected(|numbers| numbers.steps),
            number(elements),
            expected(|numbers| numbers.elements),
            number(spheres),
            expected(|numbers| numbers.spheres),
            self.expected_nanoseconds.map_or("-".to_owned(), number),
        ]
    }
}

impl Numbers {
    fn of(counts: Counts) -> Self {
        Self { steps: counts.steps, elements: counts.elements, spheres: counts.spheres }
    }
}

/// What a ray of the picture does on average, and the share of rays that meet the scene's box.
pub(super) fn count(scene: &BenchScene, accel: &Accel) -> (Counts, f64) {
    let (columns, rows) = (scene.film.width().min(SIDE), scene.film.height().min(SIDE));
    // The middles of equal parts of the picture.
    let spread =
        |i: u32, side: u32, count: u32| (f64::from(i) + 0.5) / f64::from(count) * f64::from(side);
    let number = f64::from(columns * rows);
    let (mut counts, mut in_box) = (Counts::default(), 0_u32);
    for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
        let pixel = [spread(i, scene.film.width(), columns), spread(j, scene.film.height(), rows)];
        if let Some(ray) = ray(scene, pixel, accel.bounds()) {
            accel.count_nearest(&ray, &mut counts);
            in_box += 1;
        }
    }
    (counts.times(1.0 / number), f64::from(in_box) / number)
}

/// The ray through a point of the picture in pixels, from where it enters the box; `None` if it misses the box.
fn ray(scene: &BenchScene, [x, y]: [f64; 2], (min, max): (Vec3, Vec3)) -> Option<RayF32> {
    let ray = scene.camera.ray_in_world(scene.film.relative_location(x, y));
    let origin = ray.origin - scene.scene.origin();
    let to = |side: Vec3| (side.as_dvec3() - origin) / ray.direction;
    let (a, b): (DVec3, DVec3) = (to(min), to(max));
    let (enters, leaves) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
    (enters < leaves).then(|| RayF32 {
        origin: (origin + enters * ray.direction).as_vec3(),
        direction: ray.direction.as_vec3(),
    })
}
