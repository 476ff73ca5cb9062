//! Tests of profiles: what they hold, and that pictures do not depend on them.

use std::collections::BTreeMap;

use libtest_mimic::Trial;
use pinhole::gpu::{Headless, HeadlessOptions, Profile, ProfileTrack};
use pinhole::scene::{NewColors, SceneUpdate};
use pinhole::{Colors, LayerSet, RenderSettings, Scene, View};

use crate::support::appearances::kinds;
use crate::{light, scenes, trial};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("profile::a_picture_does_not_depend_on_it", same_picture),
        trial("profile::every_pass_and_phase_is_named", passes),
        trial("profile::updates_of_colors_are_passes", recolored),
    ]
}

/// A device that fills in a profile, and the profile.
fn profiled() -> (Headless, Profile) {
    let profile = Profile::default();
    let options = HeadlessOptions { profile: Some(profile.clone()), ..HeadlessOptions::default() };
    (Headless::open(&options).unwrap(), profile)
}

fn same_picture(headless: &'static Headless) {
    let (other, _) = profiled();
    let check = |name: &str, scene: &Scene, view: &View<'_>, settings: &RenderSettings| {
        let [without, with] = [headless, &other]
            .map(|device| device.render(scene, view, settings, LayerSet::ALL).unwrap());
        assert_eq!(without, with, "{name}");
    };
    for (name, view) in scenes::all() {
        check(name, &view.scene, &view.seen(), &view.settings);
    }
    for (name, mut view) in light::scenes::all() {
        view.settings.sampling.samples = 5;
        check(name, &view.scene, &view.seen(), &view.settings);
    }
}

/// How often each pass ran, or each phase, by its name.
fn calls(profile: &Profile, track: ProfileTrack) -> BTreeMap<&'static str, u64> {
    let totals = profile.totals().into_iter().filter(|total| total.track == track);
    totals.map(|total| (total.name, total.calls)).collect()
}

fn passes(_: &'static Headless) {
    let all: BTreeMap<_, _> = light::scenes::all().into_iter().collect();
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
        let view = &all[name];
        let mut settings = view.settings.clone();
        (settings.sampling.samples, settings.is_denoised) = (2, true);
        device.render(&view.scene, &view.seen(), &settings, LayerSet::COLOR).unwrap();

        let passes = calls(&profile, ProfileTrack::Device);
        let mut wanted: Vec<_> = wanted.iter().chain(&by_one_ray).chain(&["denoise"]).collect();
        wanted.sort();
        assert_eq!(passes.keys().collect::<Vec<_>>(), wanted, "{name}");
        assert!(passes.values().all(|count| *count > 0));
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
    let mut buffers = device.upload(&scene, &structures).unwrap();
    let colors = Some(NewColors::Rgba8(&[[9, 99, 199, 255]]));
    let update = SceneUpdate { colors, ..SceneUpdate::default() };
    scene.apply(&update).unwrap();
    device.update(&mut buffers, &scene, &update).unwrap();
    assert_eq!(calls(&profile, ProfileTrack::Device).get("recolor"), Some(&1));
}
