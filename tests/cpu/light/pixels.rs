//! Samples and pixels: means, variances, filters, lenses, and pixels without a hit. All sampling methods find the same
//! amount of light.

use std::sync::Arc;

use pinhole::camera::filter::PixelFilter;
use pinhole::camera::{FisheyeCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::glam::DVec3;
use pinhole::image::NO_ID;
use pinhole::light::{Ground, LightKind, Sky, SkyLight};
use pinhole::render::{Integrator, LightSampling, PathTracing, Studio};
use pinhole::{Environment, Film, Image, LayerSet, Material, RenderSettings, Scene, Sphere, View, cpu};

use super::{Shot, blocks, by, emissive, furnace, gray, ground, light, paths, rgb, standard_errors, sun, white};
use crate::support::effort::{effort, tries};

/// Layers are the means of samples, or the data of one ray, to the last bit of f32.
#[test]
fn layers_are_means_of_samples() {
    let lamp = Sphere::new([0.5, 0.0, 0.0], 0.5, rgb([4.0, 0.5, 0.25])).with_material(emissive(2.0));
    let matt = Sphere::new([-0.5, 0.0, 0.0], 0.5, rgb([0.5, 0.25, 1.0])).with_opacity(0.5);
    let shot = Shot::new(&[matt, lamp], [0.0; 3], 1.1, 12);
    let mut lighting = furnace(7);
    lighting.sampling.filter = PixelFilter::BlackmanHarris;
    for integrator in [lighting.integrator.clone(), Integrator::Studio(Studio::default())] {
        let lighting = by(integrator, &lighting);
        let image = shot.render(&lighting);
        let picture = shot.picture(&lighting);
        for index in 0..144 {
            let pixel = [index as u32 % 12, index as u32 / 12];
            let samples: Vec<_> = (0..7).map(|s| picture.sample(pixel, s)).collect();
            let mean = |of: &dyn Fn(&cpu::Sample) -> f64| samples.iter().map(of).sum::<f64>() / 7.0;
            let luminance = |s: &cpu::Sample| 0.2126 * s.color[0] + 0.7152 * s.color[1] + 0.0722 * s.color[2];
            for c in 0..3 {
                assert_eq!(image.color()[index][c], mean(&|s| s.color[c]) as f32);
                assert_eq!(image.albedo().unwrap()[index][c], mean(&|s| s.albedo[c]) as f32);
            }
            assert_eq!(image.alpha().unwrap()[index], mean(&|s| s.alpha) as f32);
            assert_eq!(image.samples().unwrap()[index], 7);
            // The unbiased variance of one sample, divided by 7.
            let average = mean(&luminance);
            let wanted = mean(&|s| (luminance(s) - average).powi(2)) / 6.0;
            let found = f64::from(image.variance().unwrap()[index]);
            assert!((found - wanted).abs() < 1e-6 * (wanted + 1e-6), "{found}, not {wanted}");
        }
        let data = cpu::render(
            &shot.scene,
            &View::new(shot.camera.as_ref(), shot.film),
            &RenderSettings::default(),
            LayerSet::ALL,
        )
        .unwrap();
        assert_eq!(image.depth(), data.depth());
        assert_eq!(image.normal(), data.normal());
        assert_eq!(image.position(), data.position());
        assert_eq!(image.id(), data.id());
        let first = picture.sample([9, 6], 0);
        assert_eq!(first.albedo.to_array(), [1.0, 0.5, 0.25], "no albedo exceeds 1");
    }
    lighting.sampling.samples = 1;
    assert_eq!(shot.render(&lighting).variance().unwrap(), [0.0; 144]);
}

/// The fraction of a pixel beside an edge that a sphere as large as a plane covers.
#[test]
fn filters_blur_edges_as_wide_as_they_are() {
    let radius = 1e4;
    let spheres = [white([-radius, 0.0, 0.0], radius)];
    let shot = Shot::from(1e3, &spheres, [0.0; 3], 8.0, 16);
    for filter in [PixelFilter::Box, PixelFilter::BlackmanHarris] {
        let mut lighting = furnace(256);
        lighting.sampling.filter = filter;
        let image = shot.render(&lighting);
        let row = &image.alpha().unwrap()[8 * 16..9 * 16];
        // The camera is in the plane that touches the sphere in the middle of the picture.
        let edge = 8.0;
        for (column, alpha) in row.iter().enumerate() {
            let distance = edge - (column as f64 + 0.5);
            if distance.abs() > filter.radius() {
                assert_eq!(*alpha, if distance > 0.0 { 1.0 } else { 0.0 }, "{filter:?}, {column}");
            }
        }
        let sum: f64 = row.iter().map(|a| f64::from(*a)).sum();
        assert!((sum - edge).abs() < 0.02, "{filter:?}: {sum}, not {edge}");
    }
}

/// A small sphere behind the plane of focus becomes a disk with the diameter 2·aperture·|s − f|/s in that plane. A
/// sphere in the plane stays sharp.
#[test]
fn a_lens_blurs_what_is_out_of_focus() {
    let (aperture, focus, far) = (0.5, 4.0, 8.0);
    let pose = Pose::looking_along([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
    // A pixel is 1/32 wide in the plane of focus.
    let pinhole = PinholeCamera::new(pose, focus, [0.5, 0.5]).unwrap();
    let lens = ThinLensCamera::new(pinhole, aperture, focus).unwrap();
    let render = |sphere: Sphere, through_lens: bool| {
        let shot = Shot {
            scene: Scene::new(&[sphere]).unwrap(),
            camera: if through_lens { Box::new(lens) } else { Box::new(pinhole) },
            film: Film::new(32, 32).unwrap(),
        };
        let image = shot.render(&furnace(256));
        let (mut cover, mut moment, mut reach) = (0.0, 0.0, 0.0_f64);
        for (index, alpha) in image.alpha().unwrap().iter().enumerate() {
            let [x, y] = [index % 32, index / 32].map(|i| (i as f64 + 0.5) / 32.0 - 0.5);
            let square = x * x + y * y;
            cover += f64::from(*alpha);
            moment += f64::from(*alpha) * square;
            if *alpha > 0.0 {
                reach = reach.max(square.sqrt());
            }
        }
        (cover / 1024.0, moment / cover, reach)
    };
    let radius = 0.05;
    let (cover, moment, reach) = render(white([0.0, 0.0, -far], radius), true);
    let disk = aperture * (far - focus) / far;
    // The sphere's own image in the plane of focus.
    let image = radius * focus / far;
    assert!((cover - std::f64::consts::PI * image * image).abs() < 0.03 * cover, "{cover}");
    // The mean squares of two uniform disks and of a pixel's square add up.
    let wanted = 0.5 * disk * disk + 0.5 * image * image + 1.0 / (6.0 * 32.0 * 32.0);
    assert!((moment - wanted).abs() < 0.03 * wanted, "{moment}, not {wanted}");
    assert!((reach - disk - image).abs() < 0.04, "{reach}");
    let near = white([0.0, 0.0, -focus], 0.2);
    let (sharp, through_lens) = (render(near, false), render(near, true));
    assert!((sharp.0 - through_lens.0).abs() < 0.02 * sharp.0, "{sharp:?}, {through_lens:?}");
    assert!(through_lens.2 < 0.24, "{through_lens:?}");
}

/// Albedo is the colour of the surface that stops a path, or of a studio's first surface. A shadow catcher has none.
#[test]
fn albedo_is_that_of_the_first_surface() {
    let veil = Sphere::new([0.0; 3], 1.0, rgb([0.0, 0.5, 0.0])).with_opacity(0.0);
    let core = Sphere::new([0.0; 3], 0.5, rgb([0.5, 0.0, 0.0]));
    let shot = Shot::from(4.0, &[veil, core], [0.0; 3], 0.1, 2);
    let studio = Integrator::Studio(Studio::default());
    let path = furnace(2);
    for (integrator, wanted) in [(path.integrator.clone(), [0.5, 0.0, 0.0]), (studio, [0.0, 0.5, 0.0])] {
        let lighting = by(integrator, &path);
        assert_eq!(shot.render(&lighting).albedo().unwrap(), [wanted; 4]);
    }
    for is_shadow_catcher in [false, true] {
        let ground = ground(DVec3::ZERO, DVec3::Z, gray(0.25));
        let ground = Some(Ground { is_shadow_catcher, ..ground });
        let integrator = Integrator::Studio(Studio::default());
        let lighting = RenderSettings { ground, ..by(integrator, &path) };
        let image = Shot::from(4.0, &[], [0.0; 3], 0.1, 2).render(&lighting);
        let wanted = if is_shadow_catcher { [0.0; 3] } else { [0.25; 3] };
        assert_eq!(image.albedo().unwrap(), [wanted; 4]);
    }
}

/// Pixels without a hit show the sky if it is visible, or the background, or nothing. Where the camera has no ray, they
/// never show the sky.
#[test]
fn where_there_is_nothing() {
    let background = rgb([0.1, 0.2, 0.3]);
    let sky = |is_visible| Sky { light: SkyLight::Constant(gray(0.5)), is_visible };
    let base = RenderSettings { background, ..paths(2, LightSampling::Multiple) };
    let pose = Pose::looking_along([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
    let fisheye = FisheyeCamera::new(pose, std::f64::consts::PI, 1.0).unwrap();
    let mirror = white([0.0, 0.0, -3.0], 1.0).with_material(Material::Conductor { roughness: 0.02 });
    let shot =
        Shot { scene: Scene::new(&[mirror]).unwrap(), camera: Box::new(fisheye), film: Film::new(16, 16).unwrap() };
    let studio = Integrator::Studio(Studio { ambient: gray(0.5), ..Studio::default() });
    for (integrator, is_visible, miss) in [
        (base.integrator.clone(), true, [0.5; 3]),
        (base.integrator.clone(), false, [0.1, 0.2, 0.3]),
        (studio, true, [0.1, 0.2, 0.3]),
    ] {
        for is_transparent in [false, true] {
            let lighting = RenderSettings { sky: sky(is_visible), is_transparent, ..base.clone() };
            let lighting = by(integrator.clone(), &lighting);
            let image = shot.render(&lighting);
            let at = |i: usize, j: usize| (image.color()[j * 16 + i], image.alpha().unwrap()[j * 16 + i]);
            let hidden = |color: [f32; 3]| if is_transparent { [0.0; 3] } else { color };
            assert_eq!(at(0, 0), (hidden([0.1, 0.2, 0.3]), 0.0), "a corner of the film");
            assert_eq!(at(3, 8), (hidden(miss), 0.0), "beside the sphere");
            let (color, alpha) = at(8, 8);
            assert_eq!(alpha, 1.0);
            assert!((color[0] - 0.5).abs() < 1e-3, "lit by what is not seen: {color:?}");
        }
    }
    assert_eq!(shot.render(&base).id().unwrap()[0], NO_ID);
}

/// Surfaces with lobes, metal, glass, translucent surfaces, and emissive spheres. One of these is translucent, one is
/// partly inside another sphere, and one coincides with another.
fn spheres() -> Vec<Sphere> {
    let sphere = |x: f64, y: f64, z: f64, r: f64, color: [f32; 3]| Sphere::new([x, y, z], r, rgb(color));
    let glossy = Material::Lambert { specular: 0.4, roughness: 0.4 };
    vec![
        sphere(-1.0, 0.7, 0.0, 0.7, [0.8, 0.3, 0.3]).with_material(glossy),
        sphere(0.6, 0.6, 0.2, 0.6, [0.9, 0.8, 0.4]).with_material(Material::Conductor { roughness: 0.5 }),
        sphere(-0.1, 0.3, 1.1, 0.3, [0.4, 0.8, 0.9]).with_opacity(0.6),
        sphere(0.9, 0.25, 1.2, 0.25, [0.9, 0.9, 1.0]).with_material(Material::Dielectric {
            ior: 1.5,
            roughness: 0.3,
            attenuation_distance: Some(0.5),
        }),
        sphere(-0.2, 1.6, 0.6, 0.3, [1.0, 0.7, 0.4]).with_material(emissive(4.0)),
        sphere(1.5, 1.4, 0.2, 0.4, [0.5, 0.7, 1.0]).with_material(emissive(2.0)).with_opacity(0.5),
        sphere(-1.0, 0.3, 0.75, 0.25, [0.7, 1.0, 0.7]).with_material(emissive(1.5)),
        sphere(-1.0, 0.3, 0.75, 0.25, [1.0, 0.7, 0.7]).with_material(emissive(3.0)),
    ]
}

fn lighting(samples: u32, light_sampling: LightSampling, seed: u32) -> RenderSettings {
    let sun = sun(DVec3::new(1.0, 1.0, 0.5), gray(0.6), 0.35);
    let point = LightKind::Point { position: DVec3::new(-2.0, 2.0, 2.0), intensity: gray(1.0) };
    let mut texels = vec![[0.2, 0.3, 0.5]; 32];
    texels[10] = [4.0, 3.0, 2.0];
    texels[21] = [0.0; 3];
    let environment = Arc::new(Environment::new(8, 4, texels).unwrap());
    let base = paths(samples, light_sampling);
    let tracing = PathTracing { max_depth: 6, roulette_from: 2, light_sampling };
    RenderSettings {
        integrator: Integrator::Path(tracing),
        sampling: pinhole::render::Sampling { seed, ..base.sampling },
        lights: [sun, point].map(light).into(),
        sky: Sky { light: SkyLight::Image { environment, strength: 0.75, rotation: 0.6 }, is_visible: true },
        ground: Some(ground(DVec3::ZERO, DVec3::Y, gray(0.6))),
        ..base
    }
}

/// A view from the front and above, so that ground and spheres fill the picture.
fn shot() -> Shot {
    let pose = Pose::looking_at([0.3, 6.0, 9.0], [0.2, 0.5, 0.4], [0.0, 1.0, 0.0]).unwrap();
    Shot {
        scene: Scene::new(&spheres()).unwrap(),
        camera: Box::new(PinholeCamera::with_vertical_fov(pose, 0.3, 1.0).unwrap()),
        film: Film::new(32, 32).unwrap(),
    }
}

fn luminances(image: &Image) -> Vec<f64> {
    let luminance = |[r, g, b]: &[f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    blocks(image, 4).iter().map(luminance).collect()
}

#[test]
fn chance_and_search_find_the_same_light() {
    let shot = shot();
    // Each has its own seed, so that common errors do not cancel.
    let ways = [(LightSampling::Chance, 8192, 1), (LightSampling::Direct, 2048, 2), (LightSampling::Multiple, 2048, 3)];
    let images = ways.map(|(way, samples, seed)| {
        let image = shot.render(&lighting(tries(samples), way, seed));
        (luminances(&image), standard_errors(&image, 4))
    });
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        for block in 0..16 {
            let [(light, error), (other, other_error)] = [a, b].map(|way| (images[way].0[block], images[way].1[block]));
            let bound = 4.0 * error.hypot(other_error);
            let difference = light - other;
            let ways = (ways[a].0, ways[b].0);
            assert!(difference.abs() < bound, "{ways:?}, {block}: {light}, {other} ± {bound}");
            // A larger bound would prove nothing. Noise falls with the root of the number of samples.
            assert!(bound < 0.04 * light / effort().sqrt(), "{ways:?}, {block}: {light} ± {bound}");
        }
    }
}

/// Russian roulette changes only noise.
#[test]
fn paths_that_end_by_chance_lose_nothing() {
    let shot = shot();
    let render = |roulette_from, seed| {
        let mut lighting = lighting(tries(1024), LightSampling::Multiple, seed);
        let Integrator::Path(tracing) = &mut lighting.integrator else { panic!() };
        tracing.roulette_from = roulette_from;
        let image = shot.render(&lighting);
        (luminances(&image), standard_errors(&image, 4))
    };
    let (early, never) = (render(0, 8), render(u32::MAX, 9));
    for block in 0..16 {
        let bound = 4.0 * early.1[block].hypot(never.1[block]);
        let difference = (early.0[block] - never.0[block]).abs();
        assert!(difference < bound, "{block}: {difference}, {bound}");
    }
}
