//! Scene files: their content, and reading written files again. Files that are refused are in `tests/files/refused`.

use std::path::Path;

use pinhole::camera::film::YAxis;
use pinhole::camera::{Camera, CameraKind, CameraParameters};
use pinhole::glam::{DVec2, DVec3};
use pinhole::image::encoding::Bits;
use pinhole::light::{LightKind, SkyLight};
use pinhole::render::{DepthCue, Occlusion, Outline, Studio};
use pinhole::{
    Encoding, Film, Integrator, LinearRgb, Material, RenderSettings, Scene, Shading, Sphere, SphereArray,
    SurfaceProperties, ToneCurve,
};
use pinhole_data::load::Dataset;
use pinhole_figure::scene_file::{Data, DataError, IntegratorKind, SceneFile, SceneFileError, Settled};
use pinhole_figure::settings::Sources;
use pinhole_figure::style::Style;

use crate::cases::compare;
use crate::support::{View, random_light};

pub(crate) fn parse(text: &str) -> SceneFile {
    SceneFile::parse(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The settings of a file that uses primary rays.
fn settings(file: &SceneFile) -> RenderSettings {
    let scene = file.scene().unwrap();
    let camera = file.camera(&file.film, &scene).unwrap();
    file.settings(IntegratorKind::Primary, &scene, camera.as_ref(), None).unwrap()
}

#[test]
fn an_empty_file_is_a_picture_of_nothing() {
    let file = parse("");
    assert_eq!([file.film.width(), file.film.height()], [800, 600]);
    let scene = file.scene().unwrap();
    assert!(scene.is_empty());
    assert_eq!(file.camera(&file.film, &scene).unwrap().kind(), CameraKind::Pinhole);
}

#[test]
fn the_example_has_the_expected_contents() {
    let file = parse(include_str!("../../../../examples/three-spheres.toml"));
    let primary = settings(&file).primary().unwrap();
    assert_eq!(primary.shading, Shading::Flat);
    assert_eq!(primary.background, LinearRgb::from_srgb8([0xb0, 0xe0, 0xe6]));
    assert_eq!(file.film.y_axis(), YAxis::Down);
    let scene = file.scene().unwrap();
    assert_eq!(scene.spheres(), [[-4.0, 0.0, 0.0, 2.0], [4.0, 0.0, 0.0, 2.0], [0.0, 0.0, 3.0, 2.0]]);
    let vectors = file.camera(&file.film, &scene).unwrap().vectors();
    assert_eq!(vectors.origin, DVec3::new(0.0, 1.0, -8.0));
    assert_eq!(vectors.right, DVec3::X);
}

#[test]
fn how_the_picture_is_written() {
    assert_eq!(parse("[output]\n").encoding, Encoding::default());
    let all = "[output]\nexposure = 1.5\ntone = 'filmic'\ntransparent = true\nbits = 16\n";
    let mut expected = Encoding::default().with_exposure(1.5).unwrap();
    expected.tone = ToneCurve::Filmic;
    expected.transparent = true;
    expected.bits = Bits::Sixteen;
    assert_eq!(parse(all).encoding, expected);
    for tone in ToneCurve::ALL {
        let name = format!("{tone:?}").to_lowercase();
        let file = parse(&format!("[output]\ntone = '{name}'\nexposure = -2\n"));
        assert_eq!((file.encoding.tone, file.encoding.exposure()), (*tone, -2.0));
    }
}

#[test]
fn colors_in_three_ways() {
    let file = parse(
        "[[spheres]]\ncenter=[0,0,0]\nradius=1\ncolor='tomato'\n\
         [[spheres]]\ncenter=[0,0,0]\nradius=1\ncolor='#ff6347'\n\
         [[spheres]]\ncenter=[0,0,0]\nradius=1\ncolor=[0.25, 1, 3.5]\n",
    );
    let scene = file.scene().unwrap();
    assert_eq!(scene.color(0), LinearRgb::from_srgb8([255, 99, 71]));
    assert_eq!(scene.color(0), scene.color(1));
    assert_eq!(scene.color(2).to_array(), [0.25, 1.0, 3.5]);
}

#[test]
fn data_comes_behind_the_files_own_spheres() {
    let file = parse("data = 'a.xyz'\nframe = 3\nradius_scale = 0.5\n[[spheres]]\ncenter=[0,0,0]\nradius=1\n");
    let data = file.data().unwrap();
    assert_eq!((data.file.as_str(), data.frame, data.radius_scale), ("a.xyz", Some(3), 0.5));
    let own = file.shapes();
    let scene = |radii: &[f64]| {
        let spheres = radii.iter().map(|radius| [5.0, 0.0, 0.0, *radius]).collect();
        data.scene(Dataset::new(SphereArray::F64(spheres)), own).map(|made| made.scene)
    };
    let made = scene(&[4.0]).unwrap();
    assert_eq!(made.spheres(), [[0.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0, 2.0]]);

    let Err(DataError::Scene(error)) = scene(&[4.0, -4.0]) else { panic!("-4 is no radius") };
    let error = file.at_shape(&error);
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
        let scene = file.scene().unwrap();
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
        // The list of valid keys is in both messages.
        assert!(long < short + 50, "{long} bytes, and {short} for a short name");
    }
}

/// The time must not grow with the square of the number of spheres.
#[test]
fn many_spheres() {
    let text = "[[spheres]]\ncenter=[0,0,0]\nradius=1\n".repeat(30_000);
    assert_eq!(parse(&text).scene().unwrap().len(), 30_000);
}

#[test]
fn noise_never_panics() {
    let seed = include_str!("../../../../examples/three-spheres.toml");
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
            && let Ok(scene) = file.scene()
        {
            let _ = file.camera(&file.film, &scene);
        }
    }
}

/// Writes settings to a scene file and reads them. Returns what was read, and the text.
fn round_trip(settings: &RenderSettings, scene: &Scene) -> (RenderSettings, String) {
    let image = match &settings.sky.light {
        SkyLight::Image { environment, .. } => Some(environment.as_ref().clone()),
        _ => None,
    };
    let settled = Settled {
        camera: CameraParameters::default(),
        settings,
        sky_image: image.as_ref().map(|_| "a \"sky\".hdr".to_owned()),
        data: None,
        cone_files: Vec::new(),
    };
    let text = parse("").settled(settled);
    let file = parse(&text);
    let camera = file.camera(&file.film, scene).unwrap();
    let kind = file.integrator().unwrap();
    let read = file.settings(kind, scene, camera.as_ref(), image).unwrap();
    (read, text)
}

#[test]
fn random_light_is_read_as_it_was_written() {
    for seed in 0..200 {
        let view = random_light::view(seed);
        let (read, text) = round_trip(&view.settings, &view.scene);
        // Transparency is a key of the output. The caller sets it.
        let mut wanted = RenderSettings { is_transparent: false, ..view.settings.clone() };
        // Not every angle has an exact value in degrees. The nearest is read.
        for (light, read) in wanted.lights.iter_mut().zip(&read.lights) {
            if matches!(light.kind, LightKind::Head { .. }) {
                // A light at the eye has no frame.
                light.frame = read.frame;
            }
            if let (
                LightKind::Directional { angular_radius: a, .. },
                LightKind::Directional { angular_radius: b, .. },
            ) = (&mut light.kind, &read.kind)
            {
                assert!((*a - *b).abs() <= 1e-15 * a.abs(), "{seed}: {a} {b}");
                *a = *b;
            }
        }
        if let (SkyLight::Image { rotation: a, .. }, SkyLight::Image { rotation: b, .. }) =
            (&mut wanted.sky.light, &read.sky.light)
        {
            assert!((*a - *b).abs() <= 1e-15 * a.abs(), "{seed}: {a} {b}");
            *a = *b;
        }
        assert_eq!(read, wanted, "{seed}\n{text}");
        assert_eq!(round_trip(&read, &view.scene).0, read, "{seed}: a second time");
    }
}

#[test]
fn every_style_is_read_as_it_was_written() {
    let sphere = |x: f64| Sphere::new([x, 0.5, -x], 1.0, LinearRgb::from_srgb8([90; 3]));
    let scene = Scene::new(&[sphere(0.0), sphere(1.5), sphere(-4.0)]).unwrap();
    for style in Style::ALL {
        let file = SceneFile::read(&Sources { style: Some(*style), ..Sources::default() }).unwrap();
        let camera = file.camera(&file.film, &scene).unwrap();
        let kind = file.integrator().unwrap();
        let settings = file.settings(kind, &scene, camera.as_ref(), None).unwrap();
        assert_eq!(round_trip(&settings, &scene).0, settings, "{}", style.name());
        assert_eq!(Style::of_name(style.name()), Some(*style));
    }
}

#[test]
fn a_studio_with_everything_is_read_as_it_was_written() {
    let studio = Studio {
        ambient: LinearRgb::new([0.1, 0.2, 1.0 / 3.0]).unwrap(),
        occlusion: Some(Occlusion { radius: Some(1e-3), samples: 7 }),
        depth_cue: Some(DepthCue { near: 0.1, far: 1e5, color: LinearRgb::new([0.7; 3]).unwrap() }),
        outline: Some(Outline { angle: 0.1 + 0.2, ..Outline::thin() }),
        max_surfaces: 3,
        is_smooth: true,
        is_dense: true,
        added_light: true,
        shadows: false,
    };
    let settings = RenderSettings { integrator: Integrator::Studio(studio), ..RenderSettings::studio() };
    let scene = Scene::new(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE)]).unwrap();
    assert_eq!(round_trip(&settings, &scene).0, settings);
    let dark = RenderSettings { lights: Vec::new(), ..settings };
    assert_eq!(round_trip(&dark, &scene).0, dark, "no light is not the default light");
}

/// Reads a text, writes it and reads it again, which must give the same. Returns the file.
#[track_caller]
fn round_trip_file(text: &str) -> SceneFile {
    let file = parse(text);
    let spheres: Vec<Sphere> = file.spheres().collect();
    let settings = &RenderSettings::studio();
    let (camera, data) = (file.camera_parameters(), file.data().cloned());
    let text = file.settled(Settled { camera, settings, sky_image: None, data, cone_files: Vec::new() });
    let again = parse(&text);
    assert_eq!(again.film, file.film);
    assert_eq!(again.encoding, file.encoding);
    assert_eq!(again.annotations, file.annotations, "{text}");
    assert_eq!(again.camera_parameters(), file.camera_parameters());
    assert_eq!(again.data(), file.data(), "{text}");
    assert_eq!(again.spheres().collect::<Vec<_>>(), spheres);
    assert_eq!(again.integrator(), Some(IntegratorKind::Studio));
    again
}

#[test]
fn everything_else_is_read_as_it_was_written() {
    let text = "topology = 'b \\u{e9}.pdb'\ncolumns = ['x', '\"y\"', '']\n\
                color_by = { column = '|v|', map = 'Vik_r', reverse = true, range = ['2.5%', 1e-3], log = true, \
                missing = '#010203' }\nradius_by = { column = 'd', factor = 0.1 }\nopacity_by = 'w'\n\
                emission_by = { column = 'T \\\"\\\"', factor = 1e9 }\n\
                [legend]\ntitle = 'a \"b\"'\nposition = [0.1, 0.9]\n\
                [scale_bar]\nlength = 0.3\nunit = 'µm'\nposition = 'bottom-right'\n\
                [[labels]]\ntext = '''a\nb'''\nposition = 'top'\n[[labels]]\ntext = ''\n\
                [text]\nscale = 1.7\ncolor = '#fedcba'\npanel = 'never'\n";
    round_trip_file(&format!("data = 'a.dcd'\n{text}"));
    let annotations = round_trip_file("[legend]\n[scale_bar]\n[text]\npanel = 'auto'\n").annotations;
    assert!(annotations.legend.is_some() && annotations.scale_bar.is_some());
    for range in ["['', '98%']", "[-1, '']", "['', '']", "[0, 1]"] {
        round_trip_file(&format!("data = 'a'\ncolor_by = {{ column = 'x', range = {range} }}\n"));
    }
    let text = "data = 'a \\ \"b\".dat'\nformat = 'xyz'\nframe = 3\nradius_scale = 0.75\nmaterial = 'gold'\n\
                elements_by = ['residue', 'chain']\nleave_out = { residue = ['HOH', 'SO 4'] }\n\
                select = 'x > 1 and chain == \"A\"'\nbox = { width = 0.25 }\nbonds = 1.3\n\
                [film]\nwidth = 31\nheight = 17\ny = 'down'\n\
                [output]\nexposure = 0.1\ntone = 'agx'\nbits = 16\ntransparent = true\ndpi = 299.7\n\
                [camera.thin-lens]\neye = [0.1, 1e-7, 1e7]\nlook_at = [0, 0, 0]\naperture_radius = 0.25\nzoom = 2\n\
                [materials.gold]\nkind = 'conductor'\nroughness = 0.3\n[materials.plain]\nkind = 'lambert'\n\
                [elements.'O 1']\ncolor = [0.1, 0.2, 0.3]\nmaterial = 'plain'\n[elements.H]\nradius = 0.1\nopacity = 0.5\n\
                [[spheres]]\ncenter = [0.1, 0.2, 1e-300]\nradius = 0.3\ncolor = 'tomato'\nopacity = 0.25\n";
    let again = round_trip_file(text);
    assert_eq!(again.spheres().count(), 1);
    assert_eq!(Data::of_file("a").radius_scale, 1.0);
    let gold = SurfaceProperties { material: Material::Conductor { roughness: 0.3 }, opacity: 1.0 };
    assert_eq!(again.data().unwrap().surface, gold);
}

/// The background of a picture keeps its bytes. Spheres that cover it in part are mixed with it after the curve.
#[test]
fn a_background_is_left_alone_by_every_curve() {
    let grey = LinearRgb::from_srgb8([0x80; 3]);
    let background = grey.to_array();
    for tone in ToneCurve::ALL {
        for stops in [-2.0, 0.0, 3.0] {
            let mut encoding = Encoding::default().with_exposure(stops).unwrap();
            encoding.tone = *tone;
            assert_eq!(encoding.display_over(background, 0.0, grey), background);
            let light = [0.9, 0.2, 0.4];
            let covered = encoding.display_over(light, 1.0, grey);
            let clipped = encoding.display(light).map(|c| c.clamp(0.0, 1.0));
            assert_eq!(covered, clipped, "{tone:?} {stops}");
            let half: [f32; 3] = std::array::from_fn(|i| 0.5 * light[i] + 0.5 * background[i]);
            let mixed = encoding.display_over(half, 0.5, grey);
            for i in 0..3 {
                let wanted = 0.5 * clipped[i] + 0.5 * background[i];
                assert!((mixed[i] - wanted).abs() < 1e-5, "{tone:?} {stops}: {mixed:?}");
            }
        }
    }
}

/// The camera of a table, in a scene of one sphere two units ahead.
fn camera(table: &str) -> Result<Box<dyn Camera>, String> {
    let text = format!("{table}\n[[spheres]]\ncenter=[0,0,-2]\nradius=1\n");
    let file = SceneFile::parse(&text).map_err(|error| error.message)?;
    let scene = file.scene().unwrap();
    file.camera(&Film::new(30, 20).unwrap(), &scene).map_err(|error| error.message)
}

const EYE: &str = "eye = [0, 0, 0]\ndirection = [0, 0, -1]\n";

#[test]
fn every_camera_has_an_example() {
    for (text, kind) in [
        (include_str!("../../../../examples/three-spheres.toml"), CameraKind::Pinhole),
        (include_str!("../../../../examples/stereo.toml"), CameraKind::Pinhole),
        (include_str!("../../../../examples/three-spheres-orthographic.toml"), CameraKind::Orthographic),
        (include_str!("../../../../examples/thin-lens.toml"), CameraKind::ThinLens),
        (include_str!("../../../../examples/panorama.toml"), CameraKind::Panorama),
        (include_str!("../../../../examples/fisheye.toml"), CameraKind::Fisheye),
    ] {
        let view = View::from_toml(text);
        assert_eq!(view.camera.kind(), kind);
        let image = view.reference();
        let ids: std::collections::BTreeSet<u32> = image.id().unwrap().iter().copied().collect();
        // Every sphere and the background are visible.
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
        let radius = if keys.contains("aperture") { "" } else { "f_stop = 2\nfocal_length = 0.4\n" };
        let camera = camera(&format!("[camera.thin-lens]\n{EYE}{radius}{keys}")).unwrap();
        let vectors = camera.vectors();
        assert!((vectors.forward - DVec3::new(0.0, 0.0, -distance)).length() < 1e-12, "{keys}");
        let edge = camera.ray_through_lens(DVec2::ZERO, DVec2::new(0.0, 0.5));
        assert!((edge.origin - DVec3::new(-0.1, 0.0, 0.0)).length() < 1e-12, "{keys}");
    }
    let looking_at = "[camera.thin-lens]\neye = [0, 0, 0]\nlook_at = [3, 0, -4]\naperture_radius = 1";
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
        let scene = file.scene().unwrap();
        file.stereo_pair(&file.film, &scene)
            .unwrap()
            .map(|pair| pair.map(|eye| (eye.ray_in_world(DVec2::ZERO).origin.x, eye.vectors().numbers[0])))
    };
    let stereo = "stereo = { separation = 0.5, convergence = 2 }";
    let apart = eyes(&format!("[camera.pinhole]\n{EYE}{stereo}")).unwrap();
    assert_eq!(apart.map(|eye| eye.0), [-0.25, 0.25]);
    let around = eyes(&format!("[camera.panorama]\n{EYE}stereo.separation = 0.5")).unwrap();
    assert_eq!(around, [(-0.25, -0.25), (0.25, 0.25)]);
    assert_eq!(eyes(&format!("[camera.pinhole]\n{EYE}")), None);
    assert_eq!(eyes("[camera.fisheye]"), None);
}

/// The first error, whether it appears in parsing, in the scene, in its camera or in the settings.
fn first_error(text: &str) -> Option<SceneFileError> {
    let settings = || {
        let file = SceneFile::parse(text)?;
        let scene = file.scene()?;
        let camera = file.camera(&file.film, &scene)?;
        let kind = file.integrator().unwrap_or(IntegratorKind::Studio);
        file.settings(kind, &scene, camera.as_ref(), None)
    };
    settings().err()
}

#[test]
fn refused_files() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files/refused");
    compare(&folder, |case| {
        let [(name, bytes)] = &case.files[..] else { panic!("{}: not one file", case.arguments) };
        let error = first_error(str::from_utf8(bytes).unwrap()).unwrap();
        format!("exit code 1\nerror: {name}: {error}\n")
    });
}
