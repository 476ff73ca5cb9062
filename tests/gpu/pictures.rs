//! Tests of pictures in which every byte is known.

use glam::DVec3;
use libtest_mimic::Trial;
use pinhole::camera::film::YAxis;
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::gpu::Headless;
use pinhole::image::{Layer, NO_ID};
use pinhole::write::npy::encode;
use pinhole::{Film, Image, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, glam};

use crate::support::View;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("pictures::three_spheres_have_exactly_their_colors", exact_colors),
        trial("pictures::a_picture_does_not_change_from_run_to_run", same_again),
        trial("pictures::turning_y_over_turns_the_picture_over", turned_over),
        trial("pictures::along_the_wall_no_hit_is_far", on_the_wall),
        trial("pictures::a_very_tall_picture", very_tall),
        trial("pictures::every_layer_can_be_had_alone", every_layer_alone),
        trial("pictures::colors_do_not_depend_on_the_data_layers", layers_change_nothing),
    ]
}

fn render(headless: &Headless, view: &View, layers: LayerSet) -> Image {
    headless.render(&view.scene, &view.seen(), &view.settings, layers).unwrap()
}

fn exact_colors(headless: &'static Headless) {
    for view in [View::three_spheres(), View::three_spheres_orthographic()] {
        assert_eq!([view.film.width(), view.film.height()], [800, 600]);
        let image = render(headless, &view, LayerSet::ALL);
        for (color, id) in image.color().iter().zip(image.id().unwrap()) {
            let expected = match id {
                0 => [0xff, 0, 0],
                1 => [0, 0x80, 0],
                2 => [0, 0, 0xff],
                _ => [0xb0, 0xe0, 0xe6],
            };
            assert_eq!(pinhole::image::color::to_srgb8(*color), expected, "sphere {id}");
        }
    }
}

fn same_again(headless: &'static Headless) {
    let view = View::three_spheres();
    let first = render(headless, &view, LayerSet::ALL);
    assert_eq!(first, render(headless, &view, LayerSet::ALL));
}

fn turned_over(headless: &'static Headless) {
    let mut view = View::three_spheres();
    let down = render(headless, &view, LayerSet::ALL);
    view.film = view.film.with_y_axis(YAxis::Up);
    let up = render(headless, &view, LayerSet::ALL);
    let width = view.film.width() as usize;
    let rows = |image: &Image| image.id().unwrap().chunks(width).map(<[u32]>::to_vec).collect();
    let (down, up): (Vec<_>, Vec<_>) = (rows(&down), rows(&up));
    assert_ne!(down, up);
    assert!(down.iter().eq(up.iter().rev()));
}

fn layers_change_nothing(headless: &'static Headless) {
    let view = View::three_spheres();
    let color_only = render(headless, &view, LayerSet::COLOR);
    assert_eq!(color_only.depth(), None);
    assert_eq!(color_only.color(), render(headless, &view, LayerSet::ALL).color());
}

fn every_layer_alone(headless: &'static Headless) {
    let view = View::three_spheres();
    let all = render(headless, &view, LayerSet::ALL);
    assert_eq!(all.layers(), LayerSet::ALL);
    for layer in LayerSet::ALL.iter() {
        let layers = LayerSet::COLOR.with(layer);
        let image = render(headless, &view, layers);
        assert_eq!(image.layers(), layers);
        assert_eq!(encode(&image, layer), encode(&all, layer), "{layer}");
    }
    let pixels = all.alpha().unwrap().iter().zip(all.id().unwrap());
    assert!(pixels.into_iter().all(|(alpha, id)| (*alpha > 0.5) == (*id != NO_ID)));
    assert!(all.samples().unwrap().iter().all(|samples| *samples == 1));
    assert!(all.variance().unwrap().iter().all(|variance| *variance == 0.0));
}

/// If the eye is on the sphere up to rounding and looks along the surface, nearly all terms cancel. Such a ray may hit
/// or miss. It deviates from the middle plane by at most 10⁻⁵ of its length, so its chord in the sphere is shorter than
/// 10⁻³, also after some roundings of f32: √(8 · 2⁻²⁴) is 7 · 10⁻⁴.
fn on_the_wall(headless: &'static Headless) {
    let scene = Scene::new(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE)]).unwrap();
    let film = Film::new(64, 64).unwrap();
    let mut random = fastrand::Rng::with_seed(15);
    let mut hits = 0;
    for _ in 0..40 {
        let outward = DVec3::from([0; 3].map(|_| random.f64() - 0.5)).normalize_or(DVec3::X);
        let along = outward.any_orthonormal_vector();
        let pose = Pose::looking_along(outward, along, outward).unwrap();
        let camera = PinholeCamera::new(pose, 1.0, [1.0, 1e-5]).unwrap();
        let settings = RenderSettings::default();
        let image = headless
            .render(&scene, &pinhole::View::new(&camera, film), &settings, LayerSet::ALL)
            .unwrap();
        for depth in image.depth().unwrap().iter().filter(|depth| depth.is_finite()) {
            assert!(*depth <= 1e-3, "eye {outward}: {depth}");
            hits += 1;
        }
    }
    assert!(hits > 1000, "{hits}");
}

/// The picture has half a million rows. If the cost grew with the square of the height, this test would not end.
fn very_tall(headless: &'static Headless) {
    let mut view = View::three_spheres_orthographic();
    view.film = Film::new(2, 500_000).unwrap().with_y_axis(view.film.y_axis());
    let image = render(headless, &view, LayerSet::COLOR.with(Layer::Id));
    assert!(image.id().unwrap() == view.reference().id().unwrap());
}
