//! Tests that each frame of a live picture agrees with the CPU reference, which has the same earlier frames.

use std::sync::Arc;

use libtest_mimic::Trial;
use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::cpu::Search;
use pinhole::gpu::{GpuError, Headless, LitState, LivePicture, LiveProgress, SceneBuffers, Wait, wgpu};
use pinhole::internals::{LiveReference, ShaderEdit};
use pinhole::{Film, View};

use super::lit::Show;
use crate::host_program::Host;
use crate::lit_scenes::sampled as named;
use crate::planted::planted;
use crate::support;
use crate::trial;

pub(super) fn trials() -> Vec<Trial> {
    vec![
        trial("host::live::moving_frames_are_those_of_the_reference", moving),
        trial("host::live::a_picture_at_rest_becomes_that_of_many_rays", at_rest),
        trial("host::live::faults_in_the_kernels_are_found", faults),
        trial("host::live::frames_that_are_lost_are_noticed", lost),
        trial("host::live::what_cannot_be_shown_is_refused", refused),
    ]
}

const STUDIOS: [&str; 7] = [
    "studio_key_and_fill",
    "studio_ambient_occlusion",
    "studio_near_occlusion",
    "studio_sphere_light",
    "studio_shadow_catcher",
    "studio_depth_cue",
    "studio_without_light",
];

/// Cameras around the scene of a view. `kind` is an index into the first elements of `kinds`.
fn camera(kind: usize, angle: f64, film: Film) -> Box<dyn Camera> {
    let eye = [7.0 * angle.sin() + 0.4, 1.5 + 0.3 * angle, 7.0 * angle.cos()];
    let pose = Pose::looking_at(eye, [0.0, -0.2, 0.3], [0.05, 1.0, 0.0]).unwrap();
    let pinhole = PinholeCamera::with_vertical_fov(pose, 0.6, film.aspect()).unwrap();
    match kind {
        0 => Box::new(pinhole),
        1 => Box::new(OrthographicCamera::new(pose, [2.6, 2.6 / film.aspect()]).unwrap()),
        _ => Box::new(ThinLensCamera::new(pinhole, 0.02, 7.0).unwrap()),
    }
}

/// A host for studios with the same film as this one.
fn show(studio: &str, edits: Vec<ShaderEdit>) -> Arc<Show> {
    let film = named(studio, 1).film;
    Arc::new(Show::edited([film.width(), film.height()], edits))
}

struct Stage {
    show: Arc<Show>,
    scene: SceneBuffers,
    view: support::View,
    reference: LiveReference,
}

impl Stage {
    fn new(name: &str, edits: Vec<ShaderEdit>) -> Self {
        Self::on(&show(name, edits), name)
    }

    /// A stage on a host that other stages may have used before.
    fn on(show: &Arc<Show>, name: &str) -> Self {
        let view = named(name, 1);
        let (show, scene) = (Arc::clone(show), show.scene(&view.scene));
        Self { show, scene, view, reference: LiveReference::default() }
    }

    fn picture(&self) -> Result<LivePicture, GpuError> {
        let Host { device, queue } = &self.show.host;
        let (seen, settings) = (self.view.seen(), &self.view.settings);
        self.show.layers.with(true, |targets| {
            let renderer = &self.show.renderer;
            LivePicture::new(renderer, device, queue, &self.scene, &seen, settings, targets).wait()
        })
    }

    fn record(&self, picture: &mut LivePicture, encoder: &mut wgpu::CommandEncoder) -> LiveProgress {
        let (renderer, queue) = (&self.show.renderer, &self.show.host.queue);
        picture.record(renderer, queue, encoder, &self.scene).unwrap()
    }

    /// Renders a frame with both, and returns the fraction of pixels that show another sphere, or whose
    /// colours differ by more than rounding.
    fn compare(&mut self, picture: &mut LivePicture, camera: &dyn Camera) -> f64 {
        let Host { device, queue } = &self.show.host;
        let view = View::new(camera, self.view.film);
        let settings = &self.view.settings;
        picture.set(&self.show.renderer, device, queue, &self.scene, &view, settings).wait().unwrap();
        let mut encoder = self.show.host.encoder();
        let progress = self.record(picture, &mut encoder);
        assert!(progress.rays > 0 && !progress.was_lost, "{progress:?}");
        self.show.host.submit(encoder);
        self.show.host.wait();
        let search = Search::from(&self.view.scene);
        let wanted = self.reference.frame(search, &view, settings).unwrap();
        let color: Vec<[f32; 4]> = self.show.host.read(&self.show.layers.color);
        let depth: Vec<f32> = self.show.host.read(&self.show.layers.depth);
        let id: Vec<u32> = self.show.host.read(&self.show.layers.id);
        let differs = |i: &usize| {
            let colors = wanted.color[*i].iter().chain([&wanted.alpha[*i]]);
            let is_far = colors.zip(color[*i]).any(|(a, b)| (a - f64::from(b)).abs() > 0.004);
            let wanted_depth = wanted.depth[*i].min(1e30);
            let off = (f64::from(depth[*i]) - wanted_depth).abs();
            is_far || off > 1e-4 * wanted_depth || id[*i] != wanted.id[*i]
        };
        (0..color.len()).filter(differs).count() as f64 / color.len() as f64
    }

    /// The largest fraction of pixels that differ in frames around the scene.
    fn worst(&mut self, kind: usize) -> f64 {
        let mut picture = self.picture().unwrap();
        let film = self.view.film;
        // The camera moves, rests, and moves again.
        let angles = [0.0, 0.03, 0.06, 0.09, 0.09, 0.09, 0.12, 0.4];
        let fractions = angles.map(|angle| self.compare(&mut picture, &*camera(kind, angle, film)));
        fractions.into_iter().fold(0.0, f64::max)
    }
}

/// The fraction of pixels that may differ: rays along edges, where f32 and f64 hit different spheres, and their
/// neighbours. One pixel in 1,728 differed in practice.
const FEW: f64 = 0.005;

fn moving(_: &'static Headless) {
    let show = show(STUDIOS[0], Vec::new());
    for name in STUDIOS {
        for kind in 0..3 {
            let worst = Stage::on(&show, name).worst(kind);
            assert!(worst <= FEW, "{name}, camera {kind}: {worst}");
        }
    }
}

/// The average over frames agrees with a headless studio that traces as many rays through the same points.
fn at_rest(headless: &'static Headless) {
    let stage = Stage::new("studio_near_occlusion", Vec::new());
    let mut picture = stage.picture().unwrap();
    for _ in 0..200 {
        let mut encoder = stage.show.host.encoder();
        stage.record(&mut picture, &mut encoder);
        stage.show.host.submit(encoder);
        stage.show.host.wait();
    }
    let color: Vec<[f32; 4]> = stage.show.host.read(&stage.show.layers.color);
    let mut view = named("studio_near_occlusion", 256);
    view.settings.sampling.filter = pinhole::PixelFilter::Box;
    let wanted = headless.render(&view.scene, &view.seen(), &view.settings, pinhole::LayerSet::COLOR).wait().unwrap();
    // Within a pixel of an edge the two differ: only one of them is smooth there.
    let close =
        color.iter().zip(wanted.color()).filter(|(found, wanted)| (0..3).all(|c| (found[c] - wanted[c]).abs() < 0.06));
    let part = close.count() as f64 / wanted.color().len() as f64;
    assert!(part > 0.8, "{part}");
}

fn faults(_: &'static Headless) {
    for fault in planted("live") {
        let studios = ["studio_near_occlusion", "studio_key_and_fill"];
        let show = show(studios[0], vec![fault.edit.clone()]);
        let worst = studios.map(|studio| Stage::on(&show, studio).worst(0));
        assert!(worst.iter().any(|worst| *worst > FEW), "{}: {worst:?}", fault.name);
    }
}

fn lost(_: &'static Headless) {
    let stage = Stage::new("studio_key_and_fill", Vec::new());
    let mut picture = stage.picture().unwrap();
    let submit = |encoder: wgpu::CommandEncoder| {
        stage.show.host.submit(encoder);
        stage.show.host.wait();
    };
    let mut encoder = stage.show.host.encoder();
    stage.record(&mut picture, &mut encoder);
    submit(encoder);
    let mut dropped = stage.show.host.encoder();
    assert!(!stage.record(&mut picture, &mut dropped).was_lost);
    drop(dropped);
    let mut encoder = stage.show.host.encoder();
    assert!(stage.record(&mut picture, &mut encoder).was_lost);
    submit(encoder);
    let mut encoder = stage.show.host.encoder();
    assert!(!stage.record(&mut picture, &mut encoder).was_lost);
    // The device is not asked whether it is done, so there is no room for a fourth recording.
    let mut encoders = vec![encoder];
    for _ in 0..2 {
        let mut encoder = stage.show.host.encoder();
        assert_eq!(stage.record(&mut picture, &mut encoder).state, LitState::Refining);
        encoders.push(encoder);
    }
    let mut encoder = stage.show.host.encoder();
    let waiting = stage.record(&mut picture, &mut encoder);
    assert_eq!((waiting.state, waiting.rays), (LitState::Waiting, 0));
}

fn refused(_: &'static Headless) {
    for (name, what) in [("path_matt_under_a_sky", "studio"), ("studio_opacity", "opaque")] {
        let refused = Stage::new(name, Vec::new()).picture().unwrap_err();
        assert!(matches!(refused, GpuError::NotLive { needs } if needs.contains(what)), "{refused}");
    }
    let mut stage = Stage::new("studio_key_and_fill", Vec::new());
    let mut picture = stage.picture().unwrap();
    stage.scene = stage.show.scene(&stage.view.scene);
    let mut encoder = stage.show.host.encoder();
    let (renderer, queue) = (&stage.show.renderer, &stage.show.host.queue);
    let refused = picture.record(renderer, queue, &mut encoder, &stage.scene).unwrap_err();
    assert_eq!(refused, GpuError::OtherScene);
}
