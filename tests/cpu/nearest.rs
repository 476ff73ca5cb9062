//! Pictures of parts of a scene, put together, against the picture of the whole.

use pinhole::camera::film::Film;
use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose, View};
use pinhole::cpu;
use pinhole::geometry::bounds::Bounds;
use pinhole::image::LayerSet;
use pinhole::render::{Nearest, RenderSettings};
use pinhole::scene::{Scene, Whole};
use pinhole::{Integrator, LinearRgb, Shading};

const COLOR: LinearRgb = LinearRgb::WHITE;

/// Spheres of which every fourth appears twice.
fn spheres() -> Vec<[f32; 4]> {
    let mut rng = fastrand::Rng::with_seed(4);
    let mut all: Vec<[f32; 4]> = Vec::new();
    for index in 0..240 {
        let new = [rng.f32(), rng.f32(), rng.f32(), 0.03 + 0.05 * rng.f32()];
        all.push(if index % 4 == 3 { all[rng.usize(..index)] } else { new });
    }
    all
}

fn whole_of(scene: &Scene) -> Whole {
    let mut whole = Whole::new(scene.bounds().unwrap());
    scene.spheres().iter().for_each(|sphere| whole.add(*sphere));
    whole
}

fn settings() -> RenderSettings {
    RenderSettings {
        integrator: Integrator::Primary(Shading::Headlight),
        ..RenderSettings::default()
    }
}

/// The pictures of parts, whose spheres are given by their ids.
fn parts(scene: &Scene, ids: &[Vec<u32>], view: &View<'_>) -> Vec<Nearest> {
    let whole = whole_of(scene);
    let part = |ids: &Vec<u32>| {
        let spheres = ids.iter().map(|id| scene.spheres()[*id as usize]).collect();
        let part = Scene::part(whole, spheres, COLOR.into()).unwrap();
        let nearest = cpu::render_nearest(&part, view, &settings(), LayerSet::ALL).unwrap();
        nearest.unwrap().with_ids(ids)
    };
    ids.iter().map(part).collect()
}

#[test]
fn parts_in_any_order_and_grouping_make_the_picture_of_the_whole() {
    let scene = Scene::from_f32(spheres(), COLOR).unwrap();
    let film = Film::new(47, 39).unwrap();
    let pose = Pose::looking_at([3.0, 2.0, 4.0], [0.5; 3], [0.0, 1.0, 0.0]).unwrap();
    let pinhole = PinholeCamera::with_vertical_fov(pose, 0.4, film.aspect()).unwrap();
    let parallel = OrthographicCamera::new(pose, [0.9, 0.8]).unwrap();
    for camera in [&pinhole as &dyn Camera, &parallel] {
        let view = View::new(camera, film);
        let expected = cpu::render(&scene, &view, &settings(), LayerSet::ALL).unwrap();
        let mut rng = fastrand::Rng::with_seed(9);
        for count in [1, 2, 5, 17] {
            let mut ids = vec![Vec::new(); count];
            (0..scene.len() as u32).for_each(|id| ids[rng.usize(..count)].push(id));
            let mut left = parts(&scene, &ids, &view);
            while left.len() > 1 {
                let part = left.swap_remove(rng.usize(..left.len()));
                // As it travels between machines.
                let size = [film.width(), film.height()];
                let bytes = part.to_le_bytes();
                let part = Nearest::from_le_bytes(size, LayerSet::ALL, &bytes).unwrap();
                assert!(Nearest::from_le_bytes(size, LayerSet::ALL, &bytes[1..]).is_none());
                let at = rng.usize(..left.len());
                left[at].keep_nearer(&part).unwrap();
            }
            assert_eq!(*left[0].image(), expected, "{count} parts");
        }
    }
}

/// What a part hides is behind it, and never what it does not.
#[test]
fn a_part_hides_only_what_changes_nothing() {
    let scene = Scene::from_f32(spheres(), COLOR).unwrap();
    let film = Film::new(31, 31).unwrap();
    let pose = Pose::looking_at([0.5, 0.5, 9.0], [0.5; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 0.1, 1.0).unwrap();
    let view = View::new(&camera, film);
    let (near, far): (Vec<u32>, Vec<u32>) =
        (0..scene.len() as u32).partition(|id| scene.spheres()[*id as usize][2] > 0.5);
    let [mut near, far] = <[Nearest; 2]>::try_from(parts(&scene, &[near, far], &view)).unwrap();
    let bounds = |[x, y, z]: [f64; 3], radius| Bounds::of_sphere([x, y, z].into(), radius);
    let all = scene.bounds().unwrap();
    let is_hidden = |nearest: &Nearest, bounds| nearest.hides(&view, &all, &bounds);
    assert!(!is_hidden(&near, bounds([0.5, 0.5, 0.9], 0.1)));
    assert!(is_hidden(&near, bounds([7.0, 0.5, 0.5], 0.1)));
    let mut hidden = 0;
    for place in 0..400 {
        let at = [f64::from(place % 20) / 20.0, f64::from(place / 20) / 20.0, 0.2];
        let box_of_some = bounds(at, 0.04);
        hidden += u32::from(is_hidden(&near, box_of_some));
        if is_hidden(&near, box_of_some) {
            // A sphere in the box changes nothing.
            let sphere = [at[0] as f32, at[1] as f32, at[2] as f32, 0.039];
            let part = Scene::part(whole_of(&scene), vec![sphere], COLOR.into()).unwrap();
            let of_sphere = cpu::render_nearest(&part, &view, &settings(), LayerSet::ALL);
            let mut both = near.clone();
            both.keep_nearer(&of_sphere.unwrap().unwrap().with_ids(&[1000])).unwrap();
            assert_eq!(both.image(), near.image(), "{at:?}");
        }
    }
    assert!((20..380).contains(&hidden), "{hidden}");
    near.keep_nearer(&far).unwrap();
    assert!(is_hidden(&near, bounds([0.5, 0.5, -7.0], 0.01)));
    let small = Film::new(5, 5).unwrap();
    let other = parts(&scene, &[vec![0]], &View::new(&camera, small));
    assert!(near.keep_nearer(&other[0]).is_err());
}
