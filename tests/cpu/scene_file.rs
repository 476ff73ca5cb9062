//! Scene files: what they can contain. Those that are refused are in `tests/files/refused`.

use glam::{DVec2, DVec3};
use pinhole::camera::CameraKind;
use pinhole::camera::film::YAxis;
use pinhole::image::encoding::{Bits, Encoding};
use pinhole::scene_file::{IntegratorKind, SceneFile};
use pinhole::{LinearRgb, RenderSettings, Shading, ToneCurve, glam};

fn parse(text: &str) -> SceneFile {
    SceneFile::parse(text).unwrap_or_else(|error| panic!("{error}"))
}

/// The settings of the file for primary rays.
fn settings(file: &SceneFile) -> RenderSettings {
    let scene = file.scene(&[]).unwrap();
    let camera = file.camera(&file.film, &scene).unwrap();
    file.settings(IntegratorKind::Primary, &scene, camera.as_ref(), None).unwrap()
}

#[test]
fn an_empty_file_is_a_picture_of_nothing() {
    let file = parse("");
    assert_eq!([file.film.width(), file.film.height()], [800, 600]);
    let scene = file.scene(&[]).unwrap();
    assert!(scene.is_empty());
    assert_eq!(file.camera(&file.film, &scene).unwrap().kind(), CameraKind::Pinhole);
}

#[test]
fn the_example_has_the_expected_contents() {
    let file = parse(include_str!("../../examples/three-spheres.toml"));
    let primary = settings(&file).primary().unwrap();
    assert_eq!(primary.shading, Shading::Flat);
    assert_eq!(primary.background, LinearRgb::from_srgb8([0xb0, 0xe0, 0xe6]));
    assert_eq!(file.film.y_axis(), YAxis::Down);
    let scene = file.scene(&[]).unwrap();
    assert_eq!(
        scene.spheres(),
        [[-4.0, 0.0, 0.0, 2.0], [4.0, 0.0, 0.0, 2.0], [0.0, 0.0, 3.0, 2.0]]
    );
    let vectors = file.camera(&file.film, &scene).unwrap().vectors();
    assert_eq!(vectors.origin, DVec3::new(0.0, 1.0, -8.0));
    assert_eq!(vectors.right, DVec3::X);
}

#[test]
fn how_the_picture_is_written() {
    assert_eq!(parse("[output]\n").encoding, Encoding::default());
    let all = "[output]\nexposure = 1.5\ntone = 'filmic'\ntransparent = true\nbits = 16\n";
    let expected = Encoding::default()
        .with_exposure(1.5)
        .unwrap()
        .with_tone(ToneCurve::Filmic)
        .with_transparent(true)
        .with_bits(Bits::Sixteen);
    assert_eq!(parse(all).encoding, expected);
    for tone in ToneCurve::ALL {
        let file = parse(&format!("[output]\ntone = '{}'\nexposure = -2\n", tone.name()));
        assert_eq!((file.encoding.tone(), file.encoding.exposure()), (*tone, -2.0));
    }
}

#[test]
fn colors_in_three_ways() {
    let file = parse(
        "[[spheres]]\ncenter=[0,0,0]\nradius=1\ncolor='tomato'\n\
         [[spheres]]\ncenter=[0,0,0]\nradius=1\ncolor='#ff6347'\n\
         [[spheres]]\ncenter=[0,0,0]\nradius=1\ncolor=[0.25, 1, 3.5]\n",
    );
    let scene = file.scene(&[]).unwrap();
    assert_eq!(scene.color(0), LinearRgb::from_srgb8([255, 99, 71]));
    assert_eq!(scene.color(0), scene.color(1));
    assert_eq!(scene.color(2).to_array(), [0.25, 1.0, 3.5]);
}

#[test]
fn data_comes_behind_the_files_own_spheres() {
    let file = parse(
        "data = 'a.xyz'\nframe = 3\nradius_scale = 0.5\n[[spheres]]\ncenter=[0,0,0]\nradius=1\n",
    );
    let data = file.data().unwrap();
    assert_eq!((data.file.as_str(), data.frame, data.radius_scale), ("a.xyz", Some(3), 0.5));
    let more = pinhole::Sphere::new([5.0, 0.0, 0.0], 2.0, LinearRgb::BLACK);
    assert_eq!(file.scene(&[more]).unwrap().spheres()[1], [5.0, 0.0, 0.0, 2.0]);

    let bad = pinhole::Sphere::new(more.center, -2.0, more.color);
    let error = file.scene(&[more, bad]).unwrap_err();
    assert_eq!((error.line, error.column), (1, 8));
    assert!(error.message.starts_with("sphere 1 of a.xyz: its radius is -2.0"), "{error}");
}

#[test]
fn a_camera_without_an_eye_frames_the_scene() {
    for camera in [
        "",
        "[camera.pinhole]\nvertical_fov = 50\n",
        "[camera.orthographic]\n",
        "[camera.thin-lens]\naperture_radius = 0.1\n",
        "[camera.fisheye]\nangle = 120\n",
        "[camera.fisheye]\nangle = 360\n",
    ] {
        let file = parse(&format!("{camera}[[spheres]]\ncenter=[10,20,30]\nradius=2\n"));
        let scene = file.scene(&[]).unwrap();
        let camera = file.camera(&file.film, &scene).unwrap();
        let ray = camera.ray_in_world(DVec2::ZERO);
        assert!((ray.direction - DVec3::NEG_Z).length() < 1e-12);
        assert!((ray.origin - DVec3::new(10.0, 20.0, ray.origin.z)).length() < 1e-9);
        assert!(ray.origin.z > 32.0);
    }
}

#[test]
fn a_message_is_short_and_harmless() {
    for text in ["NAME = 1\n", "background = 'NAME'\n"] {
        let refused = |name: &str| SceneFile::parse(&text.replace("NAME", name)).unwrap_err();
        let length = |name: &str| refused(name).to_string().len();
        let (short, long) = (length("x"), length(&"x".repeat(100_000)));
        // The keys that are valid are listed in both.
        assert!(long < short + 50, "{long} bytes, and {short} for a short name");
    }
}

/// The time must not grow with the square of the number of spheres.
#[test]
fn many_spheres() {
    let text = "[[spheres]]\ncenter=[0,0,0]\nradius=1\n".repeat(30_000);
    assert_eq!(parse(&text).scene(&[]).unwrap().len(), 30_000);
}

#[test]
fn noise_never_panics() {
    let seed = include_str!("../../examples/three-spheres.toml");
    let mut random = fastrand::Rng::with_seed(13);
    for _ in 0..3_000 {
        let mut text: Vec<char> = seed.chars().collect();
        for _ in 0..random.usize(1..6) {
            let at = random.usize(..text.len());
            match random.u8(..3) {
                0 => text[at] = *random.choice(&['"', '[', ']', '=', '\n', '-', 'é', '9']).unwrap(),
                1 => drop(text.remove(at)),
                _ => text.truncate(at.max(1)),
            }
            if text.is_empty() {
                break;
            }
        }
        if let Ok(file) = SceneFile::parse(&text.into_iter().collect::<String>())
            && let Ok(scene) = file.scene(&[])
        {
            let _ = file.camera(&file.film, &scene);
        }
    }
}
