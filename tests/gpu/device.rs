//! Choosing a device, and what happens when it fails.

use libtest_mimic::Trial;
use pinhole::LayerSet;
use pinhole::gpu::{GpuError, Headless, HeadlessOptions, wgpu};

use crate::support::View;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("device::an_adapter_is_found_by_a_part_of_its_name", part_of_a_name),
        trial("device::an_unknown_name_lists_the_adapters", unknown_name),
        trial("device::a_destroyed_device_is_an_error", destroyed),
        trial("device::a_fault_of_the_callers_does_not_outlive_it", callers_fault),
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
    let View { scene, camera, film, settings } = View::three_spheres();
    let result = headless.render(&scene, camera.as_ref(), &film, &settings, LayerSet::COLOR);
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
}

/// The device is lent out; what goes wrong there is not the next render's.
fn callers_fault(_: &'static Headless) {
    let headless = Headless::open(&HeadlessOptions::default()).unwrap();
    // No usage at all is invalid.
    let _ = headless.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("the caller's"),
        size: 16,
        usage: wgpu::BufferUsages::empty(),
        mapped_at_creation: false,
    });
    let View { scene, camera, film, settings } = View::three_spheres();
    headless.render(&scene, camera.as_ref(), &film, &settings, LayerSet::COLOR).unwrap();
}
