//! Rules for what is drawn and as what, selections with names, and what a camera frames.

use pinhole::Scene;
use pinhole::glam::DVec3;
use pinhole_data::load::{self, Dataset, Options};
use pinhole_figure::scene_file::{DataScene, OwnShapes, SceneFile};
use pinhole_figure::settings::Sources;
use pinhole_figure::settings::flags::Flag;

const WATER: &str = "4\n\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\nC 9 0 0\n";

fn read(text: &str, name: &str) -> Dataset {
    load::from_bytes(text.as_bytes(), name, &Options::default()).unwrap()
}

fn file(keys: &str) -> Result<SceneFile, String> {
    let file = format!("data = \"a\"\n{keys}");
    SceneFile::read(&Sources { file: &file, ..Sources::default() }).map_err(|error| error.to_string())
}

fn made(loaded: Dataset, keys: &str) -> DataScene {
    let file = file(keys).unwrap();
    file.data().unwrap().scene(loaded, &OwnShapes::default()).unwrap_or_else(|error| panic!("{keys}: {error}"))
}

/// The radii of spheres, rounded to thousandths.
fn radii(scene: &Scene) -> Vec<i32> {
    scene.spheres().iter().map(|sphere| (1000.0 * sphere[3]).round() as i32).collect()
}

/// The radii of cones, rounded to thousandths.
fn sticks(scene: &Scene) -> Vec<i32> {
    scene.cones().iter().map(|cone| (1000.0 * cone.first_radius.abs()).round() as i32).collect()
}

#[test]
fn each_style_has_its_sizes() {
    // Alvarez' radii of O, H and C are 1.50, 1.20 and 1.77 Å. Each bond of water has two halves.
    for (style, spheres, cones) in [
        ("spacefill", [1500, 1200, 1200, 1770], 0),
        ("vdw, scale = 0.5", [750, 600, 600, 885], 0),
        ("balls", [375, 300, 300, 443], 140),
        ("ball+stick, stick = 0.1", [375, 300, 300, 443], 100),
        ("licorice", [250; 4], 250),
        ("sticks, radius = 0.1", [100; 4], 100),
        ("lines", [70; 4], 70),
        ("points", [23; 4], 0),
    ] {
        let (name, keys) = style.split_once(", ").unwrap_or((style, ""));
        let DataScene { scene, bonds, notes, .. } =
            made(read(WATER, "a.xyz"), &format!("[[show]]\nas = \"{name}\"\n{keys}"));
        assert_eq!(radii(&scene), spheres, "{style}");
        assert_eq!(sticks(&scene), vec![cones; if cones > 0 { 4 } else { 0 }], "{style}");
        assert_eq!((bonds, notes), ((cones > 0).then_some(2), vec![]), "{style}");
    }
}

#[test]
fn the_last_rule_for_a_sphere_counts() {
    let rules =
        "[[show]]\nselect = \"element O H\"\nas = \"sticks\"\n[[show]]\nselect = \"element O\"\nas = \"balls\"\n";
    let DataScene { scene, notes, kept, .. } = made(read(WATER, "a.xyz"), rules);
    assert_eq!((radii(&scene), sticks(&scene)), (vec![375, 250, 250], vec![140; 4]));
    assert_eq!(notes.len(), 1);
    assert!(notes[0].starts_with("1 of 4 spheres are in no rule of `show`"), "{notes:?}");
    assert_eq!(kept.map(|kept| (kept.kept, kept.of)), Some((3, 4)));
    // What is hidden has no bonds, and still counts for distances.
    let rules = "[[show]]\nselect = \"element O\"\nas = \"hidden\"\n[[show]]\nselect = \"within 2 of element O\"\nas = \
                 \"sticks\"\n[[show]]\nselect = \"element O\"\nas = \"none\"\n";
    let scene = made(read(WATER, "a.xyz"), rules).scene;
    assert_eq!((radii(&scene), sticks(&scene).len()), (vec![250, 250], 0));
    // Without a rule that draws, the others are as they were.
    let scene = made(read(WATER, "a.xyz"), "bonds = true\n[[show]]\nselect = \"name H\"\nas = \"hide\"\n").scene;
    assert_eq!((radii(&scene), sticks(&scene).len()), (vec![375, 443], 0));
    // The rest is what no other rule is about, whichever comes first.
    let rules = "[[show]]\nselect = \"rest\"\nas = \"ghost\"\n[[show]]\nselect = \"element C\"\nas = \"spacefill\"\n";
    let DataScene { scene, notes, .. } = made(read(WATER, "a.xyz"), rules);
    assert_eq!((radii(&scene), notes), (vec![1770], vec![]));
    assert_eq!(scene.ghosts().map(radii), Some(vec![1500, 1200, 1200]));
}

#[test]
fn ghosts_are_a_scene_of_their_own() {
    // Sticks of ghosts are ghosts, and sticks between both are in none.
    let rules = "[[show]]\nas = \"balls\"\n[[show]]\nselect = \"index 1 2\"\nas = \"ghost\"\n";
    let file = "4\n\nO 0 0 0\nC 1.2 0 0\nC 2.5 0 0\nO 0 0 9\n";
    let DataScene { scene, kept, .. } = made(read(file, "a.xyz"), rules);
    let ghosts = scene.ghosts().unwrap();
    assert_eq!((radii(&scene), sticks(&scene).len()), (vec![375, 375], 0));
    assert_eq!((radii(ghosts), sticks(ghosts).is_empty()), (vec![443, 443], false));
    assert_eq!(kept.map(|kept| (kept.kept, kept.of)), Some((4, 4)));
    // The camera frames them, and those of the scene file and the cell are no ghosts.
    let rules = "box = true\n[[show]]\nselect = \"element O\"\nas = \"ghost\"\n";
    let cell = "2\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3\nO 0 0 0\nC 4 4 4\n";
    let scene = made(read(cell, "a.extxyz"), rules).scene;
    let of_ghosts = scene.ghosts().unwrap();
    assert_eq!((radii(of_ghosts), of_ghosts.cones().len()), (vec![1500], 0));
    assert!(scene.cones().len() >= 12);
    assert!(scene.subject().bounds().min().min_element() < -1.0, "{:?}", scene.subject().bounds());
    assert!(made(read(WATER, "a.xyz"), "").scene.ghosts().is_none());
}

#[test]
fn colors_of_rules_go_to_their_spheres_and_sticks() {
    let rules = "[[show]]\nas = \"balls\"\ncolor = \"red\"\n[[show]]\nselect = \"element C\"\nas = \"spacefill\"\ncarbon = \
                 \"#0000ff\"\nopacity = 0.5\n";
    let scene = made(read(WATER, "a.xyz"), rules).scene;
    let color = |id: u32| scene.color(id).to_srgb8();
    assert_eq!([color(0), color(1), color(3), color(4)], [[255, 0, 0], [255, 0, 0], [0, 0, 255], [255, 0, 0]]);
    assert_eq!(
        [scene.surface(0).opacity, scene.surface(3).opacity].map(|x| x.to_bits()),
        [1.0_f32, 0.5].map(f32::to_bits)
    );
    // Other atoms have the colours of elements.
    let scene = made(read(WATER, "a.xyz"), "color_by = \"x\"\n[[show]]\nas = \"spacefill\"\ncarbon = \"blue\"\n").scene;
    let plain = made(read(WATER, "a.xyz"), "").scene;
    assert_eq!((scene.color(0), scene.color(3).to_srgb8()), (plain.color(0), [0, 0, 255]));
    // A column of one rule has a legend.
    let made = made(read(WATER, "a.xyz"), "[[show]]\nas = \"spacefill\"\ncolor = \"y\"\n");
    assert_eq!(made.color_key.map(|key| key.title), Some("y".to_owned()));
}

/// Alpha carbons 3.8 Å apart, five in the chain A, of which the last is far away, and three in the chain B, each with a
/// nitrogen beside it.
fn chains() -> Dataset {
    let mut text = String::new();
    for (index, (chain, x, y)) in [
        ('A', 0.0, 0.0),
        ('A', 3.8, 0.0),
        ('A', 7.6, 0.0),
        ('A', 11.4, 0.0),
        ('A', 30.0, 0.0),
        ('B', 0.0, 3.0),
        ('B', 3.8, 3.0),
        ('B', 7.6, 3.0),
    ]
    .into_iter()
    .enumerate()
    {
        for (name, element, z) in [("CA", 'C', 0.0), ("N ", 'N', 1.4)] {
            text += &format!(
                "ATOM  {:5}  {name}  ALA {chain}{:4}    {x:8.3}{y:8.3}{z:8.3}  1.00  0.00           {element}\n",
                2 * index + 1,
                index + 1
            );
        }
    }
    read(&text, "a.pdb")
}

#[test]
fn a_trace_follows_each_chain() {
    let rules = "[[show]]\nselect = \"protein\"\nas = \"trace\"\ncolor = \"chain\"\n";
    let DataScene { scene, notes, color_key, kept, .. } = made(chains(), rules);
    // No atom is drawn; tubes go through four atoms and three.
    assert_eq!((scene.len(), kept.map(|kept| (kept.kept, kept.of))), (scene.added(), Some((16, 16))));
    assert_eq!(notes, [] as [&str; 0]);
    assert!(radii(&scene).iter().all(|radius| *radius == 400), "{:?}", radii(&scene));
    assert_eq!(color_key.map(|key| key.title), Some("chain".to_owned()));
    let lengths = |is_in: &dyn Fn(f32) -> bool| -> f32 {
        let cones = scene.cones().iter().filter(|cone| is_in(cone.start[1] + scene.origin().y as f32));
        cones
            .map(|cone| (DVec3::from(cone.end.map(f64::from)) - DVec3::from(cone.start.map(f64::from))).length() as f32)
            .sum()
    };
    assert!((lengths(&|y| y < 1.5) - 11.4).abs() < 1e-3 && (lengths(&|y| y > 1.5) - 7.6).abs() < 1e-3);
    let colors: std::collections::BTreeSet<[u8; 3]> =
        (0..scene.len() as u32).map(|id| scene.color(id).to_srgb8()).collect();
    assert_eq!(colors.len(), 2);
    // A later rule draws atoms beside the tube, which stays.
    let more = format!("{rules}[[show]]\nselect = \"resid 2\"\nas = \"sticks\"\n");
    let both = made(chains(), &more).scene;
    assert_eq!((both.len() - both.added(), both.added()), (2, scene.added()));
    assert_eq!(both.cones().len(), scene.cones().len() + 2);
    // What is hidden is no part of a tube.
    let scene = made(chains(), &format!("{rules}[[show]]\nselect = \"chain A\"\nas = \"hidden\"\n")).scene;
    assert!(scene.spheres().iter().all(|sphere| f64::from(sphere[1]) + scene.origin().y > 2.0));
    // Beads without names have a tube along near neighbours.
    let beads = read("4\n\nA 0 0 0\nA 1 0 0\nA 2 0 0\nA 9 0 0\n", "a.xyz");
    assert!(made(beads, "[[show]]\nas = \"trace\"\n").scene.cones().len() > 1);
    let note = &made(read(WATER, "a.xyz"), "[[show]]\nselect = \"element C\"\nas = \"cartoon\"\n").notes;
    assert!(note.iter().any(|note| note.starts_with("`show`: no chain was found")), "{note:?}");
    assert!(note.iter().any(|note| note.starts_with("there are no ribbons")), "{note:?}");
}

#[test]
fn selections_have_names_and_a_camera_frames_one() {
    let keys =
        "focus = \"far\"\nselect = \"not near\"\n[selections]\nnear = \"x < 0.5 and not far\"\nfar = \"element C\"\n";
    let scene = made(read(WATER, "a.xyz"), keys).scene;
    assert_eq!(scene.len(), 2);
    let center = scene.subject().bounds().center();
    assert!((center - DVec3::new(9.0, 0.0, 0.0)).length() < 1e-6, "{center}");
    for (keys, message) in [
        (
            "[selections]\none = \"two\"\ntwo = \"not one\"\n",
            "line 3, column 7: names use each other in a circle: one -> two -> one",
        ),
        (
            "[selections]\nwater = \"resname H2O\"\n",
            "`water` is a word of selections; choose another name, such as my_water",
        ),
        ("[selections]\nA = \"resname H2O\"\n", "a name of a selection has the characters a-z, 0-9 and _"),
        ("[selections]\nmine = \"resname\"\n", "line 3, column 8: character 8 of `resname`"),
        (
            "[[show]]\nas = \"stick-figure\"\n",
            "line 3, column 6: `stick-figure` is no style; use spacefill, balls, sticks",
        ),
        ("[[show]]\nas = \"cpk\"\n", "cpk is balls in VMD and spacefill in Jmol"),
        ("[[show]]\nas = \"surface\"\n", "there are no surfaces; spacefill is closest"),
        ("[[show]]\nas = \"balls\"\nradius = -1\n", "line 4, column 10: `radius` is -1"),
        (
            "[[show]]\nselect = \"within 5 resname HEM\"\nas = \"balls\"\n",
            "line 3, column 10: character 1 of `within 5 resname HEM`",
        ),
    ] {
        let error = file(keys).unwrap_err();
        assert!(error.contains(message), "{keys}: {error}");
    }
    let error = |keys: &str| {
        let file = file(keys).unwrap();
        file.data().unwrap().scene(read(WATER, "a.xyz"), &OwnShapes::default()).unwrap_err().to_string()
    };
    assert!(error("focus = \"element Fe\"\n").starts_with("`focus`: `element Fe` selects none of the 4 spheres"));
    assert!(error("[[show]]\nselect = \"protein\"\nas = \"balls\"\n").starts_with("`show`: character 1 of `protein`"));
    // Another frame may have what this one lacks.
    let notes = made(read(WATER, "a.xyz"), "[[show]]\nselect = \"element Fe\"\nas = \"ghost\"\n").notes;
    assert!(notes[0].starts_with("`show`: `element Fe` selects none of the 4 spheres"), "{notes:?}");
}

#[test]
fn flags_say_rules() {
    let layer = |name: &str, value: &str| Flag::of_name(name).unwrap().layer(value, "pinhole").map(|layer| layer.text);
    for (name, value, toml) in [
        ("show", "sticks", "show = [{ as = \"sticks\" }]"),
        ("show", "resname HEM = sticks", "show = [{ select = \"resname HEM\", as = \"sticks\" }]"),
        (
            "show",
            "x == 3: balls, radius=2, color=#f00",
            "show = [{ select = \"x == 3\", as = \"balls\", \"radius\" = 2.0, \"color\" = \"#f00\" }]",
        ),
        ("show", "name C,N = lines", "show = [{ select = \"name C,N\", as = \"lines\" }]"),
        ("hide", "water", "show = [{ select = \"water\", as = \"hidden\" }]"),
        ("ghost", "rest", "show = [{ select = \"rest\", as = \"ghost\" }]"),
        ("define", "heme = resname == HEM", "selections = { \"heme\" = \"resname == HEM\" }"),
    ] {
        assert_eq!(layer(name, value).as_deref(), Ok(toml));
    }
    for (value, message) in [
        ("protein", "`protein` is no style; use spacefill"),
        ("protein = sticky", "`sticky` is no style"),
        ("protein = sticks, radius", "`radius` is not KEY=VALUE"),
    ] {
        let error = layer("show", value).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    assert!(layer("define", "pocket").is_err());
}
