//! Tests that a camera which frames the spheres leaves room for the legend.

use crate::support::{Folder, decode};

/// A cube of 27 spheres, each with a number and a text.
fn cube() -> String {
    let head = "27\nProperties=species:S:1:pos:R:3:radius:R:1:v:R:1:kind:S:1\n".to_owned();
    (0..27).fold(head, |text, i| {
        let [x, y, z] = [i % 3, i / 3 % 3, i / 9];
        text + &format!(
            "C {x} {y} {z} 0.6 {}.5 {}\n",
            i * i,
            ["water", "sodium", "chloride"][i % 3]
        )
    })
}

/// Renders the cube; returns whether each pixel shows a sphere, and whether it shows the legend on the background.
fn render(folder: &Folder, size: &str, flags: &str) -> (usize, Vec<bool>, Vec<bool>) {
    let fixed = "--backend cpu --style fast -q --layer id=id.npy -o out.png";
    folder.run(&format!("render a.xyz --size {size} {fixed} {flags}")).succeeded();
    let (width, height, rgb) = decode(&folder.read("out.png"));
    let ids = folder.read("id.npy");
    let ids = &ids[ids.len() - 4 * (width * height) as usize..];
    let is_sphere: Vec<bool> = ids.chunks_exact(4).map(|id| id != [0xff; 4]).collect();
    // The corner between the sides that legends lie on is background.
    let corner = &rgb[3 * (width as usize * (height as usize - 1))..][..3];
    let pixels = rgb.chunks_exact(3).zip(&is_sphere);
    let is_legend = pixels.map(|(pixel, is_sphere)| !is_sphere && pixel != corner).collect();
    (width as usize, is_sphere, is_legend)
}

/// The rows and the columns of the pixels, each from the first to the last.
fn extent(width: usize, pixels: &[bool]) -> [[usize; 2]; 2] {
    let found = || (0..pixels.len()).filter(|pixel| pixels[*pixel]);
    let ends = |place: &dyn Fn(usize) -> usize| {
        [found().map(place).min().unwrap(), found().map(place).max().unwrap()]
    };
    [ends(&|pixel| pixel % width), ends(&|pixel| pixel / width)]
}

#[test]
fn no_sphere_lies_under_the_legend() {
    let folder = Folder::with(&[("a.xyz", &cube())]);
    for size in ["400x300", "300x500", "900x240"] {
        for position in ["right", "left", "top", "bottom", "bottom-right", "0.9,0.4"] {
            for (column, camera) in [("v", "pinhole"), ("kind", "orthographic")] {
                let flags = format!("--color-by {column} --legend={position} --camera {camera}");
                let (width, is_sphere, is_legend) = render(&folder, size, &flags);
                let [columns, rows] = extent(width, &is_legend);
                let covered = is_sphere.iter().enumerate().any(|(pixel, is_sphere)| {
                    let (x, y) = (pixel % width, pixel / width);
                    let is_inside = |[low, high]: [usize; 2], at| low <= at && at <= high;
                    *is_sphere && is_inside(columns, x) && is_inside(rows, y)
                });
                assert!(!covered, "{size} {flags}: {columns:?} {rows:?}");
                assert!(is_sphere.iter().any(|is_sphere| *is_sphere), "{size} {flags}");
            }
        }
    }
}

/// Without a legend, and with one that takes too much of the picture, the spheres are in the middle.
#[test]
fn without_room_the_spheres_stay_in_the_middle() {
    let folder = Folder::with(&[("a.xyz", &cube())]);
    for flags in ["--color-by v", "--color-by v --legend=0.5,0.5 --text-scale 3"] {
        let (width, is_sphere, _) = render(&folder, "400x300", flags);
        let [columns, rows] = extent(width, &is_sphere);
        assert!((columns[0] + columns[1]).abs_diff(399) <= 2, "{flags}: {columns:?}");
        assert!((rows[0] + rows[1]).abs_diff(299) <= 2, "{flags}: {rows:?}");
    }
}
