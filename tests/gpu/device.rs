//! Choosing a device, and what happens when it fails.

use libtest_mimic::Trial;
use pinhole::gpu::{GpuError, Headless};
use pinhole::{LayerSet, Scene};

use crate::support::View;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("device::an_adapter_is_found_by_a_part_of_its_name", part_of_a_name),
        trial("device::an_unknown_name_lists_the_adapters", unknown_name),
        trial("device::a_destroyed_device_is_an_error", destroyed),
        trial("device::too_many_spheres_for_a_binding_are_an_error", too_many_spheres),
    ]
}

fn part_of_a_name(headless: &'static Headless) {
    let name = &headless.adapter_info().name;
    let part = name.split_whitespace().next().unwrap().to_uppercase();
    let found = Headless::open(Some(&part)).unwrap();
    assert_eq!(&found.adapter_info().name, name);
}

fn unknown_name(headless: &'static Headless) {
    match Headless::open(Some("no such adapter")) {
        Err(GpuError::UnknownAdapter { wanted, available }) => {
            assert_eq!(wanted, "no such adapter");
            assert!(available.contains(&headless.adapter_info().name));
        }
        other => panic!("{other:?}"),
    }
}

fn destroyed(_: &'static Headless) {
    let headless = Headless::open(None).unwrap();
    headless.device().destroy();
    let View { scene, camera, film, settings } = View::three_spheres();
    let result = headless.render(&scene, camera.as_ref(), &film, &settings, LayerSet::COLOR);
    assert!(matches!(result, Err(GpuError::DeviceLost { .. })), "{result:?}");
}

fn too_many_spheres(headless: &'static Headless) {
    let limit = headless.device().limits().max_storage_buffer_binding_size;
    let sphere = pinhole::Sphere::new([0.0; 3], 1.0, pinhole::LinearRgb::WHITE);
    let count = limit / 16 + 1;
    if count > 20_000_000 {
        // Only worth the memory where the limit is WebGPU's.
        return;
    }
    let scene = Scene::new(&vec![sphere; count as usize]).unwrap();
    let View { camera, film, settings, .. } = View::three_spheres();
    match headless.render(&scene, camera.as_ref(), &film, &settings, LayerSet::COLOR) {
        Err(GpuError::Limit { needed, limit: found, limit_name, .. }) => {
            assert_eq!((needed, found), (count * 16, limit));
            assert_eq!(limit_name, "max_storage_buffer_binding_size");
        }
        other => panic!("{other:?}"),
    }
}
