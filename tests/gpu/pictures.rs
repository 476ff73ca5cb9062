//! Tests of pictures of a device: pictures in which every byte is known, agreement with the CPU reference, and parts of
//! a film, which have the same pixels as the whole, to the bit.

use glam::DVec3;
use libtest_mimic::Trial;
use pinhole::accel::{Accel, AccelChoice};
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::gpu::{self, Decision, GpuError, Headless, PictureRequest, Progress, SceneBuffers, Structures, Wait};
use pinhole::image::{Layer, NO_ID};
use pinhole::render::{Integrator, Outline, Sampling};
use pinhole::verify::Recording;
use pinhole::{Film, Image, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, glam};
use pinhole_figure::write::npy::encode;

use crate::support::View;
use crate::support::compare::{Picture, compare};
use crate::{headless, lit_scenes, scenes, trial};

pub(crate) fn trials() -> Vec<Trial> {
    [own(), agreements(), parts_of_films()].into_iter().flatten().collect()
}

fn own() -> Vec<Trial> {
    vec![
        trial("pictures::along_the_wall_no_hit_is_far", on_the_wall),
        trial("pictures::a_very_tall_picture", very_tall),
        trial("pictures::every_layer_can_be_had_alone", every_layer_alone),
    ]
}

fn every_layer_alone(headless: &'static Headless) {
    let view = View::three_spheres();
    let all = view.picture(headless, LayerSet::ALL);
    assert_eq!(all.layers(), LayerSet::ALL);
    for layer in LayerSet::ALL.iter() {
        let layers = LayerSet::COLOR.with(layer);
        let image = view.picture(headless, layers);
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
/// 10⁻³, even after some roundings of f32: √(8 · 2⁻²⁴) is 7 · 10⁻⁴.
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
        let image =
            headless.render(&scene, &pinhole::View::new(&camera, film), &settings, LayerSet::ALL).wait().unwrap();
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
    let image = view.picture(headless, LayerSet::COLOR.with(Layer::Id));
    assert!(image.id().unwrap() == view.reference().id().unwrap());
}

/// A callback that always continues.
pub(crate) fn go_on(_: &Progress) -> Decision {
    Decision::GoOn
}

impl View {
    pub(crate) fn picture(&self, device: &Headless, layers: LayerSet) -> Image {
        device.render(&self.scene, &self.seen(), &self.settings, layers).wait().unwrap()
    }

    /// All layers of a picture of the scene, which is traced in a structure.
    pub(crate) fn traced(&self, device: &Headless, accel: &Accel) -> Result<Image, GpuError> {
        let scene = device.upload(&self.scene, &accel.clone().into()).wait()?;
        Ok(self.watched(device, &scene, LayerSet::ALL, &mut go_on)?.image)
    }

    /// The uploaded scene with one structure, without a structure for occluders.
    pub(crate) fn uploaded(&self, device: &Headless, choice: AccelChoice) -> SceneBuffers {
        let accel = device.plan_accel(&self.scene, choice).build(self.scene.spheres());
        device.upload(&self.scene, &accel.into()).wait().unwrap()
    }

    /// The structures that a device plans, including a structure for occluders if it is needed.
    pub(crate) fn planned(&self, device: &Headless, choice: AccelChoice) -> Structures {
        let (scene, seen) = (&self.scene, self.seen());
        let request = PictureRequest::new(scene, &seen, &self.settings, LayerSet::COLOR);
        device.plan(&request, choice).build(scene)
    }

    pub(crate) fn watched(
        &self,
        device: &Headless,
        scene: &SceneBuffers,
        layers: LayerSet,
        watch: &mut dyn FnMut(&Progress) -> Decision,
    ) -> Result<gpu::Picture, GpuError> {
        device.render_uploaded(scene, &self.seen(), &self.settings, layers, watch).wait()
    }

    pub(crate) fn record(&self, device: &Headless, structures: &Structures) -> Result<Recording, GpuError> {
        let scene = device.upload(&self.scene, structures).wait()?;
        device.record(&scene, &self.seen(), &self.settings, &mut go_on).wait()
    }
}

/// Maximum fraction of pixels whose id may differ because two ids are correct.
const MAX_AMBIGUOUS: f64 = 1e-3;

fn agreements() -> Vec<Trial> {
    scenes::all()
        .into_iter()
        .map(|(name, view)| {
            Trial::test(format!("agreement::{name}"), move || {
                let image = view.picture(headless()?, LayerSet::ALL);
                let reference = Picture::from(&view.reference());
                let comparison = compare(&view, &reference, &Picture::from(&image));
                if let Some(first) = comparison.violations.first() {
                    let count = comparison.violations.len();
                    return Err(format!("{count} violations, the first is {first:?}").into());
                }
                let ambiguous = comparison.ambiguous as f64 / view.film.pixel_count() as f64;
                if ambiguous > MAX_AMBIGUOUS {
                    return Err(format!("{ambiguous} of all pixels are ambiguous").into());
                }
                Ok(())
            })
        })
        .collect()
}

fn parts_of_films() -> Vec<Trial> {
    let lit = lit_scenes::all().map(|(name, view)| {
        Trial::test(format!("film_parts::{name}"), move || {
            let mut settings = RenderSettings {
                sampling: Sampling { samples: 5, denoise: true, ..view.settings.sampling },
                ..view.settings.clone()
            };
            if let Integrator::Studio(studio) = &mut settings.integrator {
                studio.outline = Some(Outline::thin());
            }
            check_parts(headless()?, &view, &settings);
            check_parts(headless()?, &view, &settings.by_primary_rays());
            Ok(())
        })
    });
    let others = [
        trial("film_parts::a_scene_that_fills_no_part", beside),
        trial("film_parts::what_needs_the_whole_film_refuses_parts", refused),
    ];
    lit.chain(others).collect()
}

/// Compares the whole with parts whose sizes are not multiples of workgroups.
fn check_parts(device: &Headless, view: &View, settings: &RenderSettings) {
    let (scene, view) = (&view.scene, view.seen());
    let wanted = LayerSet::ALL;
    let whole = device.render(scene, &view, settings, wanted).wait().unwrap();
    let (unfinished, layers) = (settings.unfinished(), settings.layers_for(wanted));
    let [width, height] = [whole.width(), whole.height()];
    let mut joined = Image::new(width, height, layers).unwrap();
    let (left, top) = (width / 3 + 1, height / 2 + 1);
    for (x, w) in [(0, left), (left, width - left)] {
        for (y, h) in [(0, top), (top, height - top)] {
            let film = view.film.part([x, y], [w, h]).unwrap();
            let part = pinhole::View::new(view.camera, film);
            let part = device.render(scene, &part, &unfinished, layers).wait().unwrap();
            joined.put(&part, [x, y]).unwrap();
        }
    }
    let joined = device.finish(joined, settings, wanted).wait().unwrap();
    assert!(joined.to_le_bytes() == whole.to_le_bytes());
}

/// Small spheres in a corner, so that most parts show nothing.
fn beside(device: &'static Headless) {
    let view = View::from_toml(
        "[film]\nwidth = 90\nheight = 50\n[camera.pinhole]\neye = [0, 0, 9]\ndirection = [0, 0, -1]\n\
         vertical_fov = 50\n[[spheres]]\ncenter = [6, 3, 0]\nradius = 0.6\n[[spheres]]\ncenter = [5, 3, 1]\nradius = 0.1\n",
    );
    check_parts(device, &view, &view.settings);
    check_parts(device, &view, &RenderSettings::studio());
}

fn refused(device: &'static Headless) {
    let scene = Scene::new(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE)]).unwrap();
    let film = Film::new(40, 30).unwrap();
    let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect()).unwrap();
    let view = pinhole::View::new(&camera, film.part([8, 0], [16, 16]).unwrap());
    let refused = device.verify(&scene, &view, &RenderSettings::default()).wait();
    assert_eq!(refused.unwrap_err(), GpuError::PartOfFilm);
}
