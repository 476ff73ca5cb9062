//! The comparator itself: it must find what is planted, and only that.

use pinhole::image::NO_ID;
use pinhole::{Film, Image, LayerSet, Settings, cpu};

use crate::support::View;
use crate::support::compare::{Violation, compare};

fn scene() -> View {
    let mut view = View::three_spheres();
    view.film = Film::new(80, 60).unwrap().with_y_axis(view.film.y_axis());
    view.settings = Settings { shading: pinhole::Shading::Headlight, ..view.settings };
    view
}

/// The first violation that is found in a picture rendered with something changed.
fn found(change: impl FnOnce(&mut View)) -> Vec<Violation> {
    let view = scene();
    let mut other = scene();
    change(&mut other);
    compare(&view, &view.reference(), &other.reference()).violations
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
fn half_a_pixel_is_found() {
    let violations = found(|view| {
        let scene = &view.scene;
        let text = include_str!("../../examples/three-spheres.toml")
            .replace("half_extent = [1, 1]", "half_extent = [1.0125, 1]");
        let file = pinhole::scene_file::SceneFile::parse(&text).unwrap();
        view.camera = file.camera(&view.film, scene).unwrap();
    });
    assert!(violations.iter().any(|v| matches!(v, Violation::Id { .. })), "{violations:?}");
}

#[test]
fn a_picture_upside_down_is_found() {
    let violations = found(|view| view.film = Film::new(80, 60).unwrap());
    assert!(violations.iter().any(|v| matches!(v, Violation::Id { .. })), "{violations:?}");
}

#[test]
fn another_color_is_found_everywhere_it_shows() {
    let violations = found(|view| view.settings.shading = pinhole::Shading::Flat);
    assert!(violations.iter().all(|v| matches!(v, Violation::Color { .. })), "{violations:?}");
    assert!(violations.len() > 200);
}

#[test]
fn a_radius_off_by_one_part_in_ten_thousand_is_found() {
    let violations = found(|view| {
        let spheres: Vec<pinhole::Sphere> = view
            .scene
            .spheres()
            .iter()
            .zip(view.scene.colors())
            .map(|(s, color)| pinhole::Sphere {
                center: [s[0].into(), s[1].into(), s[2].into()],
                radius: f64::from(s[3]) * 1.0001,
                color: *color,
            })
            .collect();
        view.scene = pinhole::Scene::new(&spheres).unwrap();
    });
    assert!(violations.iter().any(|v| matches!(v, Violation::Depth { .. })), "{violations:?}");
}

/// Changes one value of one pixel in the middle of a sphere, or of the background.
fn spoilt(change: impl Fn(&View) -> Image) -> Vec<Violation> {
    let view = scene();
    compare(&view, &view.reference(), &change(&view)).violations
}

/// A picture whose scene has its ids swapped.
#[test]
fn swapped_ids_are_found() {
    let violations = spoilt(|view| {
        let mut spheres: Vec<pinhole::Sphere> = view
            .scene
            .spheres()
            .iter()
            .zip(view.scene.colors())
            .map(|(s, color)| {
                pinhole::Sphere::new([s[0].into(), s[1].into(), s[2].into()], s[3].into(), *color)
            })
            .collect();
        spheres.swap(0, 2);
        let scene = pinhole::Scene::new(&spheres).unwrap();
        cpu::render(&scene, view.camera.as_ref(), &view.film, &view.settings, LayerSet::ALL)
            .unwrap()
    });
    assert!(violations.iter().any(|v| matches!(v, Violation::Id { reference: 0, result: 2, .. })));
    assert!(violations.iter().all(|v| !matches!(v, Violation::Id { result: NO_ID, .. })));
}
