//! Light does not leak, and none is lost, at any scale, because rays start on surfaces, not near them.

use pinhole::glam::DVec3;
use pinhole::light::LightKind;
use pinhole::render::{Integrator, LightSampling, Occlusion, Studio};
use pinhole::{LinearRgb, Material, RenderSettings, Sphere};

use super::{Shot, by, emissive, furnace, gray, ground, paths, studio, white};

const SCALES: [f64; 5] = [1e-4, 1e-2, 1.0, 1e3, 1e6];

/// The places to which scenes are moved. f32 offsets keep these coordinates.
const PLACES: [[f64; 3]; 2] = [[0.0; 3], [1e6, -1e6, 1e6]];

fn placed(spheres: &[Sphere], scale: f64, place: [f64; 3]) -> Vec<Sphere> {
    let place_one = |sphere: &Sphere| {
        let mut sphere = *sphere;
        sphere.radius *= scale;
        for (x, offset) in sphere.center.iter_mut().zip(place) {
            *x = *x * scale + offset;
        }
        sphere
    };
    spheres.iter().map(place_one).collect()
}

/// In a furnace, touching spheres and the floor under them look the same at each scale, except for pixels at edges, and
/// few pixels whose paths hit an edge.
#[test]
fn all_scales_look_the_same() {
    for floor in [8.0, 1e6] {
        let spheres = [
            Sphere::new([-0.5, 0.5, 0.0], 0.5, gray(0.5)),
            Sphere::new([0.5, 0.5, 0.0], 0.5, gray(0.8))
                .with_material(Material::Lambert { specular: 0.5, roughness: 0.3 }),
            Sphere::new([0.0, 0.5, 0.875], 0.5, gray(0.5)).with_material(Material::Conductor { roughness: 0.3 }),
            Sphere::new([0.0, -floor, 0.0], floor, gray(0.5)),
        ];
        let lighting = furnace(4);
        let render = |scale: f64, [x, y, z]: [f64; 3]| {
            let spheres = placed(&spheres, scale, [x, y, z]);
            let target = [x, y + 0.3 * scale, z];
            Shot::new(&spheres, target, 1.5 * scale, 24).render(&lighting)
        };
        let reference = render(1.0, PLACES[0]);
        // Beside such a large floor, f32 offsets can hold the small spheres only at the world's origin.
        let places = if floor > 1e3 { &PLACES[..1] } else { &PLACES[..] };
        for scale in SCALES {
            for place in places {
                let image = render(scale, *place);
                let pairs = image.color().iter().zip(reference.color());
                let different = pairs.filter(|(a, b)| (a[0] - b[0]).abs() > 1e-3).count();
                assert!(different <= 12, "{floor}, {scale:e} at {place:?}: {different} of 576");
            }
        }
    }
}

/// An emissive sphere inside an opaque one is exactly black from outside, for any brightness.
#[test]
fn a_closed_shell_is_dark() {
    let lamp = white([0.1, 0.2, 0.0], 0.25).with_material(emissive(1e6));
    let touching = white([0.5, 0.0, 0.0], 0.5).with_material(emissive(1e6));
    let neighbours = [white([1.5, 0.0, 0.0], 0.5), white([0.0, -1e4 - 1.0, 0.0], 1e4)];
    for shell in [
        Material::default(),
        Material::Lambert { specular: 0.5, roughness: 0.5 },
        Material::Conductor { roughness: 0.1 },
    ] {
        for scale in SCALES {
            for place in PLACES {
                for sampling in [LightSampling::Chance, LightSampling::Direct, LightSampling::Multiple] {
                    let inner = if scale == 1.0 { touching } else { lamp };
                    let shell = white([0.0; 3], 1.0).with_material(shell);
                    let spheres = [&[shell, inner][..], &neighbours].concat();
                    let spheres = placed(&spheres, scale, place);
                    let shot = Shot::new(&spheres, place, 2.2 * scale, 24);
                    let image = shot.render(&paths(4, sampling));
                    let lit = image.color().iter().filter(|c| **c != [0.0; 3]).count();
                    assert_eq!(lit, 0, "{shell:?}, {scale:e} at {place:?}, {sampling:?}");
                }
            }
        }
    }
}

/// A studio's lamp in a shell lights nothing outside.
#[test]
fn a_lamp_in_a_shell_lights_nothing() {
    for scale in SCALES {
        for place in PLACES {
            let spheres = [white([0.0; 3], 1.0), white([0.0, -1e4 - 1.0, 0.0], 1e4)];
            let shot = Shot::new(&placed(&spheres, scale, place), place, 2.2 * scale, 24);
            let radius = 0.25 * scale;
            let lamp = LightKind::Sphere { center: place.into(), radius, radiance: gray(1e6) };
            let image = shot.render(&studio(4, &[lamp]));
            let lit = image.color().iter().filter(|c| **c != [0.0; 3]).count();
            assert_eq!(lit, 0, "{scale:e} at {place:?}");
        }
    }
}

/// Inside a shell that is lit by a lamp, the wall is equally bright at every scale. Paths give the value of integrating
/// spheres, which is the lamp's share divided by the loss.
#[test]
fn inside_a_shell() {
    let albedo = 0.5;
    for scale in SCALES {
        let shell = Sphere::new([0.0; 3], scale, gray(albedo));
        let lamp = white([0.0; 3], 0.1 * scale).with_material(emissive(100.0));
        let shot = Shot::from(0.5 * scale, &[shell, lamp], [0.4 * scale, 0.0, 0.0], 0.2 * scale, 16);
        for sampling in [LightSampling::Direct, LightSampling::Multiple] {
            let image = shot.render(&paths(64, sampling));
            let (mut sum, mut count) = (0.0, 0.0);
            for (color, id) in image.color().iter().zip(image.id().unwrap()) {
                if *id == 0 {
                    sum += f64::from(color[0]);
                    count += 1.0;
                }
            }
            // The wall sends back ρ E/π, with E = π L (r/R)² + ρ E (1 − (r/R)²), because the lamp is black.
            let (rho, share) = (f64::from(albedo), 0.01);
            let wanted = rho * 100.0 * share / (1.0 - rho * (1.0 - share));
            let found = sum / count;
            assert!((found - wanted).abs() < 0.02 * wanted, "{scale:e}: {found}, not {wanted}");
        }
    }
}

/// Points of a plane that carries spheres, and of the spheres, do not occlude themselves.
#[test]
fn open_surfaces_hide_nothing_of_themselves() {
    let occlusion = Some(Occlusion { radius: None, samples: 16 });
    for scale in SCALES {
        for place in PLACES {
            let studio = Studio { ambient: LinearRgb::WHITE, occlusion, ..Studio::default() };
            let lighting = by(Integrator::Studio(studio), &paths(4, LightSampling::Multiple));
            let one = placed(&[white([0.0; 3], 1.0)], scale, place);
            let image = Shot::new(&one, place, 0.6 * scale, 24).render(&lighting);
            assert!(image.color().iter().all(|c| *c == [1.0; 3]), "{scale:e} at {place:?}");
            let normal = DVec3::new(0.1, 0.2, 1.0);
            let ground = Some(ground(place.into(), normal, LinearRgb::WHITE));
            let far_above = placed(&[white([0.0, 0.0, -5.0], 1.0)], scale, place);
            let shot = Shot::new(&far_above, place, 0.6 * scale, 24);
            let image = shot.render(&RenderSettings { ground, ..lighting });
            assert!(image.color().iter().all(|c| *c == [1.0; 3]), "{scale:e} at {place:?}");
        }
    }
}
