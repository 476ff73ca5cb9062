//! Lit pictures of scenes that are read in parts are those of the whole scene, to the bit.

use std::collections::HashMap;

use libtest_mimic::Trial;
use pinhole::accel::AccelChoice;
use pinhole::glam::Vec3;
use pinhole::gpu::{
    Decision, GpuError, Headless, PartsOptions, Progress, UploadProgress, UploadWatch, Watch,
};
use pinhole::render::{Nearest, Occlusion, Outline, Sampling, Studio};
use pinhole::scene::{PartExtent, ScenePart, SceneParts, Whole};
use pinhole::{
    Appearance, Colors, Film, Image, Integrator, LayerSet, LinearRgb, Material, RenderSettings,
    Scene, SphereArray, SurfaceProperties, View,
};

use crate::support::random_light::{self, RandomView};
use crate::support::spheres;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("light_parts::random_studios", |device| random(device, random_light::studio, 0..24)),
        trial("light_parts::random_paths", |device| random(device, random_light::view, 100..116)),
        trial("light_parts::tiles_and_rounds", tiles),
        trial("light_parts::parts_of_several_bricks", several_bricks),
        trial("light_parts::parts_are_read_once_for_each_step", reads),
        trial("light_parts::what_is_refused", refused),
        trial("light_parts::a_part_that_cannot_be_read", unread),
        trial("light_parts::a_picture_can_be_stopped", stopped),
    ]
}

/// A scene that is divided by hand.
struct Divided {
    scene: Scene,
    whole: Whole,
    /// The spheres of each part.
    ids: Vec<Vec<u32>>,
    /// How often a part was read.
    reads: usize,
    /// The part that cannot be read, if any.
    broken: Option<usize>,
    /// By how much the boxes of parts are said to be smaller than they are.
    shrunk: f32,
}

impl Divided {
    /// Divides a scene into parts at random. Equal spheres are in the same part.
    fn new(scene: &Scene, parts: usize, seed: u64) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut part_of: HashMap<[u32; 4], usize> = HashMap::new();
        let mut ids = vec![Vec::new(); parts];
        for (id, sphere) in (0..).zip(scene.spheres()) {
            let bits = sphere.map(|x| (x + 0.0).to_bits());
            ids[*part_of.entry(bits).or_insert_with(|| rng.usize(..parts))].push(id);
        }
        ids.retain(|ids| !ids.is_empty());
        let mut whole = Whole::new(scene.bounds().unwrap());
        scene.spheres().iter().for_each(|sphere| whole.add(*sphere));
        Self { scene: scene.clone(), whole, ids, reads: 0, broken: None, shrunk: 0.0 }
    }

    fn part(&self, part: usize) -> Scene {
        let of = |id: &u32| self.scene.spheres()[*id as usize];
        let spheres = self.ids[part].iter().map(of).collect();
        let appearance = self.scene.appearance();
        let pick = |id: &u32| *id as usize;
        let ids = self.ids[part].iter().map(pick);
        let colors = match appearance.colors() {
            Colors::Rgba8(colors) => Colors::Rgba8(ids.map(|id| colors[id]).collect()),
            Colors::Palette { palette, indices } => Colors::Palette {
                palette: palette.clone(),
                indices: ids.map(|id| indices[id]).collect(),
            },
            colors => colors.clone(),
        };
        let appearance = Appearance::new(colors).with_surface(appearance.surfaces()[0]);
        Scene::part(self.whole, spheres, appearance).unwrap()
    }
}

impl SceneParts for Divided {
    fn whole(&self) -> Whole {
        self.whole
    }

    fn extents(&self) -> Vec<PartExtent> {
        let extent = |part: usize| {
            let part = self.part(part);
            let mut extent =
                PartExtent { count: part.len() as u32, min: Vec3::MAX, max: Vec3::MIN };
            for [x, y, z, radius] in part.spheres() {
                let center = Vec3::new(*x, *y, *z);
                extent.min = extent.min.min(center - *radius);
                extent.max = extent.max.max(center + *radius);
            }
            extent.max -= self.shrunk;
            extent
        };
        (0..self.ids.len()).map(extent).collect()
    }

    fn read(&mut self, part: usize) -> Result<ScenePart, String> {
        self.reads += 1;
        if self.broken == Some(part) {
            return Err("a.bricks: this file is cut off".to_owned());
        }
        Ok(ScenePart { scene: self.part(part), ids: self.ids[part].clone() })
    }
}

fn upload_goes_on(_: &UploadProgress) -> Decision {
    Decision::GoOn
}

fn goes_on(_: &Progress) -> Decision {
    Decision::GoOn
}

/// The layers of one ray for each pixel, put together from all parts.
fn by_one_ray(device: &Headless, parts: &Divided, view: &View<'_>, layers: LayerSet) -> Image {
    let settings = RenderSettings::default();
    let mut all: Option<Nearest> = None;
    for (part, ids) in parts.ids.iter().enumerate() {
        let scene = parts.part(part);
        let plan = device.plan(&scene, view, &settings, layers, AccelChoice::Auto, 0);
        let watches: (&mut UploadWatch<'_>, &mut Watch<'_>) = (&mut upload_goes_on, &mut goes_on);
        let found = device.render_nearest(&scene, &plan, view, &settings, layers, watches).unwrap();
        let found = found.with_ids(ids);
        match &mut all {
            Some(all) => all.keep_nearer(&found).unwrap(),
            None => all = Some(found),
        }
    }
    all.unwrap().into_image()
}

fn lit(
    device: &Headless,
    parts: &mut Divided,
    view: &View<'_>,
    settings: &RenderSettings,
    options: PartsOptions,
) -> Result<Image, GpuError> {
    let wanted = LayerSet::ALL;
    let image = by_one_ray(device, parts, view, settings.layers_for(wanted));
    let watches: (&mut UploadWatch<'_>, &mut Watch<'_>) = (&mut upload_goes_on, &mut goes_on);
    let picture = device.light_parts(parts, view, settings, image, wanted, options, watches)?;
    assert_eq!(picture.samples, settings.sampling.samples);
    Ok(picture.image)
}

fn options(choice: AccelChoice, bytes_in_flight: u64) -> PartsOptions {
    PartsOptions { choice, bytes_in_flight, bytes_kept: 0 }
}

/// The spheres of a random view, opaque and of one material, in one colour or in many.
fn opaque(view: &RandomView, seed: u64) -> Scene {
    let mut rng = fastrand::Rng::with_seed(seed);
    let spheres = view.scene.spheres().to_vec();
    let colors = match seed % 3 {
        0 => Colors::One(LinearRgb::new([0.8, 0.5, 0.2]).unwrap()),
        1 => Colors::Rgba8(spheres.iter().map(|_| [rng.u8(..), rng.u8(..), 200, 255]).collect()),
        _ => Colors::Palette {
            palette: vec![LinearRgb::WHITE, LinearRgb::new([0.1, 0.2, 0.9]).unwrap()],
            indices: spheres.iter().map(|_| rng.u32(..2)).collect(),
        },
    };
    let material = match seed % 4 {
        0 => SurfaceProperties::default().material,
        1 => Material::Lambert { specular: 0.04, roughness: 0.3 },
        2 => Material::Conductor { roughness: 0.2 },
        _ => Material::Dielectric { ior: 1.5, roughness: 0.0, attenuation_distance: None },
    };
    let surface = SurfaceProperties { material, ..SurfaceProperties::default() };
    let appearance = Appearance::new(colors).with_surface(surface);
    Scene::from_parts(SphereArray::F32(spheres), appearance).unwrap()
}

fn random(device: &Headless, view_of: fn(u64) -> RandomView, seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let random = view_of(seed);
        let scene = opaque(&random, seed);
        let view = View::new(random.camera.as_ref(), random.film);
        let mut settings = RenderSettings {
            sampling: Sampling { samples: 3, ..random.settings.sampling },
            is_denoised: seed % 5 == 0,
            ..random.settings.clone()
        };
        if let Integrator::Studio(studio) = &mut settings.integrator {
            studio.outline = (seed % 2 == 0).then(Outline::thin);
        }
        if settings.check(&scene).is_err() {
            continue;
        }
        let expected = device.render(&scene, &view, &settings, LayerSet::ALL).unwrap();
        let expected = expected.to_le_bytes();
        let choices = [AccelChoice::Auto, AccelChoice::Grid, AccelChoice::Tree, AccelChoice::List];
        for (parts, choice) in [1, 2, 7, 3].into_iter().zip(choices) {
            let mut parts = Divided::new(&scene, parts, seed);
            let found = lit(device, &mut parts, &view, &settings, options(choice, 0)).unwrap();
            let (count, name) = (parts.ids.len(), &random.name);
            assert!(
                found.to_le_bytes() == expected,
                "seed {seed}, {count} parts, {choice}: {name}"
            );
        }
    }
}

/// A crowd in the unit cube, seen from the front.
fn crowd(count: usize, radius: f32) -> Scene {
    Scene::from_f32(spheres::random(count, 3, |_| radius), LinearRgb::WHITE).unwrap()
}

/// More pixels than a tile has, and more samples than are in flight at once.
fn tiles(device: &'static Headless) {
    let scene = crowd(2_000, 0.03);
    let film = Film::new(230, 160).unwrap();
    let camera = pinhole::camera::PinholeCamera::framing_from_the_front(scene.subject(), 1.4);
    let camera = camera.unwrap();
    let view = View::new(&camera, film);
    let settings = RenderSettings::studio();
    let sampling = Sampling { samples: 70, ..settings.sampling };
    let settings = RenderSettings { sampling, ..settings };
    let expected = device.render(&scene, &view, &settings, LayerSet::ALL).unwrap();
    // One tile at a time, some, and all.
    for bytes in [0, 300 << 20, u64::MAX] {
        let mut parts = Divided::new(&scene, 5, 1);
        let options = options(AccelChoice::Auto, bytes);
        let found = lit(device, &mut parts, &view, &settings, options).unwrap();
        assert!(found.to_le_bytes() == expected.to_le_bytes(), "{bytes}");
    }
}

/// Lists of more spheres than a loop tests are several bricks, in which equal spheres are told apart by their ids.
fn several_bricks(device: &'static Headless) {
    let mut all = spheres::random(49_300, 3, |_| 0.02);
    let (first, last) = all.split_at_mut(49_200);
    last.copy_from_slice(&first[..100]);
    let scene = Scene::from_f32(all, LinearRgb::WHITE).unwrap();
    let camera = pinhole::camera::PinholeCamera::framing_from_the_front(scene.subject(), 1.5);
    let camera = camera.unwrap();
    let view = View::new(&camera, Film::new(12, 8).unwrap());
    let settings = RenderSettings::path();
    let sampling = Sampling { samples: 1, ..settings.sampling };
    let settings = RenderSettings { sampling, ..settings };
    let expected = device.render(&scene, &view, &settings, LayerSet::ALL).unwrap();
    let mut parts = Divided::new(&scene, 1, 1);
    let found = lit(device, &mut parts, &view, &settings, options(AccelChoice::List, 0)).unwrap();
    assert!(found.to_le_bytes() == expected.to_le_bytes());
}

/// With room for all samples, a studio reads the largest part to plan, and then each part to find what rays hit, to shade
/// that, for shadows, and for each 32 directions of ambient light; what is there is not read again.
fn reads(device: &'static Headless) {
    let scene = crowd(500, 0.05);
    let camera = pinhole::camera::PinholeCamera::framing_from_the_front(scene.subject(), 1.5);
    let camera = camera.unwrap();
    let view = View::new(&camera, Film::new(60, 40).unwrap());
    let ambient = Occlusion { radius: None, samples: 40 };
    for (occlusion, visits) in [(None, 3), (Some(ambient), 5)] {
        let studio = Studio { occlusion, ..Studio::default() };
        let settings =
            RenderSettings { integrator: Integrator::Studio(studio), ..RenderSettings::studio() };
        for count in [1, 4] {
            let mut parts = Divided::new(&scene, count, 2);
            let options = options(AccelChoice::Auto, u64::MAX);
            let found = lit(device, &mut parts, &view, &settings, options).unwrap();
            assert_eq!(parts.reads, 1 + count + (visits - 1) * (count - 1), "{count} parts");
            // With room for some parts, and for all.
            let [least, most] = [1 + count, parts.reads];
            for bytes_kept in [15_000, u64::MAX] {
                parts.reads = 0;
                let options = PartsOptions { bytes_kept, ..options };
                let again = lit(device, &mut parts, &view, &settings, options).unwrap();
                assert!(again.to_le_bytes() == found.to_le_bytes());
                if count == 4 && bytes_kept < u64::MAX {
                    assert!(least < parts.reads && parts.reads < most);
                } else {
                    assert_eq!(parts.reads, least);
                }
            }
        }
    }
}

fn refused(device: &'static Headless) {
    let scene = crowd(50, 0.1);
    let camera = pinhole::camera::PinholeCamera::framing_from_the_front(scene.subject(), 1.5);
    let camera = camera.unwrap();
    let view = View::new(&camera, Film::new(30, 20).unwrap());
    let error = |scene: &Scene, settings: &RenderSettings, layers: LayerSet| {
        let image = Image::new(30, 20, layers).unwrap();
        let watches: (&mut UploadWatch<'_>, &mut Watch<'_>) = (&mut upload_goes_on, &mut goes_on);
        let parts = &mut Divided::new(scene, 2, 1);
        let options = options(AccelChoice::Auto, 0);
        let wanted = LayerSet::COLOR;
        let done = device.light_parts(parts, &view, settings, image, wanted, options, watches);
        done.unwrap_err()
    };
    let studio = RenderSettings::studio();
    let layers = studio.layers_for(LayerSet::COLOR);
    assert_eq!(error(&scene, &RenderSettings::default(), layers), GpuError::NotLit);
    assert_eq!(error(&scene, &studio, LayerSet::ALL), GpuError::PartLayers);
    let glass = SurfaceProperties { opacity: 0.5, ..SurfaceProperties::default() };
    let material = Material::Emissive { strength: 2.0 };
    let lamp = SurfaceProperties { material, ..SurfaceProperties::default() };
    for surface in [glass, lamp] {
        let scene = scene.clone().with_surface(surface);
        assert_eq!(error(&scene, &studio, layers), GpuError::PartMaterials);
    }
    // One transparent sphere is in some part.
    let mut colors = vec![[9, 9, 9, 255]; scene.len()];
    colors[31][3] = 254;
    let colors = Appearance::new(Colors::Rgba8(colors));
    let some = Scene::from_parts(SphereArray::F32(scene.spheres().to_vec()), colors).unwrap();
    assert_eq!(error(&some, &studio, layers), GpuError::PartMaterials);
}

fn unread(device: &'static Headless) {
    let scene = crowd(300, 0.05);
    let camera = pinhole::camera::PinholeCamera::framing_from_the_front(scene.subject(), 1.5);
    let camera = camera.unwrap();
    let view = View::new(&camera, Film::new(30, 20).unwrap());
    let settings = RenderSettings::studio();
    for broken in 0..3 {
        let mut parts = Divided { broken: Some(broken), ..Divided::new(&scene, 3, 2) };
        let found = lit(device, &mut parts, &view, &settings, options(AccelChoice::Auto, 0));
        let message = "a.bricks: this file is cut off".to_owned();
        assert_eq!(found.unwrap_err(), GpuError::Part { part: broken, message });
    }
    // A part with spheres beside its box.
    let mut parts = Divided { shrunk: 1e-3, ..Divided::new(&scene, 3, 2) };
    let found = lit(device, &mut parts, &view, &settings, options(AccelChoice::Auto, 0));
    assert!(matches!(found.unwrap_err(), GpuError::Part { .. }));
    // A part of another scene.
    let mut parts = Divided::new(&scene, 3, 2);
    parts.ids[1].reverse();
    let found = lit(device, &mut parts, &view, &settings, options(AccelChoice::Auto, 0));
    assert!(matches!(found.unwrap_err(), GpuError::Part { part: 1, .. }));
}

fn stopped(device: &'static Headless) {
    let scene = crowd(300, 0.05);
    let camera = pinhole::camera::PinholeCamera::framing_from_the_front(scene.subject(), 1.5);
    let camera = camera.unwrap();
    let view = View::new(&camera, Film::new(30, 20).unwrap());
    let settings = RenderSettings::studio();
    let wanted = settings.layers_for(LayerSet::COLOR);
    let mut stopped = 0;
    for after in 0.. {
        let mut left = after;
        let mut stop = |_: &Progress| {
            left -= 1;
            if left < 0 { Decision::Stop } else { Decision::GoOn }
        };
        let image = Image::new(30, 20, wanted).unwrap();
        let parts = &mut Divided::new(&scene, 3, 2);
        let options = options(AccelChoice::Auto, 0);
        let watches: (&mut UploadWatch<'_>, &mut Watch<'_>) = (&mut upload_goes_on, &mut stop);
        let done =
            device.light_parts(parts, &view, &settings, image, LayerSet::COLOR, options, watches);
        match done {
            Ok(_) => break,
            Err(error) => assert_eq!(error, GpuError::Stopped),
        }
        stopped += 1;
    }
    assert!(stopped > 8, "{stopped}");
    let mut parts = Divided::new(&scene, 3, 2);
    lit(device, &mut parts, &view, &settings, options(AccelChoice::Auto, 0)).unwrap();
}
