//! A device that follows paths between matt spheres and does whatever WGSL leaves it free to do is never accused.

use std::f64::consts::PI;

use pinhole::camera::sampling::{pair, pixel_seed, unit};
use pinhole::camera::{Camera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::image::NO_ID;
use pinhole::internals::{
    NO_HIT, PathState, PixelSums, RecordedFilm, RecordedSample, RecordedSurface, UploadedLighting,
};
use pinhole::light::{Sky, SkyLight};
use pinhole::render::{Integrator, LightSampling, PathTracing, RenderSettings, Sampling};
use pinhole::verify::{
    Checker, LitInputs, Outcome, PathRecording, Recording, TracedPixel, TracedRay,
};
use pinhole::{Film, Image, LayerSet, LinearRgb, Scene, Sphere};

use crate::legal_device::{Habit, LegalDevice};
use crate::support::spheres;
use crate::verify::given;

const DEPTH: u32 = 5;

/// The lighting of all these: a sky, and nothing that is looked for.
fn lighting() -> RenderSettings {
    let rgb = |r, g, b| LinearRgb::new([r, g, b]).unwrap();
    RenderSettings {
        integrator: Integrator::Path(PathTracing {
            max_depth: DEPTH,
            roulette_from: 1,
            light_sampling: LightSampling::Multiple,
        }),
        sampling: Sampling { samples: 1, seed: 3, ..Sampling::default() },
        lights: Vec::new(),
        sky: Sky {
            light: SkyLight::Gradient {
                zenith: rgb(0.3, 0.5, 0.9),
                horizon: rgb(0.8, 0.7, 0.6),
                nadir: rgb(0.2, 0.1, 0.0),
            },
            is_visible: true,
        },
        ground: None,
        background: LinearRgb::BLACK,
        is_transparent: false,
        ..RenderSettings::studio()
    }
}

fn recording(scene: &Scene, camera: &dyn Camera, film: Film) -> PathRecording {
    let made = given(scene, camera, film);
    let settings = lighting();
    let filter = settings.sampling.filter.offset_table();
    let SkyLight::Gradient { zenith, horizon, nadir } = &settings.sky.light else {
        unreachable!("it is one")
    };
    let lighting = UploadedLighting {
        flags: 2,
        zenith: zenith.to_array(),
        horizon: horizon.to_array(),
        nadir: nadir.to_array(),
        roulette_from: 1,
        light_sampling: 2,
        seed: settings.sampling.seed,
        filter_table: filter.to_vec(),
        ..UploadedLighting::default()
    };
    // The ground's material, and those of the spheres, which are matt and opaque.
    let material = [[0, 0, (0.3_f32 * 0.3).to_bits(), 0], [0, 0, 0, 1_f32.to_bits()]];
    let tables = (0..=scene.appearance().surfaces().len()).flat_map(|_| material).collect();
    let given = LitInputs {
        camera: made.camera,
        occluders: [made.uploaded.scene_min, made.uploaded.scene_max],
        uploaded: made.uploaded,
        film,
        origin: [0, 0],
        size: [film.width(), film.height()],
        settings,
        max_surfaces: DEPTH,
        lighting,
        tables,
        emitters: Vec::new(),
        sky: None,
    };
    PathRecording { given, samples: Vec::new() }
}

/// A path, in the order of its slots.
#[derive(Clone, Copy)]
struct Path {
    origin: [f32; 3],
    flags: u32,
    direction: [f32; 3],
    density: f32,
    /// Which sphere it leaves, and how far its far side is.
    left: (u32, f32),
    through: [f32; 4],
    radiance: [f32; 4],
    first: [f32; 4],
}

fn bits(v: [f32; 3], w: u32) -> [u32; 4] {
    let [x, y, z] = v.map(f32::to_bits);
    [x, y, z, w]
}

impl Path {
    fn state(&self) -> PathState {
        let one = 1.0_f32.to_bits();
        let slots = [
            bits(self.origin, self.flags),
            bits(self.direction, self.density.to_bits()),
            [self.left.0, 0, self.left.1.to_bits(), u32::MAX],
            self.through.map(f32::to_bits),
            self.radiance.map(f32::to_bits),
            self.first.map(f32::to_bits),
            [0, 0, one, 0],
            [0; 4],
            [0; 4],
        ];
        PathState { slots }
    }
}

#[derive(Clone, Copy)]
struct Hit {
    t: f32,
    id: u32,
    distance: f32,
}

const ALIVE: u32 = 1;
const INSIDE: u32 = 2;
const FULL: u32 = 32;
const SCATTERED: u32 = 64;

impl LegalDevice {
    /// `start` of shaders/path/start.wgsl.
    fn start(&mut self, made: &PathRecording, pixel: [u32; 2], seed: u32) -> Path {
        let table = &made.given.lighting.filter_table;
        let u = pair(seed, 0, 0);
        let side = [made.given.film.width(), made.given.film.height()];
        let [x, y] = [0, 1].map(|axis| {
            let (low, high) =
                (table[(u[axis] >> 24) as usize], table[(u[axis] >> 24) as usize + 1]);
            let step = self.add(high, -low);
            let fraction = ((u[axis] >> 8) & 0xffff) as f32 / 65536.0;
            let offset = self.mul(fraction, step);
            let offset = self.add(low, offset);
            let doubled = 2.0 * pixel[axis] as f32 + 1.0 - side[axis] as f32;
            let sum = self.mul_add(2.0, offset, doubled);
            self.divide(sum, side[axis] as f32)
        });
        let lens = pair(seed, 0, 1).map(|bits| unit(bits) as f32);
        let ray = self.camera_ray(made.given.camera.kind, &made.given.uploaded, [x, -y], lens);
        Path {
            origin: ray.origin,
            flags: ALIVE | FULL,
            direction: ray.direction,
            density: 0.0,
            left: (NO_ID, 0.0),
            through: [1.0; 4],
            radiance: [0.0; 4],
            first: [0.0, 0.0, 0.0, ray.distance],
        }
    }

    /// `trace` of shaders/primary/trace.wgsl.
    fn extend(&mut self, scene: &Scene, made: &PathRecording, path: &Path, last: Hit) -> Hit {
        let (ray, is_inside) = self.enter(&made.given.uploaded, path.origin, path.direction);
        let mut hit = Hit { t: NO_HIT, id: NO_ID, distance: 0.0 };
        if path.flags & INSIDE != 0 {
            hit = Hit { t: path.left.1, id: last.id, distance: 0.0 };
        }
        let left = scene.spheres().get(path.left.0 as usize);
        for (sphere, id) in scene.spheres().iter().zip(0..) {
            let is_first = !scene.spheres()[..id as usize].contains(sphere);
            if is_inside && is_first && Some(sphere) != left {
                let t = self.intersect(&ray, *sphere);
                if t < hit.t {
                    hit = Hit { t, id, distance: ray.distance };
                }
            }
        }
        hit
    }

    fn middle_of(&mut self, sphere: [f32; 4], origin: [f32; 3], direction: [f32; 3]) -> f32 {
        let to_center = self.vector(|this, k| this.add(sphere[k], -origin[k]));
        self.dot(&mut [0, 1, 2].map(|k| (to_center[k], direction[k])))
    }

    fn unit_vector(&mut self, v: [f32; 3]) -> [f32; 3] {
        let squared = self.dot(&mut v.map(|x| (x, x)));
        let length = self.sqrt(squared);
        self.vector(|this, k| this.divide(v[k], length))
    }

    /// `axes_around` of shaders/math/warp.wgsl.
    fn axes(&mut self, n: [f32; 3]) -> [[f32; 3]; 3] {
        let [x, y, z] = n;
        let s = if z >= 0.0 { 1.0 } else { -1.0 };
        let sum = self.add(s, z);
        let a = self.divide(-1.0, sum);
        let xy = self.mul(x, y);
        let b = self.mul(xy, a);
        let (xx, yy) = (self.mul(x, x), self.mul(y, y));
        let (xa, ya) = (self.mul(xx, a), self.mul(yy, a));
        let first = [self.add(1.0, s * xa), s * b, -s * x];
        [first, [b, self.add(s, ya), -y], n]
    }

    /// `scatter` of shaders/path/scatter.wgsl, of a scene in which everything is matt and nothing is looked for.
    fn scatter(
        &mut self,
        scene: &Scene,
        made: &PathRecording,
        path: &Path,
        hit: Hit,
        (seed, surface): (u32, u32),
    ) -> Path {
        let mut next = *path;
        let d = path.direction;
        if hit.id == NO_ID {
            let lighting = &made.given.lighting;
            let end = if d[1] >= 0.0 { lighting.zenith } else { lighting.nadir };
            let along = d[1].abs();
            let level = self.add(1.0, -along);
            let light = self
                .vector(|this, k| this.dot(&mut [(lighting.horizon[k], level), (end[k], along)]));
            let [r, g, b] =
                self.vector(|this, k| this.mul_add(path.through[k], light[k], path.radiance[k]));
            next.radiance = [r, g, b, path.radiance[3]];
            return Path { origin: [0.0; 3], flags: 0, ..next };
        }
        let sphere = scene.spheres()[hit.id as usize];
        let origin = self.vector(|this, k| this.mul_add(hit.distance, d[k], path.origin[k]));
        let origin = if hit.distance == 0.0 { path.origin } else { origin };
        let ray = TracedRay { origin, direction: d, distance: hit.distance };
        let triangle = self.triangle(&ray, sphere);
        let middle = self.middle_of(sphere, origin, d);
        let is_far_side = path.flags & INSIDE != 0 && hit.id == path.left.0;
        let half = if is_far_side { middle.abs() } else { triangle.from_foot.abs() };
        let from_foot = if is_far_side || hit.t > middle { half } else { -half };
        let outward = self.vector(|this, k| this.mul_add(from_foot, d[k], -triangle.foot[k]));
        let outward = self.unit_vector(outward);
        let is_back = self.dot(&mut [0, 1, 2].map(|k| (outward[k], d[k]))) > 0.0;
        let far = self.add(hit.t, hit.distance);
        let position = if sphere[3] > 64.0 * far {
            self.vector(|this, k| this.mul_add(hit.t, d[k], origin[k]))
        } else {
            self.vector(|this, k| this.mul_add(sphere[3], outward[k], sphere[k]))
        };
        let normal = if is_back { outward.map(|x| -x) } else { outward };
        let color = scene.color(hit.id).to_array();
        if path.flags & SCATTERED == 0 && path.first[3] >= 0.0 {
            next.first = [color[0].min(1.0), color[1].min(1.0), color[2].min(1.0), -1.0];
        }
        next.radiance[3] = 1.0;
        next.origin = position;
        let axes = self.axes(normal);
        let u = pair(seed, 0, 2 + 8 * surface).map(|bits| unit(bits) as f32);
        let [x, y] = self.concentric_disk(u);
        let rest = self.dot(&mut [(1.0, 1.0), (-x, x), (-y, y)]);
        let z = if rest > 0.0 { self.sqrt(rest) } else { 0.0 };
        let toward = self
            .vector(|this, k| this.dot(&mut [(x, axes[0][k]), (y, axes[1][k]), (z, axes[2][k])]));
        next.direction = self.unit_vector(toward);
        let pi = self.round(PI);
        next.density = self.divide(z, pi);
        let carried = self.vector(|this, k| this.mul(path.through[k], color[k]));
        let most = carried.into_iter().fold(0.0, f32::max);
        let survival = if surface >= 1 { most.min(0.95) } else { 1.0 };
        let draw = unit(pair(seed, 0, 6 + 8 * surface)[0]) as f32;
        let is_alive = most > 0.0 && draw < survival && surface < DEPTH;
        let [r, g, b] = self.vector(|this, k| this.divide(carried[k], survival.max(1e-30)));
        next.through = [r, g, b, 0.0];
        let side = if is_back { INSIDE } else { 0 };
        next.left = (hit.id, 0.0);
        if is_back {
            let middle = self.middle_of(sphere, position, next.direction);
            next.left.1 = self.mul(2.0, middle).max(0.0);
        }
        next.flags = SCATTERED | side | if is_alive { ALIVE } else { 0 };
        next
    }

    /// `accumulate` of shaders/path/accumulate.wgsl, and `plus` of `film_sums.wgsl`.
    fn accumulate(&mut self, path: &Path, before: PixelSums) -> PixelSums {
        let [[r, g, b, alpha], rest, [x, y, z, square]] =
            before.map(|four| four.map(f32::from_bits));
        let [red, green, blue, opacity] = path.radiance;
        let light = self.dot(&mut [(red, 0.2126), (green, 0.7152), (blue, 0.0722)]);
        let more = [red, green, blue, self.mul(light, light)];
        let (mut value, mut rest) = ([r, g, b, square], rest);
        for channel in 0..4 {
            let (sum, more) = (value[channel], more[channel]);
            value[channel] = self.add(sum, more);
            let part = self.add(value[channel], -sum);
            let kept = self.add(value[channel], -part);
            let lost = [self.add(sum, -kept), self.add(more, -part)];
            let lost = self.add(lost[0], lost[1]);
            rest[channel] = self.add(rest[channel], lost);
        }
        let [first, others] = [path.first, [x, y, z, 0.0]];
        let albedo = [0, 1, 2].map(|c| self.add(others[c], first[c]));
        let color = [value[0], value[1], value[2], self.add(alpha, opacity)];
        [color, rest, [albedo[0], albedo[1], albedo[2], value[3]]]
            .map(|four| four.map(f32::to_bits))
    }

    fn follow(&mut self, scene: &Scene, made: &PathRecording) -> RecordedSample {
        let [width, height] = made.given.size;
        let pixels: Vec<[u32; 2]> =
            (0..height).flat_map(|j| (0..width).map(move |i| [i, j])).collect();
        let seeds: Vec<u32> =
            pixels.iter().map(|pixel| pixel_seed(*pixel, made.given.lighting.seed)).collect();
        let nothing = Hit { t: NO_HIT, id: NO_ID, distance: 0.0 };
        let mut paths: Vec<Path> = pixels
            .iter()
            .zip(&seeds)
            .map(|(pixel, seed)| self.start(made, *pixel, *seed))
            .collect();
        let mut hits = vec![nothing; paths.len()];
        let mut recorded = RecordedSample {
            start: paths.iter().map(Path::state).collect(),
            ..RecordedSample::default()
        };
        for surface in 0..=DEPTH {
            for ((path, hit), seed) in paths.iter_mut().zip(&mut hits).zip(&seeds) {
                if path.flags & ALIVE != 0 {
                    *hit = self.extend(scene, made, path, *hit);
                    *path = self.scatter(scene, made, path, *hit, (*seed, surface));
                }
            }
            recorded.surfaces.push(RecordedSurface {
                hits: hits
                    .iter()
                    .map(|hit| [hit.t.to_bits(), hit.id, 0, hit.distance.to_bits()])
                    .collect(),
                scattered: paths.iter().map(Path::state).collect(),
                open: vec![0; paths.len()],
            });
        }
        // Sums of some samples of any light.
        let sum = |k: usize| [0.3, 1.7, 900.0, 1e-4, 0.0].map(|x: f32| x * (k % 13) as f32);
        let before: Vec<PixelSums> = (0..paths.len())
            .map(|k| {
                let [a, b, c, d, e] = sum(k);
                let small = [a, b, c, d].map(|x| x * 1e-8);
                [[a, b, c, d], small, [b, e, a, c]].map(|four| four.map(f32::to_bits))
            })
            .collect();
        let after = paths.iter().zip(&before).map(|(path, sums)| self.accumulate(path, *sums));
        let after = after.collect();
        recorded.film = RecordedFilm { before, after };
        recorded
    }
}

fn scene(spheres: &[[f32; 4]]) -> Scene {
    let colored = |(i, s): (usize, &[f32; 4])| {
        let level = |k: usize| ((i * k) % 17 + 1) as f32 / 18.0;
        let [x, y, z, radius] = s.map(f64::from);
        Sphere::new([x, y, z], radius, LinearRgb::new([level(3), level(5), level(7)]).unwrap())
    };
    Scene::new(&spheres.iter().enumerate().map(colored).collect::<Vec<_>>()).unwrap()
}

fn scenes() -> Vec<Scene> {
    let random = |seed| spheres::random(40, seed, |rng| 0.02 + 0.1 * rng.f32());
    let far: Vec<_> =
        random(3).iter().map(|[x, y, z, r]| [x + 1e6, y - 2e6, z + 3e6, *r]).collect();
    let small: Vec<_> = random(5).iter().map(|s| s.map(|x| x * 2_f32.powi(-13))).collect();
    [random(1), spheres::four_decades(60), spheres::twice(20), spheres::nested(12), far, small]
        .iter()
        .map(|spheres| scene(spheres))
        .collect()
}

/// Two samples of such a device, which sees a scene from inside, with a film of this size, for other tests. The recording
/// by one ray for each pixel has no rays.
pub(crate) fn followed(number: usize, film: Film) -> (Scene, Recording, PathRecording) {
    let scene = scenes().swap_remove(number);
    let center = scene.bounds_to_frame().center();
    let within = Pose::looking_along(center, [0.3, -0.4, 0.8], [0.1, 1.0, 0.2]).unwrap();
    let camera = PanoramaCamera::new(within);
    let mut picture = given(&scene, &camera, film);
    let missed = TracedPixel { t: NO_HIT, id: NO_ID, ..TracedPixel::default() };
    picture.pixels = vec![missed; film.pixel_count() as usize];
    picture.image = Image::new(film.width(), film.height(), LayerSet::DATA).unwrap();
    let mut made = recording(&scene, &camera, film);
    for habit in [Habit::Up, Habit::Random] {
        let mut device = LegalDevice { habit, random: fastrand::Rng::with_seed(7) };
        let followed = device.follow(&scene, &made);
        made.samples.push(followed);
    }
    (scene, picture, made)
}

#[test]
fn no_conforming_device_is_accused_of_its_paths() {
    let (mut checked, mut undecided) = (0, 0);
    for (number, scene) in scenes().iter().enumerate() {
        let bounds = scene.bounds_to_frame();
        let (center, size) = (bounds.center(), bounds.size().max_element());
        let eye = center + pinhole::glam::DVec3::new(1.2, 0.7, 1.9) * size;
        let pose = Pose::looking_at(eye, center, [0.1, 1.0, 0.2]).unwrap();
        let within = Pose::looking_along(center, [0.3, -0.4, 0.8], [0.1, 1.0, 0.2]).unwrap();
        let pinhole = PinholeCamera::with_vertical_fov(pose, 0.5, 1.3).unwrap();
        let lens = ThinLensCamera::new(pinhole, 0.05 * size, 2.0 * size).unwrap();
        let cameras: [&dyn Camera; 2] = [&lens, &PanoramaCamera::new(within)];
        let checker = Checker::new(scene).unwrap();
        for camera in cameras {
            let mut made = recording(scene, camera, Film::new(29, 23).unwrap());
            for habit in [Habit::Nearest, Habit::Up, Habit::Down, Habit::Random] {
                let random = fastrand::Rng::with_seed(number as u64);
                let mut device = LegalDevice { habit, random };
                made.samples = vec![device.follow(scene, &made)];
                let certificate = checker.certify_paths(&made);
                assert_ne!(
                    certificate.outcome(),
                    Outcome::Violated,
                    "scene {number}, {}, {habit:?}: {certificate}",
                    camera.kind().name()
                );
                checked += certificate.stages().checked;
                undecided += certificate.stages().undecided;
            }
        }
    }
    // A set of everything would be sound as well.
    assert!(checked > 100_000 && undecided < checked / 50, "{undecided} of {checked}");
}
