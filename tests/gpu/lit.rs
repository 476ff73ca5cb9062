//! Tests that the checker accepts the paths and the studios of this device, and finds faults that are inserted.

use libtest_mimic::{Failed, Trial};
use pinhole::accel::{Accel, AccelChoice, AccelPlan, Brick};
use pinhole::camera::OrthographicCamera;
use pinhole::gpu::{Decision, GpuError, Headless, SampleRequest, Structures, Wait};
use pinhole::light::{Ground, LightKind};
use pinhole::render::{Integrator, Studio};
use pinhole::scene::material::Material;
use pinhole::verify::{Checker, LitCertificate, LitRecording, Outcome};
use pinhole::{Film, LinearRgb, Scene, Sphere};

use crate::planted::{Fault, planted};
use crate::support::effort::tries;
use crate::support::{View, random_light};
use crate::{headless, lit_scenes, planted, trial};

/// Maximum size of a binding in bytes for which a scene of 300 spheres has four bricks.
const SMALL_BINDING: u64 = 16 * 100;

/// The suites, and the number of random scenes of each if all run, with one test for each scene. For more scenes, run
/// `cargo bench --bench verify -- lit-campaign 500`, or `studio-campaign 500`.
const SUITES: [(&str, u32); 2] = [("paths", 36), ("studio", 48)];

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (suite, seeds) in SUITES {
        for name in lit_scenes::judged(suite) {
            let full = format!("{suite}::legal::{name}");
            trials.push(Trial::test(full, move || legal(&lit_scenes::view(suite, &name))));
        }
        let choices = [AccelChoice::List, AccelChoice::Grid, AccelChoice::Tree];
        let structures = choices.map(|choice| (format!("a_{choice:?}"), choice, 1 << 27));
        let bricks = ("bricks".to_owned(), AccelChoice::List, SMALL_BINDING);
        for (name, choice, binding_bytes) in structures.into_iter().chain([bricks]) {
            for view in ["many", "many_rods"] {
                let name = format!("{suite}::legal::{view}_in_{name}").to_lowercase();
                trials.push(Trial::test(name, move || legal_in(suite, view, choice, binding_bytes)));
            }
        }
        for seed in 0..u64::from(tries(seeds)) {
            let name = format!("{suite}::random::seed_{seed}");
            trials.push(Trial::test(name, move || random(suite, seed)));
        }
        let find = move |fault: &Fault| is_found(fault, suite, chosen);
        trials.extend(planted::trials(&format!("{suite}::faults::"), planted(suite), find));
    }
    for choice in [AccelChoice::List, AccelChoice::Grid, AccelChoice::Tree] {
        let name = format!("paths::legal::equal_spheres_in_bricks_{choice:?}").to_lowercase();
        trials.push(Trial::test(name, move || {
            let view = lit_scenes::view("paths", "thrice");
            is_legal(&certify(&view, &record(headless()?, &view, &in_bricks(&view, choice).into())?))
        }));
    }
    trials.extend(planted::trials("paths::faults::", planted("paths_by_id"), |fault| {
        is_found(fault, "paths", |_, view| in_bricks(view, AccelChoice::Tree).into())
    }));
    for (suite, name, change) in inputs() {
        let name = format!("{suite}::faults::input_{name}");
        trials.push(Trial::test(name, move || input_fault_is_found(suite, change)));
    }
    trials.push(Trial::test("paths::faults::film_of_one_pixel_more", part_of_a_large_film));
    trials.push(trial("paths::stops_when_told", stops_when_told));
    trials
}

/// The structures that a device chooses.
fn chosen(device: &Headless, view: &View) -> Structures {
    view.planned(device, AccelChoice::Auto)
}

/// Records some samples. In studios, they are the first, one in between, and the last sample of a picture with many.
fn record(device: &Headless, view: &View, structures: &Structures) -> Result<LitRecording, GpuError> {
    let buffers = device.upload(&view.scene, structures).wait()?;
    let samples = match view.settings.integrator {
        Integrator::Studio(_) => &[0, 37, 63][..],
        _ => &[0, 1],
    };
    let mut all = None;
    let each = &mut |one: &LitRecording| match &mut all {
        None => all = Some(one.clone()),
        Some(LitRecording { samples, .. }) => samples.extend_from_slice(&one.samples),
    };
    let go_on = &mut |_: &_| Decision::GoOn;
    device.record_lit(&buffers, &view.seen(), &view.settings, SampleRequest::middle(samples), each, go_on).wait()?;
    Ok(all.unwrap())
}

fn certify(view: &View, samples: &LitRecording) -> LitCertificate {
    Checker::new(&view.scene).unwrap().certify_lit(samples)
}

fn recorded(device: &Headless, view: &View) -> Result<LitRecording, GpuError> {
    record(device, view, &chosen(device, view))
}

/// Asserts that a recording is legal, and that the check is meaningful: most stages have a single legal result.
fn is_legal(certificate: &LitCertificate) -> Result<(), Failed> {
    let stages = certificate.stages();
    let is_telling = stages.checked > 10_000
        && stages.decided + stages.open > stages.checked / 1000 * 999
        && stages.open < stages.checked / 20;
    println!("{certificate}");
    if certificate.is_legal() && is_telling {
        Ok(())
    } else {
        Err(format!("{certificate}\n{:#?}\n{certificate:#?}", certificate.named()).into())
    }
}

fn legal(view: &View) -> Result<(), Failed> {
    is_legal(&certify(view, &recorded(headless()?, view)?))
}

/// Recordings are legal with every structure.
fn legal_in(suite: &str, view: &str, choice: AccelChoice, binding_bytes: u64) -> Result<(), Failed> {
    let view = lit_scenes::view(suite, view);
    let device = headless()?;
    let mut structures = view.planned(device, choice);
    if binding_bytes == SMALL_BINDING {
        let (spheres, cones) = (view.scene.spheres(), view.scene.cones());
        let plan = AccelPlan::new(spheres, choice, binding_bytes).with_cones(cones, binding_bytes);
        structures.accel = plan.bricks(spheres).with_cones(cones).build();
    }
    is_legal(&certify(&view, &record(device, &view, &structures)?))
}

/// Several bricks. Equal spheres are in different bricks.
fn in_bricks(view: &View, choice: AccelChoice) -> Accel {
    let spheres = view.scene.spheres();
    let accel = AccelPlan::new(spheres, choice, SMALL_BINDING).build(spheres);
    let brick_of = |sphere: &[f32; 4]| {
        let place = |brick: &Brick| brick.spheres.iter().any(|other| other[..3] == sphere[..3]);
        accel.bricks().iter().filter(|brick| place(brick)).count()
    };
    assert!(spheres.iter().any(|sphere| brick_of(sphere) > 1), "none is in several");
    accel
}

/// Random scenes with random light are legal.
fn random(suite: &str, seed: u64) -> Result<(), Failed> {
    let of = if suite == "paths" { random_light::view } else { random_light::studio };
    let random = of(seed);
    let name = random.name.clone();
    let view = View::from(random);
    let certificate = certify(&view, &recorded(headless()?, &view)?);
    let stages = certificate.stages();
    println!("seed {seed}: {name}: {certificate}");
    let said = stages.decided + stages.open;
    let is_good = match suite {
        // In some scenes, such as scenes with mirrors, many stages are undecided, but not in most scenes.
        "paths" => certificate.outcome() != Outcome::Violated && said > stages.checked / 2,
        _ => certificate.is_legal() && said > stages.checked / 10 * 9,
    };
    if is_good { Ok(()) } else { Err(format!("seed {seed}: {name}: {certificate}\n{:#?}", certificate.named()).into()) }
}

/// Asserts that the fault is found in the stage in which it was inserted.
fn is_found(fault: &Fault, suite: &str, structures: impl Fn(&Headless, &View) -> Structures) -> Result<(), Failed> {
    let [view, stage] = fault.setup();
    let (device, view) = (fault.device()?, lit_scenes::view(suite, view));
    let certificate = certify(&view, &record(&device, &view, &structures(&device, &view))?);
    println!("{certificate}");
    match certificate.violations.first() {
        None => Err(format!("the fault was not found: {certificate}").into()),
        Some(first) if format!("{:?}", first.stage) != stage => Err(format!("elsewhere: {certificate}").into()),
        Some(_) => Ok(()),
    }
}

/// Asserts that a certificate is violated, and not only undecided.
fn is_violated(certificate: &LitCertificate) -> Result<(), Failed> {
    match certificate.outcome() {
        Outcome::Violated => Ok(()),
        _ => Err(format!("the fault was not found: {certificate}").into()),
    }
}

/// The inputs of the device differ from the requested ones, or the recording is damaged.
fn input_fault_is_found(suite: &str, change: Change) -> Result<(), Failed> {
    let view = view_to_change(suite);
    let mut given = view_to_change(suite);
    if let Change::View(change) = change {
        change(&mut given);
    }
    let mut samples = recorded(headless()?, &given)?;
    samples.given.settings = view.settings.clone();
    if let Change::Recording(change) = change {
        change(&mut samples);
    }
    is_violated(&certify(&view, &samples))
}

/// For a large film, the rectangle in the middle is recorded. Its paths are not legal for another rectangle.
fn part_of_a_large_film() -> Result<(), Failed> {
    let pose = pinhole::camera::Pose::looking_at([0.5, 1.5, 7.0], [0.0; 3], [0.1, 1.0, 0.0])?;
    let camera = Box::new(OrthographicCamera::new(pose, [5.0, 4.5])?);
    let view = View { camera, film: Film::new(300, 270)?, ..lit_scenes::view("paths", "matt") };
    let mut samples = recorded(headless()?, &view)?;
    let given = &mut samples.given;
    if given.origin != [38, 23] || given.size != [224, 224] {
        return Err(format!("{:?}, {:?}", given.origin, given.size).into());
    }
    is_legal(&certify(&view, &samples))?;
    samples.given.origin[0] += 1;
    is_violated(&certify(&view, &samples))
}

fn stops_when_told(headless: &'static Headless) {
    let view = lit_scenes::view("paths", "matt");
    let buffers = headless.upload(&view.scene, &chosen(headless, &view)).wait().unwrap();
    let stop = &mut |_: &_| Decision::Stop;
    let each = &mut |_: &LitRecording| {};
    let stopped =
        headless.record_lit(&buffers, &view.seen(), &view.settings, SampleRequest::middle(&[0]), each, stop).wait();
    assert_eq!(stopped.unwrap_err(), GpuError::Stopped);
}

#[derive(Clone, Copy)]
enum Change {
    /// A change before the device renders the scene.
    View(fn(&mut View)),
    /// A change after the recording.
    Recording(fn(&mut LitRecording)),
}

/// The suite, the name and the change of a fault.
type Input = (&'static str, &'static str, Change);

fn given(suite: &'static str, name: &'static str, change: fn(&mut View)) -> Input {
    (suite, name, Change::View(change))
}

fn of_paths(name: &'static str, change: fn(&mut LitRecording)) -> Input {
    ("paths", name, Change::Recording(change))
}

fn of_studio(name: &'static str, change: fn(&mut LitRecording)) -> Input {
    ("studio", name, Change::Recording(change))
}

/// A scene that has all kinds of inputs that can be changed.
fn view_to_change(suite: &str) -> View {
    lit_scenes::view(suite, if suite == "paths" { "everything" } else { "translucent" })
}

fn on_spheres(view: &mut View, change: impl FnOnce(&mut [Sphere])) {
    let (mut spheres, _) = lit_scenes::read("paths", "everything");
    change(&mut spheres);
    view.scene = Scene::new(&spheres).unwrap();
}

fn in_studio(view: &mut View) -> &mut Studio {
    match &mut view.settings.integrator {
        Integrator::Studio(studio) => studio,
        _ => panic!("no studio"),
    }
}

/// Moves the lights at points.
fn move_lights(view: &mut View) {
    for light in &mut view.settings.lights {
        if let LightKind::Point { position, .. } = &mut light.kind {
            position.x += 1e-4;
        }
    }
}

fn ground(view: &mut View) -> &mut Ground {
    view.settings.ground.as_mut().unwrap()
}

fn inputs() -> Vec<Input> {
    vec![
        given("paths", "color_a_thousandth_off", |view| {
            on_spheres(view, |spheres| {
                let [r, g, b] = spheres[3].color.to_array();
                spheres[3].color = LinearRgb::new([r, g * 0.999, b]).unwrap();
            });
        }),
        given("paths", "opacity_off", |view| {
            on_spheres(view, |spheres| {
                spheres[6] = spheres[6].with_opacity(0.8);
            });
        }),
        given("paths", "roughness_a_thousandth_off", |view| {
            on_spheres(view, |spheres| {
                spheres[1] = spheres[1].with_material(Material::Conductor { roughness: 0.3003 });
            });
        }),
        given("paths", "emitter_a_thousandth_brighter", |view| {
            on_spheres(view, |spheres| {
                spheres[0] = spheres[0].with_material(Material::Emissive { strength: 1.001 });
            });
        }),
        given("paths", "two_spheres_swapped", |view| {
            on_spheres(view, |spheres| spheres.swap(0, 3));
        }),
        given("paths", "light_moved", move_lights),
        given("paths", "another_seed", |view| view.settings.sampling.seed += 1),
        given("paths", "another_filter", |view| {
            view.settings.sampling.filter = pinhole::PixelFilter::Box;
        }),
        given("paths", "ground_moved", |view| ground(view).point.y -= 1e-5),
        given("paths", "sky_seen", |view| view.settings.sky.is_visible ^= true),
        given("paths", "light_left_out", |view| {
            view.settings.lights.pop();
        }),
        of_paths("another_number_of_sources", |recording| {
            recording.given.lighting.source_count += 1;
        }),
        of_paths("energy_of_a_lobe", |recording| {
            let last = recording.given.tables.len() - 3;
            recording.given.tables[last][1] ^= 1;
        }),
        of_paths("opacity_of_a_material", |recording| {
            let at = recording.given.lighting.material_first as usize + 2 * 3 + 1;
            recording.given.tables[at][3] ^= 1 << 3;
        }),
        of_paths("emitter_more_likely", |recording| recording.given.emitters[1][1] += 1 << 20),
        of_paths("one_surface_less", |recording| {
            recording.samples[0].surfaces.pop();
        }),
        of_paths("a_sample_of_another_number", |recording| recording.samples[0].sample = 5),
        of_paths("a_pixel_less", |recording| {
            recording.samples[1].start.pop();
        }),
        of_paths("a_bit_of_a_sum", |recording| {
            recording.samples[1].film.after[777][0][0] ^= 1 << 3;
        }),
        of_paths("a_bit_of_an_ended_path", |recording| {
            let surfaces = &mut recording.samples[0].surfaces;
            let last = surfaces.len() - 1;
            surfaces[last].states[0].slots[4][1] ^= 1;
        }),
        of_paths("a_camera_elsewhere", |recording| recording.given.uploaded.origin[1] += 1e-5),
        given("studio", "ambient_light_a_thousandth_brighter", |view| {
            in_studio(view).ambient = LinearRgb::new([0.25025; 3]).unwrap();
        }),
        given("studio", "no_shadows", |view| in_studio(view).shadows = false),
        given("studio", "a_surface_less", |view| in_studio(view).max_surfaces -= 1),
        given("studio", "fog_a_thousandth_nearer", |view| {
            in_studio(view).depth_cue.as_mut().unwrap().near *= 0.999;
        }),
        given("studio", "another_radius_of_occlusion", |view| {
            in_studio(view).occlusion.as_mut().unwrap().radius = Some(0.801);
        }),
        given("studio", "light_moved", move_lights),
        given("studio", "a_catcher_for_a_ground", |view| ground(view).is_shadow_catcher = true),
        given("studio", "another_seed", |view| view.settings.sampling.seed += 1),
        of_studio("box_of_the_occluders_too_small", |recording| {
            recording.given.occluders[1][0] -= 0.05;
        }),
        of_studio("a_sample_of_another_number", |recording| recording.samples[1].sample = 5),
        of_studio("a_hidden_light", |recording| {
            recording.samples[2].surfaces[0].lights[0].hidden[900] ^= 1;
        }),
        of_studio("a_bit_of_the_radiance", |recording| {
            recording.samples[0].surfaces[0].lights[0].radiance[900][1] ^= 1 << 4;
        }),
        of_studio("a_bit_of_a_sum", |recording| {
            recording.samples[2].film.after[900][0][2] ^= 1 << 3;
        }),
        of_studio("a_bit_of_the_rest_of_a_sum", |recording| {
            recording.samples[2].film.after[900][1][2] ^= 1 << 30;
        }),
        of_studio("a_film_that_was_cleared", |recording| {
            let film = &mut recording.samples[1].film;
            film.before.iter_mut().for_each(|sums| *sums = [[0; 4]; 3]);
        }),
        of_studio("a_surface_that_is_missing", |recording| {
            recording.samples[0].surfaces.pop();
        }),
        of_studio("a_pixel_less", |recording| {
            recording.samples[1].surfaces[0].ambient[0].left.pop();
        }),
    ]
}
