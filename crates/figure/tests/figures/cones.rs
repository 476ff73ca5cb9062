//! The cylinders and cones of scene files. Tables that are refused are in `tests/files/refused/scene_files.txt`.

use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::tube::Tube;
use pinhole::scene::{Scene, SceneError};
use pinhole::{LinearRgb, RenderSettings, SphereArray};
use pinhole_data::load::{ConeSet, Dataset};
use pinhole_figure::framing::{Union, around, swept};
use pinhole_figure::scene_file::{ConeFile, DataError, Settled};

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
fn round_ends_are_spheres_behind_those_of_the_file() {
    let file = parse(
        "[[cylinders]]\nstart = [0, 0, 0]\nend = [0, 0, 4]\nradius = 0.5\nround = true\ncolor = 'navy'\n\
         [[spheres]]\ncenter = [9, 0, 0]\nradius = 1\n\
         [[cones]]\nstart = [5, 0, 0]\nend = [5, 0, 4]\nradii = [2, 0]\nround = true\n\
         [[cones]]\nstart = [0, 0, 9]\nend = [0, 0, 9.5]\nradii = [1, 2]\nround = true\nopacity = 0.5\n",
    );
    let scene = file.scene().unwrap();
    let spheres = [[9.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.5], [0.0, 0.0, 4.0, 0.5], [5.0, 0.0, 0.0, 2.0]];
    assert_eq!(scene.spheres(), [&spheres[..], &[[0.0, 0.0, 9.5, 2.0]]].concat());
    let side = 3.0_f32.sqrt();
    assert_eq!(
        cones(&scene),
        [([0.0; 3], -0.5, [0.0, 0.0, 4.0], -0.5), ([5.0, 0.0, 1.0], -side, [5.0, 0.0, 4.0], -0.0)]
    );
    let navy = LinearRgb::from_srgb8([0, 0, 128]);
    assert_eq!((0..7).filter(|id| scene.color(*id) == navy).collect::<Vec<_>>(), [1, 2, 5]);
    assert_eq!((0..7).filter(|id| scene.surface(*id).opacity < 1.0).collect::<Vec<_>>(), [4]);
    let (camera, settings) = (file.camera_parameters(), &RenderSettings::studio());
    let text = file.settled(Settled { camera, settings, sky_image: None, data: None, cone_files: Vec::new() });
    assert_eq!(parse(&text).shapes(), file.shapes(), "{text}");
}

#[test]
fn tubes_come_behind_cones_and_round_ends() {
    let file = parse(
        "[[tubes]]\npoints = [[0, 0, 0], [0, 0, 2], [0, 2, 2]]\nradii = [0.5, 0.2, 0.5]\ncolor = 'navy'\nopacity = 0.5\n\
         [[tubes]]\npoints = [[5, 0, 0], [6, 0, 0]]\nradius = 1\n\
         [[cylinders]]\nstart = [9, 0, 0]\nend = [9, 0, 4]\nradius = 0.5\nround = true\n",
    );
    let tube = Tube::through(&[[0.0, 0.0, 0.0, 0.5], [0.0, 0.0, 2.0, 0.2], [0.0, 2.0, 2.0, 0.5]]);
    let scene = file.scene().unwrap();
    let (spheres, sides) = (tube.spheres.len(), tube.sides.len());
    assert_eq!([scene.len(), scene.cones().len()], [2 + spheres + 2, 1 + sides + 1]);
    let f32s: Vec<[f32; 4]> = tube.spheres.iter().map(|sphere| sphere.map(|value| value as f32)).collect();
    assert_eq!(scene.spheres()[2..2 + spheres], f32s);
    let navy = LinearRgb::from_srgb8([0, 0, 128]);
    let of_tube = scene.len() as u32 + 1;
    assert_eq!((scene.color(2), scene.color(of_tube), scene.surface(of_tube).opacity), (navy, navy, 0.5));
    let (camera, settings) = (file.camera_parameters(), &RenderSettings::studio());
    let text = file.settled(Settled { camera, settings, sky_image: None, data: None, cone_files: Vec::new() });
    assert_eq!(parse(&text).shapes(), file.shapes(), "{text}");
}

/// A table of text with two rods.
const RODS: &str = "start_x,start_y,start_z,end_x,end_y,end_z,radius\n0,0,0,0,0,2,0.5\n3,0,0,3,0,2,0.25\n";

#[test]
fn a_table_may_name_a_file_of_many_shapes() {
    let text = "[[cylinders]]\nstart = [7, 0, 0]\nend = [7, 0, 1]\nradius = 1\n\
                [[cylinders]]\nfile = 'rods.csv'\nopacity = 0.5\ncaps = 'none'\n\
                [[cylinders]]\nfile = 'more.csv'\nround = true\n";
    let mut file = parse(text);
    assert_eq!(file.cone_files().map(|of| of.file.as_str()).collect::<Vec<_>>(), ["rods.csv", "more.csv"]);
    let open = file.scene().unwrap_err();
    assert_eq!((open.line, open.column), (6, 8));
    let colored =
        RODS.replace("radius\n", "radius,r,g,b\n").replace(".5\n", ".5,1,0,0\n").replace(".25\n", ".25,0,0,1\n");
    let read = |of: &ConeFile| {
        let text = if of.file == "rods.csv" { RODS } else { &colored };
        ConeSet::from_bytes(text.as_bytes(), &of.file, of.kind, of.radii).map_err(|error| error.to_string())
    };
    assert_eq!(file.read_cones(read), Ok(vec![]));
    let scene = file.scene().unwrap();
    assert_eq!((scene.len(), scene.cones().len(), file.shapes().cone_count()), (4, 5, 5));
    assert_eq!((4..9).filter(|id| scene.surface(*id).opacity < 1.0).collect::<Vec<_>>(), [5, 6]);
    let [red, blue] = [[255, 0, 0], [0, 0, 255]].map(LinearRgb::from_srgb8);
    let of = |color: LinearRgb| (0..9).filter(|id| scene.color(*id) == color).collect::<Vec<_>>();
    assert_eq!((of(red), of(blue)), (vec![0, 1, 7], vec![2, 3, 8]));
    let (camera, settings) = (file.camera_parameters(), &RenderSettings::studio());
    let cone_files = ["a.csv", "b.csv"].map(str::to_owned).to_vec();
    let written = parse(&file.settled(Settled { camera, settings, sky_image: None, data: None, cone_files }));
    assert_eq!(written.cone_files().map(|of| of.file.as_str()).collect::<Vec<_>>(), ["a.csv", "b.csv"]);

    let error = file.read_cones(|_| Err("rods.csv: wrong".to_owned())).unwrap_err();
    assert_eq!((error.line, error.message.as_str()), (6, "rods.csv: wrong"));
    let tip =
        "[[cones]]\nfile = 'tips.npy'\nradii = [1, 1]\nround = true\n[[spheres]]\ncenter = [1e9, 0, 0]\nradius = 1\n";
    let mut far = parse(&format!("{tip}[[spheres]]\ncenter = [-1e9, 0, 0]\nradius = 1\n").replace("round = true", ""));
    let row = "start_x,start_y,start_z,end_x,end_y,end_z\n0,0,0,0,0,1\n1e9,0,0,1000000001,0,0\n";
    far.read_cones(|of| {
        ConeSet::from_bytes(row.as_bytes(), "a.csv", of.kind, of.radii).map_err(|error| error.to_string())
    })
    .unwrap();
    let error = far.scene().unwrap_err();
    assert!(error.message.starts_with("tips.npy: row 1: after rounding to f32"), "{error}");
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
