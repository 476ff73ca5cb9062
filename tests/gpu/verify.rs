//! Tests that the checker accepts the pictures of this device, and finds faults that are inserted.

use libtest_mimic::{Failed, Trial};
use pinhole::accel::{Accel, AccelChoice, AccelPlan};
use pinhole::camera::film::YAxis;
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::gpu::{Decision, Headless};
use pinhole::image::NO_ID;
use pinhole::verify::conformance::{Answers, Rays};
use pinhole::verify::{Certificate, Checker, Outcome, Recording};
use pinhole::{Integrator, LayerSet, LinearRgb, Scene, Shading, Sphere};

use crate::planted::{self, Fault, named, planted};
use crate::support::View;
use crate::verify_views as views;
use crate::{headless, scenes};

/// The example of docs/verify.md for tests of other renderers.
#[path = "../../examples/legal.rs"]
#[allow(dead_code, reason = "an example has a main function")]
mod example;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    trials.push(Trial::test("verify::the_example", || {
        example::this_adapter_renders_legally().map_err(Into::into)
    }));
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
        trials.push(Trial::test(format!("verify::faults::input_{name}"), move || {
            input_fault_is_found(*spoil)
        }));
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
    // A size of bindings so small that there are several bricks.
    ("bricks", How { binding_bytes: 16 * 100, ..LIST }),
];

/// Scenes in which rounding decides what many pixels show: cameras on a surface, and rays along surfaces.
const UNDECIDED: [&str; 4] =
    ["on_the_wall_looking_in", "on_the_wall_looking_out", "tangent_rays", "huge_radius"];

fn legal(name: &str, view: &View) -> Result<(), Failed> {
    let View { scene, camera, film, settings } = view;
    let certificate =
        headless()?.verify(scene, &pinhole::View::new(camera.as_ref(), *film), settings)?;
    if certificate.rendered_otherwise.is_none() {
        return Err("what is rendered was not compared".into());
    }
    let expected = if UNDECIDED.contains(&name) { Outcome::Undecided } else { Outcome::Proved };
    match certificate.outcome() == expected {
        true => Ok(()),
        false => Err(certificate.to_string().into()),
    }
}

/// By exact rays, as the answers of any renderer are judged.
fn certified(view: &View) -> Result<(), Failed> {
    let View { scene, camera, film, settings } = view;
    let view = pinhole::View::new(camera.as_ref(), *film);
    let image = headless()?.render(scene, &view, settings, LayerSet::DATA)?;
    let depths: Vec<f64> =
        image.depth().unwrap_or_default().iter().copied().map(f64::from).collect();
    let normals: Vec<[f64; 3]> =
        image.normal().unwrap_or_default().iter().map(|normal| normal.map(f64::from)).collect();
    let answers = Answers {
        size: [film.width(), film.height()],
        ids: image.id().unwrap_or_default(),
        depths: Some(&depths),
        normals: Some(&normals),
        ..Answers::default()
    };
    let found = Checker::new(scene)?.certify_answers(&answers, Rays::View(view), None)?;
    println!("{found}");
    if found.outcome() == Outcome::Violated { Err(found.to_string().into()) } else { Ok(()) }
}

fn build(scene: &Scene, how: How) -> Accel {
    let spheres = scene.spheres();
    AccelPlan::new(spheres, how.choice, how.binding_bytes).build(spheres)
}

fn record(headless: &Headless, view: &View, how: How) -> Result<Recording, Failed> {
    let scene = &view.scene;
    let buffers = headless.upload(scene, &build(scene, how).into())?;
    let go_on = |_: &_| Decision::GoOn;
    Ok(headless.record(&buffers, &view.seen(), &view.settings, &mut { go_on })?)
}

fn certify(view: &View, recording: &Recording) -> Certificate {
    Checker::new(&view.scene).unwrap().certify(recording)
}

/// The view in which a fault is visible, and the structure in which it is tested.
fn view_of(fault: &Fault) -> (View, How) {
    let [view, how] = fault.setup();
    (named(views::ALL, view)(), named(STRUCTURES, how))
}

/// The views in which faults are inserted are legal without them.
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

/// A fault that only affects pictures without a recording.
fn fault_of_render_is_found(fault: &Fault) -> Result<(), Failed> {
    let faulty = fault.device()?;
    let [view] = fault.setup();
    let view = named(views::ALL, view)();
    let alone = certify(&view, &record(&faulty, &view, LIST)?);
    if !alone.is_legal() || alone.rendered_otherwise.is_some() {
        return Err(format!("the recording has the fault as well:\n{alone}").into());
    }
    let View { scene, camera, film, settings } = &view;
    let certificate =
        faulty.verify(scene, &pinhole::View::new(camera.as_ref(), *film), settings)?;
    println!("{certificate}");
    found(&certificate)?;
    match certificate.violations.iter().find(|violation| violation.stage != "render") {
        Some(elsewhere) => Err(format!("elsewhere: {elsewhere}").into()),
        None => Ok(()),
    }
}

/// Changes the input of the device, or the recorded input. The index of a visible sphere is given to change that
/// sphere.
type Spoil = fn(&mut View, &mut dyn FnMut(&View) -> Recording, usize) -> Recording;

/// The recording is of a different view than the requested one.
const INPUT_FAULTS: &[(&str, Spoil)] = &[
    ("radius_off_by_a_thousandth", |view, record, seen| {
        with_spheres(view, record, |spheres| spheres[seen].radius *= 1.0 + 2_f64.powi(-10))
    }),
    ("center_off_by_a_ten_thousandth", |view, record, seen| {
        with_spheres(view, record, |spheres| spheres[seen].center[1] += 1e-4)
    }),
    ("two_spheres_swapped", |view, record, seen| {
        with_spheres(view, record, |spheres| spheres.swap(seen, seen / 2))
    }),
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

fn spheres_of(scene: &Scene) -> Vec<Sphere> {
    (0..)
        .zip(scene.spheres())
        .map(|(id, [x, y, z, radius])| {
            let center = [*x, *y, *z].map(f64::from);
            Sphere::new(center, f64::from(*radius), scene.color(id))
        })
        .collect()
}

/// Records a picture of different spheres than those of the view.
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
    let mut view = views::balls();
    let reference = view.reference();
    let seen = reference.id().unwrap().iter().find(|id| **id != NO_ID).unwrap();
    let record = &mut |view: &View| record(headless, view, LIST).unwrap();
    let recording = spoil(&mut view, record, *seen as usize);
    found(&certify(&view, &recording))
}
