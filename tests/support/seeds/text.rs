//! Good files of formats that are text, one of them compressed.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;
use pinhole::load::Options;

use super::Seed;

pub(super) fn xyz() -> Vec<Seed> {
    let two =
        "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n2\n\nFe 1e1 2.5D0 -3\nXx 0 0 0\n";
    let mut gz = GzEncoder::new(Vec::new(), Compression::fast());
    gz.write_all(two.as_bytes()).unwrap();
    vec![Seed::new(two), Seed::new(two.replace('\n', "\r\n")), Seed::new(gz.finish().unwrap())]
}

pub(super) fn extxyz() -> Vec<Seed> {
    let head = "2\nLattice=\"4 0 0 0 4 0 0 0 4\" Properties=species:S:1:pos:R:3:radius:R:1:color:R:3:forces:R:3:id:I:1 \
                energy=-1.5\n";
    let atoms = "O 0 0 0.1 0.5 1 0 0.5 1 2 3 7\nH 0.76 0 -0.5 0.3 0 0 1 -1 -2 -3 8\n";
    let numbers = "1\nProperties=Z:I:1:pos:R:3:label:S:1:fixed:L:1\n6 1 2 3 CA T\n";
    vec![Seed::new([head, atoms, head, atoms].concat()), Seed::new(numbers)]
}

pub(super) fn pdb() -> Vec<Seed> {
    let atoms = "ATOM      1  N   VAL A   1       6.204  16.869   4.854  1.00 49.05           N\n\
                 ATOM      2  CA AVAL A   1       6.913  17.759   4.607  0.50 43.14           C\n\
                 ATOM      3  CA BVAL A   1       6.913  17.859   4.607  0.50 43.14           C\n\
                 HETATM 4430 FE   HEM A 142       8.128   7.371 -15.022  1.00 16.74          FE\n";
    let cell = "HEADER    OXYGEN TRANSPORT\n\
                CRYST1   63.150   83.590   53.800  90.00  99.34  90.00 P 1 21 1      4\n";
    let models =
        format!("{cell}MODEL        1\n{atoms}ENDMDL\nMODEL        2\n{atoms}TER\nENDMDL\nEND\n");
    vec![Seed::new(models), Seed::new([cell, atoms].concat())]
}

pub(super) fn mmcif() -> Vec<Seed> {
    let cell = "_cell.length_a 10.0\n_cell.length_b 20\n_cell.length_c 30.00(2)\n_cell.angle_alpha 80\n\
                _cell.angle_beta 100\n_cell.angle_gamma '110'\n";
    let names = [
        "group_PDB",
        "type_symbol",
        "auth_atom_id",
        "label_alt_id",
        "auth_comp_id",
        "auth_asym_id",
        "auth_seq_id",
        "pdbx_PDB_ins_code",
        "Cartn_x",
        "Cartn_y",
        "Cartn_z",
        "occupancy",
        "pdbx_PDB_model_num",
    ];
    let header: String = names.map(|name| format!("_atom_site.{name}\n")).concat();
    let model = |number: u32| {
        format!(
            "ATOM C CA A ALA A 7 ? 1.5 -2.25 103.125 0.40 {number}\n\
             ATOM C CA B ALA A 7 ? 2.5 -2.25 103.125 0.60 {number} # a comment\n\
             HETATM ? \"O5'\" . DA\n;B\n; 42 . 0 0 .5 1 {number}\n"
        )
    };
    let models = format!("data_4HHB\n{cell}loop_\n{header}{}{}#\n", model(1), model(2));
    let small = "data_x\n_cell_length_a 10\n_cell_length_b 20\n_cell_length_c 30\n_cell_angle_alpha 90\n\
                 _cell_angle_beta 90\n_cell_angle_gamma 90\nloop_\n_atom_site_label\n_atom_site_fract_x\n\
                 _atom_site_fract_y\n_atom_site_fract_z\nFe1 0.5000(3) -0.25 1\nC12A 0 0 0\nloop_\n_other\nFe1\n";
    vec![Seed::new(models.replace('\n', "\r\n")), Seed::new(models), Seed::new(small)]
}

pub(super) fn csv() -> Vec<Seed> {
    let table = "# made by hand\nname,x,y,z,radius,element,q,note\n\"a, b\",1,-2.5,3,0.5,O,,\"two\nlines\"\n\
                 c,4,5,6e-3,2,H,NA,\n";
    let bare = "1 2 3\n4\t5 6\n";
    let named = Options::default().with_columns(["x", "y", "z"]);
    vec![
        Seed::new(table),
        Seed::new("# x; y; z; id\n1;2;3;7\n\n4;5;6;A2\n"),
        Seed::with_options(bare, named),
    ]
}
