//! Pictures merged from parts of a film, of a scene, or of samples equal those rendered at once.

use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::cpu::{self, RenderError, SampledPicture, SearchStructure};
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::DVec3;
use pinhole::image::Layer;
use pinhole::render::{Decision, NearestPicture, Outline, Progress, Sampling};
use pinhole::scene::SceneExtent;
use pinhole::{Film, Image, Integrator, LayerSet, LinearRgb, RenderSettings, Scene, Shading, Sphere, View};

use crate::support::random_light::{self, RandomView};

/// Rectangles that cover a film of 24 by 18 pixels.
const PARTS: [([u32; 2], [u32; 2]); 5] =
    [([0, 0], [11, 7]), ([11, 0], [13, 3]), ([11, 3], [13, 4]), ([0, 7], [23, 11]), ([23, 7], [1, 11])];

/// The settings of a view without noise removal. A studio has outlines.
fn finished(view: &RandomView) -> RenderSettings {
    let mut settings = RenderSettings {
        sampling: Sampling { samples: 3, denoise: true, ..view.settings.sampling },
        ..view.settings.clone()
    };
    if let pinhole::render::Integrator::Studio(studio) = &mut settings.integrator {
        studio.outline = Some(Outline::thin());
    }
    settings
}

/// Returns whether steps that read neighbours changed the picture.
fn check(view: &RandomView, settings: &RenderSettings) -> bool {
    let search = SearchStructure::new(&view.scene).unwrap();
    let on = |film: Film, settings: &RenderSettings, layers: LayerSet| {
        cpu::render(&search, &View::new(view.camera.as_ref(), film), settings, layers).unwrap()
    };
    let wanted = LayerSet::ALL;
    let whole = on(view.film, settings, wanted);
    let (unfinished, layers) = (settings.unfinished(), settings.layers_for(wanted));
    let mut joined = Image::new(24, 18, layers).unwrap();
    for (origin, size) in PARTS {
        let part = on(view.film.part(origin, size).unwrap(), &unfinished, layers);
        joined.put(&part, origin).unwrap();
    }
    let joined = cpu::finish(joined, settings, wanted);
    assert!(joined.to_le_bytes() == whole.to_le_bytes(), "{}", view.name);
    on(view.film, &unfinished, wanted).color() != whole.color()
}

#[test]
fn random_pictures_are_put_together_from_parts() {
    let mut changed = 0;
    for seed in 0..12 {
        for view in [random_light::view(seed), random_light::studio(seed)] {
            changed += usize::from(check(&view, &finished(&view)));
            check(&view, &view.settings.by_primary_rays());
        }
    }
    // Some of the pictures are dark.
    assert!(changed > 18, "{changed}");
}

#[test]
fn a_part_of_a_part_is_a_part() {
    let film = Film::new(24, 18).unwrap();
    let part = film.part([3, 4], [20, 10]).unwrap().part([2, 1], [5, 6]).unwrap();
    assert_eq!(part, film.part([5, 5], [5, 6]).unwrap());
    assert_eq!((part.width(), part.height(), part.origin()), (5, 6, [5, 5]));
    assert_eq!((part.whole(), part.aspect()), (film, film.aspect()));
    assert!(film.is_whole() && !part.is_whole());
    assert_eq!(film.part([0, 0], [24, 18]).unwrap(), film);
    for (origin, size) in [
        ([0, 0], [25, 18]),
        ([1, 0], [24, 18]),
        ([0, 18], [1, 1]),
        ([u32::MAX, 0], [1, 1]),
        ([0, 0], [0, 1]),
        ([0, 0], [1, u32::MAX]),
    ] {
        assert!(film.part(origin, size).is_err(), "{origin:?} {size:?}");
    }
}

const COLOR: LinearRgb = LinearRgb::WHITE;

/// Spheres, every fourth of which appears twice.
fn spheres() -> Vec<[f32; 4]> {
    let mut rng = fastrand::Rng::with_seed(4);
    let mut all: Vec<[f32; 4]> = Vec::new();
    for index in 0..240 {
        let new = [rng.f32(), rng.f32(), rng.f32(), 0.03 + 0.05 * rng.f32()];
        all.push(if index % 4 == 3 { all[rng.usize(..index)] } else { new });
    }
    all
}

fn whole_of(scene: &Scene) -> SceneExtent {
    let mut whole = SceneExtent::new(scene.bounds().unwrap());
    scene.spheres().iter().for_each(|sphere| whole.add(*sphere));
    whole
}

fn settings() -> RenderSettings {
    RenderSettings { integrator: Integrator::Primary(Shading::Headlight), ..RenderSettings::default() }
}

/// The pictures of parts. The spheres of each part are given by their ids.
fn parts(scene: &Scene, ids: &[Vec<u32>], view: &View<'_>) -> Vec<NearestPicture> {
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
                // Sends the part as bytes, as between machines.
                let size = [film.width(), film.height()];
                let bytes = part.to_le_bytes();
                let part = NearestPicture::from_le_bytes(size, LayerSet::ALL, &bytes).unwrap();
                assert!(NearestPicture::from_le_bytes(size, LayerSet::ALL, &bytes[1..]).is_none());
                let at = rng.usize(..left.len());
                left[at].keep_nearer(&part).unwrap();
            }
            assert_eq!(*left[0].image(), expected, "{count} parts");
        }
    }
}

/// A part hides boxes behind its spheres, and only those.
#[test]
fn a_part_hides_only_what_changes_nothing() {
    let scene = Scene::from_f32(spheres(), COLOR).unwrap();
    let film = Film::new(31, 31).unwrap();
    let pose = Pose::looking_at([0.5, 0.5, 9.0], [0.5; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 0.1, 1.0).unwrap();
    let view = View::new(&camera, film);
    let (near, far): (Vec<u32>, Vec<u32>) =
        (0..scene.len() as u32).partition(|id| scene.spheres()[*id as usize][2] > 0.5);
    let [mut near, far] = <[NearestPicture; 2]>::try_from(parts(&scene, &[near, far], &view)).unwrap();
    let bounds = |[x, y, z]: [f64; 3], radius| Bounds::of_sphere([x, y, z].into(), radius);
    let all = scene.bounds().unwrap();
    let is_hidden = |nearest: &NearestPicture, bounds| nearest.hides(&view, &all, &bounds);
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

/// The size of a picture with several strips and tiles, some of them incomplete.
const FILM: [u32; 2] = [37, 29];

/// The size of a picture for which a batch of samples takes a while.
const TALL: [u32; 2] = [37, 1601];

/// Calls `test` with a lit picture of the path integrator and one of the studio integrator.
fn with_lit([width, height]: [u32; 2], samples: u32, test: impl Fn(&SearchStructure<'_>, &View<'_>, &RenderSettings)) {
    let view = random_light::view(3);
    for mut settings in [view.settings.clone(), RenderSettings::studio()] {
        settings.sampling.samples = samples;
        let tree = SearchStructure::new(&view.scene).unwrap();
        let film = Film::new(width, height).unwrap();
        test(&tree, &View::new(view.camera.as_ref(), film), &settings);
    }
}

/// The picture with `samples` samples, rendered without a watch.
fn whole(tree: &SearchStructure<'_>, view: &View<'_>, settings: &RenderSettings, count: u32) -> Image {
    let mut settings = settings.clone();
    settings.sampling.samples = count;
    cpu::render(tree, view, &settings, LayerSet::ALL).unwrap()
}

/// The colours of all pixels, pixel by pixel. They are the means of samples taken without batches.
fn means(tree: &SearchStructure<'_>, view: &View<'_>, settings: &RenderSettings, count: u32) -> Vec<[f32; 3]> {
    let picture = SampledPicture::new(tree, view, settings).unwrap();
    let [width, height] = [view.film.width(), view.film.height()];
    (0..width * height)
        .map(|index| {
            let pixel = [index % width, index / width];
            let sum: DVec3 = (0..count).map(|sample| picture.sample(pixel, sample).color).sum();
            (sum / f64::from(count)).as_vec3().to_array()
        })
        .collect()
}

#[test]
fn batches_give_the_picture_of_all_samples_at_once() {
    for samples in [1, 2, 7, 40] {
        with_lit(FILM, samples, |tree, view, settings| {
            for denoise in [false, true] {
                let settings = settings.with_denoise(denoise);
                let watch = &mut |_: &Progress| Decision::MeasureNoise;
                let found = cpu::render_watched(tree, view, &settings, LayerSet::ALL, watch);
                let found = found.unwrap();
                assert!(found.image == whole(tree, view, &settings, samples), "{samples}");
                assert_eq!(found.samples, samples);
                if !denoise {
                    let wanted = means(tree, view, &settings, samples);
                    assert!(found.image.color() == wanted, "{samples}");
                }
            }
        });
    }
}

/// Progress rises to the end, and the caller is told of each batch.
#[test]
fn the_caller_is_told_of_every_batch() {
    with_lit(FILM, 9, |tree, view, settings| {
        for settings in [settings, &RenderSettings::default()] {
            let mut told = Vec::new();
            let watch = &mut |progress: &Progress| {
                told.push(*progress);
                Decision::GoOn
            };
            let done = cpu::render_watched(tree, view, settings, LayerSet::COLOR, watch).unwrap();
            assert!(told.is_sorted_by(|a, b| a.part <= b.part && a.samples <= b.samples));
            let last = told.last().unwrap();
            let total = if settings.integrator.is_primary() { 1 } else { 9 };
            assert_eq!((last.samples, last.total, done.samples), (total, total, total));
            assert!(last.part >= 1.0 && last.noise.is_none());
            for samples in [1, 2, 4, 8, 9].into_iter().filter(|samples| *samples <= total) {
                assert!(told.iter().any(|progress| progress.samples == samples), "{samples}");
            }
        }
    });
}

#[test]
fn a_level_of_noise_ends_a_picture() {
    with_lit(FILM, 1000, |tree, view, settings| {
        let mut noises = Vec::new();
        let watch = &mut |progress: &Progress| {
            noises.extend(progress.noise.map(|noise| (progress.samples, noise)));
            if progress.samples >= 16 { Decision::Finish } else { Decision::MeasureNoise }
        };
        let found = cpu::render_watched(tree, view, settings, LayerSet::ALL, watch).unwrap();
        assert_eq!(found.samples, 16);
        assert!(found.image == whole(tree, view, settings, 16));
        assert_eq!(noises.last(), found.noise.map(|noise| (16, noise)).as_ref());
        // The noise follows from the layers, up to their rounding to f32.
        let variance = found.image.variance().unwrap().iter().map(|v| f64::from(*v)).sum::<f64>();
        let colors = found.image.color().iter().map(|color| color.map(f64::from));
        let light: f64 = colors.map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b).sum();
        let count = f64::from(FILM[0] * FILM[1]);
        if light > 0.0 {
            let wanted = (variance / count).sqrt() / (light / count);
            let noise = found.noise.unwrap();
            assert!((noise / wanted - 1.0).abs() < 1e-3, "{noise} and {wanted}");
        }
    });
}

/// A picture that is finished within a batch keeps the samples taken in the batch.
#[test]
fn every_pixel_has_the_samples_that_the_layer_says() {
    with_lit(TALL, 4000, |tree, view, settings| {
        let is_within = |progress: &Progress| {
            let samples = f64::from(progress.samples);
            progress.samples > 0 && progress.part * f64::from(progress.total) > samples + 0.5
        };
        let watch = &mut |progress: &Progress| {
            if is_within(progress) { Decision::Finish } else { Decision::GoOn }
        };
        let layers = LayerSet::COLOR.with(Layer::Samples).with(Layer::Variance);
        let settings = settings.with_denoise(false);
        let found = cpu::render_watched(tree, view, &settings, layers, watch).unwrap();
        let counts = found.image.samples().unwrap();
        assert_eq!(counts.iter().min(), Some(&found.samples));
        let most = *counts.iter().max().unwrap();
        assert!(most > found.samples, "{most}");
        let whole = [found.samples, most].map(|count| whole(tree, view, &settings, count));
        for (index, count) in counts.iter().enumerate() {
            let whole = if *count == most { &whole[1] } else { &whole[0] };
            assert_eq!(found.image.color()[index], whole.color()[index], "{index}: {count}");
        }
    });
}

#[test]
fn the_caller_may_stop() {
    with_lit(FILM, 9, |tree, view, settings| {
        for settings in [settings, &RenderSettings::default()] {
            let stop = &mut |_: &Progress| Decision::Stop;
            let done = cpu::render_watched(tree, view, settings, LayerSet::ALL, stop);
            assert_eq!(done.err(), Some(RenderError::Stopped));
        }
        // Without a sample there is no picture, even if it is to be finished.
        let mut calls = 0;
        let finish = &mut |progress: &Progress| {
            calls += 1;
            if progress.samples == 0 { Decision::Finish } else { Decision::GoOn }
        };
        let done = cpu::render_watched(tree, view, settings, LayerSet::COLOR, finish);
        assert_eq!(done.err(), Some(RenderError::Stopped));
        assert_eq!(calls, 1);
    });
}

/// The sums need more memory than the picture, and a refusal is not a panic.
#[test]
fn a_picture_without_memory_is_refused() {
    let scene = Scene::new(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE)]).unwrap();
    let view = random_light::view(3);
    let film = Film::new(Film::MAX_SIDE, Film::MAX_SIDE).unwrap();
    let view = View::new(view.camera.as_ref(), film);
    let settings = RenderSettings::studio();
    let go_on = &mut |_: &Progress| Decision::GoOn;
    let done = cpu::render_watched(&scene, &view, &settings, LayerSet::COLOR, go_on);
    assert!(matches!(done, Err(RenderError::Image(_))));
}
