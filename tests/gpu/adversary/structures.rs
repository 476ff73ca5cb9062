//! Tests that no structure leaves out a sphere on a device that rounds as it likes: all give the same hits, to the bit.
//! On such a device, equal operands have equal results in all kernels.

use libtest_mimic::Failed;
use pinhole::accel::{AccelChoice, AccelPlan};
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::gpu::Headless;
use pinhole::{Film, LinearRgb, RenderSettings, Scene, View};

use super::{Device, go_on, open};
use crate::any_rounding::{Adversary, Rounding};
use crate::support::spheres;

static ALIKE: Device =
    Device::new(|| open(Adversary { is_alike: true, ..Adversary::new(Rounding::EachItsOwn, 3) }));

/// The bits of the distance and the id of every pixel's hit. `box_margin` is that of boxes for ray queries.
pub(crate) fn hits(
    headless: &Headless,
    scene: &Scene,
    view: &View<'_>,
    choice: AccelChoice,
    box_margin: f32,
) -> Result<Vec<(u32, u32)>, Failed> {
    let plan = AccelPlan::new(scene.spheres(), choice, 1 << 27);
    let plan = plan.with_box_margin(box_margin);
    let buffers = headless.upload(scene, &plan.build(scene.spheres()).into())?;
    let recording = headless.record(&buffers, view, &RenderSettings::default(), &mut go_on())?;
    Ok(recording.pixels.iter().map(|pixel| (pixel.t.to_bits(), pixel.id)).collect())
}

/// Calls `test` with a view of all of a scene.
pub(crate) fn seen<T>(
    scene: &Scene,
    test: impl FnOnce(&View<'_>) -> Result<T, Failed>,
) -> Result<T, Failed> {
    let bounds = scene.bounds_to_frame();
    let (center, size) = (bounds.center(), bounds.size().max_element());
    let eye = center + pinhole::glam::DVec3::new(0.3, 0.2, 0.9) * size;
    let pose = Pose::looking_at(eye, center, [0.1, 1.0, 0.2])?;
    let camera = PinholeCamera::with_vertical_fov(pose, 0.6, 1.0)?;
    test(&View::new(&camera, Film::new(112, 112)?))
}

pub(super) fn agree() -> Result<(), Failed> {
    let headless = ALIKE.as_ref()?;
    // Small spheres in a large box, beside which its margin is not small, and spheres that touch.
    let scenes = [
        ("small", spheres::random(6000, 5, |_| 1e-3)),
        ("four decades", spheres::four_decades(3000)),
        ("a line that touches", spheres::line(300)),
        ("mirrored pairs", spheres::mirrored(1000)),
    ];
    for (name, spheres) in scenes {
        let scene = Scene::from_f32(spheres, LinearRgb::WHITE)?;
        let expected = seen(&scene, |view| hits(headless, &scene, view, AccelChoice::List, 1.0))?;
        let misses = expected.iter().filter(|(_, id)| *id == pinhole::image::NO_ID).count();
        println!("{name}: {} hits", expected.len() - misses);
        if expected.len() - misses < 40 {
            return Err(format!("{name}: few hits").into());
        }
        for choice in [AccelChoice::Grid, AccelChoice::Tree] {
            let found = seen(&scene, |view| hits(headless, &scene, view, choice, 1.0))?;
            let different = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
            if different > 0 {
                return Err(format!("{name}: {different} hits differ in {choice:?}").into());
            }
        }
    }
    Ok(())
}
