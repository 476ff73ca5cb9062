//! Scene files that name files of cylinders and cones.

use crate::support::{Folder, decode};

/// Two rods, one of which is red.
const RODS: &str =
    "start_x,start_y,start_z,end_x,end_y,end_z,radius,r,g,b\n0,0,0,0,3,0,0.5,1,0,0\n3,0,0,3,3,0,0.25,0,0,1\n";

const SCENE: &str = "[film]\nwidth = 24\nheight = 16\n[[cylinders]]\nfile = 'data/rods.csv'\n";

/// The same shapes in tables of their own.
const TABLES: &str = "[film]\nwidth = 24\nheight = 16\n\
    [[cylinders]]\nstart = [0, 0, 0]\nend = [0, 3, 0]\nradius = 0.5\ncolor = '#f00'\n\
    [[cylinders]]\nstart = [3, 0, 0]\nend = [3, 3, 0]\nradius = 0.25\ncolor = '#00f'\n";

fn folder() -> Folder {
    let folder = Folder::with(&[("file.toml", SCENE), ("tables.toml", TABLES)]);
    std::fs::create_dir(folder.path("data")).unwrap();
    std::fs::write(folder.path("data/rods.csv"), RODS).unwrap();
    folder
}

fn picture(folder: &Folder, arguments: &str) -> Vec<u8> {
    decode(&folder.run(&format!("render {arguments} -o - --backend cpu")).succeeded().stdout).2
}

#[test]
fn a_file_of_shapes_is_as_tables_of_them() {
    let folder = folder();
    for style in ["", " --style fast"] {
        assert_eq!(picture(&folder, &format!("file.toml{style}")), picture(&folder, &format!("tables.toml{style}")));
    }
    let info: serde_json::Value =
        serde_json::from_slice(&folder.run("info file.toml --json").succeeded().stdout).unwrap();
    assert_eq!((&info["cones"], &info["files"]), (&2.into(), &serde_json::json!(["data/rods.csv"])));
    // The paths in a saved scene are relative to its own folder.
    folder.run("render file.toml -o a.png --backend cpu --save-scene data/saved.toml").succeeded();
    let saved = String::from_utf8(folder.read("data/saved.toml")).unwrap();
    assert!(saved.contains("file = \"rods.csv\""), "{saved}");
    assert_eq!(picture(&folder, "data/saved.toml"), picture(&folder, "file.toml"));
}

#[test]
fn parts_of_a_job_notice_a_file_that_changed() {
    let folder = folder();
    folder.run("job split file.toml --tiles 2x1 -o job -q --backend cpu").succeeded();
    std::fs::write(folder.path("data/rods.csv"), RODS.replace("0.25", "0.75")).unwrap();
    folder.refuses("job part job 0", 1, "data/rods.csv: this file has changed since the job was split; split it again");
}

#[test]
fn errors_name_the_scene_file_the_file_and_its_row() {
    let folder = folder();
    let refused = |rods: &str, words: &str| {
        std::fs::write(folder.path("data/rods.csv"), rods).unwrap();
        folder.refuses("render file.toml -o out.png --backend cpu", 1, words);
    };
    refused(
        &RODS.replace("3,3,0,0.25", "3,0,0,0.25"),
        "file.toml: line 5, column 8: data/rods.csv: row 1: it has no length",
    );
    refused(&RODS.replace("radius", "mass"), "data/rods.csv: it lacks `radius`");
    std::fs::write(folder.path("data/rods.csv"), RODS).unwrap();
    for (more, words) in [
        (
            "radius = 1\n",
            "line 5, column 8: data/rods.csv: the column radius has radii; remove it, or the key `radius`",
        ),
        ("end = [0, 0, 1]\n", "line 6, column 7: `end` and `file` exclude each other; remove one of them"),
        ("[[cones]]\nfile = 'none.npz'\n", "line 7, column 8: none.npz: cannot be read: No such file"),
        ("[[cones]]\nfile = 'data/rods.csv'\n", "cones have two radii, and the column radius has one"),
        (
            "material = 'lamp'\n[materials.lamp]\nkind = 'emissive'\nstrength = 1\n",
            "cylinder 0: it has an emissive material",
        ),
    ] {
        std::fs::write(folder.path("file.toml"), [SCENE, more].concat()).unwrap();
        folder.refuses("render file.toml -o out.png --backend cpu", 1, words);
    }
    let noted = RODS.replace(",b\n", ",b,mass\n").replace(",0\n", ",0,5\n").replace(",1\n", ",1,7\n");
    std::fs::write(folder.path("data/rods.csv"), noted).unwrap();
    std::fs::write(folder.path("file.toml"), SCENE).unwrap();
    let run = folder.run("render file.toml -o out.png --backend cpu").succeeded();
    assert!(run.stderr.contains("data/rods.csv: these columns are not used, because cylinders have"), "{}", run.stderr);
}
