//! Good files of LAMMPS.

use pinhole::load::Options;

use super::Seed;

const HEAD: &str = "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\n";

pub(super) fn dump() -> Vec<Seed> {
    let frames = |bounds: &str, columns: &str, atoms: &str| {
        format!("{HEAD}ITEM: BOX BOUNDS {bounds}\nITEM: ATOMS {columns}\n{atoms}").repeat(2)
    };
    let plain = frames(
        "pp pp pp\n-1 3\n0 10\n5 25",
        "z id type vx x y radius c_1[2] element ",
        "6 9 2 .1 1 2 0.5 -7 O \n7 3 1 1 4 5 1.5 1e3 H\n",
    );
    let tilted = frames(
        "xy xz yz pp pp ff\n-1 6 -1\n0 4 2\n-1 1 1",
        "id type xs ys zs",
        "1 O .5 .5 .5\n2 H 0 0 1\n",
    );
    let general =
        frames("abc origin pp pp pp\n1 2 3 10\n0 1 0 20\n0 0 2 30", "", "1 1 0 0 0\n2 1 1 1 1\n");
    let named = Options::default().with_columns(["id", "type", "xsu", "ysu", "zsu"]);
    vec![
        Seed::new(format!("ITEM: UNITS\nmetal\nITEM: TIME\n0.5\n{plain}")),
        Seed::new(tilted),
        Seed::with_options(general, named),
    ]
}

pub(super) fn data() -> Vec<Seed> {
    let full = "made by hand\n\n3 atoms\n2 atom types\n0 4 xlo xhi\n0 5 ylo yhi # a comment\n-1 5 zlo zhi\n\
                1 0 0.5 xy xz yz\n\nAtom Type Labels\n\n1 OW\n2 HW\n\nMasses\n\n1 15.9994 # O\n2 1.008\n\n\
                Bond Coeffs\n\n1 2 3\n\nAtoms # full\n\n2 1 2 0.4 1 0 0 0 0 -1\n1 1 1 -0.8 0 0 0 0 0 0 # first\n\
                3 1 2 0.4 0 1 0 0 0 0\n\nVelocities\n\n3 7 8 9\n1 1 2 3\n2 4 5 6\n\nBonds\n\n1 1 1 2\n";
    let sphere = "\n1 atoms\n\nAtoms # sphere\n\n1 1 0.5 2.5 1 2 3\n";
    let bare = "\n1 atoms\n\nAtoms\n\n1 1 0.5 1 2 3\n";
    let named = Options::default().with_columns(["id", "type", "q", "x", "y", "z"]);
    vec![Seed::new(full), Seed::new(sphere), Seed::with_options(bare, named)]
}
