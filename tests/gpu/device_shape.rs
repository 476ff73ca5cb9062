//! Tests that pictures do not depend on what is chosen by the type of device: the order of rows, and the sizes of tiles
//! and submissions.

use libtest_mimic::Trial;
use pinhole::gpu::wgpu::DeviceType;
use pinhole::gpu::{Headless, HeadlessOptions};
use pinhole::{Film, LayerSet};

use crate::support::View;
use crate::{light, scenes, trial};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("device_shape::small_pictures_are_the_same_as_for_every_type_of_device", small),
        trial("device_shape::a_picture_of_other_tiles_is_the_same", large),
        trial("device_shape::a_lit_picture_of_other_tiles_is_the_same", large_and_lit),
    ]
}

/// A device that is treated as one of this type.
fn treated_as(device_type: DeviceType) -> Headless {
    let options = HeadlessOptions { device_type: Some(device_type), ..HeadlessOptions::default() };
    let headless = Headless::open(&options).unwrap();
    assert_eq!(headless.adapter_info().device_type, device_type);
    headless
}

fn small(_: &'static Headless) {
    let types = [DeviceType::Cpu, DeviceType::IntegratedGpu, DeviceType::DiscreteGpu];
    let [software, others @ ..] = types.map(treated_as);
    for (name, view) in scenes::all() {
        let picture = |device: &Headless| {
            device.render(&view.scene, &view.seen(), &view.settings, LayerSet::ALL).unwrap()
        };
        let expected = picture(&software);
        for other in &others {
            assert_eq!(picture(other), expected, "{name}");
        }
    }
    for (name, mut view) in light::scenes::all() {
        view.settings.sampling.samples = 6;
        let picture = |device: &Headless| {
            device.render(&view.scene, &view.seen(), &view.settings, LayerSet::ALL).unwrap()
        };
        let expected = picture(&software);
        for other in &others {
            assert_eq!(picture(other), expected, "{name}");
        }
    }
}

fn large(_: &'static Headless) {
    let mut view = View::three_spheres();
    view.film = Film::new(1400, 1300).unwrap();
    let pictures = [DeviceType::Cpu, DeviceType::DiscreteGpu].map(|device_type| {
        let device = treated_as(device_type);
        let choice = pinhole::accel::AccelChoice::Auto;
        let (scene, settings) = (&view.scene, &view.settings);
        let plan = device.plan(scene, &view.seen(), settings, LayerSet::DATA, choice, 0);
        let picture = device.render(scene, &view.seen(), settings, LayerSet::DATA).unwrap();
        (plan.tile_count, picture)
    });
    let [(software, expected), (gpu, picture)] = pictures;
    assert_eq!((software, gpu), (2, 1));
    assert!(picture == expected);
}

fn large_and_lit(_: &'static Headless) {
    let all = light::scenes::all();
    for wanted in ["path_lobes_and_metals", "studio_opacity"] {
        let (_, view) = all.iter().find(|(name, _)| *name == wanted).unwrap();
        let seen = pinhole::View::new(view.camera.as_ref(), Film::new(700, 500).unwrap());
        let mut settings = view.settings.clone();
        settings.sampling.samples = 5;
        let pictures = [DeviceType::Cpu, DeviceType::DiscreteGpu].map(|device_type| {
            let device = treated_as(device_type);
            let choice = pinhole::accel::AccelChoice::Auto;
            let plan = device.plan(&view.scene, &seen, &settings, LayerSet::COLOR, choice, 0);
            let picture = device.render(&view.scene, &seen, &settings, LayerSet::COLOR).unwrap();
            (plan.tile_count, picture)
        });
        let [(software, expected), (gpu, picture)] = pictures;
        assert!(gpu < software, "{wanted}: {gpu} tiles instead of {software}");
        assert!(picture == expected, "{wanted}");
    }
}
