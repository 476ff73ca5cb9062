//! Tables of cameras in scene files.

use glam::{DVec2, DVec3};
use pinhole::camera::{Camera, CameraKind};
use pinhole::scene_file::SceneFile;
use pinhole::{Film, glam};

use crate::support::View;

/// Of a scene of one sphere, two units ahead.
fn camera(table: &str) -> Result<Box<dyn Camera>, String> {
    let text = format!("{table}\n[[spheres]]\ncenter=[0,0,-2]\nradius=1\n");
    let file = SceneFile::parse(&text).map_err(|error| error.message)?;
    let scene = file.scene(&[]).unwrap();
    file.camera(&Film::new(30, 20).unwrap(), &scene).map_err(|error| error.message)
}

const EYE: &str = "eye = [0, 0, 0]\ndirection = [0, 0, -1]\n";

#[test]
fn every_camera_has_an_example() {
    for (text, kind) in [
        (include_str!("../../examples/three-spheres.toml"), CameraKind::Pinhole),
        (include_str!("../../examples/stereo.toml"), CameraKind::Pinhole),
        (include_str!("../../examples/three-spheres-orthographic.toml"), CameraKind::Orthographic),
        (include_str!("../../examples/thin-lens.toml"), CameraKind::ThinLens),
        (include_str!("../../examples/panorama.toml"), CameraKind::Panorama),
        (include_str!("../../examples/fisheye.toml"), CameraKind::Fisheye),
    ] {
        let view = View::from_toml(text);
        assert_eq!(view.camera.kind(), kind);
        let image = view.reference();
        let ids: std::collections::BTreeSet<u32> = image.id().unwrap().iter().copied().collect();
        // All spheres, and the background.
        assert_eq!(ids.len(), view.scene.spheres().len() + 1, "{kind:?}: {ids:?}");
    }
}

#[test]
fn a_lens_is_focused_where_the_table_says() {
    for (keys, distance) in [
        ("focus_distance = 3", 3.0),
        ("focus_on = [5, 1, -4]", 4.0),
        ("aperture_radius = 0.1\nfocus_distance = 7", 7.0),
    ] {
        let radius =
            if keys.contains("aperture") { "" } else { "f_stop = 2\nfocal_length = 0.4\n" };
        let camera = camera(&format!("[camera.thin-lens]\n{EYE}{radius}{keys}")).unwrap();
        let vectors = camera.vectors();
        assert!((vectors.forward - DVec3::new(0.0, 0.0, -distance)).length() < 1e-12, "{keys}");
        let edge = camera.ray_through_lens(DVec2::ZERO, DVec2::new(0.0, 0.5));
        assert!((edge.origin - DVec3::new(-0.1, 0.0, 0.0)).length() < 1e-12, "{keys}");
    }
    let looking_at =
        "[camera.thin-lens]\neye = [0, 0, 0]\nlook_at = [3, 0, -4]\naperture_radius = 1";
    assert!((camera(looking_at).unwrap().vectors().forward.length() - 5.0).abs() < 1e-12);
    let framed = camera("[camera.thin-lens]\naperture_radius = 0.1").unwrap().vectors();
    assert!((framed.origin + framed.forward - DVec3::new(0.0, 0.0, -2.0)).length() < 1e-12);
}

#[test]
fn a_panorama_without_an_eye_stands_in_the_middle() {
    let ray = camera("[camera.panorama]").unwrap().ray_in_world(DVec2::ZERO);
    assert!((ray.origin - DVec3::new(0.0, 0.0, -2.0)).length() < 1e-12);
    assert!((ray.direction - DVec3::NEG_Z).length() < 1e-12);
}

#[test]
fn two_eyes_are_a_table_within() {
    let eyes = |table: &str| {
        let file = SceneFile::parse(&format!("{table}\n")).unwrap();
        let scene = file.scene(&[]).unwrap();
        file.stereo_pair(&file.film, &scene).unwrap().map(|pair| {
            pair.map(|eye| (eye.ray_in_world(DVec2::ZERO).origin.x, eye.vectors().numbers[0]))
        })
    };
    let stereo = "stereo = { separation = 0.5, convergence = 2 }";
    let apart = eyes(&format!("[camera.pinhole]\n{EYE}{stereo}")).unwrap();
    assert_eq!(apart.map(|eye| eye.0), [-0.25, 0.25]);
    let around = eyes(&format!("[camera.panorama]\n{EYE}stereo.separation = 0.5")).unwrap();
    assert_eq!(around, [(-0.25, -0.25), (0.25, 0.25)]);
    assert_eq!(eyes(&format!("[camera.pinhole]\n{EYE}")), None);
    assert_eq!(eyes("[camera.fisheye]"), None);
}
