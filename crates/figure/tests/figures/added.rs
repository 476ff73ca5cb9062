//! Bonds and the edges of cells: which of them exist, where they are, and their appearance.

use pinhole::glam::DVec3;
use pinhole::scene::ConeInFrame;
use pinhole::scene::material::SurfaceProperties;
use pinhole::{Scene, SphereArray};
use pinhole_data::added::{Additions, BondLength, Bonds, CellEdges};
use pinhole_data::load::{self, Dataset, Options};
use pinhole_figure::color_by::{ColorBy, Mapping};
use pinhole_figure::scene_file::{Data, DataError, DataScene, OwnShapes, SceneFile};

fn read(text: &str) -> Dataset {
    load::from_bytes(text.as_bytes(), "a.xyz", &Options::default()).unwrap()
}

/// Two water molecules with hydrogens that are close to each other.
const WATER: &str = "6\n\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\nH 1.7 0 0\nO 2.6 0 0\nH 2.6 0.96 0\n";

fn bonds() -> Additions {
    Additions { bonds: Some(Bonds::default()), ..Additions::default() }
}

fn made(loaded: Dataset, additions: &Additions) -> Result<DataScene, DataError> {
    Data { additions: additions.clone(), ..Data::of_file("a.xyz") }.scene(loaded, &OwnShapes::default())
}

fn scene(loaded: Dataset, additions: &Additions) -> (Scene, usize) {
    let made = made(loaded, additions).unwrap();
    (made.scene, made.bonds.unwrap_or_default())
}

fn center(sphere: &[f32; 4]) -> DVec3 {
    DVec3::new(sphere[0].into(), sphere[1].into(), sphere[2].into())
}

/// The ends of a cone, and its radii.
fn ends(cone: &ConeInFrame) -> ([DVec3; 2], [f32; 2]) {
    let place = |[x, y, z]: [f32; 3]| DVec3::new(x.into(), y.into(), z.into());
    ([cone.start, cone.end].map(place), [cone.first_radius, cone.second_radius])
}

#[test]
fn oxygen_is_bonded_to_its_hydrogens_and_hydrogens_are_not() {
    let (scene, bonds) = scene(read(WATER), &bonds());
    assert_eq!((bonds, scene.len(), scene.added()), (4, 6, 0));
    // Atoms have 0.25 of Alvarez' van der Waals radii.
    let atoms = scene.spheres();
    assert!((atoms[0][3] - 0.375).abs() < 1e-6 && (atoms[1][3] - 0.3).abs() < 1e-6);
    // Each half of a bond has the colour of its atom.
    assert_eq!(scene.cones().len(), 8);
    let red = scene.color(0);
    for (index, stick) in (6_u32..).zip(scene.cones()) {
        let ([start, end], radii) = ends(stick);
        let near = |atom: &[f32; 4]| center(atom).distance(0.5 * (start + end));
        let nearest = (0..6).min_by(|a, b| near(&atoms[*a as usize]).total_cmp(&near(&atoms[*b as usize]))).unwrap();
        assert_eq!(scene.color(index), scene.color(nearest), "{stick:?}");
        assert_eq!(scene.color(index) == red, nearest == 0 || nearest == 4);
        assert!(radii.iter().all(|radius| (radius - 0.45 * 0.3).abs() < 1e-6));
    }
    // The halves meet in the middle. Each begins in its ball, deeper than where it leaves it.
    let [([start, middle], _), ([other, end], _)] = [0, 1].map(|index| ends(&scene.cones()[index]));
    assert_eq!((middle, other), (0.5 * (center(&atoms[0]) + center(&atoms[1])).as_vec3().as_dvec3(), middle));
    let radius = 0.45 * 0.3;
    for (at, ball, radius_of_ball) in [(start, &atoms[0], 0.375), (end, &atoms[1], 0.3_f64)] {
        let depth = (radius_of_ball * radius_of_ball - radius * radius).sqrt() - at.distance(center(ball));
        assert!((depth - radius).abs() < 1e-5, "{depth}");
    }
}

#[test]
fn a_bond_of_two_like_atoms_is_one_cylinder() {
    let text = "3\n\nC 0 0 0\nC 1.5 0 0\nO 1.5 1.4 0\n";
    let (plain, bonds) = scene(read(text), &self::bonds());
    assert_eq!((bonds, plain.cones().len(), plain.shape_count()), (2, 3, 6));
    assert_eq!((plain.color(3), plain.color(5)), (plain.color(0), plain.color(2)));
    let mut loaded = read(text);
    loaded.opacities = Some(vec![1.0, 0.2, 1.0]);
    assert_eq!(scene(loaded, &self::bonds()).0.cones().len(), 4);
    // Atoms in one place have no bond.
    let (same, bonds) = scene(read("2\n\nC 0 0 0\nC 0 0 0\n"), &self::bonds());
    assert_eq!((bonds, same.cones().len()), (0, 0));
}

#[test]
fn bonds_of_shining_spheres_do_not_shine() {
    let data = "data = 'a.xyz'\nbonds = true\n[materials.lamp]\nkind = 'emissive'\nstrength = 3\n\
                [elements.O]\nmaterial = 'lamp'\nopacity = 0.5\n";
    let file = SceneFile::parse(data).unwrap();
    let made = file.data().unwrap().scene(read(WATER), &OwnShapes::default()).unwrap();
    assert!(made.notes.iter().any(|note| note == "bonds of spheres that emit light are drawn without light"));
    let scene = made.scene;
    assert_eq!(scene.color(6), scene.color(0));
    let matt = SurfaceProperties { opacity: 0.5, ..SurfaceProperties::default() };
    assert_eq!([scene.surface(6), scene.surface(7)], [matt, scene.surface(1)]);
}

#[test]
fn the_user_chooses_lengths_and_radii() {
    let of = |length: BondLength| Additions { bonds: Some(Bonds::new(length)), ..bonds() };
    // Any pair closer than the length is bonded, also the two hydrogens that are 0.74 apart.
    assert_eq!(scene(read(WATER), &of(BondLength::Below(1.0))).1, 5);
    assert_eq!(scene(read(WATER), &of(BondLength::Covalent(0.9))).1, 0);
    // An O and an H of different molecules, 1.7 apart, are closer than 1.8 times 0.97.
    assert_eq!(scene(read(WATER), &of(BondLength::Covalent(1.8))).1, 6);
    let (kept, _) = scene(read(WATER), &Additions { keeps_radii: true, ..bonds() });
    assert!((kept.spheres()[0][3] - 1.5).abs() < 1e-6);
    // Sticks inside the atoms' spheres are not drawn.
    assert_eq!(kept.cones(), []);
    for bad in [BondLength::Below(f64::NAN), BondLength::Covalent(0.0), BondLength::Below(-1.0)] {
        let Err(DataError::Add(error)) = made(read(WATER), &of(bad)) else { panic!("{bad:?}") };
        assert!(error.to_string().ends_with("it must be finite and greater than 0"), "{error}");
    }
    let far = of(BondLength::Below(f64::MAX));
    assert_eq!(scene(read(WATER), &far).1, 15);
}

#[test]
fn colours_by_data_and_opacities_reach_the_sticks() {
    let mapping = Mapping { color: Some(ColorBy::column("index")), ..Mapping::default() };
    let mut loaded = read(WATER);
    loaded.opacities = Some(vec![1.0, 0.2, 1.0, 1.0, 1.0, 1.0]);
    let additions = Additions { cell: Some(CellEdges::default()), ..bonds() };
    loaded.cell = Some([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]]);
    let data = Data { mapping, ..Data::of_file("a.xyz") };
    let plain = data.scene(loaded.clone(), &OwnShapes::default()).unwrap();
    let made = Data { additions, ..data }.scene(loaded, &OwnShapes::default()).unwrap();
    // The range, the legend and the appearance of the atoms are the same as without additions.
    assert_eq!(made.color_key, plain.color_key);
    assert_eq!(made.notes[..plain.notes.len()], plain.notes);
    let (scene, plain) = (made.scene, plain.scene);
    for id in 0..6 {
        assert_eq!((scene.color(id), scene.surface(id)), (plain.color(id), plain.surface(id)));
    }
    assert_eq!((scene.len(), scene.added()), (14, 8));
    let sticks: Vec<u32> = (14..scene.shape_count() as u32).filter(|id| scene.color(*id) == scene.color(1)).collect();
    assert_eq!(sticks.len(), 1);
    assert!(sticks.iter().all(|id| scene.surface(*id) == scene.surface(1)));
    assert!((scene.surface(1).opacity - 0.2).abs() < 1e-6);
    let last = scene.shape_count() as u32 - 1;
    assert_eq!((scene.surface(last).opacity, scene.color(last)), (1.0, scene.color(13)));
}

/// A chain of carbon atoms across the borders of its cell: the bond across is half a stick at both ends.
#[test]
fn a_bond_across_the_cell_is_two_halves() {
    let chain = |head: &str, first: &str| format!("3\n{head}\nC {first} 0 0\nC 2 0 0\nC 3.5 0 0\n");
    let (head, none) = ("Lattice=\"4.5 0 0 0 9 0 0 0 9\"", "Lattice=\"4.5 0 0 0 9 0 0 0 9\" pbc=\"F T T\"");
    let (across, bonds) = scene(read(&chain(head, "0.5")), &self::bonds());
    assert_eq!((bonds, across.cones().len()), (3, 4));
    let middles = [2, 3].map(|index| ends(&across.cones()[index]).0[1]);
    for (middle, wanted) in middles.into_iter().zip([-0.25, 4.25]) {
        let middle = middle + across.origin();
        assert!(middle.distance(DVec3::new(wanted, 0.0, 0.0)) < 1e-5, "{middle}");
    }
    assert_eq!(scene(read(&chain(none, "0.5")), &self::bonds()).1, 2);
    // An atom that has left the cell is bonded as at its place in the cell, and beside it by a whole stick.
    let (left, bonds) = scene(read(&chain(head, "5")), &self::bonds());
    assert_eq!((bonds, left.cones().len()), (3, 4));
    let length = |cone| ends(cone).0[0].distance(ends(cone).0[1]);
    assert_eq!(left.cones().iter().filter(|cone| length(cone) > 0.75).count(), 2);
}

const FORCES: &str = "4\nProperties=species:S:1:pos:R:3:forces:R:3\n\
                      O 0 0 0 0 0 4\nO 2 0 0 0 0 -2\nO 4 0 0 0 0 0\nO 6 0 0 nan 0 0\n";

fn arrows(text: &str) -> Result<DataScene, DataError> {
    let file = SceneFile::parse(&format!("data = 'a.xyz'\n{text}")).unwrap();
    file.data().unwrap().scene(read(FORCES), &OwnShapes::default())
}

#[test]
fn arrows_show_vectors() {
    let made = arrows("arrows = 'forces'").unwrap();
    // Three quarters of a vector's length 4 are 1.5 times the distance 2. Spheres are smaller, as with bonds.
    let key = made.arrow_key.unwrap();
    assert_eq!((key.name.as_str(), key.scale), ("forces", 0.75));
    assert_eq!(made.notes, ["1 of 4 spheres have no arrow: their forces is not a number"]);
    assert!((made.scene.spheres()[0][3] - 0.375).abs() < 1e-6);
    let cones: Vec<_> = made.scene.cones().iter().map(ends).collect();
    let place = |z: f64, x: f64| DVec3::new(x, 0.0, z) - made.scene.origin();
    let near = |found: DVec3, wanted: DVec3| assert!(found.distance(wanted) < 1e-5, "{found} {wanted}");
    assert_eq!(cones.len(), 4);
    near(cones[0].0[0], place(0.0, 0.0));
    near(cones[0].0[1], cones[1].0[0]);
    near(cones[1].0[1], place(3.0, 0.0));
    near(cones[3].0[1], place(-1.5, 2.0));
    assert!((cones[0].1[0] - 0.16).abs() < 1e-6 && cones[1].1[1] == 0.0);
    // An arrow that is shorter than a head has only a smaller head.
    let made = arrows("arrows = { vector = '|Forces|', scale = 0.1, at = 'middle', color = 'red', min = 3 }").unwrap();
    let cones: Vec<_> = made.scene.cones().iter().map(ends).collect();
    assert_eq!(cones.len(), 1);
    near(cones[0].0[0], DVec3::new(0.0, 0.0, -0.2) - made.scene.origin());
    assert!((cones[0].1[0] / (0.4 * 2.2 / 5.0) - 1.0).abs() < 1e-5);
    assert_eq!(made.scene.color(4).to_srgb8(), [255, 0, 0]);
    let none = arrows("select = 'x > 3 and x < 5'\narrows = 'forces'").unwrap();
    assert_eq!(none.notes, ["there are no arrows: no sphere has a forces that is longer than 0"]);
    assert!(none.arrow_key.is_none() && none.scene.cones().is_empty());
}

#[test]
fn arrows_that_cannot_be_drawn_are_refused() {
    let refused = |text: &str| arrows(text).unwrap_err().to_string();
    assert_eq!(
        refused("arrows = 'force'"),
        "`arrows`: there is no vector `force`, with the columns force.x, force.y and force.z; the vectors are forces"
    );
    let long = refused("arrows = { vector = 'forces', scale = 1e9 }");
    assert!(long.starts_with("`arrows`: the arrow of sphere 0 cannot be drawn: its length"), "{long}");
    for bad in
        ["3", "{ scale = 2 }", "{ vector = 'f', scale = 0 }", "{ vector = 'f', at = 'end' }", "{ vector = 'f', a = 1 }"]
    {
        assert!(SceneFile::parse(&format!("data = 'a.xyz'\narrows = {bad}")).is_err(), "{bad}");
    }
}

#[test]
fn edges_of_a_tilted_cell_start_at_its_origin() {
    let text = "1\nLattice=\"4 0 0 1 3 0 0 1 2\" Origin=\"10 20 30\"\nC 11 21 31\n";
    let loaded = read(text);
    assert_eq!(loaded.cell_origin, [10.0, 20.0, 30.0]);
    let edges = Additions { cell: Some(CellEdges::default()), ..Additions::default() };
    let (scene, bonds) = scene(loaded, &edges);
    assert_eq!((bonds, scene.len(), scene.added(), scene.cones().len()), (0, 9, 8, 12));
    let origin = DVec3::new(10.0, 20.0, 30.0);
    let [a, b, c] = [[4.0, 0.0, 0.0], [1.0, 3.0, 0.0], [0.0, 1.0, 2.0]].map(DVec3::from);
    let radius = (a + b + c).length() / 600.0;
    // The spheres are the eight corners, and each edge joins two corners that differ along one axis.
    let inverse = pinhole::glam::DMat3::from_cols(a, b, c).inverse();
    let corner = |place: DVec3| {
        let fractions = inverse * (scene.origin() + place - origin);
        assert!(fractions.distance(fractions.round()) < 1e-5, "{fractions}");
        fractions.round().to_array().map(|f| f as i32)
    };
    let mut corners: Vec<_> = scene.spheres()[1..].iter().map(|sphere| corner(center(sphere))).collect();
    assert!(scene.spheres()[1..].iter().all(|sphere| (f64::from(sphere[3]) - radius).abs() < 1e-6));
    corners.sort_unstable();
    corners.dedup();
    assert_eq!((corners.len(), corners[0], corners[7]), (8, [0; 3], [1; 3]));
    let mut edges: Vec<_> = scene.cones().iter().map(|edge| ends(edge).0.map(corner)).collect();
    edges.sort_unstable();
    edges.dedup();
    assert_eq!(edges.len(), 12);
    for [start, end] in edges {
        assert_eq!((0..3).map(|axis| (end[axis] - start[axis]).abs()).sum::<i32>(), 1);
    }
    // The mean radius, which a style uses, is that of the data.
    assert!((scene.subject().mean_radius().unwrap() - 1.77).abs() < 1e-6);
    let bounds = scene.bounds().unwrap();
    assert!(bounds.max().cmpge(origin + a + b + c).all());
}

#[test]
fn what_is_missing_is_an_error() {
    let error = |loaded: Dataset, additions: &Additions| made(loaded, additions).unwrap_err().to_string();
    let edges = |width: Option<f64>| Additions {
        cell: Some(width.map_or_else(CellEdges::default, CellEdges::of_width)),
        ..Additions::default()
    };
    let mut loaded = read(WATER);
    loaded.cell = Some([[0.0; 3]; 3]);
    assert!(error(loaded.clone(), &edges(None)).contains("cannot be drawn"));
    loaded.cell = Some([[4.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
    assert!(error(loaded, &edges(Some(1e-9))).contains("the width of the edges is"));
    let plain = Dataset::new(SphereArray::F32(vec![[0.0, 0.0, 0.0, 1.0]; 2]));
    assert!(error(plain, &bonds()).contains("does not say which chemical elements"));
    assert!(error(read("2\n\nXx 0 0 0\nXx 1 0 0\n"), &bonds()).contains("--bond-length"));
    let crowd = (0..20).map(|i| format!("C {} 0 0\n", 0.01 * f64::from(i))).collect::<String>();
    let crowd = read(&format!("40\n\n{crowd}{crowd}"));
    assert!(error(crowd, &bonds()).contains("choose a smaller factor or length"));
    let thin = Additions { bonds: Some(Bonds::new(BondLength::Below(1e5))), ..Additions::default() };
    let far = Dataset::new(SphereArray::F64(vec![[0.0, 0.0, 0.0, 1e-3], [9e4, 0.0, 0.0, 1e-3]]));
    let error = error(far, &thin);
    assert!(error.starts_with("the bond between the spheres 0 and 1 cannot be drawn: its length, "), "{error}");
    assert!(error.contains("choose larger radii"));
}

#[test]
fn scene_files_select_and_add() {
    let text = "data = 'a.xyz'\nselect = 'index < 3'\nbox = { width = 0.1 }\nbonds = 1.3\n\
                [elements.O]\nradius = 0.7\n";
    let file = SceneFile::parse(text).unwrap();
    let mut loaded = read(WATER);
    loaded.cell = Some([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]]);
    let made = file.data().unwrap().scene(loaded, &OwnShapes::default()).unwrap();
    assert_eq!(made.kept.as_ref().map(|kept| (kept.kept, kept.of)), Some((3, 6)));
    assert_eq!(made.bonds, Some(2));
    let spheres = made.scene.spheres();
    assert_eq!(spheres.len(), 3 + made.scene.added());
    // A radius given by the file is not reduced.
    assert_eq!([0, 1, spheres.len() - 1].map(|id| spheres[id][3]), [0.7, 0.3, 0.05]);
}
