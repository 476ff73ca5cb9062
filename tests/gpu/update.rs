//! Tests that pictures of every kind of colours are identical to pictures of spheres with individual colours. The same
//! for an updated scene and a scene that was created with the new values.

use fastrand::Rng;
use libtest_mimic::{Failed, Trial};
use pinhole::accel::{AccelChoice, AccelPlan};
use pinhole::gpu::{
    ColorTarget, GpuError, Headless, PictureRequest, Recolor, Renderer, RendererOptions, SceneBuffers, Wait,
};
use pinhole::scene::{Centers, NewColors, SceneUpdate};
use pinhole::{Film, Image, LayerSet, RenderSettings, Scene, View};

use crate::host_program::Host;
use crate::pictures::go_on;
use crate::support::appearances::{Numbers, camera, kinds, settings};
use crate::{headless, trial};

pub(crate) fn trials() -> Vec<Trial> {
    let of_kinds = kinds()
        .into_iter()
        .map(|kind| Trial::test(format!("update::{}", kind.name), move || updated(kind.scene.clone())));
    let others = [
        trial("update::frames_and_bindings_survive_colors", survives),
        trial("update::colors_of_ranges_in_bricks", in_bricks),
    ];
    let appearances = kinds().into_iter().map(|kind| {
        Trial::test(format!("appearance::{}", kind.name), move || {
            let (found, expected) = (pictures(&kind.scene)?, pictures(&kind.expected)?);
            if found == expected { Ok(()) } else { Err("another picture".into()) }
        })
    });
    of_kinds.chain(others).chain(appearances).collect()
}

fn shown(headless: &Headless, buffers: &SceneBuffers, settings: &RenderSettings) -> Result<Image, GpuError> {
    let (camera, film) = (camera(), Film::new(40, 40).unwrap());
    let (view, layers) = (View::new(&camera, film), LayerSet::ALL);
    Ok(headless.render_uploaded(buffers, &view, settings, layers, &mut go_on).wait()?.image)
}

fn uploaded(headless: &Headless, scene: &Scene) -> Result<SceneBuffers, GpuError> {
    let camera = camera();
    let view = View::new(&camera, Film::new(40, 40).unwrap());
    let settings = RenderSettings::studio();
    let request = PictureRequest::new(scene, &view, &settings, LayerSet::ALL);
    headless.upload(scene, &headless.plan(&request, AccelChoice::Auto).build(scene)).wait()
}

fn updated(mut scene: Scene) -> Result<(), Failed> {
    let headless = headless()?;
    let mut random = Rng::with_seed(42);
    let mut buffers = uploaded(headless, &scene)?;
    for _ in 0..6 {
        let first = random.usize(..scene.len());
        let count = random.usize(1..=scene.len() - first);
        let numbers = Numbers::of(&mut random, count);
        let Numbers { centers, radii, .. } = &numbers;
        let update = SceneUpdate {
            first: first as u32,
            centers: (random.u8(..3) == 0).then_some(Centers::F32(centers)),
            radii: (random.u8(..3) == 0).then_some(&radii[..]),
            colors: numbers.colors(&scene),
        };
        scene.apply(&update)?;
        headless.update(&mut buffers, &scene, &update).wait()?;
        let fresh = uploaded(headless, &scene)?;
        for settings in settings() {
            if shown(headless, &buffers, &settings)? != shown(headless, &fresh, &settings)? {
                return Err("another picture".into());
            }
        }
    }
    Ok(())
}

/// A brick may lack a sphere, or contain copies of a sphere that is also in other bricks.
fn in_bricks(headless: &'static Headless) {
    let [_, _, rgba8] = [0, 4, 8].map(|kind| kinds().swap_remove(kind));
    let mut scene = rgba8.scene;
    let mut random = Rng::with_seed(43);
    for choice in [AccelChoice::List, AccelChoice::Grid, AccelChoice::Tree] {
        let plan = AccelPlan::new(scene.spheres(), choice, 16 * 40);
        let built = plan.build(scene.spheres());
        assert!(built.bricks().len() > 1);
        let mut buffers = headless.upload(&scene, &built.into()).wait().unwrap();
        let bytes = buffers.bytes();
        for (first, count) in [(0, 60), (17, 1), (59, 1), (20, 30), (3, 0)] {
            let mut rgba = Numbers::of(&mut random, count).rgba;
            rgba.iter_mut().for_each(|color| color[3] = 255);
            let colors = Some(NewColors::Rgba8(&rgba));
            let update = SceneUpdate { first, colors, ..SceneUpdate::default() };
            scene.apply(&update).unwrap();
            assert!(buffers.takes_in_place(&scene, &update));
            headless.update(&mut buffers, &scene, &update).wait().unwrap();
            assert_eq!(buffers.bytes(), bytes);
            let settings = RenderSettings::default();
            let camera = camera();
            let view = View::new(&camera, Film::new(40, 40).unwrap());
            let fresh = headless.render(&scene, &view, &settings, LayerSet::ALL).wait().unwrap();
            assert!(shown(headless, &buffers, &settings).unwrap() == fresh, "{choice}");
        }
    }
}

/// An application records new colours into its own encoder, and continues with its existing frame.
fn survives(headless: &'static Headless) {
    let (device, queue) = (headless.device(), headless.queue());
    let mut scene = kinds().swap_remove(8).scene;
    let options = RendererOptions { color: ColorTarget::Linear32, ..RendererOptions::default() };
    let renderer = Renderer::new(device, &options).wait().unwrap();
    let recolor = Recolor::new(device).wait().unwrap();
    let mut buffers = SceneBuffers::new(&renderer, device, queue, &scene).wait().unwrap();
    let host = Host { device: device.clone(), queue: queue.clone() };
    let layers = host.layers([40, 40], options.color.texture_format());
    let mut frame = layers.frame(&renderer, device, false);
    let camera = camera();
    let view = View::new(&camera, Film::new(40, 40).unwrap());
    let settings = RenderSettings::default();
    frame.set_view(queue, &buffers, &view, &settings).unwrap();

    let colors =
        SceneUpdate { first: 7, colors: Some(NewColors::Rgba8(&[[9, 8, 7, 255]; 20])), ..SceneUpdate::default() };
    scene.apply(&colors).unwrap();
    let mut encoder = host.encoder();
    recolor.record(device, queue, &mut encoder, &mut buffers, &scene, &colors).wait().unwrap();
    renderer.record(&mut encoder, &buffers, &frame).unwrap();

    let radii = SceneUpdate { first: 3, radii: Some(&[0.5]), ..SceneUpdate::default() };
    scene.apply(&radii).unwrap();
    let refused = recolor.record(device, queue, &mut encoder, &mut buffers, &scene, &radii).wait();
    assert_eq!(refused, Err(GpuError::NotInPlace));
    buffers.replace(SceneBuffers::new(&renderer, device, queue, &scene).wait().unwrap());
    let stale = renderer.record(&mut encoder, &buffers, &frame);
    assert_eq!(stale, Err(GpuError::OtherScene));
    frame.set_view(queue, &buffers, &view, &settings).unwrap();
    renderer.record(&mut encoder, &buffers, &frame).unwrap();
    host.submit(encoder);
}

/// Pictures with one ray for each pixel, of a studio, and of paths.
fn pictures(scene: &Scene) -> Result<[Image; 3], Failed> {
    let (headless, camera) = (headless()?, camera());
    let view = View::new(&camera, Film::new(64, 64)?);
    if !headless.verify(scene, &view, &RenderSettings::default()).wait()?.is_legal() {
        return Err("the picture is not legal".into());
    }
    let render = |settings| headless.render(scene, &view, &settings, LayerSet::ALL).wait();
    let [primary, studio, path] = settings();
    Ok([render(primary)?, render(studio)?, render(path)?])
}
