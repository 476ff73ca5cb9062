//! Tests of the colours and the legend of several frames, which are the same in all of them.

use crate::support::{Folder, decode};

/// A scene whose spheres lie in the middle rows, so that a legend at the top covers none.
const SCENE: &str = "data = 'a.xyz'\nshading = 'flat'\n[film]\nwidth = 80\nheight = 80\n\
                     [camera.orthographic]\neye = [3, 0, 9]\nlook_at = [3, 0, 0]\nhalf_extent = [4, 4]\n";

/// A frame of spheres at x = 0, 2, 4, 6, each with a value of the column `v`.
fn frame(kind: char, values: &[&str]) -> String {
    let head = format!("{}\nProperties=species:S:1:pos:R:3:radius:R:1:v:{kind}:1\n", values.len());
    let rows = values.iter().enumerate().map(|(i, value)| format!("C {} 0 0 1 {value}\n", 2 * i));
    head + &rows.collect::<String>()
}

/// Renders frames; returns the colours of the middles of the spheres, and what lies above them.
fn render(kind: char, frames: &[&[&str]], flags: &str) -> (Vec<Vec<[u8; 3]>>, Vec<Vec<u8>>) {
    let text: String = frames.iter().map(|values| frame(kind, values)).collect();
    let folder = Folder::with(&[("a.xyz", &text), ("scene.toml", SCENE)]);
    let legend = "--legend=top --text-scale 0.5";
    let frames_flag =
        format!("-o f%d.png --frames : --color-by v -q --backend cpu {legend} {flags}");
    folder.run(&format!("render scene.toml {frames_flag}")).succeeded();
    let pictures = frames.iter().enumerate().map(|(number, values)| {
        let (_, _, rgb) = decode(&folder.read(&format!("f{number}.png")));
        let middle = |sphere: usize| {
            let start = 3 * (40 * 80 + 10 + 20 * sphere);
            [rgb[start], rgb[start + 1], rgb[start + 2]]
        };
        ((0..values.len()).map(middle).collect(), rgb[..3 * 80 * 29].to_vec())
    });
    pictures.unzip()
}

#[test]
fn a_category_has_the_same_color_in_all_frames() {
    let (colors, legends) = render('S', &[&["c", "a"], &["b", "c"], &["c"]], "");
    assert_eq!([colors[0][0]; 2], [colors[1][1], colors[2][0]]);
    let different = [colors[0][0], colors[0][1], colors[1][0]];
    assert!(different[0] != different[1] && different[1] != different[2], "{different:?}");
    assert!(different[0] != different[2], "{different:?}");
    let background = legends[0][..3].to_vec();
    assert!(legends[0].chunks_exact(3).any(|pixel| pixel != background), "there is no legend");
    assert!(legends.iter().all(|legend| *legend == legends[0]));
}

#[test]
fn numbers_have_one_scale_in_all_frames() {
    // The first and the last frame alone have so few whole numbers that these are categories.
    let (colors, legends) = render('R', &[&["0", "7"], &["0.5", "3", "0"], &["7"]], "");
    assert_eq!(colors[0][0], [0x44, 0x01, 0x54]);
    assert_eq!(colors[0][1], [0xfd, 0xe7, 0x25]);
    assert_eq!([colors[1][2], colors[2][0]], [colors[0][0], colors[0][1]]);
    assert!(legends.iter().all(|legend| *legend == legends[0]));
}

#[test]
fn what_the_frame_of_the_camera_lacks_has_the_color_of_missing_values() {
    let (colors, legends) = render('S', &[&["b", "a"], &["c", "b"]], "--camera-from 0");
    assert_eq!(colors[1][0], [0x80; 3]);
    assert_eq!(colors[1][1], colors[0][0]);
    assert!(legends.iter().all(|legend| *legend == legends[0]));
}

/// Types of a dump color the spheres without a flag, also in a frame with one type.
#[test]
fn colors_by_kind_are_those_of_all_frames() {
    let frame = |types: &[u8]| {
        let rows = types.iter().enumerate().map(|(i, kind)| format!("{i} {kind} {} 0 0\n", 3 * i));
        format!(
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n\
             ITEM: ATOMS id type x y z\n{}",
            types.len(),
            rows.collect::<String>()
        )
    };
    let folder = Folder::with(&[("a.lammpstrj", &(frame(&[2, 2]) + &frame(&[1, 2])))]);
    let flags = "--backend cpu --size 80x40 --style fast --view z --radius 1 -q";
    folder.run(&format!("render a.lammpstrj -o f%d.png --frames : {flags}")).succeeded();
    let right = ["f0.png", "f1.png"].map(|name| {
        let (_, _, rgb) = decode(&folder.read(name));
        let last = (0..80).rev().find(|x| rgb[3 * (20 * 80 + x)..][..3] != rgb[..3]).unwrap();
        let start = 3 * (20 * 80 + last - 6);
        [rgb[start], rgb[start + 1], rgb[start + 2]]
    });
    assert_eq!(right[0], right[1]);
}
