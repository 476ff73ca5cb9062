//! The CPU reference against answers known on paper.

use pinhole::camera::{OrthographicCamera, PinholeCamera, Pose};
use pinhole::image::NO_ID;
use pinhole::{Film, Image, LayerSet, LinearRgb, RenderSettings, Scene, Shading, Sphere, cpu};

use crate::support::{View, shaded};

fn headlight() -> RenderSettings {
    let background = LinearRgb::new([0.1, 0.2, 0.3]).unwrap();
    shaded(Shading::Headlight, background)
}

/// One white sphere of radius 2 at the origin, seen in parallel along −z from z = 8, a pixel per unit.
fn one_sphere() -> Image {
    let scene = Scene::new(&[Sphere::new([0.0; 3], 2.0, LinearRgb::WHITE)]).unwrap();
    let pose = Pose::looking_along([0.0, 0.0, 8.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
    let camera = OrthographicCamera::new(pose, [3.5, 3.5]).unwrap();
    let film = Film::new(7, 7).unwrap();
    cpu::render(&scene, &pinhole::View::new(&camera, film), &headlight(), LayerSet::ALL).unwrap()
}

#[test]
fn layers_of_one_sphere() {
    let image = one_sphere();
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
    let scene = Scene::new(&[Sphere::new([0.0; 3], 3.0, LinearRgb::WHITE)]).unwrap();
    let pose = Pose::looking_at([0.0, 0.0, 1.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::new(pose, 1.0, [1.0, 1.0]).unwrap();
    let film = Film::new(1, 1).unwrap();
    let image =
        cpu::render(&scene, &pinhole::View::new(&camera, film), &headlight(), LayerSet::ALL)
            .unwrap();
    assert_eq!(image.depth().unwrap(), [4.0]);
    // Still away from the centre, so it points along the view; the light does not mind.
    assert_eq!(image.normal().unwrap(), [[0.0, 0.0, -1.0]]);
    assert_eq!(image.color(), [[1.0; 3]]);
}

#[test]
fn of_equal_spheres_the_first_is_seen() {
    let twice = [LinearRgb::WHITE, LinearRgb::BLACK].map(|c| Sphere::new([0.0; 3], 1.0, c));
    let scene = Scene::new(&twice).unwrap();
    let pose = Pose::looking_at([0.0, 0.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::new(pose, 1.0, [0.1, 0.1]).unwrap();
    let film = Film::new(5, 5).unwrap();
    let image =
        cpu::render(&scene, &pinhole::View::new(&camera, film), &headlight(), LayerSet::ALL)
            .unwrap();
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
    let scene = Scene::new(&[]).unwrap();
    let pose = Pose::looking_at([0.0, 0.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::new(pose, 1.0, [1.0, 1.0]).unwrap();
    let film = Film::new(3, 2).unwrap();
    let image =
        cpu::render(&scene, &pinhole::View::new(&camera, film), &headlight(), LayerSet::COLOR)
            .unwrap();
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
