//! What spheres look like: every kind of colours shows what spheres one by one show, and what is refused is named.

use pinhole::camera::{PinholeCamera, Pose};
use pinhole::light::emitters::Emitters;
use pinhole::render::SettingsError;
use pinhole::scene::SceneError;
use pinhole::verify::run_file;
use pinhole::{
    Appearance, ColorMap, Colors, Film, Image, LayerSet, LinearRgb, Material, Radii,
    RenderSettings, Scene, SphereArray, SurfaceProperties, View, cpu,
};

use crate::run_file::made;
use crate::support::appearances::{kinds, settings};

fn camera() -> PinholeCamera {
    let pose = Pose::looking_at([1.0, 2.0, 8.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()
}

fn film() -> Film {
    Film::new(24, 24).unwrap()
}

/// By one ray a pixel, in a studio, and along paths.
fn pictures(scene: &Scene) -> [Image; 3] {
    let camera = camera();
    let view = View::new(&camera, film());
    settings().map(|settings| cpu::render(scene, &view, &settings, LayerSet::ALL).unwrap())
}

#[test]
fn every_kind_shows_what_spheres_one_by_one_show() {
    for kind in kinds() {
        assert_eq!(Emitters::of(&kind.scene), Emitters::of(&kind.expected), "{}", kind.name);
        for id in 0..kind.scene.len() as u32 {
            assert_eq!(kind.scene.color(id), kind.expected.color(id), "{}", kind.name);
            assert_eq!(kind.scene.surface(id), kind.expected.surface(id), "{}", kind.name);
        }
        assert!(pictures(&kind.scene) == pictures(&kind.expected), "{}", kind.name);
    }
}

#[test]
fn run_files_keep_every_kind() {
    for kind in kinds() {
        let recording = made(&kind.scene, &camera(), film());
        let written = |scene: &Scene| {
            let mut bytes = Vec::new();
            run_file::write(scene, &recording, &run_file::Provenance::default(), &mut bytes)
                .unwrap();
            bytes
        };
        let bytes = written(&kind.scene);
        let run = run_file::read(&bytes).unwrap();
        for id in 0..kind.scene.len() as u32 {
            assert_eq!(run.scene.color(id), kind.scene.color(id), "{}", kind.name);
        }
        assert_eq!(written(&run.scene), bytes, "{}", kind.name);
    }
}

/// Whatever the allocator gave for the spheres and colours, the scene has.
#[test]
fn nothing_is_copied() {
    let spheres = vec![[0.5, 0.25, 0.0, 0.5]; 1000];
    let colors = vec![[1, 2, 3, 4]; 1000];
    let places = (spheres.as_ptr(), colors.as_ptr());
    let scene = Scene::from_parts(SphereArray::F32(spheres), Appearance::from(colors)).unwrap();
    let Colors::Rgba8(colors) = scene.appearance().colors() else { unreachable!("it is RGBA8") };
    assert_eq!((scene.spheres().as_ptr(), colors.as_ptr()), places);
    assert_eq!(size_of_val(&colors[..]), 4 * scene.len());
}

#[test]
fn centers_and_radii_may_stand_apart() {
    let centers = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    let narrow = SphereArray::from_f32(&centers.map(|c| c.map(|x| x as f32)), Radii::All(0.5));
    assert_eq!(narrow, Ok(SphereArray::F32(vec![[1.0, 2.0, 3.0, 0.5], [4.0, 5.0, 6.0, 0.5]])));
    let wide = SphereArray::from_f64(&centers, Radii::Each(&[0.5, 0.75]));
    assert_eq!(wide, Ok(SphereArray::F64(vec![[1.0, 2.0, 3.0, 0.5], [4.0, 5.0, 6.0, 0.75]])));
    for (radii, words) in [
        (&[0.5][..], "position 1 has no radius: there are 1 radii for 2 positions"),
        (&[0.5; 3], "radius 2 has no position: there are 3 radii for 2 positions"),
    ] {
        let refused = SphereArray::from_f64(&centers, Radii::Each(radii)).unwrap_err();
        assert_eq!(refused.to_string(), words);
    }
}

fn refused(appearance: Appearance) -> SceneError {
    let spheres = (0..3).map(|i| [i as f32, 0.0, 0.0, 0.4]).collect();
    Scene::from_parts(SphereArray::F32(spheres), appearance).unwrap_err()
}

#[test]
fn what_does_not_fit_is_named_by_index() {
    let gray = |level| LinearRgb::new([level; 3]).unwrap();
    let palette =
        |indices| Appearance::new(Colors::Palette { palette: vec![gray(0.1); 2], indices });
    let map = ColorMap::new(vec![gray(0.1), gray(0.2)], [0.0, 1.0]).unwrap();
    let scalars = |values| Appearance::new(Colors::Scalars { values, map: map.clone() });
    let rgba = |count| Appearance::from(vec![[0; 4]; count]);
    let surfaces = |indices| rgba(3).with_surfaces(vec![SurfaceProperties::default(); 2], indices);
    for (appearance, words) in [
        (
            palette(vec![0, 2, 1]),
            "sphere 1 has no color: its index is out of range; the palette has 2 colors",
        ),
        (palette(vec![0, 1]), "sphere 2 has no color: there are 2 for 3 spheres"),
        (rgba(1), "sphere 1 has no color: there are 1 for 3 spheres"),
        (rgba(4), "color 3 has no sphere: there are 4 for 3 spheres"),
        (scalars(vec![0.0, 0.0, f32::NAN]), "sphere 2 has the number NaN, which has no color"),
        (scalars(vec![0.0]), "sphere 1 has no color: there are 1 for 3 spheres"),
        (
            surfaces(vec![0, 1, 2]),
            "the surface index of sphere 2 is out of range; there are 2 surfaces",
        ),
        (surfaces(vec![0; 4]), "surface index 3 has no sphere: there are 4 for 3 spheres"),
        (
            rgba(3).with_surfaces(vec![], vec![0; 3]),
            "the surface index of sphere 0 is out of range; there are 0 surfaces",
        ),
    ] {
        assert_eq!(refused(appearance).to_string(), words);
    }
}

/// A color that only a lamp may have is refused of the sphere that is none, and not where no sphere has it.
#[test]
fn what_creates_light_is_named_by_index() {
    let palette = [0.5, 7.0].map(|level| LinearRgb::new([level; 3]).unwrap());
    let lamp = SurfaceProperties { material: Material::Emissive { strength: 2.0 }, opacity: 1.0 };
    let check = |colors: [u32; 3], surfaces: [u32; 3]| {
        let colors = Colors::Palette { palette: palette.to_vec(), indices: colors.to_vec() };
        let appearance = Appearance::new(colors)
            .with_surfaces(vec![SurfaceProperties::default(), lamp], surfaces.to_vec());
        let spheres = (0..3).map(|i| [i as f32, 0.0, 0.0, 0.4]).collect();
        RenderSettings::studio()
            .check(&Scene::from_parts(SphereArray::F32(spheres), appearance).unwrap())
    };
    assert_eq!(check([0, 1, 0], [0, 1, 0]), Ok(()));
    assert_eq!(check([0, 0, 0], [0, 0, 1]), Ok(()));
    let refused = check([0, 1, 1], [0, 1, 0]);
    let named = matches!(&refused, Err(SettingsError::Albedo { what, .. }) if what == "sphere 2");
    assert!(named, "{refused:?}");
}
