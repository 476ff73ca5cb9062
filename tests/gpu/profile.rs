//! Tests of profiles: what they hold, and that pictures do not depend on them.

use std::collections::BTreeMap;

use libtest_mimic::Trial;
use pinhole::gpu::{
    Headless, HeadlessOptions, PassClock, Profile, ProfileSpan, ProfileTrack, wgpu::Features,
};
use pinhole::scene::{NewColors, SceneUpdate};
use pinhole::{Colors, LayerSet, RenderSettings, Scene, View};

use crate::support::appearances::kinds;
use crate::{light, scenes, trial};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("profile::a_picture_does_not_depend_on_it", same_picture),
        trial("profile::every_pass_is_named_and_lies_within_the_render", passes),
        trial("profile::updates_of_colors_are_passes", recolored),
    ]
}

/// A device that fills in a profile, and the profile.
fn profiled(clock: PassClock) -> (Headless, Profile) {
    let profile = Profile::new(clock);
    let options = HeadlessOptions { profile: Some(profile.clone()), ..HeadlessOptions::default() };
    (Headless::open(&options).unwrap(), profile)
}

/// The clocks that can measure passes on this device.
fn clocks(headless: &Headless) -> Vec<PassClock> {
    let has_clock = headless.device().features().contains(Features::TIMESTAMP_QUERY);
    [PassClock::Host].into_iter().chain(has_clock.then_some(PassClock::Device)).collect()
}

fn same_picture(headless: &'static Headless) {
    for clock in clocks(headless) {
        let (other, profile) = profiled(clock);
        assert_eq!(profile.clock(), Some(clock));
        let check = |name: &str, scene: &Scene, view: &View<'_>, settings: &RenderSettings| {
            let [without, with] = [headless, &other]
                .map(|device| device.render(scene, view, settings, LayerSet::ALL).unwrap());
            assert_eq!(without, with, "{name}, {clock:?}");
        };
        for (name, view) in scenes::all() {
            check(name, &view.scene, &view.seen(), &view.settings);
        }
        for (name, mut view) in light::scenes::all() {
            view.settings.sampling.samples = 5;
            check(name, &view.scene, &view.seen(), &view.settings);
        }
    }
}

/// How often each pass ran, by its name.
fn calls(profile: &Profile) -> BTreeMap<&'static str, u64> {
    let of_device =
        profile.totals().into_iter().filter(|total| total.track == ProfileTrack::Device);
    of_device.map(|total| (total.name, total.calls)).collect()
}

fn passes(headless: &'static Headless) {
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
        let mut of_clocks = Vec::new();
        for clock in clocks(headless) {
            let (device, profile) = profiled(clock);
            let view = &all[name];
            let mut settings = view.settings.clone();
            (settings.sampling.samples, settings.is_denoised) = (2, true);
            device.render(&view.scene, &view.seen(), &settings, LayerSet::COLOR).unwrap();
            let end = profile.elapsed();

            let calls = calls(&profile);
            let mut wanted: Vec<_> = wanted.iter().chain(&by_one_ray).chain(&["denoise"]).collect();
            wanted.sort();
            assert_eq!(calls.keys().collect::<Vec<_>>(), wanted, "{name}, {clock:?}");
            assert!(calls.values().all(|count| *count > 0));
            let spans = profile.spans();
            assert_eq!(profile.dropped(), 0);
            let is_within = |span: &&ProfileSpan| span.start + span.duration <= end;
            // The zero of the device's clock is known only roughly.
            let outside = spans.iter().filter(|span| clock == PassClock::Host && !is_within(span));
            assert_eq!(outside.count(), 0, "{name}, {clock:?}");
            for phase in ["build", "upload", "create pipelines", "submit", "wait", "read back"] {
                let found = spans
                    .iter()
                    .any(|span| (span.name, span.track) == (phase, ProfileTrack::Host(0)));
                assert!(found, "{name}, {clock:?}: no phase {phase}");
            }
            of_clocks.push(calls);
        }
        // By either clock, the passes over samples ran as often, if no dispatch was divided.
        for calls in &of_clocks {
            for pass in ["start", "accumulate", "occlude"] {
                assert_eq!(calls.get(pass), of_clocks[0].get(pass), "{name}: {pass}");
            }
        }
    }
}

fn scene_of_rgba() -> Scene {
    let is_rgba = |scene: &Scene| matches!(scene.appearance().colors(), Colors::Rgba8(_));
    kinds().into_iter().map(|kind| kind.scene).find(is_rgba).unwrap()
}

fn recolored(headless: &'static Headless) {
    for clock in clocks(headless) {
        let (device, profile) = profiled(clock);
        let mut scene = scene_of_rgba();
        let plan = device.plan_accel(&scene, pinhole::accel::AccelChoice::Auto);
        let structures = plan.build(scene.spheres()).into();
        let mut buffers = device.upload(&scene, &structures).unwrap();
        let colors = Some(NewColors::Rgba8(&[[9, 99, 199, 255]]));
        let update = SceneUpdate { colors, ..SceneUpdate::default() };
        scene.apply(&update).unwrap();
        device.update(&mut buffers, &scene, &update).unwrap();
        assert_eq!(calls(&profile).get("recolor"), Some(&1), "{clock:?}");
    }
}
