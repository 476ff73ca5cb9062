//! Tests that lit pictures that accumulate in a host's encoders are the same as on a headless device, to the bit.

use libtest_mimic::Trial;
use pinhole::gpu::{
    ColorTarget, GpuError, Headless, LitPicture, LitProgress, LitRenderer, LitState, Recolor, Renderer,
    RendererOptions, SceneBuffers, Wait, wgpu,
};
use pinhole::image::Layer;
use pinhole::internals::ShaderEdit;
use pinhole::scene::{NewColors, SceneUpdate};
use pinhole::{Appearance, Colors, Image, LayerSet, RenderSettings, Scene};

use crate::host_program::{Host, Layers};
use crate::lit_scenes::{self, sampled as named};
use crate::support::View;
use crate::support::effort::share;
use crate::trial;

pub(super) fn trials() -> Vec<Trial> {
    vec![
        trial("host::lit::any_budget_makes_the_picture_of_a_headless_device", budgets),
        trial("host::lit::every_scene_in_one_recording", every_scene),
        trial("host::lit::new_views_light_and_data_begin_again", changes),
        trial("host::lit::what_changes_nothing_keeps_the_samples", same),
        trial("host::lit::recordings_that_are_lost_are_noticed", lost),
        trial("host::lit::recordings_of_one_submission_do_not_mix", together),
        trial("host::lit::a_scene_that_changed_is_refused", other_scene),
        trial("host::lit::what_cannot_be_recorded_is_refused", refused),
    ]
}

const LAYERS: LayerSet = LayerSet::COLOR.with(Layer::Alpha).with(Layer::Depth).with(Layer::Normal).with(Layer::Id);

pub(super) struct Show {
    pub(super) host: Host,
    pub(super) renderer: LitRenderer,
    pub(super) layers: Layers,
}

impl Show {
    fn new(size: [u32; 2]) -> Self {
        Self::edited(size, Vec::new())
    }

    pub(super) fn edited(size: [u32; 2], edits: Vec<ShaderEdit>) -> Self {
        let host = Host::new();
        let options =
            RendererOptions { color: ColorTarget::Linear32, data_layers: true, edits, ..RendererOptions::default() };
        let renderer = LitRenderer::new(Renderer::new(&host.device, &options).wait().unwrap());
        let layers = host.layers(size, wgpu::TextureFormat::Rgba32Float);
        Self { host, renderer, layers }
    }

    fn of(view: &View) -> Self {
        Self::new([view.film.width(), view.film.height()])
    }

    /// A host with the scene of a view, and a picture of it.
    fn ready(view: &View) -> (Self, SceneBuffers, LitPicture) {
        let show = Self::of(view);
        let scene = show.scene(&view.scene);
        let picture = show.picture(&scene, view).unwrap();
        (show, scene, picture)
    }

    pub(super) fn scene(&self, scene: &Scene) -> SceneBuffers {
        let (renderer, Host { device, queue }) = (self.renderer.renderer(), &self.host);
        SceneBuffers::for_studio(renderer, device, queue, scene).wait().unwrap()
    }

    fn picture(&self, scene: &SceneBuffers, view: &View) -> Result<LitPicture, GpuError> {
        let Host { device, queue } = &self.host;
        let (seen, settings) = (view.seen(), &view.settings);
        self.layers.with(true, |targets| {
            LitPicture::new(&self.renderer, device, queue, scene, &seen, settings, targets).wait()
        })
    }

    fn set(&self, picture: &mut LitPicture, scene: &SceneBuffers, view: &View) -> Result<bool, GpuError> {
        let Host { device, queue } = &self.host;
        picture.set(&self.renderer, device, queue, scene, &view.seen(), &view.settings).wait()
    }

    fn record(
        &self,
        picture: &mut LitPicture,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneBuffers,
        max_rays: u64,
    ) -> Result<LitProgress, GpuError> {
        picture.record(&self.renderer, &self.host.queue, encoder, scene, max_rays)
    }

    fn submit(&self, picture: &mut LitPicture, scene: &SceneBuffers, max_rays: u64) -> LitProgress {
        let mut encoder = self.host.encoder();
        let done = self.record(picture, &mut encoder, scene, max_rays).unwrap();
        self.host.submit(encoder);
        done
    }

    /// Records and submits until the picture is done. Returns the number of recordings with work.
    fn finish(&self, picture: &mut LitPicture, scene: &SceneBuffers, max_rays: u64) -> usize {
        let mut recordings = 0;
        loop {
            let done = self.submit(picture, scene, max_rays);
            assert!(done.rays <= max_rays && !done.was_lost, "{done:?}");
            match done.state {
                LitState::Done if done.rays == 0 => return recordings,
                LitState::Waiting => self.host.wait(),
                _ => recordings += 1,
            }
        }
    }

    /// Compares the textures with a picture of a headless device.
    fn assert_shows(&self, wanted: &Image, what: &str) {
        let color: Vec<[f32; 4]> = self.host.read(&self.layers.color);
        let pixels: Vec<[f32; 3]> = color.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect();
        let wrong = pixels.iter().zip(wanted.color()).filter(|(a, b)| a != b).count();
        assert_eq!(wrong, 0, "{what}: colours of {} pixels", pixels.len());
        assert!(color.iter().map(|p| &p[3]).eq(wanted.alpha().unwrap()), "{what}: alpha");
        // A texture has 1e30 for a miss.
        let depth: Vec<f32> = self.host.read(&self.layers.depth);
        let depth = depth.into_iter().map(|d| if d >= 1e30 { f32::INFINITY } else { d });
        assert!(depth.eq(wanted.depth().unwrap().iter().copied()), "{what}: depth");
        assert!(self.host.read::<u32>(&self.layers.id) == wanted.id().unwrap(), "{what}: id");
    }
}

fn budgets(headless: &'static Headless) {
    for name in ["studio_ambient_occlusion", "studio_opacity", "path_lobes_and_metals"] {
        let view = named(name, 7);
        let wanted = view.picture(headless, LAYERS);
        let show = Show::of(&view);
        let scene = show.scene(&view.scene);
        // The smallest part of a sample has 34 rays in each of 64 invocations.
        for max_rays in [64 * 40, 64 * 40 + 17, 5_000, 50_000, u64::MAX] {
            let mut picture = show.picture(&scene, &view).unwrap();
            let recordings = show.finish(&mut picture, &scene, max_rays);
            assert!(recordings > 1 || max_rays == u64::MAX, "{name} {max_rays}");
            show.assert_shows(&wanted, &format!("{name}, {max_rays} rays at a time"));
        }
    }
}

fn every_scene(headless: &'static Headless) {
    // All scenes have the same film.
    let show = Show::of(&named("path_glass", 3));
    for (name, mut view) in share(lit_scenes::all()) {
        view.settings.sampling.samples = 3;
        view.settings.is_transparent = true;
        let scene = show.scene(&view.scene);
        let mut picture = show.picture(&scene, &view).unwrap();
        show.finish(&mut picture, &scene, u64::MAX);
        show.assert_shows(&view.picture(headless, LAYERS), &name);
    }
}

/// Tests that every change begins again, and that earlier samples leave no trace.
fn changes(headless: &'static Headless) {
    let view = named("studio_ambient_occlusion", 4);
    let (show, scene, mut picture) = Show::ready(&view);
    let changed = |change: &dyn Fn(&mut View)| {
        let mut view = named("studio_ambient_occlusion", 4);
        change(&mut view);
        view
    };
    let others = [
        named("studio_key_and_fill", 4),
        named("path_matt_under_a_sky", 4),
        changed(&|view| view.settings.lights.push(view.settings.lights[0])),
        changed(&|view| view.settings.is_transparent = true),
        changed(&|view| view.settings.sampling.seed += 1),
        changed(&|view| view.camera = nearer_camera(view)),
    ];
    for (number, other) in others.iter().enumerate() {
        show.set(&mut picture, &scene, &view).unwrap();
        // The change is in the middle of a picture.
        show.submit(&mut picture, &scene, 60_000);
        assert!(show.set(&mut picture, &scene, other).unwrap(), "change {number}");
        show.host.wait();
        show.finish(&mut picture, &scene, 60_000);
        show.assert_shows(&other.picture(headless, LAYERS), &format!("change {number}"));
    }
}

fn nearer_camera(view: &View) -> Box<dyn pinhole::camera::Camera> {
    let pose = pinhole::camera::Pose::looking_at([0.5, 1.5, 6.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let aspect = view.film.aspect();
    Box::new(pinhole::camera::PinholeCamera::with_vertical_fov(pose, 0.6, aspect).unwrap())
}

fn same(headless: &'static Headless) {
    let mut view = named("path_lobes_and_metals", 2);
    let (show, scene, mut picture) = Show::ready(&view);
    show.finish(&mut picture, &scene, u64::MAX);
    assert!(!show.set(&mut picture, &scene, &view).unwrap());
    assert_eq!(show.finish(&mut picture, &scene, u64::MAX), 0, "nothing is left to do");
    // More samples continue the picture.
    for samples in [4, 9] {
        view.settings.sampling.samples = samples;
        show.set(&mut picture, &scene, &view).unwrap();
        show.finish(&mut picture, &scene, u64::MAX);
        show.assert_shows(&view.picture(headless, LAYERS), &format!("{samples} samples"));
    }
}

fn lost(headless: &'static Headless) {
    let view = named("studio_ambient_occlusion", 6);
    let wanted = view.picture(headless, LAYERS);
    let (show, scene, _) = Show::ready(&view);
    let finish = |mut picture: LitPicture, what: &str| {
        show.host.wait();
        let noticed = show.submit(&mut picture, &scene, 20_000);
        assert!(noticed.was_lost, "{what}: {noticed:?}");
        show.finish(&mut picture, &scene, 20_000);
        show.assert_shows(&wanted, what);
    };
    let begin = || {
        let mut picture = show.picture(&scene, &view).unwrap();
        show.submit(&mut picture, &scene, 20_000);
        picture
    };
    let recorded = |picture: &mut LitPicture| {
        let mut encoder = show.host.encoder();
        show.record(picture, &mut encoder, &scene, 20_000).unwrap();
        encoder.finish()
    };

    let mut picture = begin();
    drop(recorded(&mut picture));
    finish(picture, "a recording that is dropped");

    let mut picture = begin();
    let [second, third] = [(); 2].map(|()| recorded(&mut picture));
    show.host.queue.submit([third]);
    show.host.queue.submit([second]);
    finish(picture, "recordings that are exchanged");

    // The recording that was left out is submitted after the picture has begun again.
    let mut picture = begin();
    let late = recorded(&mut picture);
    show.host.queue.submit([recorded(&mut picture)]);
    show.host.wait();
    assert!(show.submit(&mut picture, &scene, 20_000).was_lost);
    show.host.queue.submit([late]);
    finish(picture, "a recording that comes late");
}

fn together(headless: &'static Headless) {
    let view = named("path_lobes_and_metals", 6);
    let (show, scene, mut picture) = Show::ready(&view);
    loop {
        let mut states = Vec::new();
        let commands = [(); 2].map(|()| {
            let mut encoder = show.host.encoder();
            let done = show.record(&mut picture, &mut encoder, &scene, 100_000).unwrap();
            assert!(!done.was_lost);
            states.push(done.state);
            encoder.finish()
        });
        show.host.queue.submit(commands);
        show.host.wait();
        if states[1] == LitState::Done {
            break;
        }
    }
    show.assert_shows(&view.picture(headless, LAYERS), "two recordings in each submission");
}

fn other_scene(headless: &'static Headless) {
    let mut view = named("studio_ambient_occlusion", 3);
    let spheres = pinhole::SphereArray::F32(view.scene.spheres().to_vec());
    let count = view.scene.len();
    let colors = Appearance::new(Colors::Rgba8(vec![[9, 90, 200, 255]; count]));
    view.scene = Scene::from_parts(spheres, colors).unwrap();
    let show = Show::of(&view);
    let mut scene = show.scene(&view.scene);
    let mut picture = show.picture(&scene, &view).unwrap();
    show.finish(&mut picture, &scene, u64::MAX);

    let recolor = Recolor::new(&show.host.device).wait().unwrap();
    let new = vec![[200, 40, 9, 255]; count];
    let update = SceneUpdate { first: 0, colors: Some(NewColors::Rgba8(&new)), ..SceneUpdate::default() };
    view.scene.apply(&update).unwrap();
    let mut encoder = show.host.encoder();
    let Host { device, queue } = &show.host;
    recolor.record(device, queue, &mut encoder, &mut scene, &view.scene, &update).wait().unwrap();
    let refused = show.record(&mut picture, &mut encoder, &scene, u64::MAX).unwrap_err();
    assert_eq!(refused, GpuError::OtherScene);
    queue.submit([encoder.finish()]);
    assert!(show.set(&mut picture, &scene, &view).unwrap());
    show.finish(&mut picture, &scene, u64::MAX);
    show.assert_shows(&view.picture(headless, LAYERS), "other colours");

    let moved = show.scene(&view.scene);
    scene.replace(moved);
    let mut encoder = show.host.encoder();
    let refused = show.record(&mut picture, &mut encoder, &scene, u64::MAX).unwrap_err();
    assert_eq!(refused, GpuError::OtherScene);
}

fn refused(_: &'static Headless) {
    let view = named("studio_ambient_occlusion", 3);
    let (show, scene, mut picture) = Show::ready(&view);
    let mut encoder = show.host.encoder();
    let few = show.record(&mut picture, &mut encoder, &scene, 63).unwrap_err();
    assert_eq!(few, GpuError::Budget { needed: 64, given: 63 });
    let primary = View { settings: RenderSettings::default(), ..named("studio_key_and_fill", 1) };
    assert_eq!(show.picture(&scene, &primary).unwrap_err(), GpuError::NotLit);
    let small = Show::new([20, 20]);
    let refused = small.picture(&small.scene(&view.scene), &view).unwrap_err();
    assert!(matches!(refused, GpuError::Target { layer: "color", .. }), "{refused}");
    let clear = named("studio_opacity", 3);
    let Host { device, queue } = &show.host;
    let without = SceneBuffers::new(show.renderer.renderer(), device, queue, &clear.scene).wait().unwrap();
    assert_eq!(show.picture(&without, &clear).unwrap_err(), GpuError::NoOccluders);
}
