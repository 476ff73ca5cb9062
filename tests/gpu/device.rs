//! Tests of choosing a device, and of failures of devices.

use std::time::Duration;

use libtest_mimic::Trial;
use pinhole::accel::AccelChoice;
use pinhole::gpu::{Decision, GpuError, Headless, HeadlessOptions, Picture, Progress, wgpu};
use pinhole::{Film, LayerSet};

use crate::support::View;
use crate::trial;

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
    ]
}

fn open(adapter: &str) -> Result<Headless, GpuError> {
    Headless::open(&HeadlessOptions { adapter: Some(adapter.to_owned()), ..Default::default() })
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
    let headless = Headless::open(&HeadlessOptions::default()).unwrap();
    headless.device().destroy();
    let view = View::three_spheres();
    let result = headless.render(&view.scene, &view.seen(), &view.settings, LayerSet::COLOR);
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
}

/// An error that a caller causes on the device does not affect the next render.
fn callers_fault(_: &'static Headless) {
    let headless = Headless::open(&HeadlessOptions::default()).unwrap();
    // A buffer without any usage is invalid.
    let _ = headless.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("the caller's"),
        size: 16,
        usage: wgpu::BufferUsages::empty(),
        mapped_at_creation: false,
    });
    let view = View::three_spheres();
    headless.render(&view.scene, &view.seen(), &view.settings, LayerSet::COLOR).unwrap();
}

/// Renders a picture in several submissions. `watch` is called after each of them except the last.
fn render_watched(
    headless: &Headless,
    mut watch: impl FnMut(&Progress) -> Decision,
) -> Result<Picture, GpuError> {
    let View { scene, camera, settings, .. } = View::three_spheres();
    let film = Film::new(2400, 1800).unwrap();
    let accel = headless.plan_accel(&scene, AccelChoice::Auto).build(scene.spheres());
    let scene = headless.upload(&scene, &accel.into())?;
    headless.render_uploaded(
        &scene,
        &pinhole::View::new(camera.as_ref(), film),
        &settings,
        LayerSet::COLOR,
        &mut watch,
    )
}

fn lost_midway(_: &'static Headless) {
    let headless = Headless::open(&HeadlessOptions::default()).unwrap();
    let mut told = 0;
    let result = render_watched(&headless, |_| {
        told += 1;
        headless.device().destroy();
        Decision::GoOn
    });
    assert!(told > 0, "the picture is too small for more than one submission");
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
    // The device stays lost.
    let result = render_watched(&headless, |_: &_| Decision::GoOn);
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
}

fn too_slow(_: &'static Headless) {
    let timeout = Duration::ZERO;
    let options = HeadlessOptions { timeout, ..HeadlessOptions::default() };
    let headless = Headless::open(&options).unwrap();
    // The work of an upload may finish at once, but that of a picture does not.
    let result = render_watched(&headless, |_: &_| Decision::GoOn);
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
    let whole = render_watched(headless, |_: &_| Decision::GoOn).unwrap();
    assert_eq!(whole, render_watched(headless, |_: &_| Decision::GoOn).unwrap());
}

/// A picture takes at least twelve bytes of host memory for each pixel, which for the largest film is more than the
/// host can address.
fn no_memory(headless: &'static Headless) {
    let film = Film::new(Film::MAX_SIDE, Film::MAX_SIDE).unwrap();
    let view = View { film, ..View::three_spheres() };
    let result = headless.render(&view.scene, &view.seen(), &view.settings, LayerSet::COLOR);
    assert!(matches!(result, Err(GpuError::Image(_))), "{result:?}");
}
