//! Tests that pictures of every kind of colours are identical to those of spheres with individual colours.

use libtest_mimic::{Failed, Trial};
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::{Film, Image, LayerSet, RenderSettings, Scene, View};

use crate::headless;
use crate::support::appearances::{kinds, settings};

pub(crate) fn trials() -> Vec<Trial> {
    kinds()
        .into_iter()
        .map(|kind| {
            Trial::test(format!("appearance::{}", kind.name), move || {
                let (found, expected) = (pictures(&kind.scene)?, pictures(&kind.expected)?);
                if found == expected { Ok(()) } else { Err("another picture".into()) }
            })
        })
        .collect()
}

pub(crate) fn camera() -> PinholeCamera {
    let pose = Pose::looking_at([1.0, 2.0, 8.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()
}

/// Pictures with one ray for each pixel, of a studio, and of paths.
fn pictures(scene: &Scene) -> Result<[Image; 3], Failed> {
    let (headless, camera) = (headless()?, camera());
    let view = View::new(&camera, Film::new(64, 64)?);
    if !headless.verify(scene, &view, &RenderSettings::default())?.is_legal() {
        return Err("the picture is not legal".into());
    }
    let render = |settings| headless.render(scene, &view, &settings, LayerSet::ALL);
    let [primary, studio, path] = settings();
    Ok([render(primary)?, render(studio)?, render(path)?])
}
