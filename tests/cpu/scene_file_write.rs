//! Scene files that are written: what is read from them again is what was written.

use pinhole::annotate::AnnotationPlan;
use pinhole::camera::CameraParameters;
use pinhole::light::{LightKind, SkyLight};
use pinhole::render::{DepthCue, Occlusion, Outline, Studio};
use pinhole::scene_file::{Contents, Data, IntegratorKind, SceneFile, write};
use pinhole::style::Style;
use pinhole::{
    Encoding, Film, Integrator, LinearRgb, Material, RenderSettings, Scene, Sphere,
    SurfaceProperties, ToneCurve,
};

use crate::support::random_light;

/// The settings that are read from a scene file with these settings, and its text.
fn round_trip(settings: &RenderSettings, scene: &Scene) -> (RenderSettings, String) {
    let image = match &settings.sky.light {
        SkyLight::Image { environment, .. } => Some(environment.as_ref().clone()),
        _ => None,
    };
    let contents = Contents {
        film: Film::new(24, 18).unwrap(),
        encoding: Encoding::default(),
        annotations: AnnotationPlan::default(),
        camera: CameraParameters::default(),
        settings,
        sky_image: image.as_ref().map(|_| "a \"sky\".hdr".to_owned()),
        data: None,
        spheres: Vec::new(),
    };
    let text = write(&contents);
    let file = SceneFile::parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
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
        // Transparency is a key of the output; the caller sets it.
        let mut wanted = RenderSettings { is_transparent: false, ..view.settings.clone() };
        // Not every angle is one in degrees; the nearest is read.
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
        let file = SceneFile::parse_in_style("", Some(*style)).unwrap();
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
        has_shadows: false,
    };
    let settings =
        RenderSettings { integrator: Integrator::Studio(studio), ..RenderSettings::studio() };
    let scene = Scene::new(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE)]).unwrap();
    assert_eq!(round_trip(&settings, &scene).0, settings);
    let dark = RenderSettings { lights: Vec::new(), ..settings };
    assert_eq!(round_trip(&dark, &scene).0, dark, "no light is not the default light");
}

/// What is read from the file that is written of what this text says; it must be the same.
#[track_caller]
fn round_trip_file(text: &str) -> SceneFile {
    let file = SceneFile::parse(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let spheres: Vec<Sphere> = file.spheres().collect();
    let contents = Contents {
        film: file.film,
        encoding: file.encoding,
        annotations: file.annotations.clone(),
        camera: file.camera_parameters(),
        settings: &RenderSettings::studio(),
        sky_image: None,
        data: file.data().cloned(),
        spheres: spheres.clone(),
    };
    let text = write(&contents);
    let again = SceneFile::parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
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
    let annotations =
        round_trip_file("[legend]\n[scale_bar]\n[text]\npanel = 'auto'\n").annotations;
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

/// The background of a picture keeps its bytes, and what covers it in part is mixed with it after the curve.
#[test]
fn a_background_is_left_alone_by_every_curve() {
    let grey = LinearRgb::from_srgb8([0x80; 3]);
    let background = grey.to_array();
    for tone in ToneCurve::ALL {
        for stops in [-2.0, 0.0, 3.0] {
            let encoding = Encoding::default().with_tone(*tone).with_exposure(stops).unwrap();
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
