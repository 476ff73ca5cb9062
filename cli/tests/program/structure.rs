//! Tests of selections, of the periodic cell and of bonds.

use crate::support::{Folder, decode};

/// Four atoms in a row, with a number each, and a cell.
const ROW: &str = "4\nLattice=\"8 0 0 0 2 0 0 0 2\" Origin=\"-1 -1 -1\" Properties=species:S:1:pos:R:3:q:R:1\n\
                   O 0 0 0 -1\nH 0.9 0 0 0\nC 4 0 0 0.5\nC 5.5 0 0 3\n";

const FLAGS: &str = "--backend cpu --style fast --size 80x20 -o out.png";

fn folder() -> Folder {
    let plain = "2\n\nAr 0 0 0\nAr 3 0 0\n";
    Folder::with(&[("row.xyz", ROW), ("plain.xyz", plain), ("scene.toml", "data = 'row.xyz'\n")])
}

#[track_caller]
fn said(folder: &Folder, arguments: &str) -> (String, String) {
    let mut command = folder.command(&format!("render {FLAGS}"));
    command.args(arguments.split(';').map(str::trim));
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments}: {text}");
    let (notes, line) = text.trim_end().rsplit_once('\n').unwrap_or(("", text.trim_end()));
    (notes.to_owned(), line.to_owned())
}

#[test]
fn a_selection_decides_what_is_seen_and_counted() {
    let folder = folder();
    let (notes, line) = said(&folder, "row.xyz; --select; q >= 0 and species == C; --color-by; q");
    assert_eq!(notes, "note: colors show `q` from 0.5 to 3");
    assert!(line.starts_with("row.xyz: kept 2 of 4 atoms; --style fast"), "{line}");
    // The camera frames what is kept, so this is the picture of a file that has nothing else.
    let kept = decode(&folder.read("out.png"));
    let alone = Folder::with(&[(
        "row.xyz",
        "2\nProperties=species:S:1:pos:R:3:q:R:1\nC 4 0 0 0.5\nC 5.5 0 0 3\n",
    )]);
    said(&alone, "row.xyz; --color-by; q");
    assert!(kept == decode(&alone.read("out.png")));
    let (notes, line) = said(&folder, "scene.toml; --select; index != 0 and not species == Q");
    assert_eq!(notes, "note: no sphere has the species `Q`; there are O, H, C");
    assert!(line.starts_with("scene.toml: kept 3 of 4 atoms"), "{line}");
}

#[test]
fn errors_of_selections_box_and_bonds_say_where_and_what_to_do() {
    let folder = folder();
    for (flags, code, error) in [
        (
            "row.xyz; --select; q > 1 and charge < 2",
            1,
            "row.xyz: --select: character 11 of `q > 1 and charge < 2`: there is no column `charge`",
        ),
        (
            "row.xyz; --select; q >",
            2,
            "--select: character 4 of `q >`: a column, a number or a text belongs here",
        ),
        ("row.xyz; --select; q > 9", 1, "row.xyz: --select: `q > 9` selects none of the 4 spheres"),
        ("plain.xyz; --box", 1, "plain.xyz: the data has no periodic cell"),
        ("row.xyz; --box=-1", 2, "--box: `-1` is not a number that is finite and greater than 0"),
        ("row.xyz; --bonds=x", 2, "--bonds: `x` is not a number"),
        ("row.xyz; --bond-length; 0", 2, "--bond-length: `0` is not a number"),
    ] {
        let mut command = folder.command(&format!("render {FLAGS}"));
        let output = command.args(flags.split(';').map(str::trim)).output().unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(error), "{flags}: {text}");
        assert_eq!(
            (output.status.code(), text.lines().count()),
            (Some(code), 1),
            "{flags}: {text}"
        );
    }
    let own = Folder::with(&[("own.toml", "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\n")]);
    let run = own.run("render own.toml --backend cpu -o out.png --box");
    assert!(run.stderr.contains("--box applies to the `data` of a scene"), "{}", run.stderr);
    assert_eq!(run.code, 2);
}

#[test]
fn bonds_and_boxes_come_after_the_spheres_of_the_file() {
    let folder = folder();
    let (notes, line) = said(&folder, "row.xyz; --bonds; --box; --layer; id=id.npy");
    assert_eq!(notes, "note: bonds across the borders of the periodic cell are not drawn");
    assert!(line.starts_with("row.xyz: 4 atoms, 2 bonds; --style fast"), "{line}");
    let bytes = folder.read("id.npy");
    let ids = bytes[bytes.len() - 4 * 80 * 20..].chunks_exact(4);
    let ids: Vec<u32> = ids.map(|id| u32::from_le_bytes(id.try_into().unwrap())).collect();
    for atom in 0..4 {
        assert!(ids.contains(&atom), "{atom}");
    }
    assert!(ids.iter().any(|id| (4..u32::MAX).contains(id)));
    let (_, line) =
        said(&folder, "row.xyz; --bond-length; 3.5; --select; species == C or index == 1");
    assert!(line.starts_with("row.xyz: kept 3 of 4 atoms, 2 bonds"), "{line}");
}

#[test]
fn printed_scenes_select_and_add_the_same() {
    let folder = folder();
    let mut command =
        folder.command("render row.xyz --print-scene --style fast --size 80x20 --box --bonds=1.1");
    let output = command.args(["--select", "q >= 0 and species != \"O\""]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("select = \"q >= 0 and species != \\\"O\\\"\"\n"), "{text}");
    assert!(text.contains("box = true\nbonds = 1.1\n"), "{text}");
    std::fs::write(folder.path("printed.toml"), &text).unwrap();
    said(&folder, "printed.toml");
    let printed = decode(&folder.read("out.png"));
    said(&folder, "row.xyz; --box; --bonds=1.1; --select; q >= 0 and species != O");
    assert!(printed == decode(&folder.read("out.png")));
}

#[test]
fn frames_are_selected_one_by_one() {
    let frames: String = (0..3)
        .map(|frame| format!("2\nLattice=\"9 0 0 0 2 0 0 0 2\"\nO {} 0 0\nO 8 0 0\n", 2 * frame))
        .collect();
    let folder = Folder::with(&[("a.xyz", &frames)]);
    let flags = "--backend cpu --style fast --size 40x20 --view z";
    let run = folder
        .run(&format!("render a.xyz -o f%d.png --frames : --select x<7 --box {flags}"))
        .succeeded();
    assert_eq!(run.said.unwrap().split(';').next(), Some("a.xyz: 3 pictures of kept 1 of 2 atoms"));
    let pictures: Vec<_> = (0..3).map(|i| decode(&folder.read(&format!("f{i}.png")))).collect();
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    // The cell stays where it is, because the camera does.
    let run = folder.run(&format!("render a.xyz -o f%d.png --frames : --select x<3 {flags}"));
    assert!(
        run.stderr.contains("frame 2: a.xyz: --select: `x<3` selects none of the 2 spheres"),
        "{}",
        run.stderr
    );
    assert_eq!(run.code, 1);
}

#[test]
fn info_tells_where_the_cell_starts() {
    let run = folder().run("info row.xyz").succeeded();
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(text.contains("  cell       (8 0 0) (0 2 0) (0 0 2) from (-1 -1 -1)\n"), "{text}");
    let run = folder().run("info row.xyz --json").succeeded();
    let json: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!(json["cell_origin"], serde_json::json!([-1.0, -1.0, -1.0]));
}
