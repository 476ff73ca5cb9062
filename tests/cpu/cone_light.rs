//! Light of cones and cylinders: smooth pictures against random rays.

use pinhole::camera::{PinholeCamera, Pose};
use pinhole::geometry::math::unit;
use pinhole::glam::DVec3;
use pinhole::image::NO_ID;
use pinhole::light::{Light, LightFrame, LightKind};
use pinhole::render::{Occlusion, Sampling, Studio};
use pinhole::scene::cone::{Caps, Cone};
use pinhole::scene::tube::Tube;
use pinhole::{Film, Image, Integrator, LayerSet, LinearRgb, RenderSettings, Scene, SphereArray, View, cpu};

use crate::support::cones::mixed;

/// A picture of white shapes in ambient light or in that of a lamp.
fn picture(scene: &Scene, lamp: Option<(DVec3, f64)>, samples: u32, is_smooth: bool) -> Image {
    let subject = scene.bounds_to_frame();
    let size = subject.size().length();
    let eye = subject.center() + 1.6 * size * unit(DVec3::new(0.4, 0.3, 1.0)).unwrap();
    let pose = Pose::looking_at(eye, subject.center(), DVec3::Y).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 0.55, 1.0).unwrap();
    let occlusion = lamp.is_none().then(|| Occlusion { radius: Some(0.3 * size), ..Occlusion::default() });
    let light = lamp.map(|(toward, angular_radius)| Light {
        kind: LightKind::Directional { toward, strength: LinearRgb::WHITE, angular_radius },
        frame: LightFrame::World,
    });
    let ambient = if lamp.is_some() { LinearRgb::BLACK } else { LinearRgb::WHITE };
    let studio = Studio { ambient, occlusion, is_smooth, is_dense: is_smooth, ..Studio::default() };
    let settings = RenderSettings {
        integrator: Integrator::Studio(studio),
        lights: light.into_iter().collect(),
        sampling: Sampling { samples, ..Sampling::default() },
        background: LinearRgb::BLACK,
        ..RenderSettings::default()
    };
    let search = cpu::SearchStructure::new(scene).unwrap();
    let view = View::new(&camera, Film::new(40, 40).unwrap());
    cpu::render(&search, &view, &settings, LayerSet::COLOR).unwrap()
}

/// The root mean square of the differences of two pictures, and the mean difference.
fn difference(one: &Image, other: &Image) -> [f64; 2] {
    let pixels = one.color().iter().zip(other.color());
    let errors: Vec<f64> = pixels.map(|(a, b)| f64::from(a[0]) - f64::from(b[0])).collect();
    let count = errors.len() as f64;
    let square = errors.iter().map(|error| error * error).sum::<f64>() / count;
    [square.sqrt(), errors.iter().sum::<f64>() / count]
}

fn white(balls: Vec<[f64; 4]>, cones: &[Cone]) -> Scene {
    Scene::from_shapes(SphereArray::F64(balls), cones, LinearRgb::WHITE.into()).unwrap()
}

/// Balls and sticks, arrows on a plate, and struts that are much longer than they are thick.
fn scenes() -> Vec<(&'static str, Scene)> {
    let mut random = fastrand::Rng::with_seed(3);
    let mut place = |size: f64| DVec3::from([0; 3].map(|_| size * random.f64()));
    let (mut balls, mut sticks) = (Vec::new(), Vec::new());
    for _ in 0..12 {
        let mut at = place(6.0);
        for _ in 0..8 {
            let next = (at + 1.6 * (place(1.0) - 0.5)).clamp(DVec3::ZERO, DVec3::splat(6.0));
            balls.push([at.x, at.y, at.z, 0.4]);
            sticks.push(Cone::cylinder(at.to_array(), next.to_array(), 0.2));
            at = next;
        }
    }
    let mut arrows = vec![Cone::cylinder([3.0, 3.0, -0.5], [3.0, 3.0, 0.0], 4.0)];
    for k in 0..16 {
        let base = DVec3::new(f64::from(k % 4) * 1.6 + 0.6, f64::from(k / 4) * 1.6 + 0.6, 0.0);
        let along = DVec3::new(0.3, 0.2 * f64::from(k % 3) - 0.2, 1.0);
        let [neck, tip] = [1.0, 1.8].map(|part| (base + part * along).to_array());
        arrows.push(Cone::cylinder(base.to_array(), neck, 0.15));
        arrows.push(Cone::new(neck, tip, [0.4, 0.0]));
    }
    let strut = |_| Cone::cylinder(place(20.0).to_array(), place(20.0).to_array(), 0.25);
    let struts: Vec<Cone> = (0..120).map(strut).collect();
    let tubes =
        struts[..60].iter().map(|cone| Cone { radii: [0.9, 0.5], ..cone.with_caps(Caps::None) }).collect::<Vec<_>>();
    vec![
        ("balls and sticks", white(balls, &sticks)),
        ("arrows", white(Vec::new(), &arrows)),
        ("struts", white(Vec::new(), &struts)),
        ("tubes", white(Vec::new(), &tubes)),
        ("mixed", mixed(60, 120, 0.25, 4)),
    ]
}

#[test]
fn smooth_light_is_close_to_random_rays() {
    let toward = unit(DVec3::new(-0.5, 0.8, 0.6)).unwrap();
    for (name, scene) in scenes() {
        for (light, lamp) in [("ambient", None), ("sharp", Some((toward, 0.01))), ("soft", Some((toward, 0.15)))] {
            let smooth = picture(&scene, lamp, 25, true);
            let [rms, mean] = difference(&smooth, &picture(&scene, lamp, 64, false));
            assert!(rms < 0.07 && mean.abs() < 0.015, "{name}, {light}: {rms} rms, {mean} mean");
        }
    }
}

/// A tube of many pieces looks like one body: no pixel is darker or lighter than what is on both of its sides.
#[test]
fn a_tube_has_no_seams() {
    let at = |t: f64| [3.0 * t, (2.0 * t).sin(), 0.4 * (3.0 * t).cos(), 0.3 + 0.05 * (5.0 * t).sin()];
    let points: Vec<[f64; 4]> = (0..14).map(|k| at(f64::from(k) / 4.0)).collect();
    let tube = Tube::through(&points);
    let scene = white(tube.spheres, &tube.sides);
    assert!(scene.cones().len() > 100);
    let size = scene.bounds_to_frame().size().length();
    let center = scene.bounds_to_frame().center();
    let studio = Studio { is_smooth: true, shadows: false, ..Studio::default() };
    let toward = unit(DVec3::new(-0.5, 0.75, 0.9)).unwrap();
    let kind = LightKind::Directional { toward, strength: LinearRgb::WHITE, angular_radius: 0.0 };
    let settings = RenderSettings {
        integrator: Integrator::Studio(studio),
        lights: vec![Light { kind, frame: LightFrame::World }],
        sampling: Sampling { samples: 8, ..Sampling::default() },
        ..RenderSettings::default()
    };
    let search = cpu::SearchStructure::new(&scene).unwrap();
    let pose = Pose::looking_at(center + size * DVec3::new(0.0, 0.3, 2.0), center, DVec3::Y).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 0.4, 1.0).unwrap();
    // Pixels are about as large as pieces.
    for side in [120, 170] {
        let film = Film::new(side, side).unwrap();
        let width = film.width() as usize;
        let image = cpu::render(&search, &View::new(&camera, film), &settings, LayerSet::ALL).unwrap();
        let (ids, color) = (image.id().unwrap(), image.color());
        let (mut inside, mut worst) = (0, 0.0_f32);
        for at in width + 1..ids.len() - width - 1 {
            let around = [[at - 1, at + 1], [at - width, at + width]];
            if around.iter().flatten().chain(&[at]).any(|at| ids[*at] == NO_ID) {
                continue;
            }
            inside += 1;
            let bend = around.map(|[a, b]| (color[at][1] - 0.5 * (color[a][1] + color[b][1])).abs());
            worst = worst.max(bend[0].min(bend[1]));
        }
        assert!(inside > 800 && worst < 0.2, "{side}: {inside} pixels, {worst}");
    }
}
