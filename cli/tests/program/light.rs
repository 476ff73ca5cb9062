//! Tests of lit pictures on the CPU reference: flags, scene files and errors.

use exr::prelude::{SpecificChannels, WritableImage};

use crate::support::{Folder, decode};

const SCENE: &str = "[film]\nwidth = 24\nheight = 18\n[camera.pinhole]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                     [[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'tomato'\n";

/// The scene with more keys or tables at its top.
fn scene(top: &str) -> String {
    format!("{top}{SCENE}")
}

#[track_caller]
fn refused(files: &[(&str, &str)], arguments: &str, code: i32, words: &[&str]) {
    let mut all = vec![("scene.toml", SCENE)];
    all.extend(files);
    let folder = Folder::with(&all);
    let before = folder.files();
    let run = folder.run(&format!("render {arguments} --backend cpu"));
    assert_eq!(run.code, code, "{arguments}: {}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1, "{arguments}: {}", run.stderr);
    assert!(run.stderr.starts_with("error: "), "{arguments}: {}", run.stderr);
    for word in words {
        assert!(run.stderr.contains(word), "{arguments}: {} lacks {word}", run.stderr);
    }
    assert_eq!(folder.files(), before, "{arguments}");
}

#[test]
fn flags_out_of_range() {
    for (flags, words) in [
        ("--samples 0", ["--samples 0: ", "it must be from 1 to 16777216"]),
        ("--samples 16777217", ["--samples 16777217: ", "it must be from 1 to 16777216"]),
        ("--samples -1", ["--samples", ""]),
        ("--ao=0", ["--ao 0: ", "it must be from 1 to 1024"]),
        ("--outline 0.1", ["--outline 0.1", "it must be from 0.5 to 64 pixels"]),
        ("--outline -3", ["--outline -3: ", "it must be from 0.5 to 64 pixels"]),
        ("--outline nan", ["--outline NaN: ", "it must be from 0.5 to 64 pixels"]),
        ("--noise 0", ["--noise 0: ", "greater than 0"]),
        ("--noise nan", ["--noise NaN: ", "greater than 0"]),
        ("--time 0s", ["--time 0s: ", "such as 20s"]),
        ("--integrator patth", ["patth", "path"]),
        ("--ao --integrator path", ["--ao", "`studio`"]),
        ("--outline 2 --integrator path", ["--outline", "`studio`"]),
        ("--integrator primary --samples 4", ["--samples applies only", "made by `primary`"]),
        ("--integrator primary --denoise", ["--denoise applies only", "made by `primary`"]),
        ("--integrator primary --time 1s", ["--time applies only", "made by `primary`"]),
        ("--keep-partial", ["--keep-partial", "lit pictures"]),
    ] {
        let code = 2;
        refused(&[], &format!("scene.toml -o out.png {flags}"), code, &words);
    }
}

#[test]
fn scenes_with_errors() {
    let bad = |text: &str, words: &[&str]| {
        refused(&[("bad.toml", text)], "bad.toml -o out.png", 1, words);
    };
    bad("[studio.occlusion]\nsamples = 0\n", &["bad.toml: line 2, column 11: `samples` is 0;"]);
    bad(
        &scene("").replace("'tomato'", "[1, 1, 1.5]\nopacity = 0.5"),
        &["bad.toml: line 7", "sphere 0 has the color [1.0, 1.0, 1.5], which creates light"],
    );
    bad(&scene("data = 'a.bin'\n[elements.O]\n"), &["bad.toml: `data`", "a.bin"]);
    let sky = |file: &str| scene(&format!("[sky]\nkind = 'image'\nimage = '{file}'\n"));
    bad(&sky("no.hdr"), &["bad.toml: `[sky]`: no.hdr: cannot be read"]);
    bad(&sky("scene.toml"), &["bad.toml: `[sky]`: scene.toml: this is neither a Radiance HDR"]);
    refused(
        &[
            ("bad.toml", &sky("cut.hdr")),
            ("cut.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9 +X 9\n"),
        ],
        "bad.toml -o out.png",
        1,
        &["bad.toml: `[sky]`: cut.hdr: ", "incomplete"],
    );
    refused(
        &[
            ("bad.toml", "data = 'water.xyz'\ncolor = 'red'\n[studio]\n"),
            ("water.xyz", "1\n\nO 0 0 0\n"),
        ],
        "bad.toml -o out.png",
        1,
        &["`data`"],
    );
}

#[test]
fn data_that_would_create_light() {
    let folder = Folder::with(&[("bright.toml", "data = 'a.npy'\ncolor = [2, 2, 2]\n[studio]\n")]);
    folder.run("generate random -n 10 -o a.npy").succeeded();
    let run = folder.run("render bright.toml -o out.png --backend cpu");
    assert_eq!(run.code, 1);
    let words = "error: bright.toml: line 1, column 8: sphere 0 has the color [2.0, 2.0, 2.0], which creates light";
    assert!(run.stderr.starts_with(words), "{}", run.stderr);
    assert_eq!(folder.files(), ["a.npy", "bright.toml"]);

    let text = "data = 'a.npy'\n[studio]\n[elements.O]\nopacity = 0.5\n";
    std::fs::write(folder.path("elements.toml"), text).unwrap();
    let run = folder.run("render elements.toml -o out.png --backend cpu");
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("`elements` applies only to data with text"), "{}", run.stderr);
}

/// An environment map with a given third texel.
fn map(texel: f32) -> Vec<u8> {
    let channels = SpecificChannels::rgb(|at: exr::prelude::Vec2<usize>| {
        let value = if at.x() == 2 { texel } else { 1.0 };
        (value, value, value)
    });
    let mut bytes = Vec::new();
    let image = exr::prelude::Image::from_channels((4, 2), channels);
    image.write().to_buffered(std::io::Cursor::new(&mut bytes)).unwrap();
    bytes
}

#[test]
fn a_sky_that_is_not_valid_radiance() {
    let folder =
        Folder::with(&[("scene.toml", &scene("[sky]\nkind = 'image'\nimage = 'sky.exr'\n"))]);
    for (texel, words) in [(f32::NAN, "NaN"), (-1.0, "-1.0"), (f32::INFINITY, "inf")] {
        std::fs::write(folder.path("sky.exr"), map(texel)).unwrap();
        let run = folder.run("render scene.toml -o out.png --backend cpu --samples 1");
        assert_eq!(run.code, 1, "{}", run.stderr);
        let place = "scene.toml: `[sky]`: sky.exr: the texel in column 2 of row 0 is [";
        assert!(run.stderr.contains(place) && run.stderr.contains(words), "{}", run.stderr);
        assert_eq!(folder.files(), ["scene.toml", "sky.exr"]);
    }
    std::fs::write(folder.path("sky.exr"), map(0.5)).unwrap();
    folder.run("render scene.toml -o out.png --backend cpu --samples 1").succeeded();
    // An input is never overwritten. The studio does not need the sky, so its file may be missing.
    let run = folder.run("render scene.toml -o sky.exr --backend cpu --samples 1");
    assert_eq!((run.code, run.stderr.contains("also an input")), (2, true), "{}", run.stderr);
    std::fs::remove_file(folder.path("sky.exr")).unwrap();
    folder.run("render scene.toml -o out.png --backend cpu --integrator studio").succeeded();
}

#[test]
fn a_scene_without_light_is_black_with_alpha_and_a_note() {
    let dark = "lights = []\n[studio]\nambient = 'black'\n[output]\ntransparent = true\n";
    let folder = Folder::with(&[("dark.toml", &scene(dark))]);
    let run = folder.run("render dark.toml -o out.png --backend cpu --samples 4").succeeded();
    assert!(run.stderr.starts_with("note: no light: "), "{}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1);
    let png = image::load_from_memory(&folder.read("out.png")).unwrap();
    let pixels: Vec<[u8; 4]> = png.to_rgba8().pixels().map(|pixel| pixel.0).collect();
    assert!(pixels.iter().all(|[r, g, b, _]| [*r, *g, *b] == [0; 3]));
    assert_eq!((pixels[0][3], pixels[9 * 24 + 12][3]), (0, 255));
}

#[test]
fn the_same_job_gives_the_same_bytes() {
    let folder = Folder::with(&[("scene.toml", &scene("[studio]\n[studio.occlusion]\n"))]);
    let render = |name: &str, flags: &str| {
        folder.run(&format!("render scene.toml -o {name} --backend cpu {flags}")).succeeded();
        folder.read(name)
    };
    let first = render("a.png", "--samples 3 --seed 5");
    assert!(first == render("b.png", "--samples 3 --seed 5"), "two runs differ");
    for flags in
        ["--samples 4 --seed 5", "--samples 3 --seed 6", "--samples 3 --seed 5 --filter box"]
    {
        assert!(first != render("c.png", flags), "{flags} changes nothing");
    }
}

#[test]
fn flags_make_a_lit_picture() {
    let touching = "[[spheres]]\ncenter = [0.5, 0.5, 1]\nradius = 0.4\n";
    let folder = Folder::with(&[("scene.toml", &format!("{SCENE}{touching}"))]);
    let render = |flags: &str| {
        folder.run(&format!("render scene.toml -o out.png --backend cpu {flags}")).succeeded();
        decode(&folder.read("out.png")).2
    };
    let plain = render("");
    let mut pictures = vec![plain];
    for flags in [
        "--samples 1",
        "--ao --samples 1",
        "--outline 2 --samples 1",
        "--integrator path --samples 1",
    ] {
        let picture = render(flags);
        assert!(!pictures.contains(&picture), "{flags}");
        pictures.push(picture);
    }
}

#[test]
fn layers_of_samples() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let layers =
        "--layer samples=s.npy --layer variance=v.npy --layer alpha=a.npy --layer id=i.npy";
    folder
        .run(&format!("render scene.toml -o out.png --backend cpu --samples 5 {layers}"))
        .succeeded();
    fn read<T: npyz::Deserialize>(folder: &Folder, name: &str) -> Vec<T> {
        npyz::NpyFile::new(&folder.read(name)[..]).unwrap().into_vec().unwrap()
    }
    assert_eq!(read::<u32>(&folder, "s.npy"), vec![5; 24 * 18]);
    assert!(read::<f32>(&folder, "v.npy").iter().any(|variance| *variance > 0.0));
    assert!(read::<f32>(&folder, "a.npy").iter().any(|alpha| *alpha > 0.0 && *alpha < 1.0));
    assert_eq!(read::<u32>(&folder, "i.npy")[9 * 24 + 12], 0);
}

/// Primary rays can be asked for explicitly; a lit scene is then rendered without light.
#[test]
fn primary_rays_are_an_integrator() {
    let lit = scene("[studio]\n[studio.occlusion]\n[sampling]\nsamples = 3\n");
    let asked = scene("integrator = 'primary'\n");
    let clear = format!("{asked}opacity = 0.5\n");
    let folder = Folder::with(&[
        ("scene.toml", SCENE),
        ("lit.toml", &lit),
        ("asked.toml", &asked),
        ("clear.toml", &clear),
    ]);
    let render = |arguments: &str| {
        let run = folder.run(&format!("render {arguments} -o out.png --backend cpu")).succeeded();
        (folder.read("out.png"), run.stderr)
    };
    for transparent in ["", " --transparent"] {
        let plain = render(&format!("scene.toml{transparent}"));
        assert_eq!(plain.1, "");
        for view in
            ["scene.toml --integrator primary", "lit.toml --integrator primary", "asked.toml"]
        {
            assert!(render(&format!("{view}{transparent}")) == plain, "{view}{transparent}");
        }
        let (picture, said) = render(&format!("clear.toml{transparent}"));
        assert!(picture == plain.0, "opacity shows");
        assert!(said.starts_with("note: primary rays ignore opacity"), "{said}");
    }
    let run = folder.run("render asked.toml -o out.png --backend cpu --samples 2");
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("--samples applies only to the integrators `studio` and `path`"));
    assert!(render("asked.toml --integrator studio --samples 1") != render("asked.toml"));
}

#[test]
fn notes_tell_what_is_not_drawn_as_asked() {
    let glass = "[materials.glass]\nkind = 'dielectric'\n";
    let text = format!("{}material = 'glass'\n", scene(glass));
    let folder = Folder::with(&[("glass.toml", &text), ("water.xyz", "1\n\nO 0 0 0\n")]);
    let run = folder.run("render glass.toml -o out.png --backend cpu --samples 1").succeeded();
    assert!(run.stderr.starts_with("note: metal and glass are matt in a studio"), "{}", run.stderr);
    let run =
        folder.run("render glass.toml -o out.png --backend cpu --samples 1 --integrator path");
    assert_eq!(run.succeeded().stderr, "");

    let text = "data = 'water.xyz'\n[elements.O]\ncolor = 'blue'\n[elements.Fe]\nopacity = 0.5\n[film]\nwidth = 8\nheight = 8\n";
    std::fs::write(folder.path("atoms.toml"), text).unwrap();
    let run = folder.run("render atoms.toml -o out.png --backend cpu --samples 1").succeeded();
    assert_eq!(
        run.stderr,
        "note: `[elements.Fe]`: no atom of water.xyz has this name; check its spelling or remove the table\n"
    );
}
