//! The comparator itself: it must find what is planted, and only that.

use pinhole::image::{NO_ID, Pixel};
use pinhole::{Film, Integrator, Scene, Shading, Sphere};

use crate::support::View;
use crate::support::compare::{Picture, Violation, compare};

/// A pixel in the middle of the red sphere, and one of the background.
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

/// What is found in a picture of the scene with something changed.
fn found(change: impl FnOnce(&mut View)) -> Vec<Violation> {
    let view = scene();
    let mut other = scene();
    change(&mut other);
    compare(&view, &picture(&view), &picture(&other)).violations
}

/// What is found in the scene's picture with one pixel changed.
fn spoilt([i, j]: [u32; 2], change: impl FnOnce(&mut Pixel)) -> Vec<Violation> {
    let view = scene();
    let mut other = picture(&view);
    change(&mut other.pixels[(j * 80 + i) as usize]);
    compare(&view, &picture(&view), &other).violations
}

/// The scene with every sphere changed.
fn with_spheres(view: &View, change: impl Fn(&mut Vec<Sphere>)) -> Scene {
    let spheres = view.scene.spheres().iter().zip(0..);
    let mut spheres = spheres
        .map(|(s, id)| {
            let center = [s[0].into(), s[1].into(), s[2].into()];
            Sphere::new(center, s[3].into(), view.scene.color(id))
        })
        .collect();
    change(&mut spheres);
    Scene::new(&spheres).unwrap()
}

#[test]
fn equal_pictures_are_equal() {
    assert_eq!(found(|_| ()), []);
}

#[test]
fn another_size_is_found() {
    assert_eq!(found(|view| view.film = Film::new(80, 61).unwrap()), [Violation::Size]);
}

#[test]
fn one_pixel_of_each_layer_is_found() {
    for pixel in [RED, BACKGROUND] {
        let id = spoilt(pixel, |p| p.id = 1);
        assert!(matches!(id[..], [Violation::Id { pixel: at, result: 1, .. }] if at == pixel));
        let color = spoilt(pixel, |p| p.color[2] += 1e-4);
        assert!(matches!(color[..], [Violation::Color { pixel: at, .. }] if at == pixel));
        let normal = spoilt(pixel, |p| p.normal[1] += 1e-3);
        assert!(matches!(normal[..], [Violation::Normal { pixel: at, .. }] if at == pixel));
        let position = spoilt(pixel, |p| p.position[2] += 1e-4);
        assert!(matches!(position[..], [Violation::Position { pixel: at, .. }] if at == pixel));
        let albedo = spoilt(pixel, |p| p.albedo[1] += 1e-7);
        assert!(matches!(albedo[..], [Violation::Albedo { pixel: at, .. }] if at == pixel));
    }
    let depth = spoilt(RED, |p| p.depth *= 1.000_01);
    assert!(matches!(depth[..], [Violation::Depth { pixel: RED, .. }]), "{depth:?}");
    let depth = spoilt(BACKGROUND, |p| p.depth = 1e30);
    assert!(matches!(depth[..], [Violation::Depth { pixel: BACKGROUND, .. }]), "{depth:?}");
}

#[test]
fn a_miss_in_the_middle_of_a_sphere_is_found() {
    let violations = spoilt(RED, |p| p.id = NO_ID);
    assert!(matches!(violations[..], [Violation::Id { reference: 0, result: NO_ID, .. }]));
}

#[test]
fn a_normal_that_is_turned_over_or_too_short_is_found() {
    for factor in [-1.0, 0.999_9] {
        let violations = spoilt(RED, |p| p.normal = p.normal.map(|x| x * factor));
        assert!(matches!(violations[..], [Violation::Normal { pixel: RED, .. }]), "{violations:?}");
    }
}

#[test]
fn what_is_not_a_number_is_found() {
    let violations = spoilt(RED, |p| {
        p.depth = f32::NAN;
        p.normal[0] = f32::NAN;
        p.color[0] = f32::NAN;
        p.position[0] = f32::NAN;
        p.albedo[0] = f32::NAN;
    });
    assert_eq!(violations.len(), 5, "{violations:?}");
}

#[test]
fn one_shifted_row_is_found() {
    let view = scene();
    let mut other = picture(&view);
    other.pixels[30 * 80..31 * 80].rotate_right(1);
    let violations = compare(&view, &picture(&view), &other).violations;
    // The row crosses three spheres: six silhouettes.
    let ids = violations.iter().filter(|v| matches!(v, Violation::Id { .. })).count();
    assert_eq!(ids, 6, "{violations:?}");
}

#[test]
fn half_a_pixel_is_found() {
    let violations = found(|view| {
        let text = include_str!("../../examples/three-spheres.toml")
            .replace("half_extent = [1, 1]", "half_extent = [1.0125, 1]");
        view.camera = View::from_toml(&text).camera;
    });
    assert!(violations.iter().any(|v| matches!(v, Violation::Id { .. })), "{violations:?}");
}

#[test]
fn a_picture_upside_down_is_found() {
    let violations = found(|view| view.film = Film::new(80, 60).unwrap());
    assert!(violations.iter().any(|v| matches!(v, Violation::Id { .. })), "{violations:?}");
}

#[test]
fn another_shading_is_found_and_nothing_else() {
    let violations = found(|view| view.settings.integrator = Integrator::Primary(Shading::Flat));
    assert!(violations.iter().all(|v| matches!(v, Violation::Color { .. })), "{violations:?}");
    let view = scene();
    let hits = picture(&view).pixels.iter().filter(|p| p.id != NO_ID).count();
    assert!(violations.len() > hits * 9 / 10, "{} of {hits}", violations.len());
}

#[test]
fn a_radius_off_by_one_part_in_ten_thousand_is_found() {
    let violations = found(|view| {
        view.scene = with_spheres(view, |spheres| {
            spheres.iter_mut().for_each(|sphere| sphere.radius *= 1.000_1);
        });
    });
    assert!(violations.iter().any(|v| matches!(v, Violation::Depth { .. })), "{violations:?}");
}

#[test]
fn swapped_ids_are_found() {
    let violations = found(|view| view.scene = with_spheres(view, |spheres| spheres.swap(0, 2)));
    let swapped = |v: &Violation| matches!(v, Violation::Id { reference: 0, result: 2, .. });
    assert!(violations.iter().any(swapped), "{violations:?}");
}
