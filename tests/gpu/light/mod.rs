//! Tests that lit pictures of the GPU agree with pictures of the CPU reference for the same random numbers.

mod passes;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::{AccelChoice, Structure};
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::cpu::SearchStructure;
use pinhole::glam::DVec3;
use pinhole::gpu::{Decision, GpuError, Headless, PictureRequest, Progress, SampleRequest, Wait};
use pinhole::image::denoise::GUIDES;
use pinhole::light::{Ground, Sky, SkyLight};
use pinhole::scene::material::SurfaceProperties;
use pinhole::verify::Outcome;
use pinhole::verify::denoised::{DenoiseCertificate, certify};
use pinhole::{Film, Image, LayerSet, LinearRgb, Material, RenderSettings, Scene, Sphere, cpu};

use crate::pictures::go_on;
use crate::planted::planted;
use crate::support::View;
use crate::{headless, lit_scenes, planted, trial};

/// Minimum peak signal-to-noise ratio in decibels, for a peak of 1.
const LEAST_PSNR: f64 = 60.0;

/// Maximum error of a component of a pixel if all samples took the same path.
const SAME_WAY: f64 = 2e-3;

/// Maximum fraction of pixels with a sample that took another path: at a silhouette, between equally
/// near spheres, or at a random choice.
const MAX_OTHER: f64 = 0.02;

pub(crate) fn trials() -> Vec<Trial> {
    [own(), denoised_pictures()].into_iter().flatten().collect()
}

fn own() -> Vec<Trial> {
    let agreements =
        lit_scenes::all().map(|(name, view)| Trial::test(format!("light::agreement::{name}"), move || agree(&view)));
    let others = [
        trial("light::batches_do_not_change_samples", batches),
        trial("light::denoising_is_the_reference's", denoising),
        trial("light::shadows_have_a_structure_of_the_kind_that_is_asked_for", occluders),
        trial("light::a_studio_that_lacks_its_occluders_is_an_error", no_occluders),
        trial("light::only_primary_rays_are_recorded", not_recorded),
        trial("light::emitters_beyond_one_layer_are_sampled", several_layers),
    ];
    agreements.chain(others).chain(passes::trials()).collect()
}

fn agree(view: &View) -> Result<(), Failed> {
    let wanted = cpu::render(&view.scene, &view.seen(), &view.settings, LayerSet::ALL)?;
    agree_with(view, &wanted)
}

fn agree_with(view: &View, wanted: &Image) -> Result<(), Failed> {
    let found = view.picture(headless()?, LayerSet::ALL);
    let colors = found.color().iter().zip(wanted.color());
    let differences: Vec<f64> =
        colors.map(|(a, b)| (0..3).map(|c| f64::from((a[c] - b[c]).abs())).fold(0.0, f64::max)).collect();
    let squares = found
        .color()
        .iter()
        .zip(wanted.color())
        .flat_map(|(a, b)| (0..3).map(move |c| f64::from(a[c].min(1.0) - b[c].min(1.0)).powi(2)));
    let count = view.film.pixel_count() as f64;
    let mean_square = squares.sum::<f64>() / (3.0 * count);
    let psnr = -10.0 * mean_square.max(1e-20).log10();
    let other = differences.iter().filter(|difference| **difference > SAME_WAY).count();
    let worst = differences.iter().copied().fold(0.0, f64::max);
    let brightest = wanted.color().iter().flatten().copied().fold(0.0, f32::max);
    println!("{psnr:.1} dB, {other} pixels went another way, worst {worst:.2e}, brightest {brightest}");
    let alphas = found.alpha().unwrap_or_default().iter().zip(wanted.alpha().unwrap_or_default());
    let alpha = alphas.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    if psnr < LEAST_PSNR || other as f64 > MAX_OTHER * count || alpha > 0.05 {
        return Err(format!("{psnr} dB, {other} pixels differ, by {worst}; alpha by {alpha}").into());
    }
    if found.samples() != wanted.samples() || found.id() != wanted.id() {
        return Err("samples or ids differ".into());
    }
    Ok(())
}

/// A picture that is finished early is identical to a picture that was requested with the same number of samples.
fn batches(device: &'static Headless) {
    let mut view = lit_scenes::sampled("path_lobes_and_metals", 1000);
    let buffers = view.uploaded(device, AccelChoice::Auto);
    let enough = &mut |progress: &Progress| {
        if progress.samples >= 8 { Decision::Finish } else { Decision::GoOn }
    };
    let early = view.watched(device, &buffers, LayerSet::COLOR, enough).unwrap();
    assert!((8..=64).contains(&early.samples), "{}", early.samples);
    view.settings.sampling.samples = early.samples;
    assert_eq!(early.image, view.picture(device, LayerSet::COLOR));
}

fn denoising(device: &'static Headless) {
    let mut view = lit_scenes::sampled("path_lobes_and_metals", 4);
    let noisy = view.picture(device, LayerSet::ALL);
    let quiet = device.denoise(&noisy).wait().unwrap();
    let wanted = cpu::denoise(&noisy).unwrap();
    for (a, b) in quiet.color().iter().zip(wanted.color()) {
        for c in 0..3 {
            assert!((a[c] - b[c]).abs() <= 1e-4 * b[c].max(1.0), "{a:?} {b:?}");
        }
    }
    view.settings.sampling.samples = 512;
    let reference = view.picture(device, LayerSet::ALL);
    let error = |image: &Image| {
        let squares = image.color().iter().zip(reference.color());
        squares.map(|(a, b)| (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>()).sum::<f64>()
    };
    assert!(error(&quiet) < 0.5 * error(&noisy), "{} of {}", error(&quiet), error(&noisy));
}

/// Spheres of which every second is not opaque. There are enough that every structure pays off.
fn translucent(side: u32, settings: RenderSettings) -> View {
    let spheres: Vec<Sphere> = (0..400)
        .map(|i| {
            let center = [f64::from(i % 20), f64::from(i / 20), 0.0];
            let sphere = Sphere::new(center, 0.4, LinearRgb::from_srgb8([128; 3]));
            if i % 2 == 0 { sphere.with_opacity(0.5) } else { sphere }
        })
        .collect();
    let scene = Scene::new(&spheres).unwrap();
    let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.0).unwrap();
    View { scene, camera: Box::new(camera), film: Film::new(side, side).unwrap(), settings }
}

fn occluders(device: &'static Headless) {
    let mut studio = RenderSettings::studio();
    studio.sampling.samples = 2;
    let view = translucent(32, studio);
    let plan_for = |scene: &Scene, settings: &RenderSettings, choice| {
        let seen = view.seen();
        device.plan(&PictureRequest::new(scene, &seen, settings, LayerSet::COLOR), choice)
    };
    let scene = &view.scene;
    let mut images = Vec::new();
    for (choice, structure) in [(AccelChoice::Tree, Structure::WideTree), (AccelChoice::List, Structure::List)] {
        let plan = plan_for(scene, &view.settings, choice);
        let occluders = plan.occluders.as_ref().unwrap();
        assert_eq!((plan.accel.structure, occluders.structure), (structure, structure));
        assert_eq!(occluders.statistics.count, 200);
        let structures = plan.build(scene);
        assert_eq!(structures.occluders.as_ref().unwrap().structure(), structure);
        let buffers = device.upload(scene, &structures).wait().unwrap();
        let planned: u64 = plan.scene_buffers.iter().map(|buffer| buffer.bytes).sum();
        // The plan does not count the records of bricks and the single appearance words.
        assert!(buffers.bytes() <= planned + 400, "{} of {planned}", buffers.bytes());
        images.push(view.watched(device, &buffers, LayerSet::COLOR, &mut go_on));
    }
    assert!(images[0].is_ok() && images.iter().all(|image| *image == images[0]));
    for settings in [RenderSettings::default(), RenderSettings::path()] {
        let plan = plan_for(scene, &settings, AccelChoice::Tree);
        assert!(plan.occluders.is_none(), "{}", settings.integrator.name());
    }
    // If all spheres are opaque, one structure suffices.
    let opaque = Scene::from_f32(scene.spheres().to_vec(), LinearRgb::from_srgb8([128; 3])).unwrap();
    assert!(plan_for(&opaque, &view.settings, AccelChoice::Tree).occluders.is_none());
}

fn no_occluders(device: &'static Headless) {
    let view = translucent(8, RenderSettings::studio());
    let buffers = view.uploaded(device, AccelChoice::Auto);
    let render = |mut settings: RenderSettings| {
        settings.sampling.samples = 1;
        let (seen, layers) = (view.seen(), LayerSet::COLOR);
        device.render_uploaded(&buffers, &seen, &settings, layers, &mut go_on).wait()
    };
    let error = render(RenderSettings::studio()).unwrap_err();
    assert_eq!(error, GpuError::NoOccluders);
    assert!(error.to_string().contains("RenderPlan::build"), "{error}");
    // Other integrators do not need the occluders.
    assert_eq!(render(RenderSettings::path()).unwrap().samples, 1);
    let primary = render(RenderSettings::default()).unwrap();
    assert_eq!((primary.samples, primary.noise, primary.hits), (1, None, None));
}

fn not_recorded(device: &'static Headless) {
    let path = translucent(8, RenderSettings::path());
    let (buffers, view) = (path.uploaded(device, AccelChoice::Auto), path.seen());
    let refused = |integrator| Some(GpuError::NotPrimary { integrator });
    let recording = device.record(&buffers, &view, &path.settings, &mut go_on).wait();
    assert_eq!(recording.err(), refused("path"));
    let certificate = device.verify(&path.scene, &view, &RenderSettings::studio()).wait();
    assert_eq!(certificate.err(), refused("studio"));
    let (settings, request) = (RenderSettings::default(), SampleRequest::middle(&[0]));
    let light = device.record_lit(&buffers, &view, &settings, request, &mut |_| {}, &mut go_on).wait();
    assert_eq!(light.err(), Some(GpuError::NotLit));
}

/// A ceiling of lamps above a matt ground. The first layer of the table holds 1,398,101 of them.
fn several_layers(_: &'static Headless) {
    const COLUMNS: usize = 1250;
    let lamps: Vec<[f64; 4]> = (0..1200 * COLUMNS)
        .map(|i| {
            let (row, column) = ((i / COLUMNS) as f64, (i % COLUMNS) as f64);
            // The lamps of the last rows are in the second layer. They are larger and give most of the light.
            let radius = if row < 1120.0 { 0.002 } else { 0.008 };
            [0.02 * column - 12.5, 2.0, 0.02 * row - 12.0, radius]
        })
        .collect();
    let surface =
        SurfaceProperties { material: Material::Emissive { strength: 400.0 }, ..SurfaceProperties::default() };
    let scene = Scene::from_f64(&lamps, LinearRgb::WHITE).unwrap().with_surface(surface);
    let pose = Pose::looking_at([0.0, 1.0, 4.0], [0.0, 0.0, 11.0], [0.0, 1.0, 0.0]).unwrap();
    let mut settings = RenderSettings::path();
    settings.lights = Vec::new();
    settings.sky = Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: true };
    let (point, normal, color) = (DVec3::ZERO, DVec3::Y, LinearRgb::WHITE);
    settings.ground = Some(Ground { point, normal, color, is_shadow_catcher: false });
    settings.sampling.samples = 16;
    let view = View {
        scene,
        camera: Box::new(PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()),
        film: Film::new(24, 24).unwrap(),
        settings,
    };
    let tree = SearchStructure::new(&view.scene).unwrap();
    let wanted = cpu::render(&tree, &view.seen(), &view.settings, LayerSet::ALL).unwrap();
    let mean = wanted.color().iter().map(|c| f64::from(c[1])).sum::<f64>() / 576.0;
    assert!(mean > 0.01, "{mean}");
    agree_with(&view, &wanted).unwrap();
}

fn denoised_pictures() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, view) in lit_scenes::all() {
        trials.push(Trial::test(format!("denoised::legal::{name}"), move || {
            let found = denoised(headless()?, view)?;
            // From inside a sphere, similar pixels are so dark that one in a hundred is undecided.
            match found.violation_count == 0 && found.undecided <= found.pixels / 50 {
                true => Ok(()),
                false => Err(format!("{found:?}").into()),
            }
        }));
    }
    trials.extend(planted::trials("denoised::faults::", planted("denoised"), |fault| {
        let view = lit_scenes::named("path_lobes_and_metals");
        let found = denoised(&fault.device()?, view)?;
        println!("{} of {} pixels", found.violation_count, found.pixels);
        match found.outcome() {
            Outcome::Violated => Ok(()),
            outcome => Err(format!("the fault was not found: {outcome}").into()),
        }
    }));
    trials
}

fn denoised(device: &Headless, mut view: View) -> Result<DenoiseCertificate, Failed> {
    view.settings.sampling.samples = 4;
    let noisy = device.render(&view.scene, &view.seen(), &view.settings, GUIDES).wait()?;
    Ok(certify(&noisy, &device.denoise(&noisy).wait()?)?)
}
