//! The sizes from which on errors are found in a recording; docs/verify.md has them as a table.

use pinhole::glam::DVec3;
use pinhole::image::NO_ID;
use pinhole::verify::{Outcome, Recording};
use pinhole::{Image, Scene, Sphere};

use crate::legal_device::{Habit, LegalDevice};
use crate::verify::{certify, legal_recording};

/// The layers of a picture.
struct Layers {
    color: Vec<[f32; 3]>,
    depth: Vec<f32>,
    normal: Vec<[f32; 3]>,
    id: Vec<u32>,
}

/// Changes the layers of each pixel.
fn change_layers(recording: &mut Recording, change: impl Fn(usize, &mut Layers)) {
    let image = &recording.image;
    let mut layers = Layers {
        color: image.color().to_vec(),
        depth: image.depth().unwrap().to_vec(),
        normal: image.normal().unwrap().to_vec(),
        id: image.id().unwrap().to_vec(),
    };
    (0..layers.id.len()).for_each(|index| change(index, &mut layers));
    let (size, Layers { color, depth, normal, id }) = ([image.width(), image.height()], layers);
    recording.image = Image::from_layers(size, color, depth, normal, id).unwrap();
}

/// The largest power of two of which a relative error is found somewhere in a picture.
fn least_found(spoil: impl Fn(&mut Recording, f32)) -> i32 {
    let (scene, recording) = legal_recording();
    let is_found = |power: &i32| {
        let mut spoilt = recording.clone();
        spoil(&mut spoilt, 2_f32.powi(-power));
        certify(&scene, &spoilt).outcome() == Outcome::Violated
    };
    (4..24).take_while(is_found).last().unwrap_or(0)
}

/// The table of docs/verify.md says these sizes.
#[test]
fn errors_are_found_from_the_documented_size_on() {
    let (scene, recording) = legal_recording();
    let of_radius = least_found(|spoilt, size| {
        let larger = (0..).zip(scene.spheres()).map(|(id, [x, y, z, radius])| {
            let center = scene.origin() + DVec3::from([*x, *y, *z].map(f64::from));
            let radius = f64::from(*radius) * (1.0 + f64::from(size));
            Sphere::new(center.to_array(), radius, scene.color(id))
        });
        let larger = Scene::new(&larger.collect::<Vec<_>>()).unwrap();
        let mut device = LegalDevice { habit: Habit::Nearest, random: fastrand::Rng::with_seed(0) };
        *spoilt = device.record(&larger, &recording);
    });
    let of_distance = least_found(|spoilt, size| {
        let depths: Vec<f32> = spoilt
            .pixels
            .iter_mut()
            .map(|pixel| {
                pixel.t *= if pixel.id == NO_ID { 1.0 } else { 1.0 + size };
                pixel.ray.map_or(f32::INFINITY, |ray| ray.distance + pixel.t)
            })
            .collect();
        change_layers(spoilt, |index, layers| {
            layers.depth[index] =
                if layers.id[index] == NO_ID { f32::INFINITY } else { depths[index] };
        });
    });
    let of_normal = least_found(|spoilt, size| {
        change_layers(spoilt, |index, layers| {
            let [x, y, z] = layers.normal[index];
            // Turned about the third axis, by about as much as `size`.
            layers.normal[index] = [x - size * y, y + size * x, z];
        });
    });
    let of_color = least_found(|spoilt, size| {
        change_layers(spoilt, |index, layers| {
            if layers.id[index] != NO_ID {
                layers.color[index] = layers.color[index].map(|c| c * (1.0 + size));
            }
        });
    });
    let found = [of_radius, of_distance, of_normal, of_color];
    assert!(found.iter().zip([17, 17, 15, 17]).all(|(found, said)| *found >= said), "{found:?}");
}
