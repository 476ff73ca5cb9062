//! DCD files of every layout, bad files and noise.

use pinhole::load::{Format, LoadError, Loaded, Options, Trajectory};

use super::{Rng, mutations, refused, spheres, topology};
use crate::binary_files::dcd::{ATOMS, FRAMES_WRITTEN, Layout, Order, PLAIN, coordinate, file};

fn read(bytes: &[u8], frame: usize) -> Result<Loaded, LoadError> {
    let (_folder, options) = topology(ATOMS);
    super::read("dcd", bytes, &options.with_frame(frame))
}

#[test]
fn every_layout() {
    let cell = [10.0, 90.0, 20.0, 90.0, 90.0, 30.0];
    for order in [Order::Little, Order::Big] {
        for marker_bytes in [4, 8] {
            for has_fourth in [false, true] {
                for has_fixed in [false, true] {
                    let cell = Some(cell).filter(|_| has_fourth != has_fixed);
                    let layout = Layout { order, marker_bytes, cell, has_fourth, has_fixed };
                    let bytes = file(layout);
                    assert_eq!(Format::of_content(&bytes).unwrap().name, "dcd");
                    for frame in [2, 0, 1] {
                        let loaded = read(&bytes, frame).unwrap();
                        assert_eq!(loaded.frames, Some(FRAMES_WRITTEN));
                        let edges = [[10.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 30.0]];
                        assert_eq!(loaded.cell, cell.map(|_| edges));
                        assert_eq!(loaded.notes.len(), usize::from(has_fourth));
                        for (atom, [x, y, z, radius]) in spheres(&loaded).into_iter().enumerate() {
                            let is_fixed = has_fixed && (1..3).contains(&atom);
                            let from = if is_fixed { 0 } else { frame };
                            let expected =
                                [0, 1, 2].map(|axis| coordinate(from, atom, axis).into());
                            assert_eq!(([x, y, z], radius), (expected, 1.5), "{frame} {atom}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn cells_in_three_variants() {
    let edges = |cell| {
        let edges = read(&file(Layout { cell: Some(cell), ..PLAIN }), 0).unwrap().cell;
        edges.map(|edges| edges.as_flattened().iter().map(|v| (v * 1e6).round() / 1e6).collect())
    };
    // Degrees, cosines, a matrix, none.
    let slanted: Option<Vec<f64>> =
        Some(vec![10.0, 0.0, 0.0, 10.0, 17.320508, 0.0, 0.0, 0.0, 30.0]);
    assert_eq!(edges([10.0, 60.0, 20.0, 90.0, 90.0, 30.0]), slanted);
    assert_eq!(edges([10.0, 0.5, 20.0, 0.0, 0.0, 30.0]), slanted);
    let matrix = edges([10.0, -2.0, 20.0, -3.0, 4.0, 30.0]);
    assert_eq!(matrix, Some(vec![10.0, -2.0, -3.0, -2.0, 20.0, 4.0, -3.0, 4.0, 30.0]));
    assert_eq!(edges([0.0; 6]), None);
    for cell in [[f64::NAN; 6], [-1.0, 90.0, 1.0, 90.0, 90.0, 1.0]] {
        let message = refused(read(&file(Layout { cell: Some(cell), ..PLAIN }), 0));
        assert!(message.starts_with("byte 276: frame 0: the unit cell ["), "{message}");
    }
}

#[test]
fn bad_files() {
    let good = file(PLAIN);
    let with = |at: usize, bytes: &[u8]| {
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        refused(read(&file, 1))
    };
    assert_eq!(
        refused(read(b"12\n\nO 0 0 0\n", 0)),
        "this is not a dcd file: it does not start with a record of 84 bytes for CORD"
    );
    assert!(with(4, b"VELD").contains("the file has velocities (VELD)"));
    // The number of atoms.
    assert!(with(268, &(-4_i32).to_le_bytes()).contains("byte 268: the file declares -4 atoms"));
    let huge = with(268, &i32::MAX.to_le_bytes());
    assert!(
        huge.contains("byte 276: a frame of 2147483647 atoms takes 25769803788 bytes"),
        "{huge}"
    );
    assert!(
        with(264, &5_u32.to_le_bytes()).starts_with("byte 264: the number of atoms must take 4")
    );
    let start = good.len() - FRAMES_WRITTEN * 72;
    let nan = with(start + 72 + 24 + 4 + 8, &f32::NAN.to_le_bytes());
    assert!(
        nan.ends_with("frame 1: the y coordinate of atom 2 is NaN; a position must be finite"),
        "{nan}"
    );
    assert!(nan.starts_with(&format!("byte {}:", start + 108)), "{nan}");
    assert!(
        with(start + 72, &9_u32.to_le_bytes()).contains("must take 16 bytes, but the file says 9")
    );
    for length in 0..start + 72 {
        refused(read(&good[..length], 0));
    }
    // What is after complete frames is said, and they can be read.
    let cut = read(&good[..good.len() - 5], 1).unwrap();
    let left = format!("byte {}: frame 2 takes 72 bytes, but the file ends after 67", start + 144);
    assert!(cut.notes[0].starts_with(&left), "{:?}", cut.notes);
    let message = refused(read(&good[..good.len() - 5], 2));
    assert!(message.starts_with(&left), "{message}");
}

#[test]
fn a_topology_must_be_there_and_fit() {
    let missing = refused(super::read("dcd", &file(PLAIN), &Options::default()));
    assert!(missing.starts_with("a dcd file has positions alone; give a topology"), "{missing}");
    let (_folder, options) = topology(3);
    let message = refused(super::read("dcd", &file(PLAIN), &options));
    assert!(message.starts_with("frame 0 has 4 atoms, but the topology "), "{message}");
    assert!(message.contains("3.xyz has 3; use a file of the same system"), "{message}");
    let nowhere =
        refused(super::read("dcd", &file(PLAIN), &Options::default().with_topology("no.pdb")));
    assert!(nowhere.starts_with("the topology no.pdb: the file cannot be read: "), "{nowhere}");
}

/// From a file, a cut trajectory has the frames that are complete.
#[test]
fn a_trajectory_seeks() {
    let (folder, options) = topology(ATOMS);
    let path = folder.path().join("a.dcd");
    let good = file(PLAIN);
    std::fs::write(&path, &good[..good.len() - 1]).unwrap();
    let mut trajectory = Trajectory::open(&path, &options).unwrap();
    assert_eq!((trajectory.len(), trajectory.frame_bytes(1)), (2, Some(72)));
    assert!(trajectory.problem().unwrap().to_string().contains("frame 2 takes 72 bytes"));
    let loaded = trajectory.frame(1).unwrap();
    assert_eq!(spheres(&loaded)[0][0], 100.25);
    assert_eq!(loaded.labels("species").unwrap().names, ["O"]);
    // One frame alone has the note that it has from memory.
    let alone = pinhole::load::open(&path, &options.with_frame(1)).unwrap();
    assert!(alone.notes[0].contains("frame 2 takes 72 bytes"), "{:?}", alone.notes);
}

#[test]
fn noise_never_panics() {
    let (_folder, options) = topology(ATOMS);
    let mut random = Rng::with_seed(7);
    let cell = Some([10.0, 0.5, 20.0, 0.0, 0.0, 30.0]);
    let other =
        Layout { order: Order::Big, marker_bytes: 8, cell, has_fourth: true, has_fixed: true };
    for seed in [file(PLAIN), file(other)] {
        mutations(&mut random, &seed, 2000, |bytes, random| {
            let frame = random.usize(..FRAMES_WRITTEN);
            let _ = super::read("dcd", bytes, &options.clone().with_frame(frame));
        });
    }
}
