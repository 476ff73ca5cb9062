//! Bonds and the edges of cells: which of them exist, the positions of their spheres, and their appearance.

use pinhole::glam::DVec3;
use pinhole::{Scene, SphereArray};
use pinhole_data::added::{Additions, BondLength, Bonds, CellEdges};
use pinhole_data::load::{self, Dataset, Options};
use pinhole_figure::color_by::{ColorBy, Mapping};
use pinhole_figure::scene_file::{Data, DataError, DataScene, SceneFile};

fn read(text: &str) -> Dataset {
    load::from_bytes(text.as_bytes(), "a.xyz", &Options::default()).unwrap()
}

/// Two water molecules with hydrogens that are close to each other.
const WATER: &str = "6\n\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\nH 1.7 0 0\nO 2.6 0 0\nH 2.6 0.96 0\n";

fn bonds() -> Additions {
    Additions { bonds: Some(Bonds::default()), ..Additions::default() }
}

fn made(loaded: Dataset, additions: &Additions) -> Result<DataScene, DataError> {
    Data { additions: additions.clone(), ..Data::of_file("a.xyz") }.scene(loaded, &[])
}

fn scene(loaded: Dataset, additions: &Additions) -> (Scene, usize) {
    let made = made(loaded, additions).unwrap();
    (made.scene, made.bonds.unwrap_or_default())
}

fn center(sphere: &[f32; 4]) -> DVec3 {
    DVec3::new(sphere[0].into(), sphere[1].into(), sphere[2].into())
}

#[test]
fn oxygen_is_bonded_to_its_hydrogens_and_hydrogens_are_not() {
    let (scene, bonds) = scene(read(WATER), &bonds());
    assert_eq!(bonds, 4);
    let (atoms, sticks) = scene.spheres().split_at(6);
    // Atoms have 0.25 of Alvarez' van der Waals radii.
    assert!((atoms[0][3] - 0.375).abs() < 1e-6 && (atoms[1][3] - 0.3).abs() < 1e-6);
    assert!(!sticks.is_empty());
    let red = scene.color(0);
    for (index, stick) in (6_u32..).zip(sticks) {
        let near = |atom: &&[f32; 4]| center(atom).distance(center(stick));
        let nearest = atoms.iter().min_by(|a, b| near(a).total_cmp(&near(b))).unwrap();
        let atom = atoms.iter().position(|atom| atom == nearest).unwrap() as u32;
        // Each half of a bond has the colour of its atom.
        assert_eq!(scene.color(index), scene.color(atom), "{stick:?}");
        assert_eq!(scene.color(index) == red, atom == 0 || atom == 4);
        assert!((stick[3] - 0.45 * 0.3).abs() < 1e-6);
    }
    // Every bond is a row of spheres without gaps. Steps are at most 0.4 of the radius, also across the middle.
    let [from, to] = [center(&atoms[0]), center(&atoms[1])];
    let on_bond = |sphere: &&[f32; 4]| (center(sphere).y).abs() < 1e-6 && sphere[0] < 1.0;
    let mut along: Vec<f64> = sticks.iter().filter(on_bond).map(|s| s[0].into()).collect();
    along.sort_by(f64::total_cmp);
    let radius = 0.45 * 0.3;
    assert_eq!(along.len(), 7);
    assert!(along.windows(2).all(|pair| pair[1] - pair[0] <= 0.4 * radius + 1e-6), "{along:?}");
    let reach = |ball: f64| (ball * ball - radius * radius).sqrt();
    assert!(along[0] - from.x <= reach(0.375) + 0.2 * radius + 1e-6);
    assert!(to.x - along[along.len() - 1] <= reach(0.3) + 0.2 * radius + 1e-6);
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
    assert_eq!(kept.added(), 0);
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
    let plain = data.scene(loaded.clone(), &[]).unwrap();
    let made = Data { additions, ..data }.scene(loaded, &[]).unwrap();
    // The range, the legend and the appearance of the atoms are the same as without additions.
    assert_eq!(made.color_key, plain.color_key);
    assert_eq!(made.notes[..plain.notes.len()], plain.notes);
    let (scene, plain) = (made.scene, plain.scene);
    for id in 0..6 {
        assert_eq!((scene.color(id), scene.surface(id)), (plain.color(id), plain.surface(id)));
    }
    let of_atom = |id: &u32| scene.color(*id) == scene.color(1);
    let sticks: Vec<u32> = (6..scene.len() as u32).filter(of_atom).collect();
    assert!(!sticks.is_empty());
    assert!(sticks.iter().all(|id| scene.surface(*id) == scene.surface(1)));
    assert!((scene.surface(1).opacity - 0.2).abs() < 1e-6);
    let last = scene.len() as u32 - 1;
    assert_eq!((scene.surface(last).opacity, scene.added()), (1.0, scene.len() - 6));
    assert!(made.notes[made.notes.len() - 1].contains("borders of the periodic cell"));
}

#[test]
fn edges_of_a_tilted_cell_start_at_its_origin() {
    let text = "1\nLattice=\"4 0 0 1 3 0 0 1 2\" Origin=\"10 20 30\"\nC 11 21 31\n";
    let loaded = read(text);
    assert_eq!(loaded.cell_origin, [10.0, 20.0, 30.0]);
    let edges = Additions { cell: Some(CellEdges::default()), ..Additions::default() };
    let (scene, bonds) = scene(loaded, &edges);
    assert_eq!((bonds, scene.added()), (0, scene.len() - 1));
    let origin = DVec3::new(10.0, 20.0, 30.0);
    let [a, b, c] = [[4.0, 0.0, 0.0], [1.0, 3.0, 0.0], [0.0, 1.0, 2.0]].map(DVec3::from);
    let radius = (a + b + c).length() / 600.0;
    let at = |sphere: &[f32; 4]| scene.origin() + center(sphere);
    // Every sphere lies on an edge. Two of its fractions are 0 or 1, and the third is between them.
    let inverse = pinhole::glam::DMat3::from_cols(a, b, c).inverse();
    let mut on_edge = [0; 12];
    for sphere in &scene.spheres()[1..] {
        assert!((f64::from(sphere[3]) - radius).abs() < 1e-6);
        let fractions = (inverse * (at(sphere) - origin)).to_array();
        let is_end = |f: &f64| f.abs() < 1e-5 || (f - 1.0).abs() < 1e-5;
        assert!(fractions.iter().all(|f| (-1e-5..1.0 + 1e-5).contains(f)), "{fractions:?}");
        let ends = fractions.iter().filter(|f| is_end(f)).count();
        assert!(ends >= 2, "{fractions:?}");
        if ends == 2 {
            let axis = fractions.iter().position(|f| !is_end(f)).unwrap();
            let [one, other] = [(axis + 1) % 3, (axis + 2) % 3].map(|i| usize::from(fractions[i] > 0.5));
            on_edge[4 * axis + 2 * one + other] += 1;
        }
    }
    // All twelve edges have as many spheres as their length needs, and the corners have eight.
    let [of_a, of_b, of_c] = [a, b, c].map(|edge| (edge.length() / (0.6 * radius)).ceil() as usize);
    let expected = [[of_a; 4], [of_b; 4], [of_c; 4]].concat();
    assert_eq!(on_edge.to_vec(), expected);
    assert_eq!(scene.added(), expected.iter().sum::<usize>() + 8);
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
    assert!(error(read(WATER), &edges(None)).starts_with("the data has no periodic cell"));
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
    assert!(error(far, &thin).contains("choose larger radii"));
}

#[test]
fn scene_files_select_and_add() {
    let text = "data = 'a.xyz'\nselect = 'index < 3'\nbox = { width = 0.1 }\nbonds = 1.3\n\
                [elements.O]\nradius = 0.7\n";
    let file = SceneFile::parse(text).unwrap();
    let mut loaded = read(WATER);
    loaded.cell = Some([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]]);
    let made = file.data().unwrap().scene(loaded, &[]).unwrap();
    assert_eq!(made.kept.as_ref().map(|kept| (kept.kept, kept.of)), Some((3, 6)));
    assert_eq!(made.bonds, Some(2));
    let spheres = made.scene.spheres();
    assert_eq!(spheres.len(), 3 + made.scene.added());
    // A radius given by the file is not reduced.
    assert_eq!([0, 1, spheres.len() - 1].map(|id| spheres[id][3]), [0.7, 0.3, 0.05]);
}
