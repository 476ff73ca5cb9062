//! Tests that the checker accepts the pictures of this device, and finds faults that are inserted.

/// The example of docs/how-to/verify.md for tests of other renderers.
#[path = "../../examples/legal.rs"]
#[allow(dead_code, reason = "an example has a main function")]
mod example;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::{Accel, AccelChoice, AccelPlan};
use pinhole::camera::film::YAxis;
use pinhole::camera::{FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::gpu::{Headless, Wait};
use pinhole::image::NO_ID;
use pinhole::verify::conformance::{Answers, Conformance, Rays};
use pinhole::verify::{Certificate, Checker, Outcome, Recording};
use pinhole::{Appearance, Image, Integrator, LayerSet, LinearRgb, Scene, Shading, Sphere, SphereArray};

use crate::planted::{Fault, named, planted};
use crate::scenes::{self, pinhole, view};
use crate::support::cones::mixed;
use crate::support::{View, spheres, spheres_of};
use crate::{headless, planted};

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    trials.push(Trial::test("verify::the_example", || example::this_adapter_renders_legally().map_err(Into::into)));
    for (name, view) in scenes::all() {
        trials.push(Trial::test(format!("verify::legal::{name}"), move || legal(name, &view)));
    }
    for (name, view) in scenes::all() {
        trials.push(Trial::test(format!("verify::certified::{name}"), move || certified(&view)));
    }
    trials.push(Trial::test("verify::faults::none_without_one", none_without_one));
    trials.extend(planted::trials("verify::faults::", planted("primary"), is_found));
    let group = "verify::faults::render_";
    trials.extend(planted::trials(group, planted("render"), fault_of_render_is_found));
    for (name, spoil) in INPUT_FAULTS {
        trials.push(Trial::test(format!("verify::faults::input_{name}"), move || input_fault_is_found(*spoil)));
    }
    trials
}

/// The structure in which a fault is tested.
#[derive(Clone, Copy)]
struct How {
    choice: AccelChoice,
    binding_bytes: u64,
}

const fn how(choice: AccelChoice) -> How {
    How { choice, binding_bytes: 1 << 27 }
}

const LIST: How = how(AccelChoice::List);

const STRUCTURES: &[(&str, How)] = &[
    ("list", LIST),
    ("grid", how(AccelChoice::Grid)),
    ("tree", how(AccelChoice::Tree)),
    // Bindings are so small that there are several bricks.
    ("bricks", How { binding_bytes: 16 * 100, ..LIST }),
];

/// Scenes in which rounding decides which sphere many pixels show: cameras on a surface, and rays along surfaces.
const UNDECIDED: [&str; 4] = ["on_the_wall_looking_in", "on_the_wall_looking_out", "tangent_rays", "huge_radius"];

fn legal(name: &str, view: &View) -> Result<(), Failed> {
    let certificate = headless()?.verify(&view.scene, &view.seen(), &view.settings).wait()?;
    if certificate.rendered_otherwise.is_none() {
        return Err("what is rendered was not compared".into());
    }
    let expected = if UNDECIDED.contains(&name) { Outcome::Undecided } else { Outcome::Proved };
    match certificate.outcome() == expected {
        true => Ok(()),
        false => Err(certificate.to_string().into()),
    }
}

/// Judges a picture by exact rays, like the answers of any renderer.
fn certified(view: &View) -> Result<(), Failed> {
    let found = judged_by_rays(&view.scene, view.seen(), &view.picture(headless()?, LayerSet::DATA));
    println!("{found}");
    if found.outcome() == Outcome::Violated { Err(found.to_string().into()) } else { Ok(()) }
}

/// Judges the ids, depths and normals of a picture by exact rays.
pub(crate) fn judged_by_rays(scene: &Scene, view: pinhole::View<'_>, image: &Image) -> Conformance {
    let depths: Vec<f64> = image.depth().unwrap_or_default().iter().copied().map(f64::from).collect();
    let normals: Vec<[f64; 3]> =
        image.normal().unwrap_or_default().iter().map(|normal| normal.map(f64::from)).collect();
    let answers = Answers {
        size: [image.width(), image.height()],
        ids: image.id().unwrap_or_default(),
        depths: Some(&depths),
        normals: Some(&normals),
        ..Answers::default()
    };
    Checker::new(scene).unwrap().certify_answers(&answers, Rays::View(view), None).unwrap()
}

fn build(scene: &Scene, how: How) -> Accel {
    let (spheres, cones) = (scene.spheres(), scene.cones());
    let plan = AccelPlan::new(spheres, how.choice, how.binding_bytes).with_cones(cones, how.binding_bytes);
    plan.bricks(spheres).with_cones(cones).build()
}

fn record(headless: &Headless, view: &View, how: How) -> Result<Recording, Failed> {
    Ok(view.record(headless, &build(&view.scene, how).into())?)
}

fn certify(view: &View, recording: &Recording) -> Certificate {
    Checker::new(&view.scene).unwrap().certify(recording)
}

/// The view in which a fault is visible, and the structure in which it is tested.
fn view_of(fault: &Fault) -> (View, How) {
    let [view, how] = fault.setup();
    (named(VIEWS, view)(), named(STRUCTURES, how))
}

/// Tests that the views in which faults are inserted are legal without them.
fn none_without_one() -> Result<(), Failed> {
    let mut seen = Vec::new();
    for fault in planted("primary") {
        if seen.contains(&fault.setup) {
            continue;
        }
        let (view, how) = view_of(&fault);
        let certificate = certify(&view, &record(headless()?, &view, how)?);
        if !certificate.is_legal() {
            return Err(format!("{}, without the fault: {certificate}", fault.name).into());
        }
        seen.push(fault.setup);
    }
    Ok(())
}

fn is_found(fault: &Fault) -> Result<(), Failed> {
    let (view, how) = view_of(fault);
    let certificate = certify(&view, &record(&fault.device()?, &view, how)?);
    found(&certificate).map_err(|error| {
        let structure = build(&view.scene, how).structure().name();
        format!("in the structure {structure}: {error:?}").into()
    })
}

fn found(certificate: &Certificate) -> Result<(), Failed> {
    if certificate.outcome() != Outcome::Violated {
        return Err(format!("the fault was not found:\n{certificate}").into());
    }
    Ok(())
}

/// Tests a fault that only affects pictures without a recording.
fn fault_of_render_is_found(fault: &Fault) -> Result<(), Failed> {
    let faulty = fault.device()?;
    let [view] = fault.setup();
    let view = named(VIEWS, view)();
    let alone = certify(&view, &record(&faulty, &view, LIST)?);
    if !alone.is_legal() || alone.rendered_otherwise.is_some() {
        return Err(format!("the recording has the fault as well:\n{alone}").into());
    }
    let certificate = faulty.verify(&view.scene, &view.seen(), &view.settings).wait()?;
    println!("{certificate}");
    found(&certificate)?;
    match certificate.violations.iter().find(|violation| violation.stage != "render") {
        Some(elsewhere) => Err(format!("elsewhere: {elsewhere}").into()),
        None => Ok(()),
    }
}

/// Changes the input of the device, or the recorded input. The last argument is the index of a
/// visible sphere, which may be changed.
type Spoil = fn(&mut View, &mut dyn FnMut(&View) -> Recording, usize) -> Recording;

/// Faults with which the recording shows a different view than the requested one.
const INPUT_FAULTS: &[(&str, Spoil)] = &[
    ("radius_off_by_a_thousandth", |view, record, seen| {
        with_spheres(view, record, |spheres| spheres[seen].radius *= 1.0 + 2_f64.powi(-10))
    }),
    ("center_off_by_a_ten_thousandth", |view, record, seen| {
        with_spheres(view, record, |spheres| spheres[seen].center[1] += 1e-4)
    }),
    ("two_spheres_swapped", |view, record, seen| with_spheres(view, record, |spheres| spheres.swap(seen, seen / 2))),
    ("one_sphere_twice_for_another", |view, record, seen| {
        with_spheres(view, record, |spheres| spheres[seen] = spheres[seen / 2])
    }),
    ("one_color_off_by_a_hundred_thousandth", |view, record, seen| {
        with_spheres(view, record, |spheres| {
            let [r, g, b] = spheres[seen].color.to_array();
            spheres[seen].color = LinearRgb::new([r, g * 1.000_01, b]).unwrap();
        })
    }),
    ("another_shading", |view, record, _| {
        let asked = view.settings.primary().unwrap();
        view.settings.integrator = Integrator::Primary(Shading::Flat);
        Recording { primary: asked, ..record(view) }
    }),
    ("y_the_other_way_round", |view, record, _| {
        let asked = view.film;
        view.film = asked.with_y_axis(YAxis::Down);
        Recording { film: asked, ..record(view) }
    }),
    ("field_of_view_off_by_a_millionth", |view, record, _| {
        let asked = record(view).camera;
        let pose = Pose::looking_at([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], [0.1, 1.0, 0.2]).unwrap();
        let fov = f64::to_radians(44.000_044);
        view.camera = Box::new(PinholeCamera::with_vertical_fov(pose, fov, 1.2).unwrap());
        Recording { camera: asked, ..record(view) }
    }),
    ("eye_moved_past_the_first_spheres", |view, record, _| {
        let mut recording = record(view);
        recording.uploaded.advance *= 1.1;
        recording
    }),
    ("box_without_the_last_sphere", |view, record, _| {
        let mut recording = record(view);
        recording.uploaded.scene_max[0] -= 0.1;
        recording
    }),
    ("box_smaller_on_the_device", |view, record, _| {
        let asked = record(view).uploaded;
        let whole = view.scene.clone();
        let fewer: Vec<Sphere> = spheres_of(&whole).into_iter().take(10).collect();
        view.scene = Scene::new(&fewer).unwrap();
        let recording = record(view);
        view.scene = whole;
        Recording { uploaded: asked, ..recording }
    }),
];

/// Records a picture of spheres that differ from the spheres of the view.
fn with_spheres(
    view: &mut View,
    record: &mut dyn FnMut(&View) -> Recording,
    change: impl FnOnce(&mut Vec<Sphere>),
) -> Recording {
    let asked = view.scene.clone();
    let mut spheres = spheres_of(&asked);
    change(&mut spheres);
    view.scene = Scene::new(&spheres).unwrap();
    let recording = record(view);
    view.scene = asked;
    recording
}

fn input_fault_is_found(spoil: Spoil) -> Result<(), Failed> {
    let headless = headless()?;
    let mut view = balls();
    let reference = view.reference();
    let seen = reference.id().unwrap().iter().find(|id| **id != NO_ID).unwrap();
    let record = &mut |view: &View| record(headless, view, LIST).unwrap();
    let recording = spoil(&mut view, record, *seen as usize);
    found(&certify(&view, &recording))
}

/// A function that makes a view.
type Make = fn() -> View;

pub(crate) const VIEWS: &[(&str, Make)] = &[
    ("balls", balls),
    ("sticks", sticks),
    ("own_colors", own_colors),
    ("parallel", parallel),
    ("lens", lens),
    ("around", around),
    ("disk", disk),
    ("inside", inside),
    ("behind", behind),
    ("lattice", lattice),
    ("clusters", clusters),
    ("far_clusters", far_clusters),
    ("copies", copies),
    ("two_tiles", two_tiles),
];

fn colored(center: [f64; 3], radius: f64, i: usize) -> Sphere {
    let level = |k: usize| ((i * k) % 17 + 1) as f32 / 18.0;
    let color = LinearRgb::new([level(3), level(5), level(7)]).unwrap();
    Sphere::new(center, radius, color)
}

fn pose(eye: [f64; 3], look_at: [f64; 3]) -> Pose {
    Pose::looking_at(eye, look_at, [0.1, 1.0, 0.2]).unwrap()
}

fn random(count: usize, seed: u64) -> Vec<Sphere> {
    let mut random = fastrand::Rng::with_seed(seed);
    (0..count)
        .map(|i| {
            let center = [0; 3].map(|_| random.f64() * 4.0 - 2.0);
            colored(center, 0.08 + 0.1 * random.f64(), i)
        })
        .collect()
}

/// Spheres in several colours, seen from outside, with background around them.
pub(crate) fn balls() -> View {
    view(&random(400, 31), pinhole([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], 44.0, 1.2), [96, 80])
}

/// Cones, cylinders and spheres.
pub(crate) fn sticks() -> View {
    let scene = mixed(100, 300, 0.2, 31);
    View { scene, ..balls() }
}

/// Spheres with individual colours.
pub(crate) fn own_colors() -> View {
    let view = balls();
    let colors = (0..view.scene.len()).map(|i| [i as u8, (i / 2) as u8, (i / 3) as u8, 255]);
    let appearance = Appearance::from(colors.collect::<Vec<_>>());
    let spheres = SphereArray::F32(view.scene.spheres().to_vec());
    View { scene: Scene::from_parts(spheres, appearance).unwrap(), ..view }
}

pub(crate) fn parallel() -> View {
    let camera = OrthographicCamera::new(pose([3.0, 2.0, 6.0], [0.1, 0.2, 0.3]), [3.4, 2.8]).unwrap();
    view(&random(400, 31), camera, [96, 80])
}

/// A view through a lens. Recordings use rays through the centre of the lens.
pub(crate) fn lens() -> View {
    let pinhole = pinhole([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], 44.0, 1.2);
    view(&random(400, 31), ThinLensCamera::new(pinhole, 0.3, 5.0).unwrap(), [96, 80])
}

/// A stereo view from the middle, for the right eye.
pub(crate) fn around() -> View {
    let pose = pose([0.1, 0.2, 0.3], [3.0, 2.0, 6.0]);
    let [_, right] = PanoramaCamera::new(pose).stereo_pair(0.1, 1.0).unwrap();
    view(&random(400, 31), right, [96, 48])
}

/// A view from the middle in most directions, in which no ray misses.
pub(crate) fn disk() -> View {
    let mut spheres = random(400, 31);
    spheres.push(colored([0.0; 3], 5.0, 3));
    let pose = pose([0.1, 0.2, 0.3], [3.0, 2.0, 6.0]);
    let camera = FisheyeCamera::new(pose, 5.0, 1.2).unwrap();
    view(&spheres, camera, [96, 80])
}

/// A view from inside a large sphere, with other spheres inside and around it.
pub(crate) fn inside() -> View {
    let mut spheres = random(60, 32);
    spheres.push(colored([0.0; 3], 5.0, 3));
    view(&spheres, pinhole([0.5, 1.0, 3.9], [0.0; 3], 90.0, 1.2), [96, 80])
}

/// Spheres all around the eye, most of them behind it.
pub(crate) fn behind() -> View {
    view(&random(100, 33), pinhole([0.0, 0.0, 1.6], [0.0, 0.0, 4.0], 60.0, 1.2), [96, 80])
}

/// Spheres that fill all cells of a grid equally and extend into neighbouring cells.
pub(crate) fn lattice() -> View {
    let spheres: Vec<Sphere> = spheres::lattice(12)
        .iter()
        .enumerate()
        .map(|(i, [x, y, z, r])| {
            let radius = f64::from(*r) * (0.2 + 0.3 * (i % 5) as f64);
            colored([*x, *y, *z].map(f64::from), radius, i)
        })
        .collect();
    view(&spheres, pinhole([-9.0, 15.0, -12.0], [5.0, 5.0, 5.0], 40.0, 1.2), [96, 80])
}

fn in_clusters() -> Vec<Sphere> {
    let mut random = fastrand::Rng::with_seed(34);
    (0..12)
        .flat_map(|_| {
            let center = [0; 3].map(|_| random.f64() * 4.0 - 2.0);
            let size = 10_f64.powf(-2.0 * random.f64());
            (0..120)
                .map(|i| {
                    let near = center.map(|x| x + (random.f64() - 0.5) * size);
                    colored(near, size * 0.08 * (0.2 + random.f64()), i)
                })
                .collect::<Vec<_>>()
        })
        .collect()
}

/// Spheres that form a few dense clusters.
pub(crate) fn clusters() -> View {
    view(&in_clusters(), pinhole([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], 44.0, 1.2), [96, 80])
}

/// The spheres of [`clusters`], but small in a large box.
pub(crate) fn far_clusters() -> View {
    let mut spheres = in_clusters();
    spheres.push(colored([40.0, 60.0, 120.0], 0.5, 5));
    view(&spheres, pinhole([63.0, 42.0, 126.0], [0.0; 3], 1.8, 1.2), [96, 80])
}

/// Eight copies of each sphere, in shuffled order.
pub(crate) fn copies() -> View {
    let mut random = fastrand::Rng::with_seed(35);
    let mut places: Vec<usize> = (0..40 * 8).map(|i| i % 40).collect();
    random.shuffle(&mut places);
    let spheres: Vec<Sphere> = places
        .into_iter()
        .enumerate()
        .map(|(i, place)| {
            let center = [(place % 8) as f64 - 3.5, (place / 8) as f64 - 2.0, 0.0];
            colored(center, 0.45, i)
        })
        .collect();
    view(&spheres, pinhole([1.0, 2.0, 9.0], [0.0; 3], 40.0, 1.2), [96, 80])
}

/// A picture that is larger than one tile.
pub(crate) fn two_tiles() -> View {
    let spheres = [colored([-1.0, 0.0, 0.0], 0.9, 1), colored([1.0, 0.0, 0.0], 0.9, 2)];
    view(&spheres, pinhole([0.0, 0.5, 5.0], [0.0; 3], 16.0, 1.2), [1100, 1000])
}
