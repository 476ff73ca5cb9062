//! Compares the CPU reference with known answers. The comparator must find planted differences, and only those.

use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::image::{NO_ID, Pixel};
use pinhole::{Film, Image, Integrator, LayerSet, LinearRgb, RenderSettings, Scene, Shading, Sphere, cpu};

use crate::support::compare::{Picture, Violation, compare};
use crate::support::spheres_of;
use crate::support::{View, shaded};

fn headlight() -> RenderSettings {
    let background = LinearRgb::new([0.1, 0.2, 0.3]).unwrap();
    shaded(Shading::Headlight, background)
}

/// A square picture with all layers.
fn rendered(spheres: &[Sphere], camera: &dyn Camera, side: u32) -> Image {
    let film = Film::new(side, side).unwrap();
    let view = pinhole::View::new(camera, film);
    cpu::render(&Scene::new(spheres).unwrap(), &view, &headlight(), LayerSet::ALL).unwrap()
}

/// A camera that looks at the origin along −z, and sees as far to each side of it as `reach`.
fn pinhole(z: f64, reach: f64) -> PinholeCamera {
    let pose = Pose::looking_at([0.0, 0.0, z], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    PinholeCamera::new(pose, 1.0, [reach; 2]).unwrap()
}

#[test]
fn layers_of_one_sphere() {
    // An orthographic view along −z from z = 8, with one pixel per unit.
    let pose = Pose::looking_along([0.0, 0.0, 8.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
    let camera = OrthographicCamera::new(pose, [3.5, 3.5]).unwrap();
    let image = rendered(&[Sphere::new([0.0; 3], 2.0, LinearRgb::WHITE)], &camera, 7);
    for j in 0..7_i32 {
        for i in 0..7_i32 {
            let index = (j * 7 + i) as usize;
            // Row 0 is the top.
            let (x, y) = (f64::from(i - 3), f64::from(3 - j));
            let z_squared = 4.0 - x * x - y * y;
            if z_squared < 0.0 {
                assert_eq!(image.id().unwrap()[index], NO_ID);
                assert_eq!(image.depth().unwrap()[index], f32::INFINITY);
                assert_eq!(image.normal().unwrap()[index], [0.0; 3]);
                assert_eq!(image.color()[index], [0.1, 0.2, 0.3]);
                assert_eq!(image.alpha().unwrap()[index], 0.0);
                assert_eq!(image.position().unwrap()[index], [0.0; 3]);
                assert_eq!(image.albedo().unwrap()[index], [0.0; 3]);
                continue;
            }
            let z = z_squared.sqrt();
            assert_eq!(image.id().unwrap()[index], 0);
            assert!((f64::from(image.depth().unwrap()[index]) - (8.0 - z)).abs() < 1e-6);
            let normal = image.normal().unwrap()[index].map(f64::from);
            for (found, expected) in normal.into_iter().zip([x / 2.0, y / 2.0, z / 2.0]) {
                assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
            }
            let position = image.position().unwrap()[index].map(f64::from);
            for (found, expected) in position.into_iter().zip([x, y, z]) {
                assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
            }
            assert_eq!(image.alpha().unwrap()[index], 1.0);
            assert_eq!(image.albedo().unwrap()[index], [1.0; 3]);
            // Lambert with the light at the eye.
            assert!((f64::from(image.color()[index][0]) - z / 2.0).abs() < 1e-6);
        }
    }
    assert_eq!(image.samples().unwrap(), [1; 49]);
    assert_eq!(image.variance().unwrap(), [0.0; 49]);
    // The four points of the rim at distance 2 are tangents, and tangents hit.
    assert_eq!(image.id().unwrap()[3 * 7 + 1], 0);
    assert_eq!(image.depth().unwrap()[3 * 7 + 1], 8.0);
}

#[test]
fn from_inside_the_far_side_is_seen() {
    let sphere = Sphere::new([0.0; 3], 3.0, LinearRgb::WHITE);
    let image = rendered(&[sphere], &pinhole(1.0, 1.0), 1);
    assert_eq!(image.depth().unwrap(), [4.0]);
    // The normal still points away from the centre, so along the view. The light does not depend on its side.
    assert_eq!(image.normal().unwrap(), [[0.0, 0.0, -1.0]]);
    assert_eq!(image.color(), [[1.0; 3]]);
}

#[test]
fn of_equal_spheres_the_first_is_seen() {
    let twice = [LinearRgb::WHITE, LinearRgb::BLACK].map(|c| Sphere::new([0.0; 3], 1.0, c));
    let image = rendered(&twice, &pinhole(4.0, 0.1), 5);
    assert!(image.id().unwrap().iter().all(|id| *id == 0));
}

#[test]
fn three_spheres_have_exactly_their_colors_and_places() {
    let view = View::three_spheres();
    let image = view.reference();
    let mut pixels = [0_u64; 4];
    let mut columns = [0_u64; 4];
    for (index, (color, id)) in image.color().iter().zip(image.id().unwrap()).enumerate() {
        let expected = match id {
            0 => [0xff, 0, 0],
            1 => [0, 0x80, 0],
            2 => [0, 0, 0xff],
            _ => [0xb0, 0xe0, 0xe6],
        };
        assert_eq!(pinhole::image::color::to_srgb8(*color), expected);
        let sphere = (*id).min(3) as usize;
        pixels[sphere] += 1;
        columns[sphere] += index as u64 % 800;
    }
    let [red, green, blue, _] = [0, 1, 2, 3].map(|i| columns[i] / pixels[i]);
    assert!(red < blue && blue < green, "red is left, green right: {red} {blue} {green}");
    assert!(pixels[2] < pixels[0] && pixels[2] < pixels[1], "blue is smallest: {pixels:?}");
    // The scene is symmetric.
    assert_eq!(pixels[0], pixels[1]);
}

#[test]
fn a_picture_of_nothing_is_background() {
    let (scene, camera) = (Scene::new(&[]).unwrap(), pinhole(4.0, 1.0));
    let film = Film::new(3, 2).unwrap();
    let image = cpu::render(&scene, &pinhole::View::new(&camera, film), &headlight(), LayerSet::COLOR).unwrap();
    assert!(image.color().iter().all(|c| *c == [0.1, 0.2, 0.3]));
    assert_eq!((image.depth(), image.normal(), image.id()), (None, None, None));
}

#[test]
fn seen_in_parallel_the_three_spheres_are_equally_large() {
    let image = View::three_spheres_orthographic().reference();
    let rows = |wanted: u32| {
        let ids = image.id().unwrap().chunks(800);
        ids.filter(|row| row.contains(&wanted)).count()
    };
    assert_eq!([rows(0), rows(1), rows(2)], [240; 3]);
    let middle = &image.id().unwrap()[300 * 800..301 * 800];
    assert_eq!([middle[0], middle[400], middle[799]], [0, 2, 1], "red, blue, green");
}

/// A pixel in the middle of the red sphere, and one in the background.
const RED: [u32; 2] = [19, 30];
const BACKGROUND: [u32; 2] = [2, 3];

fn scene() -> View {
    let mut view = View::three_spheres();
    view.film = Film::new(80, 60).unwrap().with_y_axis(view.film.y_axis());
    view.settings.integrator = Integrator::Primary(Shading::Headlight);
    view
}

fn picture(view: &View) -> Picture {
    Picture::from(&view.reference())
}

/// The violations in a picture of the scene with something changed.
fn found(change: impl FnOnce(&mut View)) -> Vec<Violation> {
    let view = scene();
    let mut other = scene();
    change(&mut other);
    compare(&view, &picture(&view), &picture(&other)).violations
}

/// The layers with violations in the scene's picture with one pixel changed. Other pixels must have none.
fn spoilt([i, j]: [u32; 2], change: impl FnOnce(&mut Pixel)) -> Vec<&'static str> {
    let view = scene();
    let mut other = picture(&view);
    change(&mut other.pixels[(j * 80 + i) as usize]);
    let violations = compare(&view, &picture(&view), &other).violations;
    assert!(violations.iter().all(|violation| violation.pixel == [i, j]), "{violations:?}");
    violations.iter().map(|violation| violation.layer).collect()
}

/// The scene with its spheres changed.
fn with_spheres(view: &View, change: impl Fn(&mut Vec<Sphere>)) -> Scene {
    let mut spheres = spheres_of(&view.scene);
    change(&mut spheres);
    Scene::new(&spheres).unwrap()
}

#[test]
fn one_pixel_of_each_layer_is_found() {
    assert!(found(|_| ()).is_empty());
    type Spoil<'a> = (&'a [[u32; 2]], &'a str, fn(&mut Pixel));
    let spoils: [Spoil<'_>; 10] = [
        (&[RED, BACKGROUND], "id", |p| p.id = 1),
        (&[RED, BACKGROUND], "color", |p| p.color[2] += 1e-4),
        (&[RED, BACKGROUND], "normal", |p| p.normal[1] += 1e-3),
        (&[RED, BACKGROUND], "position", |p| p.position[2] += 1e-4),
        (&[RED, BACKGROUND], "albedo", |p| p.albedo[1] += 1e-7),
        (&[RED], "depth", |p| p.depth *= 1.000_01),
        (&[BACKGROUND], "depth", |p| p.depth = 1e30),
        // A miss in the middle of a sphere, and normals that are turned over or too short.
        (&[RED], "id", |p| p.id = NO_ID),
        (&[RED], "normal", |p| p.normal = p.normal.map(|x| -x)),
        (&[RED], "normal", |p| p.normal = p.normal.map(|x| 0.999_9 * x)),
    ];
    for (row, (pixels, layer, spoil)) in spoils.into_iter().enumerate() {
        for pixel in pixels {
            assert_eq!(spoilt(*pixel, spoil), [layer], "row {row}, {pixel:?}");
        }
    }
    let not_numbers = spoilt(RED, |p| {
        (p.depth, p.normal[0], p.color[0]) = (f32::NAN, f32::NAN, f32::NAN);
        (p.position[0], p.albedo[0]) = (f32::NAN, f32::NAN);
    });
    assert_eq!(not_numbers, ["depth", "normal", "position", "albedo", "color"]);
}

#[test]
fn one_shifted_row_is_found() {
    let view = scene();
    let mut other = picture(&view);
    other.pixels[30 * 80..31 * 80].rotate_right(1);
    let violations = compare(&view, &picture(&view), &other).violations;
    // The row crosses three spheres, which have six silhouettes.
    let ids = violations.iter().filter(|violation| violation.layer == "id").count();
    assert_eq!(ids, 6, "{violations:?}");
}

#[test]
fn another_picture_is_found() {
    type Change<'a> = (&'a str, &'a str, fn(&mut View));
    let changes: [Change<'_>; 5] = [
        ("another size", "size", |view| view.film = Film::new(80, 61).unwrap()),
        ("half a pixel", "id", |view| {
            let text = include_str!("../../examples/three-spheres.toml")
                .replace("half_extent = [1, 1]", "half_extent = [1.0125, 1]");
            view.camera = View::from_toml(&text).camera;
        }),
        ("upside down", "id", |view| view.film = Film::new(80, 60).unwrap()),
        ("a radius off by one part in ten thousand", "depth", |view| {
            view.scene = with_spheres(view, |spheres| {
                spheres.iter_mut().for_each(|sphere| sphere.radius *= 1.000_1);
            });
        }),
        ("swapped ids", "id", |view| view.scene = with_spheres(view, |all| all.swap(0, 2))),
    ];
    for (name, layer, change) in changes {
        let violations = found(change);
        assert!(violations.iter().any(|v| v.layer == layer), "{name}: {violations:?}");
        assert!(layer != "size" || violations.len() == 1, "{name}: {violations:?}");
        if name == "swapped ids" {
            assert!(violations.iter().any(|v| v.values == ["0", "2"]), "{violations:?}");
        }
    }
}

#[test]
fn another_shading_is_found_and_nothing_else() {
    let violations = found(|view| view.settings.integrator = Integrator::Primary(Shading::Flat));
    assert!(violations.iter().all(|violation| violation.layer == "color"), "{violations:?}");
    let view = scene();
    let hits = picture(&view).pixels.iter().filter(|p| p.id != NO_ID).count();
    assert!(violations.len() > hits * 9 / 10, "{} of {hits}", violations.len());
}
