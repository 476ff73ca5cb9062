//! Text files with something wrong in them.

use super::cases::{Case, Input};

/// Renders a file once for each of its contents.
pub(super) fn contents(name: &'static str, flags: &str, contents: &[&'static str]) -> Vec<Case> {
    let arguments = format!("render {name} -o out.png --backend cpu{flags}");
    let inputs = contents.iter().map(|text| Input { name, text });
    inputs.map(|input| Case { input: Some(input), arguments: arguments.clone() }).collect()
}

/// Scene files: syntax, keys, values, contradictions.
pub(super) fn scene_files() -> Vec<Case> {
    contents(
        "bad.toml",
        "",
        &[
            "[film\nwidth = 3\n",
            "[film]\nwidht = 3\n",
            "[film]\nwidth = 0\n",
            "[film]\nwidth = 'wide'\n",
            "[film]\nwidth = 3\nwidth = 4\n",
            "[flim]\nwidth = 3\n",
            "output = [1]\n",
            "[output]\nbits = 10\n",
            "[output]\nexposure = 40.5\n",
            "[output]\ntone = 'agxx'\n",
            "[output]\ntransparent = 1\n",
            "data = 'scene.toml'\n",
            "data = 'unknown.doc'\n",
            "data = 'ten-columns.npy'\n",
            "data = 'spheres.npy'\n[elements.O]\nopacity = 0.5\n",
            "data = 'water.xyz'\n[elements.O]\ncolor = 'gren'\n",
            "[[spheres]]\ncenter = [0, 0, 0]\n",
            "[[spheres]]\ncenter = [0, 0]\nradius = 1\n",
            "[[spheres]]\ncenter = [0, 0, 0]\nradius = nan\n",
            "[[spheres]]\ncenter = [0, 0, 0]\nradius = -1.5\n",
            "[[spheres]]\ncenter = [inf, 0, 0]\nradius = 1\n",
            "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'gren'\n",
            "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'glas'\n",
            "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\nopacity = 2\n",
            "[materials.glass]\nkind = 'glass'\n",
            "[camera.pinhole]\neye = [0, 0, 5]\n",
            "[camera.pinhole]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nvertical_fov = 180\n",
            "[camera.pinhole]\n[camera.orthographic]\n",
            "[camera.orthographic]\nvertical_fov = 30\n",
            "\"\\u001b[31mred\" = 1\n",
        ],
    )
}

/// Light and materials in scene files.
pub(super) fn lit_scene_files() -> Vec<Case> {
    contents(
        "bad.toml",
        "",
        &[
            "integrator = 'patth'\n",
            "[sampling]\nsamples = 0\n",
            "[sampling]\nfilter = 'triangle'\n",
            "[studio.occlusion]\nsamples = 0\n",
            "[studio.outline]\nwidth = 100\n",
            "[[lights]]\nkind = 'lamp'\n",
            "[[lights]]\nkind = 'point'\n",
            "[sky]\nkind = 'image'\nimage = 'no.hdr'\n",
            "[sky]\nkind = 'image'\nimage = 'scene.toml'\n",
            "[sky]\nkind = 'image'\nimage = 'cut.hdr'\n",
            "[ground]\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\n",
            "integrator = 'path'\n[ground]\nshadow_catcher = true\n",
            "[denoise]\n",
            "[materials.glass]\nkind = 'dielectric'\nior = 0.5\n",
            "[materials.gold]\nkind = 'conductor'\nroughness = 2\n",
        ],
    )
}

/// Text formats.
pub(super) fn atoms() -> Vec<Case> {
    let mut cases = contents(
        "bad.xyz",
        "",
        &[
            "",
            "three\n\nO 0 0 0\n",
            "4\n\nO 0 0 0\n",
            "1\n\nO 0 0 0\nO 1 1 1\n",
            "1\n\nO 0 x 0\n",
            "1\n\nO 0 0\n",
            "1\n\nO 0 nan 0\n",
            "1\nProperties=species:S:1:pos:R:2\nO 0 0\n",
            "1\nProperties=species:S:1:pos:R\nO 0 0 0\n",
            "1\nProperties=species:S:1:pos:R:3:radius:R:1\nO 0 0 0 -2\n",
        ],
    );
    cases.extend(contents(
        "bad.pdb",
        "",
        &[
            "",
            "ATOM      1  N   VAL A   1       6.204  16.\n",
            "ATOM      1  N   VAL A   1       6.204  16,869   4.854  1.00 49.05           N\n",
            "ATOM      1  N   VAL A  x1       6.204  16.869   4.854  1.00 49.05           N\n",
            "ATOM      1  N   VÄL A   1       6.204  16.869   4.854  1.00 49.05           N\n",
            "ATOM      1  N   VAL A   1       6.204  16.869   4.854  1.00 49.05           N\n\
             MODEL        1\n\
             ATOM      1  N   VAL A   1       6.204  16.869   4.854  1.00 49.05           N\n\
             ENDMDL\n",
            "MODEL        1\nMODEL        2\nENDMDL\n",
            "MODEL        1\nENDMDL\n",
            "data_4HHB\n",
            "CRYST1   63.150   83.590    0.000  90.00  99.34  90.00 P 1 21 1      4\n\
             ATOM      1  N   VAL A   1       6.204  16.869   4.854  1.00 49.05           N\n",
        ],
    ));
    cases.extend(contents(
        "one.pdb",
        " --frame 2",
        &["ATOM      1  N   VAL A   1       6.204  16.869   4.854  1.00 49.05           N\n"],
    ));
    cases.extend(contents("bad.cif", "", &BAD_CIF));
    cases.extend(contents("bad.lammpstrj", "", &BAD_DUMPS));
    cases.extend(contents(
        "bad.data",
        "",
        &[
            "\n1 atoms\n\nAtoms\n\n1 1 0.5 0 0 0\n",
            "\n1 atoms\n\nAtoms # full\n\n1 1 0 0 0\n",
            "\n2 atoms\n\nAtoms # atomic\n\n1 1 0 0 0\n",
        ],
    ));
    cases.extend(contents(
        "bad.csv",
        "",
        &[
            "",
            "0,0,0\n",
            "a,b,c\n0,0,0\n",
            "x,y,z\n0,0\n",
            "x,y,z\n0,0,0,0\n",
            "x,y,z\n0,north,0\n",
            "x,y,z\n0,,0\n",
        ],
    ));
    cases.extend(contents("names.csv", " --columns x,y,z", &["x,y,z\n0,0,0\n", "0,0\n"]));
    cases
}

const BAD_CIF: [&str; 5] = [
    "data_X\n",
    "data_X\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n0 0 x\n",
    "data_X\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n0 0 0 0\n",
    "data_X\nloop_\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n0 0 0\n",
    "data_X\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n0 'a 0\n",
];

const BAD_DUMPS: [&str; 4] = [
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z\n1 0 0 0\n",
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0\n0 1\nITEM: ATOMS id x y z\n1 0 0 0\n",
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id x y\n1 0 0\n",
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z\n1 0 zero 0\n",
];
