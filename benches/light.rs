//! Measures the time for light in addition to the primary rays: ambient rays, shadow rays and diffuse bounces.
//!
//! ```sh
//! cargo bench --bench light              # R1M and C200k
//! cargo bench --bench light -- R1M
//! ```
//! The time of one kind of ray is the difference of two pictures that differ only in these rays, divided by their
//! number.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark may panic, and prints")]

use std::time::Instant;

use pinhole::accel::AccelChoice;
use pinhole::generate::Standard;
use pinhole::gpu::{Decision, Headless, HeadlessOptions, Picture, SceneBuffers, Wait};
use pinhole::light::{Light, Sky, SkyLight};
use pinhole::render::{Integrator, LightSampling, Occlusion, PathTracing, Sampling, Studio};
use pinhole::{LayerSet, LinearRgb, PixelFilter, RenderSettings, Scene, Shading, View};

/// Number of times that everything is measured. The best time counts.
const TURNS: usize = 5;

fn main() {
    let headless = Headless::open(&HeadlessOptions::default()).wait().unwrap();
    let info = headless.adapter_info();
    println!("{} ({:?}), {} {}\n", info.name, info.backend, info.driver, info.driver_info);
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    for standard in [Standard::R1M, Standard::C200k, Standard::L1M, Standard::R10M] {
        let is_named = wanted.iter().any(|name| name == standard.name());
        let by_default = [Standard::R1M, Standard::C200k].contains(&standard);
        if is_named || (wanted.is_empty() && by_default) {
            measure(&headless, standard);
        }
    }
}

struct Subject<'a> {
    headless: &'a Headless,
    scene: SceneBuffers,
    view: View<'a>,
}

impl Subject<'_> {
    fn picture(&self, settings: &RenderSettings) -> (f64, Picture) {
        let started = Instant::now();
        let go_on = &mut |_: &_| Decision::GoOn;
        let picture =
            self.headless.render_uploaded(&self.scene, &self.view, settings, LayerSet::COLOR, go_on).wait().unwrap();
        (started.elapsed().as_secs_f64(), picture)
    }
}

fn studio(samples: u32, occlusion: Option<Occlusion>, lights: Vec<Light>) -> RenderSettings {
    let studio = Studio { occlusion, ..Studio::default() };
    RenderSettings {
        integrator: Integrator::Studio(studio),
        lights,
        sampling: Sampling { samples, seed: 0, filter: PixelFilter::Box, denoise: false },
        ..RenderSettings::studio()
    }
}

/// Grey spheres under a white sky, without direct light, so that each bounce is one ray.
fn path(samples: u32, max_depth: u32) -> RenderSettings {
    let light_sampling = LightSampling::Chance;
    let mut lighting = studio(samples, None, Vec::new());
    lighting.integrator = Integrator::Path(PathTracing { max_depth, roulette_from: 64, light_sampling });
    lighting.sky = Sky { light: SkyLight::Constant(LinearRgb::WHITE), is_visible: true };
    lighting
}

fn measure(headless: &Headless, standard: Standard) {
    let grey = LinearRgb::from_srgb8([128, 128, 128]);
    let scene = Scene::from_f32(standard.spheres().unwrap(), grey).unwrap();
    let (camera, film) = (standard.camera().unwrap(), standard.film().unwrap());
    let accel = headless.plan_accel(&scene, AccelChoice::Auto).build(scene.spheres());
    let buffers = headless.upload(&scene, &accel.into()).wait().unwrap();
    let view = View::new(&camera, film);
    let subject = Subject { headless, scene: buffers, view };
    const RAYS: u32 = 4;
    let near = Occlusion { radius: Some(0.02), samples: RAYS };
    let far = Occlusion { radius: None, samples: RAYS };
    let lights = Light::key_and_fill().to_vec();
    let pictures = [
        ("no light", studio(2, None, Vec::new())),
        ("ambient light, near", studio(2, Some(near), Vec::new())),
        ("ambient light, far", studio(2, Some(far), Vec::new())),
        ("two shadows", studio(2, None, lights.clone())),
        ("path, 1 bounce", path(2, 1)),
        ("path, 3 bounces", path(2, 3)),
        ("studio: two shadows, 16 ambient rays", studio(1, Some(Occlusion { radius: None, samples: 16 }), lights)),
    ];
    let mut best = vec![f64::INFINITY; pictures.len()];
    let mut hits = vec![0.0; pictures.len()];
    let mut bare = f64::INFINITY;
    let (mut plain, mut traced) = ([f64::INFINITY; 2], 0);
    for _ in 0..TURNS {
        let time = headless.measure(&subject.scene, &view).wait().unwrap();
        traced = time.pixels;
        bare = bare.min(time.wall.as_secs_f64());
        for (best, shading) in plain.iter_mut().zip([Shading::Flat, Shading::Headlight]) {
            let integrator = Integrator::Primary(shading);
            let settings = RenderSettings { integrator, ..RenderSettings::default() };
            *best = best.min(subject.picture(&settings).0);
        }
        for (index, (_, settings)) in pictures.iter().enumerate() {
            let (seconds, picture) = subject.picture(settings);
            best[index] = best[index].min(seconds);
            hits[index] = picture.hits.unwrap() / f64::from(picture.samples);
        }
    }
    let pixels = film.pixel_count() as f64;
    // Rays that cannot hit the box of the scene are not traced.
    let primary = bare / traced as f64;
    let name = standard.name();
    let share = |count: f64| 100.0 * count / pixels;
    let (traced, met) = (share(traced as f64), share(hits[0]));
    println!("{name}: {traced:.1} % of the camera's rays are traced, {met:.1} % meet a sphere");
    println!("  a primary ray, bare            {:8.1} ns", 1e9 * primary);
    let [flat, headlight, bare] = [plain[0], plain[1], bare].map(|seconds| 1e3 * seconds);
    println!("  a picture: flat {flat:.1} ms, headlight {headlight:.1} ms; tracing alone {bare:.1} ms");
    let report = |what: &str, seconds: f64, rays: f64| {
        let ray = seconds / rays;
        println!("  {what:30} {:8.1} ns, {:.2} of a primary ray", 1e9 * ray, ray / primary);
    };
    report("a lit sample's primary ray", best[0] / 2.0, pixels);
    report("an ambient ray, near", best[1] - best[0], 2.0 * hits[0] * f64::from(RAYS));
    report("an ambient ray, far", best[2] - best[0], 2.0 * hits[0] * f64::from(RAYS));
    report("a shadow ray", best[3] - best[0], 2.0 * hits[0] * 2.0);
    report("a diffuse bounce", best[5] - best[4], 2.0 * hits[0] * 2.0);
    let rays = pixels + hits[0] * 18.0;
    println!("  {}: {:.2} s, {:.1} million rays\n", pictures[6].0, best[6], rays / 1e6);
}
