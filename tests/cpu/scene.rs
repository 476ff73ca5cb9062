//! Scenes: the data that they accept, their frame, the appearance of spheres, and updates.

use fastrand::Rng;
use pinhole::glam::DVec3;
use pinhole::light::emitters::Emitters;
use pinhole::render::SettingsError;
use pinhole::scene::{Centers, NewColors, SceneError, SceneUpdate};
use pinhole::verify::run_file;
use pinhole::{
    Appearance, ColorMap, Colors, Film, Image, LayerSet, LinearRgb, Material, Radii, RenderSettings, Scene, Sphere,
    SphereArray, SurfaceProperties, View, cpu,
};

use crate::run_file::made;
use crate::support::appearances::{Numbers, camera, kinds, settings};

/// A scene of spheres with colours by index.
pub(crate) fn colored(spheres: &[[f32; 4]], color: impl Fn(usize) -> [f32; 3]) -> Scene {
    let one = |(i, s): (usize, &[f32; 4])| {
        let [x, y, z, radius] = s.map(f64::from);
        Sphere::new([x, y, z], radius, LinearRgb::new(color(i)).unwrap())
    };
    Scene::new(&spheres.iter().enumerate().map(one).collect::<Vec<_>>()).unwrap()
}

fn sphere(center: [f64; 3], radius: f64) -> Sphere {
    Sphere::new(center, radius, LinearRgb::WHITE)
}

#[test]
fn bad_spheres_are_named_by_index() {
    let good = sphere([1.0, 2.0, 3.0], 1.0);
    let error = |bad: Sphere| Scene::new(&[good, good, bad, good]).unwrap_err();
    for radius in [0.0, -1.0, -0.0, f64::NAN, f64::INFINITY, 1e-40, 1e40] {
        let error = error(sphere([0.0; 3], radius));
        let expected = format!("sphere 2: its radius is {radius:?}; a radius must be finite, ");
        assert!(error.to_string().starts_with(&expected), "{error}");
    }
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e20] {
        for axis in 0..3 {
            let mut center = [0.0; 3];
            center[axis] = x;
            let error = error(sphere(center, 1.0));
            let expected = format!("sphere 2: its center is {center:?}; every coordinate must be ");
            assert!(error.to_string().starts_with(&expected), "{error}");
        }
    }
}

#[test]
fn data_around_the_origin_keeps_its_numbers() {
    let scene = Scene::new(&[sphere([-4.0, 0.1, 0.0], 2.0), sphere([4.0, 0.0, 3.0], 2.0)]).unwrap();
    assert_eq!(scene.origin(), DVec3::ZERO);
    assert_eq!(scene.spheres()[0], [-4.0, 0.1, 0.0, 2.0]);
}

#[test]
fn data_far_from_the_origin_keeps_its_shape() {
    let far = 123_456_789.0;
    let spheres: Vec<Sphere> = (0..100).map(|i| sphere([far + f64::from(i) * 0.01, -far, far], 0.004)).collect();
    let scene = Scene::new(&spheres).unwrap();
    for (given, kept) in spheres.iter().zip(scene.spheres()) {
        let world = scene.origin() + DVec3::new(kept[0].into(), kept[1].into(), kept[2].into());
        assert!((world - DVec3::from(given.center)).length() < 1e-6, "{world}");
    }
    // In f32 without a frame, neighbours would coincide, because the step of numbers there is 8.
    assert_eq!(far as f32, (far + 0.01) as f32);
}

/// Only the axis along which the data is far away is moved. Numbers that were exact in f32 stay exact.
#[test]
fn data_that_was_exact_in_f32_stays_exact() {
    let mut random = fastrand::Rng::with_seed(14);
    let exact = |x: f64| f64::from(x as f32);
    let spheres: Vec<Sphere> = (0..1000)
        .map(|_| {
            let [x, y, z] = [0; 3].map(|_| random.f64() * 10.0 - 5.0);
            sphere([exact(1000.0 + x), exact(y), exact(z - 77.0)], 0.1)
        })
        .collect();
    let scene = Scene::new(&spheres).unwrap();
    assert!(scene.origin().x != 0.0 && scene.origin().y == 0.0);
    for (given, kept) in spheres.iter().zip(scene.spheres()) {
        let kept = DVec3::new(kept[0].into(), kept[1].into(), kept[2].into());
        assert_eq!((scene.origin() + kept).to_array(), given.center);
    }
}

#[test]
fn bounds_hold_every_sphere() {
    let scene = Scene::new(&[sphere([-4.0, 0.0, 0.0], 2.0), sphere([1.0, 5.0, -3.0], 0.5)]).unwrap();
    let bounds = scene.bounds().unwrap();
    assert_eq!(bounds.min(), DVec3::new(-6.0, -2.0, -3.5));
    assert_eq!(bounds.max(), DVec3::new(1.5, 5.5, 2.0));
    assert!(Scene::new(&[]).unwrap().bounds().is_none());
}

/// A list that is long enough for several threads.
fn many(random: &mut fastrand::Rng, at: f64) -> Vec<[f64; 4]> {
    let coordinate = |random: &mut fastrand::Rng| at + random.f64() * 10.0 - 5.0;
    (0..200_000).map(|_| [0; 3].map(|_| coordinate(random))).map(|[x, y, z]| [x, y, z, 0.1]).collect()
}

#[test]
fn arrays_make_the_scene_that_spheres_make() {
    let mut random = fastrand::Rng::with_seed(15);
    for at in [0.0, 1000.0, 1e7] {
        let wide = many(&mut random, at);
        let narrow: Vec<[f32; 4]> = wide.iter().map(|s| s.map(|x| x as f32)).collect();
        let same = |scene: Scene, spheres: Vec<Sphere>| {
            let expected = Scene::new(&spheres).unwrap();
            assert_eq!(scene.origin(), expected.origin());
            assert_eq!(scene.bounds(), expected.bounds());
            assert_eq!(scene.spheres(), expected.spheres());
            assert_eq!(scene.appearance(), expected.appearance());
            assert_eq!(scene.appearance().colors(), &Colors::One(LinearRgb::WHITE));
            assert_eq!(scene.color(17), LinearRgb::WHITE);
        };
        let spheres = wide.iter().map(|&[x, y, z, r]| sphere([x, y, z], r)).collect();
        same(Scene::from_f64(&wide, LinearRgb::WHITE).unwrap(), spheres);
        let spheres = narrow.iter().map(|s| s.map(f64::from));
        let spheres = spheres.map(|[x, y, z, r]| sphere([x, y, z], r)).collect();
        same(Scene::from_f32(narrow, LinearRgb::WHITE).unwrap(), spheres);
    }
}

#[test]
fn the_first_bad_sphere_of_an_array_is_named_however_many_threads_look() {
    let mut random = fastrand::Rng::with_seed(17);
    let mut spheres = many(&mut random, 0.0);
    for bad in [199_999, 150_000, 70_001, 3] {
        spheres[bad][3] = -1.0;
        let expected = format!("sphere {bad}: its radius is -1.0; ");
        let narrow: Vec<[f32; 4]> = spheres.iter().map(|s| s.map(|x| x as f32)).collect();
        for error in [
            Scene::from_f64(&spheres, LinearRgb::WHITE).unwrap_err(),
            Scene::from_f32(narrow, LinearRgb::WHITE).unwrap_err(),
        ] {
            assert!(error.to_string().starts_with(&expected), "{error}");
        }
    }
}

fn film() -> Film {
    Film::new(24, 24).unwrap()
}

/// Pictures of primary rays, of a studio, and of paths.
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
            let from = run_file::Provenance::default();
            run_file::write(scene, &recording, &from, &mut bytes).unwrap();
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

/// The scene keeps the allocations of the spheres and colours.
#[test]
fn nothing_is_copied() {
    let spheres = vec![[0.5, 0.25, 0.0, 0.5]; 1000];
    let colors = vec![[1, 2, 3, 4]; 1000];
    let places = (spheres.as_ptr(), colors.as_ptr());
    let scene = Scene::from_parts(SphereArray::F32(spheres), Appearance::from(colors)).unwrap();
    let Colors::Rgba8(colors) = scene.appearance().colors() else { unreachable!("it is RGBA8") };
    assert_eq!((scene.spheres().as_ptr(), colors.as_ptr()), places);
    assert_eq!(size_of_val(&colors[..]), 4 * scene.len());
    assert!(Scene::from_f32(Vec::new(), LinearRgb::WHITE).unwrap().bounds().is_none());
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
    let palette = |indices| Appearance::new(Colors::Palette { palette: vec![gray(0.1); 2], indices });
    let map = ColorMap::new(vec![gray(0.1), gray(0.2)], [0.0, 1.0]).unwrap();
    let scalars = |values| Appearance::new(Colors::Scalars { values, map: map.clone() });
    let rgba = |count| Appearance::from(vec![[0; 4]; count]);
    let surfaces = |indices| rgba(3).with_surfaces(vec![SurfaceProperties::default(); 2], indices);
    for (appearance, words) in [
        (palette(vec![0, 2, 1]), "sphere 1 has no color: its index is out of range; the palette has 2 colors"),
        (palette(vec![0, 1]), "sphere 2 has no color: there are 2 for 3 spheres"),
        (rgba(1), "sphere 1 has no color: there are 1 for 3 spheres"),
        (rgba(4), "color 3 has no sphere: there are 4 for 3 spheres"),
        (scalars(vec![0.0, 0.0, f32::NAN]), "sphere 2 has the number NaN, which has no color"),
        (scalars(vec![0.0]), "sphere 1 has no color: there are 1 for 3 spheres"),
        (surfaces(vec![0, 1, 2]), "the surface index of sphere 2 is out of range; there are 2 surfaces"),
        (surfaces(vec![0; 4]), "surface index 3 has no sphere: there are 4 for 3 spheres"),
        (
            rgba(3).with_surfaces(vec![], vec![0; 3]),
            "the surface index of sphere 0 is out of range; there are 0 surfaces",
        ),
    ] {
        assert_eq!(refused(appearance).to_string(), words);
    }
}

/// A colour that only an emissive sphere may have is refused for other spheres, but not if no sphere has it.
#[test]
fn what_creates_light_is_named_by_index() {
    let palette = [0.5, 7.0].map(|level| LinearRgb::new([level; 3]).unwrap());
    let lamp = SurfaceProperties { material: Material::Emissive { strength: 2.0 }, opacity: 1.0 };
    let check = |colors: [u32; 3], surfaces: [u32; 3]| {
        let colors = Colors::Palette { palette: palette.to_vec(), indices: colors.to_vec() };
        let appearance =
            Appearance::new(colors).with_surfaces(vec![SurfaceProperties::default(), lamp], surfaces.to_vec());
        let spheres = (0..3).map(|i| [i as f32, 0.0, 0.0, 0.4]).collect();
        RenderSettings::studio().check(&Scene::from_parts(SphereArray::F32(spheres), appearance).unwrap())
    };
    assert_eq!(check([0, 1, 0], [0, 1, 0]), Ok(()));
    assert_eq!(check([0, 0, 0], [0, 0, 1]), Ok(()));
    let refused = check([0, 1, 1], [0, 1, 0]);
    let named = matches!(&refused, Err(SettingsError::Albedo { what, .. }) if what == "sphere 2");
    assert!(named, "{refused:?}");
}

/// All parts of a scene.
fn parts(scene: &Scene) -> (Vec<[f32; 4]>, Appearance, String) {
    let bounds = format!("{:?} {:?}", scene.bounds(), scene.origin());
    (scene.spheres().to_vec(), scene.appearance().clone(), bounds)
}

/// The same scene, made again from its numbers.
fn fresh(scene: &Scene) -> Scene {
    let spheres = SphereArray::F32(scene.spheres().to_vec());
    Scene::from_parts(spheres, scene.appearance().clone()).unwrap()
}

#[test]
fn updates_are_as_a_scene_that_was_made_so() {
    let mut random = Rng::with_seed(41);
    for kind in kinds() {
        let mut scene = kind.scene;
        for _ in 0..50 {
            let first = random.usize(..scene.len());
            let count = random.usize(..=scene.len() - first);
            let mut numbers = Numbers::of(&mut random, count);
            numbers.rgba.fill_with(|| [0; 4].map(|_| random.u8(..)));
            numbers.radii.fill_with(|| 0.05 + random.f32() * 0.3);
            let Numbers { centers, radii, .. } = &numbers;
            let colors = numbers.colors(&scene);
            let update = SceneUpdate {
                first: first as u32,
                centers: random.bool().then_some(Centers::F32(centers)),
                radii: random.bool().then_some(&radii[..]),
                colors: colors.filter(|_| random.bool()),
            };
            let before = scene.clone();
            scene.apply(&update).unwrap();
            for id in 0..scene.len() {
                let is_in = update.range().contains(&(id as u32));
                let place = id.wrapping_sub(first);
                let [x, y, z, r] = before.spheres()[id];
                let [x, y, z] = if is_in && update.centers.is_some() { centers[place] } else { [x, y, z] };
                let r = if is_in && update.radii.is_some() { radii[place] } else { r };
                assert_eq!(scene.spheres()[id], [x, y, z, r]);
                if !is_in || update.colors.is_none() {
                    assert_eq!(scene.color(id as u32), before.color(id as u32));
                }
            }
            if let (Some(NewColors::Rgba8(colors)), true) = (update.colors, count > 0) {
                let [r, g, b, _] = colors[0];
                assert_eq!(scene.color(first as u32), LinearRgb::from_srgb8([r, g, b]));
            }
            assert_eq!(parts(&scene), parts(&fresh(&scene)), "{}", kind.name);
        }
    }
}

/// Far from the world's origin, centres are moved into the frame in f64.
#[test]
fn centers_are_in_the_world() {
    let spheres = [[1e7, 0.0, 0.0, 0.5], [1e7 + 3.0, 1.0, 0.0, 0.5]];
    let mut scene = Scene::from_f64(&spheres, LinearRgb::WHITE).unwrap();
    let origin = scene.origin();
    let moved = [[1e7 + 0.125, 0.25, 0.0]];
    let update = SceneUpdate { first: 1, centers: Some(Centers::F64(&moved)), ..SceneUpdate::default() };
    scene.apply(&update).unwrap();
    assert_eq!(scene.origin(), origin);
    let [x, y, z, radius] = scene.spheres()[1].map(f64::from);
    assert_eq!([x + origin.x, y + origin.y, z + origin.z, radius], [1e7 + 0.125, 0.25, 0.0, 0.5]);
}

#[test]
fn what_is_refused_is_named_and_changes_nothing() {
    let palette = vec![LinearRgb::WHITE; 3];
    let colors = Colors::Palette { palette, indices: vec![0; 10] };
    let spheres = SphereArray::F32(vec![[0.0, 0.0, 0.0, 0.5]; 10]);
    let mut scene = Scene::from_parts(spheres, Appearance::new(colors)).unwrap();
    let before = parts(&scene);
    let centers = [[1.0_f32; 3]; 4];
    let mut bad_centers = centers;
    bad_centers[2][1] = f32::NAN;
    let update = SceneUpdate { first: 4, ..SceneUpdate::default() };
    let moved = |centers| Some(Centers::F32(centers));
    let radii = Some(&[0.25, -1.0][..]);
    for (update, words) in [
        (SceneUpdate { first: 7, centers: moved(&centers), ..update }, "there is no sphere 10: "),
        (SceneUpdate { first: u32::MAX, centers: moved(&centers), ..update }, "there is no sphere"),
        (SceneUpdate { centers: moved(&bad_centers), ..update }, "sphere 6: its center is [1.0, NaN"),
        (SceneUpdate { radii, ..update }, "sphere 5: its radius is -1.0; "),
        (
            SceneUpdate { centers: moved(&centers), radii, ..update },
            "sphere 6 is not in every list: the update has a radius for 2 spheres, but 4",
        ),
        (
            SceneUpdate { colors: Some(NewColors::Palette(&[2, 3])), ..update },
            "sphere 5 has no color: its index is out of range; the palette has 3 colors",
        ),
        (
            SceneUpdate { radii: Some(&[1.0; 2]), colors: Some(NewColors::Palette(&[2])), ..update },
            "sphere 5 is not in every list: the update has a color for 1 spheres, but 2",
        ),
        (
            SceneUpdate { colors: Some(NewColors::Rgba8(&[[0; 4]])), ..update },
            "sphere 4 cannot be given individual colors: the scene's spheres have palette colors",
        ),
        // The values before it are valid, but are not kept.
        (
            SceneUpdate { radii: Some(&[0.25]), colors: Some(NewColors::Palette(&[9])), ..update },
            "sphere 4 has no color: its index is out of range; the palette has 3 colors",
        ),
    ] {
        let error = scene.apply(&update).unwrap_err();
        assert!(error.to_string().starts_with(words), "{error}");
        assert_eq!(parts(&scene), before, "{error}");
    }
    let scalars = [0.5, f32::NAN];
    let update = SceneUpdate { colors: Some(NewColors::Scalars(&scalars)), ..update };
    for mut kind in kinds() {
        let before = parts(&kind.scene);
        let refused = kind.scene.apply(&update).unwrap_err();
        let is_named = match kind.scene.appearance().colors() {
            Colors::Scalars { .. } => refused.to_string().starts_with("sphere 5 has the number NaN"),
            _ => refused.to_string().starts_with("sphere 4 cannot be given"),
        };
        assert!(is_named, "{}: {refused}", kind.name);
        assert_eq!(format!("{:?}", parts(&kind.scene)), format!("{before:?}"));
    }
}
