//! Tests of the kinds of made files.

use super::*;
use crate::load::{self, Options};

fn traits(name: &str, text: &str) -> Traits {
    Traits::of(&load::from_bytes(text.as_bytes(), name, &Options::default()).unwrap(), None, None)
}

fn kind(name: &str, text: &str) -> Kind {
    traits(name, text).kind
}

/// A file of atoms in a cubic cell, in which nothing repeats along z if `is_slab`.
fn cell(side: f64, height: f64, atoms: &[(&str, [f64; 3])]) -> String {
    let rows = atoms.iter().map(|(species, [x, y, z])| format!("{species} {x} {y} {z}\n"));
    let count = atoms.len();
    format!(
        "{count}\nLattice=\"{side} 0 0 0 {side} 0 0 0 {height}\" Properties=species:S:1:pos:R:3\n{}",
        rows.collect::<String>()
    )
}

const COPPER: [(&str, [f64; 3]); 4] =
    [("Cu", [0.0; 3]), ("Cu", [0.0, 1.8, 1.8]), ("Cu", [1.8, 0.0, 1.8]), ("Cu", [1.8, 1.8, 0.0])];

#[test]
fn cells_of_atoms_are_crystals_slabs_or_molecules() {
    assert_eq!(kind("a.xyz", &cell(3.6, 3.6, &COPPER)), Kind::Crystal);
    assert_eq!(kind("a.xyz", &cell(2.6, 2.6, &COPPER[..1])), Kind::Crystal);
    let slab = traits("a.xyz", &cell(3.6, 13.6, &COPPER));
    assert_eq!((slab.kind, slab.up, slab.is_metal), (Kind::Slab, DVec3::Z, true));
    let water = [("O", [0.0; 3]), ("H", [0.76, 0.59, 0.0]), ("H", [-0.76, 0.59, 0.0])];
    assert_eq!(kind("a.xyz", &cell(9.0, 9.0, &water)), Kind::Molecules);
    // A molecule across a face of the cell does not reach its own image, but a chain along an edge does.
    let across = [("O", [0.0; 3]), ("H", [0.76, 0.59, 0.0]), ("H", [8.24, 0.59, 0.0])];
    assert_eq!(kind("a.xyz", &cell(9.0, 5.0, &across)), Kind::Molecules);
    let chain = [("C", [0.0; 3]), ("C", [1.3, 0.0, 0.0]), ("C", [2.6, 0.0, 0.0])];
    assert_eq!(kind("a.xyz", &cell(3.9, 20.0, &chain)), Kind::Slab);
    assert_eq!(kind("a.xyz", "2\n\nAr 0 0 0\nAr 0 0 4\n"), Kind::Liquid);
    assert_eq!(kind("a.xyz", "3\n\nAu 0 0 0\nAu 2.9 0 0\nAu 0 2.9 0\n"), Kind::Atoms);
}

#[test]
fn beads_are_particles() {
    let beads: String = (0..10).map(|i| format!("{} {} 0 0\n", if i % 2 == 0 { "A" } else { "B" }, 3 * i)).collect();
    let beads = traits("a.xyz", &format!("10\n\n{beads}"));
    assert_eq!((beads.kind, beads.beads_lack), (Kind::Particles, [true; 2]));
    // One atom that is a mark only is no bead.
    let marked: String = (0..20).map(|i| format!("{} {} 0 0\n", if i == 3 { "X" } else { "C" }, i)).collect();
    assert_eq!(traits("a.xyz", &format!("20\n\n{marked}")).beads_lack, [false; 2]);
    assert_eq!(kind("a.xyz", "1\n\nO 0 0 0\n"), Kind::Plain);
    assert_eq!(kind("a.xyz", "0\n\n"), Kind::Plain);
}

#[test]
fn beads_with_bonds_are_polymers() {
    let file = |bonds: &str| {
        format!(
            "chain\n\n2 atoms\n2 atom types\n{bonds}\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nAtoms # bond\n\n\
             1 1 1 1 1 1\n2 1 2 2 1 1\n"
        )
    };
    assert_eq!(kind("a.data", &file("")), Kind::Particles);
    let bonds = file("1 bonds\n1 bond types") + "\nBonds\n\n1 1 1 2\n";
    assert_eq!(kind("a.data", &bonds), Kind::Polymer);
}

#[test]
fn many_points_are_scans_or_stars() {
    let rows = |count: usize, header: &str, more: &str| -> String {
        // A few are far away.
        let place = |i: usize| if i.is_multiple_of(100) { i } else { i % 30 };
        (0..count)
            .fold(format!("x,y,z{header}\n"), |text, i| text + &format!("{},{},{}{more}\n", place(i), i % 37, i % 41))
    };
    assert_eq!(kind("a.csv", &rows(SCAN, ",r,g,b", ",9,8,7")), Kind::Scan);
    assert_eq!(kind("a.csv", &rows(SCAN - 1, ",r,g,b", ",9,8,7")), Kind::Plain);
    assert_eq!(kind("a.csv", &rows(SCAN, ",r,g,b,radius", ",9,8,7,1")), Kind::Plain);
    assert_eq!(kind("a.csv", &rows(STARS, "", "")), Kind::Stars);
    assert_eq!(kind("a.csv", &rows(STARS - 1, "", "")), Kind::Plain);
    assert_eq!(kind("a.csv", &(rows(STARS, ",radius", ",1") + "0,0,0,2\n")), Kind::Plain);
}

#[test]
fn residues_are_biomolecules_or_coarse() {
    let atom = |number: usize, name: &str, residue: &str, chain: char, x: f64| {
        format!("ATOM  {number:5}  {name:<3} {residue} {chain}{number:4}    {x:8.3}   0.000   0.000  1.00  0.00\n")
    };
    let chain = |spacing: f64| -> String {
        (0..6).map(|i| atom(i + 1, "CA", "ALA", if i < 3 { 'A' } else { 'B' }, spacing * i as f64)).collect()
    };
    let fine = traits("a.pdb", &chain(1.5));
    assert_eq!((fine.kind, fine.has_chains, fine.has_water, fine.has_ligands), (Kind::Biomolecule, true, false, false));
    assert_eq!(kind("a.pdb", &chain(3.8)), Kind::Coarse);
    let with_water =
        traits("a.pdb", &(chain(1.5) + &atom(9, "O", "HOH", 'A', 30.0) + &atom(10, "FE", "HEM", 'A', 40.0)));
    assert_eq!((with_water.kind, with_water.has_water, with_water.has_ligands), (Kind::Biomolecule, true, true));
}

#[test]
fn a_few_that_are_far_away_are_not_framed() {
    let rows = |far: f64| -> String {
        let near = (0..2000).map(|i| format!("{},{},{}\n", i % 10, i / 10 % 10, i / 100));
        near.chain([format!("{far},0,0\n")]).collect()
    };
    let traits = |far: f64| traits("a.csv", &format!("x,y,z\n{}", rows(far)));
    assert_eq!(traits(12.0).bulk, None);
    let [low, high] = traits(100.0).bulk.unwrap();
    assert!((low - DVec3::splat(-0.95)).length() < 1e-9 && (high - DVec3::new(9.95, 9.95, 19.95)).length() < 1e-9);
}

#[test]
fn points_that_would_be_specks_are_larger_and_planes_are_known() {
    let table = |rows: &mut dyn Iterator<Item = [f64; 3]>| {
        let rows: String = rows.map(|[x, y, z]| format!("{x},{y},{z}\n")).collect();
        traits("a.csv", &format!("x,y,z\n{rows}"))
    };
    // Points on a curve are much closer to each other than to the ends of the box.
    let along = |i: i32| [f64::from(i) * 0.01, (f64::from(i) * 0.01).sin(), (f64::from(i) * 0.01).cos()];
    for (step, kind, radius) in [(7919, Kind::Plain, 0.05..0.1), (1, Kind::Curve, 0.2..0.3)] {
        let curve = table(&mut (0..2000).map(|i| along(i * step % 2000)));
        assert!(radius.contains(&curve.seen_radius.unwrap()), "{curve:?}");
        assert_eq!((curve.kind, curve.is_uncolored, curve.flat), (kind, true, None));
    }
    // A jump, points in no order, and turns to all sides make no curve.
    let circle = |i: u32| [f64::from(i % 10).sin() * 9.0, f64::from(i).sin(), f64::from(i).cos()];
    let path = |i: u32| [f64::from(i / 2), f64::from(i % 2), f64::from(i / 7 % 2)];
    for rows in [circle, path] {
        assert_eq!(table(&mut (0..100).map(rows)).kind, Kind::Plain);
    }
    let jump = |i: u32| [f64::from(i) + if i > 50 { 20.0 } else { 0.0 }, f64::from(i).mul_add(0.1, 1.0), 0.0];
    assert_eq!([100, 50].map(|count| table(&mut (0..count).map(jump)).kind), [Kind::Plain, Kind::Curve]);
    let lattice = table(&mut (0..1000).map(|i| [i / 100, i / 10 % 10, i % 10].map(f64::from)));
    assert_eq!(lattice.seen_radius, None);
    for axis in 0..3 {
        let mut rows = (0..100).map(|i| {
            let mut row = [f64::from(i % 10), f64::from(i / 10), f64::from(i % 10)];
            (row[(axis + 1) % 3], row[axis]) = (f64::from(i / 10), 3.0);
            row
        });
        assert_eq!(table(&mut rows).flat, Some(axis));
    }
    assert_eq!(table(&mut (0..9).map(|i| [f64::from(i), 0.0, 0.0])).flat, None);
    assert!(!traits("a.csv", "x,y,z,r,g,b\n0,0,0,1,0,0\n1,0,0,0,1,0\n").is_uncolored);
    assert_eq!(traits("a.csv", "x,y,z,radius\n0,0,0,1\n100,0,0,1\n").seen_radius, None);
}
