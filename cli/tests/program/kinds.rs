//! Tests of what is drawn of files of different kinds, if no flag says so.

use crate::support::{Folder, WATER, decode};

const SMALL: &str = "--size 40x30 --backend cpu --style fast";

/// Copper in a cubic cell, and the same below an empty layer.
fn copper(height: f64) -> String {
    let atoms = "Cu 0 0 0\nCu 0 1.8 1.8\nCu 1.8 0 1.8\nCu 1.8 1.8 0\n";
    format!("4\nLattice=\"3.6 0 0 0 3.6 0 0 0 {height}\" Properties=species:S:1:pos:R:3\n{atoms}")
}

fn protein() -> String {
    let atom = |number: usize, name: &str, residue: &str, chain: char| {
        let x = 1.5 * number as f64;
        format!("ATOM  {number:5}  {name:<3} {residue} {chain}{number:4}    {x:8.3}   0.000   0.000  1.00  0.00\n")
    };
    let chains = (1..7).map(|i| atom(i, "CA", "ALA", if i < 4 { 'A' } else { 'B' }));
    chains.collect::<String>() + &atom(8, "O", "HOH", 'A') + &atom(9, "FE", "HEM", 'A')
}

fn folder() -> Folder {
    let beads: String = (0..8).map(|i| format!("{} {} {} 0\n", ["A", "B"][i % 2], 3 * i, i % 3)).collect();
    Folder::with(&[
        ("water.xyz", WATER),
        ("crystal.xyz", &copper(3.6)),
        ("slab.xyz", &copper(13.6)),
        ("beads.xyz", &format!("8\n\n{beads}")),
        ("protein.pdb", &protein()),
    ])
}

#[test]
fn a_saved_scene_has_what_follows_from_the_kind() {
    let folder = folder();
    for (file, kind) in [
        ("water.xyz", "molecules"),
        ("crystal.xyz", "crystal"),
        ("slab.xyz", "slab"),
        ("beads.xyz", "particles"),
        ("protein.pdb", "biomolecule"),
    ] {
        let run = folder.run(&format!("{file} -o a.png {SMALL} --save-scene a.toml")).succeeded();
        let said = run.said.unwrap();
        assert!(said.contains(&format!("; --kind {kind} --style fast")), "{said}");
        folder.run("a.toml -o b.png --backend cpu -q").succeeded();
        assert!(folder.read("a.png") == folder.read("b.png"), "{file}");
        folder.run(&format!("{file} -o c.png {SMALL} -q --kind {kind}")).succeeded();
        assert!(folder.read("a.png") == folder.read("c.png"), "{file}");
        folder.run(&format!("{file} -o d.png {SMALL} -q --kind plain")).succeeded();
        assert!(decode(&folder.read("a.png")) != decode(&folder.read("d.png")), "{file}");
    }
}

#[test]
fn ghosts_are_drawn_over_the_picture_of_the_others() {
    let folder = folder();
    let picture = |flags: &str| {
        let run = folder.run(&format!("protein.pdb -o a.png {SMALL} --layer id=a.npy {flags}")).succeeded();
        (run.stderr, folder.read("a.png"), folder.read("a.npy"))
    };
    let [(_, hidden, ids), (_, faint, same), (_, solid, others)] =
        ["--hide 'chain==B' --focus all", "--ghost 'chain==B' --focus all", "--focus all"]
            .map(|flags| picture(&flags.replace('\'', "")));
    assert!(hidden != faint && faint != solid && others != same);
    // Ghosts are in no layer of data.
    assert!(ids == same);
    let (said, ..) = picture("--focus chain==A");
    assert!(said.contains("others may hide what is in focus; --ghost 'not (chain==A)'"), "{said}");
    let (said, ..) = picture("--focus chain==A --ghost chain==B");
    assert!(!said.contains("others may hide"), "{said}");
    folder.run(&format!("protein.pdb -o b.png {SMALL} --ghost chain==B --save-scene b.toml")).succeeded();
    folder.run("b.toml -o c.png --backend cpu -q").succeeded();
    assert!(folder.read("b.png") == folder.read("c.png"));
}

#[test]
fn flags_take_the_place_of_what_follows_from_the_kind() {
    let folder = folder();
    let scene = |arguments: &str| {
        let run = folder.run(&format!("render {arguments} --print-scene {SMALL}")).succeeded();
        String::from_utf8(run.stdout).unwrap()
    };
    let crystal = scene("crystal.xyz --zoom 2 --replicate 2x1x1 --no-box");
    assert!(crystal.contains("replicate = \"2x1x1\"") && crystal.contains("up = [0.0, 0.0, 1.0]"), "{crystal}");
    assert!(crystal.contains("[camera.orthographic]") && !crystal.contains("box = true"), "{crystal}");
    let front = scene("crystal.xyz --view front");
    assert!(front.contains("[camera.orthographic]") && front.contains("up = [0.0, 0.0, 1.0]"), "{front}");
    assert!(scene("crystal.xyz --fov 20").contains("[camera.pinhole]"));
    let protein = scene("protein.pdb --hide name==CA");
    assert!(protein.contains("as = \"hidden\"") && protein.contains("as = \"spacefill\""), "{protein}");
    assert!(!scene("protein.pdb --show trace").contains("spacefill"));
    assert!(!scene("protein.pdb --select residue==HOH").contains("hidden"));
    assert!(!scene("protein.pdb --color red").contains("color_by"));
    let beads = scene("beads.xyz --set elements.A.color=red");
    assert!(!beads.contains("color_by") && beads.contains("[elements.A]") && beads.contains("radius ="), "{beads}");
    folder.refuses("water.xyz --kind gas", 2, "invalid value 'gas'");
    std::fs::write(folder.path("kind.toml"), "data = \"water.xyz\"\nkind = \"slab\"\n").unwrap();
    folder.refuses("kind.toml -o a.png", 1, "`kind` applies to data files without a scene");
    folder.refuses("kind.toml -o a.png --kind slab", 2, "--kind applies to data files");
    folder.refuses("water.xyz -o a.png --replicate 2x2x2", 1, "`replicate`: the data has no periodic cell");
    folder.refuses("water.xyz -o a.png --replicate 0x1x1", 2, "--replicate");
}
