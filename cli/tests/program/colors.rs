//! Tests of colours by data, and of what is drawn over pictures.

use crate::support::{Folder, decode};

/// Four spheres in a row, with a number and a text each.
const ROW: &str = "4\nProperties=species:S:1:pos:R:3:radius:R:1:charge:R:1:site:S:1:v:R:3\n\
                   C 0 0 0 1 -1 a 3 4 0\nC 2 0 0 1 0 b 0 0 1\nC 4 0 0 1 0.5 a 0 0 2\nC 6 0 0 1 3 c 0 0 0\n";

const SCENE: &str = "data = 'row.xyz'\nshading = 'flat'\ncolor_by = 'site'\n\
                     [film]\nwidth = 80\nheight = 20\n\
                     [camera.orthographic]\neye = [3, 0, 9]\nlook_at = [3, 0, 0]\nhalf_extent = [4, 1]\n\
                     [legend]\ntitle = 'Site'\n";

/// The colours of the middles of the four spheres, and what the program says.
#[track_caller]
fn render(arguments: &str) -> (Vec<[u8; 3]>, String) {
    let folder = Folder::with(&[("row.xyz", ROW), ("scene.toml", SCENE)]);
    let flags = "--backend cpu -o out.png --legend=0,0 --text-scale 0.2";
    let run = folder.run(&format!("render scene.toml {flags} {arguments}")).succeeded();
    let (width, height, rgb) = decode(&folder.read("out.png"));
    assert_eq!((width, height), (80, 20));
    let pixel = |x: usize| 3 * (18 * 80 + x);
    let middles = [10, 30, 50, 70].map(|x| {
        let start = pixel(x) - 3 * 80 * 8;
        [rgb[start], rgb[start + 1], rgb[start + 2]]
    });
    (middles.to_vec(), run.stderr)
}

#[test]
fn columns_color_the_spheres() {
    let (colors, says) = render("--color-by charge --cmap gray --range -1,1");
    assert_eq!(colors[1..], [[128; 3], [191; 3], [255; 3]]);
    assert_eq!(
        says,
        "note: `charge` of 1 sphere lies outside the range -1 to 1 and has the color of its end\n"
    );
    let (colors, says) = render("--color-by |v| --cmap gray_r");
    assert_eq!(colors[1..], [[204; 3], [153; 3], [255; 3]]);
    assert_eq!(says, "note: colors show `|v|` from 0 to 5\n");
    let (colors, says) = render("");
    assert_eq!(colors[1..], [[0x56, 0xb4, 0xe9], [0xe6, 0x9f, 0x00], [0x00, 0x9e, 0x73]]);
    assert_eq!(says, "");
}

#[test]
fn errors_say_what_to_do() {
    let folder = Folder::with(&[("row.xyz", ROW)]);
    for (flags, code, error) in [
        (
            "--color-by sites",
            1,
            "row.xyz: there is no column `sites`; did you mean `site`? the columns are species, charge, site, v.x, v.y, \
             v.z, index, radius, x, y, z, |v|",
        ),
        (
            "--cmap vik",
            2,
            "--cmap says how numbers become colors, but no column is named; add --color-by COLUMN",
        ),
        ("--legend", 2, "a legend shows what colors mean, but no column gives colors"),
        ("--color-by charge --range 5", 2, "--range: `5` is not a number"),
        ("--color-by charge --legend=middle", 2, "--legend: `middle` is not a position"),
        ("--radius-by charge", 1, "sphere 0 would have the radius -1"),
        ("--opacity-by site", 1, "the column `site` holds text, but numbers are needed here"),
        ("--scale-bar=1000", 2, "choose a length near"),
        ("--dpi 0", 2, "--dpi: `dpi` is 0; it must lie between 1 and 100000 dots per inch"),
        ("--text-scale 99", 2, "--text-scale 99: it must be from 0.2 to 10"),
    ] {
        let run = folder.run(&format!("render row.xyz --backend cpu -o out.png {flags}"));
        assert!(run.stderr.contains(error), "{flags}: {}", run.stderr);
        assert_eq!((run.code, run.stderr.lines().count()), (code, 1), "{flags}: {}", run.stderr);
    }
    assert_eq!(folder.files(), ["row.xyz"]);
}

#[test]
fn an_exr_has_no_annotations() {
    let folder = Folder::with(&[("row.xyz", ROW), ("scene.toml", SCENE)]);
    let run = folder.run("render scene.toml --backend cpu -o out.exr --label a");
    assert!(run.stderr.contains("are drawn on PNG pictures"), "{}", run.stderr);
    assert_eq!(run.code, 2);
    let run = folder.run("render scene.toml --backend cpu -o out.exr").succeeded();
    assert!(run.stderr.contains("annotations are not drawn; write a .png"), "{}", run.stderr);
}
