//! The cylinders and cones of scene files. Tables that are refused are in `tests/files/refused/scene_files.txt`.

use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::{Scene, SceneError};
use pinhole::{LinearRgb, RenderSettings, SphereArray};
use pinhole_data::load::Dataset;
use pinhole_figure::framing::{Union, around, swept};
use pinhole_figure::scene_file::{DataError, Settled};

use crate::scene_file::parse;

const SHAPES: &str = "[materials.gold]\nkind = 'conductor'\nroughness = 0.3\n\
    [[cones]]\nstart = [0, 0, 0]\nend = [0, 0, 2]\nradii = [0.5, 0]\ncaps = 'first'\ncolor = 'tomato'\n\
    [[cylinders]]\nstart = [1, 0, 0]\nend = [1, 0, 4]\nradius = 0.25\nmaterial = 'gold'\nopacity = 0.5\n\
    [[spheres]]\ncenter = [9, 0, 0]\nradius = 1\n\
    [[cylinders]]\nstart = [2, 0, 0]\nend = [2, 0, 4]\nradius = 1\ncaps = 'none'\n";

/// The ends of each cone, with its radii, which are negative where it is open.
fn cones(scene: &Scene) -> Vec<([f32; 3], f32, [f32; 3], f32)> {
    scene.cones().iter().map(|cone| (cone.start, cone.first_radius, cone.end, cone.second_radius)).collect()
}

#[test]
fn cylinders_come_behind_spheres_and_cones_behind_cylinders() {
    let file = parse(SHAPES);
    let scene = file.scene().unwrap();
    let expected = [
        ([1.0, 0.0, 0.0], 0.25, [1.0, 0.0, 4.0], 0.25),
        ([2.0, 0.0, 0.0], -1.0, [2.0, 0.0, 4.0], -1.0),
        ([0.0, 0.0, 0.0], 0.5, [0.0, 0.0, 2.0], -0.0),
    ];
    assert_eq!(cones(&scene), expected);
    assert_eq!((scene.len(), scene.shape_count()), (1, 4));
    assert_eq!(scene.color(3), LinearRgb::from_srgb8([255, 99, 71]));
    assert_eq!([scene.color(1), scene.color(2)], [scene.color(0); 2]);
    let gold = SurfaceProperties { material: Material::Conductor { roughness: 0.3 }, opacity: 0.5 };
    assert_eq!([0, 1, 2, 3].map(|id| scene.surface(id) == gold), [false, true, false, false]);
    let (camera, settings) = (file.camera_parameters(), &RenderSettings::studio());
    let text = file.settled(Settled { camera, settings, sky_image: None, data: None, cone_files: Vec::new() });
    assert_eq!(parse(&text).shapes(), file.shapes(), "{text}");
}

#[test]
fn cones_of_the_file_come_before_sticks_of_its_data() {
    let data = "data = 'a.npy'\nradius = 0.2\nbonds = { length = 3 }\ncolor = 'navy'\n";
    let file = parse(&format!("{data}{SHAPES}"));
    let of = |radii: [f64; 2]| {
        let spheres = vec![[5.0, 0.0, 0.0, radii[0]], [5.0, 0.0, 2.0, radii[1]]];
        file.data().unwrap().scene(Dataset::new(SphereArray::F64(spheres)), file.shapes())
    };
    let made = of([0.2, 0.2]).unwrap();
    assert_eq!((made.bonds, made.scene.len(), made.scene.cones().len()), (Some(1), 3, 4));
    let navy = LinearRgb::from_srgb8([0, 0, 128]);
    assert_eq!((0..7).filter(|id| made.scene.color(*id) == navy).collect::<Vec<_>>(), [1, 2, 6]);
    let Err(DataError::Scene(error)) = of([0.2, -1.0]) else { panic!("-1 is no radius") };
    assert!(file.at_shape(&error).message.starts_with("sphere 1 of a.npy: its radius"), "{error}");
}

#[test]
fn a_cone_that_vanishes_in_the_frame_has_a_place() {
    let far = "[[spheres]]\ncenter = [1e9, 0, 0]\nradius = 1\n[[spheres]]\ncenter = [-1e9, 0, 0]\nradius = 1\n\
               [[cylinders]]\nstart = [1e9, 0, 0]\nend = [1000000001, 0, 0]\nradius = 0.5\n";
    let error = parse(far).scene().unwrap_err();
    assert_eq!(error.line, 7);
    assert!(error.message.starts_with("cylinder 0: after rounding to f32"), "{error}");
    let own = SceneError::Invalid(String::new());
    assert_eq!(parse(far).at_shape(&own).line, 1);
}

/// A camera that shows several frames, or a scene that turns, shows the cones, too.
#[test]
fn cones_are_framed() {
    let scene = parse("[[cones]]\nstart = [0, 0, 0]\nend = [0, 0, 9]\nradii = [1, 0]\n").scene().unwrap();
    let reach = |framed: &Scene| framed.bounds().unwrap().max().to_array();
    let mut union = Union::default();
    union.add(&scene);
    let near = |[x, y, z]: [f64; 3], wanted: [f64; 3]| {
        assert!(
            (x - wanted[0]).abs() < 0.1 && (y - wanted[1]).abs() < 0.1 && (z - wanted[2]).abs() < 0.1,
            "{x} {y} {z}"
        );
    };
    near(reach(&union.scene().unwrap()), [1.0, 1.0, 9.0]);
    let center = scene.bounds().unwrap().center();
    let turned = swept(&scene, pinhole::glam::DVec3::X, center).unwrap();
    let half = 9.0 - center.z;
    near(reach(&turned), [1.0, half, center.z + half]);
    assert!(around(&scene).unwrap().bounds().unwrap().max().x > 4.0);
}
