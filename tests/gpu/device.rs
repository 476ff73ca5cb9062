//! Tests of choosing a device, of its properties and failures, of plans and profiles, and that pictures do not depend
//! on the choices for its type: the order of rows, and the sizes of tiles and submissions.

use std::collections::BTreeMap;
use std::time::Duration;

use libtest_mimic::Trial;
use pinhole::accel::AccelChoice;
use pinhole::camera::PinholeCamera;
use pinhole::generate::Kind;
use pinhole::gpu::wgpu::DeviceType;
use pinhole::gpu::{
    Decision, GpuError, Headless, HeadlessOptions, Picture, PictureRequest, Profile, ProfileTrack, Progress,
    SelfTestExtent, TestedProperty, Wait, wgpu,
};
use pinhole::internals::ShaderEdit;
use pinhole::scene::{NewColors, SceneUpdate};
use pinhole::{Colors, Film, LayerSet, LinearRgb, RenderSettings, Scene};

use crate::pictures::go_on;
use crate::support::View;
use crate::support::appearances::kinds;
use crate::support::effort::share;
use crate::{lit_scenes, scenes, trial};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("device::an_adapter_is_found_by_a_part_of_its_name", part_of_a_name),
        trial("device::an_unknown_name_lists_the_adapters", unknown_name),
        trial("device::a_destroyed_device_is_an_error", destroyed),
        trial("device::a_fault_of_the_callers_does_not_outlive_it", callers_fault),
        trial("device::a_device_that_is_destroyed_in_the_middle_of_a_render", lost_midway),
        trial("device::a_device_that_does_not_finish_in_time", too_slow),
        trial("device::a_render_that_is_stopped_leaves_the_device_usable", stopped),
        trial("device::what_cannot_be_allocated_is_an_error", no_memory),
        trial("profile::every_pass_and_phase_is_named", named_passes),
        trial("profile::updates_of_colors_are_passes", recolored),
        trial("plan::it_bounds_what_is_built", bounds),
        trial("self_test::the_adapter_has_all_properties", properties),
        trial("self_test::fences_that_a_driver_sees_through_are_found", seen_through),
        trial("self_test::wrong_cones_are_found", wrong_cones),
        trial("device::pictures_do_not_depend_on_how_it_is_opened", opened_otherwise),
        trial("device_shape::a_picture_of_other_tiles_is_the_same", large),
    ]
}

fn open(adapter: &str) -> Result<Headless, GpuError> {
    Headless::open(&HeadlessOptions { adapter: Some(adapter.to_owned()), ..Default::default() }).wait()
}

fn part_of_a_name(headless: &'static Headless) {
    let name = &headless.adapter_info().name;
    let part = name.split_whitespace().next().unwrap().to_uppercase();
    let found = open(&part).unwrap();
    assert_eq!(&found.adapter_info().name, name);
}

fn unknown_name(headless: &'static Headless) {
    match open("no such adapter") {
        Err(GpuError::UnknownAdapter { wanted, available }) => {
            assert_eq!(wanted, "no such adapter");
            assert!(available.contains(&headless.adapter_info().name));
        }
        other => panic!("{other:?}"),
    }
}

fn destroyed(_: &'static Headless) {
    let headless = Headless::open(&HeadlessOptions::default()).wait().unwrap();
    headless.device().destroy();
    let view = View::three_spheres();
    let result = headless.render(&view.scene, &view.seen(), &view.settings, LayerSet::COLOR).wait();
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
}

/// An error that a caller causes on the device does not affect the next render.
fn callers_fault(_: &'static Headless) {
    let headless = Headless::open(&HeadlessOptions::default()).wait().unwrap();
    // A buffer without any usage is invalid.
    let _ = headless.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("the caller's"),
        size: 16,
        usage: wgpu::BufferUsages::empty(),
        mapped_at_creation: false,
    });
    let view = View::three_spheres();
    view.picture(&headless, LayerSet::COLOR);
}

/// Renders a picture in several submissions. `watch` is called after each of them except the last.
fn render_watched(headless: &Headless, mut watch: impl FnMut(&Progress) -> Decision) -> Result<Picture, GpuError> {
    let view = View { film: Film::new(2400, 1800).unwrap(), ..View::three_spheres() };
    let scene = headless.upload(&view.scene, &view.planned(headless, AccelChoice::Auto)).wait()?;
    view.watched(headless, &scene, LayerSet::COLOR, &mut watch)
}

fn lost_midway(_: &'static Headless) {
    let headless = Headless::open(&HeadlessOptions::default()).wait().unwrap();
    let mut told = 0;
    let result = render_watched(&headless, |_| {
        told += 1;
        headless.device().destroy();
        Decision::GoOn
    });
    assert!(told > 0, "the picture is too small for more than one submission");
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
    // The device stays lost, even for pictures in one submission.
    let result = render_watched(&headless, go_on);
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
    let view = View::three_spheres();
    let result = headless.render(&view.scene, &view.seen(), &view.settings, LayerSet::COLOR).wait();
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
}

fn too_slow(_: &'static Headless) {
    let timeout = Duration::ZERO;
    let options = HeadlessOptions { timeout, ..HeadlessOptions::default() };
    let headless = Headless::open(&options).wait().unwrap();
    // The work of an upload may finish at once, but the work of a picture does not.
    let result = render_watched(&headless, go_on);
    assert_eq!(result.err(), Some(GpuError::Timeout { waited: timeout }));
}

fn stopped(headless: &'static Headless) {
    let mut told = 0;
    let result = render_watched(headless, |progress| {
        told += 1;
        assert!(progress.part < 1.0, "{progress:?}");
        Decision::Stop
    });
    assert_eq!((result.err(), told), (Some(GpuError::Stopped), 1));
    let whole = render_watched(headless, go_on).unwrap();
    assert_eq!(whole, render_watched(headless, go_on).unwrap());
}

/// A picture takes at least twelve bytes of host memory for each pixel. For the largest film, this
/// is more than the host can address.
fn no_memory(headless: &'static Headless) {
    let film = Film::new(Film::MAX_SIDE, Film::MAX_SIDE).unwrap();
    let view = View { film, ..View::three_spheres() };
    let result = headless.render(&view.scene, &view.seen(), &view.settings, LayerSet::COLOR).wait();
    assert!(matches!(result, Err(GpuError::Image(_))), "{result:?}");
}

/// A device that is treated as if it had this type.
fn treated_as(device_type: DeviceType, options: HeadlessOptions) -> Headless {
    let options = HeadlessOptions { device_type: Some(device_type), ..options };
    let headless = Headless::open(&options).wait().unwrap();
    assert_eq!(headless.adapter_info().device_type, device_type);
    headless
}

/// A device makes the same pictures, regardless of the options with which it was opened.
fn opened_otherwise(headless: &'static Headless) {
    let mut types = vec![DeviceType::Cpu, DeviceType::IntegratedGpu, DeviceType::DiscreteGpu];
    types.retain(|kind| *kind != headless.adapter_info().device_type);
    let direct = HeadlessOptions { indirect: false, ..HeadlessOptions::default() };
    let profile = HeadlessOptions { profile: Some(Profile::default()), ..Default::default() };
    let others = types.into_iter().zip([direct, profile]);
    let others: Vec<_> = others.map(|(kind, how)| (kind, treated_as(kind, how))).collect();
    let lit = lit_scenes::all().map(|(name, mut view)| {
        view.settings.sampling.samples = 6;
        (name, view)
    });
    let primary = scenes::all().into_iter().map(|(name, view)| (name.to_owned(), view));
    for (name, view) in share(primary.chain(lit)) {
        let expected = view.picture(headless, LayerSet::ALL);
        for (how, other) in &others {
            assert_eq!(view.picture(other, LayerSet::ALL), expected, "{name}, {how:?}");
        }
    }
}

/// Numbers of tiles on devices that are treated as software and as a GPU. Their pictures must be the same.
fn tiles(mut view: View, size: [u32; 2], layers: LayerSet) -> [u64; 2] {
    view.film = Film::new(size[0], size[1]).unwrap();
    let pictures = [DeviceType::Cpu, DeviceType::DiscreteGpu].map(|device_type| {
        let device = treated_as(device_type, HeadlessOptions::default());
        let seen = view.seen();
        let request = PictureRequest::new(&view.scene, &seen, &view.settings, layers);
        let plan = device.plan(&request, AccelChoice::Auto);
        (plan.tile_count, view.picture(&device, layers))
    });
    let [(software, expected), (gpu, picture)] = pictures;
    assert!(picture == expected, "{size:?}");
    [software, gpu]
}

fn large(_: &'static Headless) {
    assert_eq!(tiles(View::three_spheres(), [1400, 1300], LayerSet::DATA), [2, 1]);
    for name in ["path_lobes_and_metals", "studio_opacity"] {
        let [software, gpu] = tiles(lit_scenes::sampled(name, 5), [700, 500], LayerSet::COLOR);
        assert!(gpu < software, "{name}: {gpu} tiles instead of {software}");
    }
}

const QUICK: &[&str] = &["fence", "add_multiply", "divide", "sqrt", "inverse_sqrt", "dot"];

fn properties(headless: &'static Headless) {
    let rest = ["subnormals", "comparison_and_conversion", "cones", "loops", "fence_in_trace"];
    for (extent, rest) in [(SelfTestExtent::Quick, &[][..]), (SelfTestExtent::Full, &rest)] {
        let report = headless.self_test(extent).wait().unwrap();
        let names: Vec<_> = report.properties().iter().map(|property| property.name).collect();
        assert_eq!(names, [QUICK, rest].concat());
        assert!(report.passed(), "{:?}", report.first_failure());
    }
}

fn fences_in_trace(headless: &Headless) -> TestedProperty {
    let report = headless.self_test(SelfTestExtent::Full).wait().unwrap();
    report.properties().iter().find(|property| property.name == "fence_in_trace").unwrap().clone()
}

/// Faults of the kernel that tests cones.
fn wrong_cones(_: &'static Headless) {
    let [cone, crossing, side] = ["scene/cone.wgsl", "scene/cone_crossing.wgsl", "scene/cone_side.wgsl"];
    for (fault, file, find, replace) in [
        ("a disc that is not there", crossing, "let is_open_in = enters_disc &&", "let is_open_in = false &&"),
        (
            "a closed disc that is left out",
            crossing,
            "let is_open_out = leaves_disc &&",
            "let is_open_out = leaves_disc ||",
        ),
        ("the other end's disc", crossing, "let is_up = risen > 0.0", "let is_up = risen < 0.0"),
        ("a rim that is cut off", crossing, "let at_end = (seen.half", "let at_end = (0.998 * seen.half"),
        (
            "the radius of the other end",
            side,
            "let first = abs(cone.first_radius)",
            "let first = abs(cone.second_radius)",
        ),
        ("a slope that points the other way", crossing, "outward - seen.slope", "outward + seen.slope"),
        ("the axis for the normal", crossing, "let on_side = select(normal", "let on_side = select(seen.axis"),
        ("the other half of a cone", side, "select(-FAR, high, opens)", "select(high, -FAR, opens)"),
        ("only the far side", cone, "far, is_far), near, is_near)", "far, is_far), far, is_near)"),
        ("the root of another equation", side, "- side * side)", "- 1.001 * side * side)"),
    ] {
        let edit = ShaderEdit { file: file.to_owned(), find: find.to_owned(), replace: replace.to_owned() };
        let options = HeadlessOptions { edits: vec![edit], ..HeadlessOptions::default() };
        let report = Headless::open(&options).wait().unwrap().self_test(SelfTestExtent::Full).wait().unwrap();
        let failed: Vec<_> = report.properties().iter().filter(|tested| !tested.passed()).map(|t| t.name).collect();
        assert_eq!(failed, ["cones"], "{fault}");
    }
}

/// A driver that assumes that the zero of fences is constant, only in kernels that trace rays.
fn seen_through(headless: &'static Headless) {
    let sound = fences_in_trace(headless);
    println!("{sound}");
    let (_, rewritten) = sound.figures.iter().find(|(name, _)| *name == "unfenced_rewritten_percent").unwrap();
    let edit = ShaderEdit {
        file: "scene/frame.wgsl".to_owned(),
        find: "frame.iteration_limit ^ frame.iteration_limit_again".to_owned(),
        replace: "0u".to_owned(),
    };
    let options = HeadlessOptions { edits: vec![edit], ..HeadlessOptions::default() };
    let known = fences_in_trace(&Headless::open(&options).wait().unwrap());
    println!("{known}");
    // Some drivers rewrite nothing.
    assert_eq!(known.passed(), *rewritten < 1.0, "{known}");
}

fn bounds(headless: &'static Headless) {
    let grey = LinearRgb::from_srgb8([128, 128, 128]);
    let film = Film::new(64, 48).unwrap();
    for kind in [Kind::Random, Kind::Clusters] {
        let scene = Scene::from_f32(kind.spheres(5000, 1).unwrap(), grey).unwrap();
        let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), film.aspect()).unwrap();
        let view = pinhole::View::new(&camera, film);
        for choice in [AccelChoice::Grid, AccelChoice::Tree, AccelChoice::List] {
            let settings = RenderSettings::default();
            let request = PictureRequest::new(&scene, &view, &settings, LayerSet::DATA);
            let plan = headless.plan(&request, choice);
            let structures = plan.build(&scene);
            let buffers = headless.upload(&scene, &structures).wait().unwrap();
            // The plan does not count the record of a brick, and the single appearance word.
            let small = 200 * structures.accel.bricks().len() as u64;
            let planned: u64 = plan.scene_buffers.iter().map(|buffer| buffer.bytes).sum();
            assert!(buffers.bytes() <= planned + small, "{kind:?}, {choice}");
            assert!(plan.check(&headless.device().limits(), None).is_ok());
        }
    }
}

/// A device that fills in a profile, and the profile.
fn profiled() -> (Headless, Profile) {
    let profile = Profile::default();
    let options = HeadlessOptions { profile: Some(profile.clone()), ..HeadlessOptions::default() };
    (Headless::open(&options).wait().unwrap(), profile)
}

/// Number of runs of each pass, or of each phase, by its name.
fn calls(profile: &Profile, track: ProfileTrack) -> BTreeMap<&'static str, u64> {
    let totals = profile.totals().into_iter().filter(|total| total.track == track);
    totals.map(|total| (total.name, total.calls)).collect()
}

fn named_passes(_: &'static Headless) {
    let common = ["start", "extend", "advance", "accumulate"];
    let by_one_ray = ["trace", "shade"];
    let of_studio = ["surface", "shadow", "illuminate", "ambient", "gather"];
    for (name, wanted) in [
        ("path_sky_image", [&common[..], &["scatter", "occlude"]].concat()),
        ("studio_opacity", [&common[..], &of_studio].concat()),
        ("studio_key_and_fill", vec!["one_pass"]),
        ("path_emissive_both", vec!["whole_paths"]),
    ] {
        let (device, profile) = profiled();
        let mut view = lit_scenes::sampled(name, 2);
        view.settings.sampling.denoise = true;
        view.picture(&device, LayerSet::COLOR);

        let named_passes = calls(&profile, ProfileTrack::Device);
        let mut wanted: Vec<_> = wanted.iter().chain(&by_one_ray).chain(&["denoise"]).collect();
        wanted.sort();
        assert_eq!(named_passes.keys().collect::<Vec<_>>(), wanted, "{name}");
        assert!(named_passes.values().all(|count| *count > 0));
        let phases = calls(&profile, ProfileTrack::Host);
        for phase in ["build", "upload", "create pipelines", "submit", "wait", "read back"] {
            assert!(phases.contains_key(phase), "{name}: no phase {phase}");
        }
    }
}

fn scene_of_rgba() -> Scene {
    let is_rgba = |scene: &Scene| matches!(scene.appearance().colors(), Colors::Rgba8(_));
    kinds().into_iter().map(|kind| kind.scene).find(is_rgba).unwrap()
}

fn recolored(_: &'static Headless) {
    let (device, profile) = profiled();
    let mut scene = scene_of_rgba();
    let plan = device.plan_accel(&scene, pinhole::accel::AccelChoice::Auto);
    let structures = plan.build(scene.spheres()).into();
    let mut buffers = device.upload(&scene, &structures).wait().unwrap();
    let colors = Some(NewColors::Rgba8(&[[9, 99, 199, 255]]));
    let update = SceneUpdate { colors, ..SceneUpdate::default() };
    scene.apply(&update).unwrap();
    device.update(&mut buffers, &scene, &update).wait().unwrap();
    assert_eq!(calls(&profile, ProfileTrack::Device).get("recolor"), Some(&1));
}
