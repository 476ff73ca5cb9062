//! Tests of pictures: light and framing, styles, files, and pairs of pictures for two eyes.

use std::io::Cursor;

use exr::prelude::{ReadChannels, ReadLayers};
use npyz::NpyFile;

use crate::support::{Folder, Run, SCENE, WATER, decode};

const THREE_SPHERES: &str = include_str!("../../../examples/three-spheres.toml");

fn folder() -> Folder {
    Folder::with(&[("three.toml", THREE_SPHERES), ("scene.toml", SCENE)])
}

#[track_caller]
fn render(folder: &Folder, arguments: &str) -> Run {
    let run = folder.run(&format!("render {arguments} --backend cpu --size 80x60")).succeeded();
    assert_eq!(run.stderr, "", "{arguments}");
    run
}

/// The names of the channels of an EXR.
fn channels(file: Vec<u8>) -> Vec<String> {
    let read = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    let image = read.first_valid_layer().all_attributes().from_buffered(Cursor::new(file)).unwrap();
    assert_eq!(image.layer_data.size, exr::math::Vec2(80, 60));
    let channels = image.layer_data.channel_data.list.into_iter();
    channels.map(|channel| channel.name.to_string()).collect()
}

fn rgba(png: &[u8]) -> image::DynamicImage {
    image::load_from_memory_with_format(png, image::ImageFormat::Png).unwrap()
}

#[test]
fn an_exr_has_the_layers_that_are_named() {
    let folder = folder();
    render(&folder, "three.toml -o out.exr");
    assert_eq!(channels(folder.read("out.exr")), ["A", "B", "G", "R"]);
    let layers = "--layer depth --layer id --layer normal=n.npy --layer samples --layer color";
    render(&folder, &format!("three.toml -o out.exr {layers} --transparent"));
    assert_eq!(folder.files(), ["n.npy", "out.exr", "scene.toml", "three.toml"]);
    let channels = channels(folder.read("out.exr"));
    assert_eq!(channels, ["A", "B", "G", "R", "Z", "id", "samples"]);
}

#[test]
fn scenes_say_how_they_are_written_and_flags_come_first() {
    let folder = folder();
    let output = "[output]\nexposure = -1\ntone = 'agx'\ntransparent = true\nbits = 16\n";
    // Keys at the top level must come before the first table.
    let (keys, tables) = THREE_SPHERES.split_once("[film]").unwrap();
    let scene = format!("{keys}{output}[film]{tables}");
    std::fs::write(folder.path("output.toml"), scene).unwrap();
    let picture = |arguments: &str| render(&folder, &format!("{arguments} -o -")).stdout;
    let by_scene = picture("output.toml");
    assert_eq!(rgba(&by_scene).color(), image::ColorType::Rgba16);
    let flags = "--exposure -1 --tone agx --transparent --bits 16";
    assert_eq!(picture(&format!("three.toml {flags}")), by_scene);
    for (flags, same) in [
        ("--exposure 0", "--tone agx --transparent --bits 16"),
        ("--tone none", "--exposure -1 --transparent --bits 16"),
        ("--transparent=false", "--exposure -1 --tone agx --bits 16"),
        ("--bits 8", "--exposure -1 --tone agx --transparent=true"),
        ("--bits 8 --exposure 0 --tone none --transparent=false", ""),
    ] {
        let expected = picture(&format!("three.toml {same}"));
        assert_ne!(expected, by_scene, "{flags}");
        assert_eq!(picture(&format!("output.toml {flags}")), expected, "{flags}");
    }
    // An EXR file stores the light, so the keys for PNG do not change it.
    render(&folder, "output.toml -o a.exr");
    render(&folder, "three.toml -o b.exr --transparent");
    assert_eq!(folder.read("a.exr"), folder.read("b.exr"));
}

#[test]
#[cfg(unix)]
fn a_full_disk_leaves_one_line_and_no_file() {
    let folder = folder();
    for output in ["out.exr", "out.png"] {
        // The limit is 4 KiB, so that the empty file can be created that is tried before the work.
        let run = folder.run_with_blocks(8, &format!("render three.toml -o {output} --backend cpu"));
        run.refused(1, &format!("{output}: cannot be written: File too large"));
        assert_eq!(folder.files(), ["scene.toml", "three.toml"]);
    }
}

const LIT: &str = "[film]\nwidth = 24\nheight = 18\n[camera.pinhole]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                     [[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'tomato'\n";

/// The scene with more keys or tables before the others.
fn scene(top: &str) -> String {
    format!("{top}{LIT}")
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
fn flags_make_a_lit_picture() {
    let touching = "[[spheres]]\ncenter = [0.5, 0.5, 1]\nradius = 0.4\n";
    let folder = Folder::with(&[("scene.toml", &format!("{LIT}{touching}"))]);
    let render = |flags: &str| {
        folder.run(&format!("render scene.toml -o out.png --backend cpu {flags}")).succeeded();
        decode(&folder.read("out.png")).2
    };
    let mut pictures = vec![render("")];
    for flags in [
        "--samples 1",
        "--samples 1 --seed 5",
        "--samples 1 --filter box",
        "--ao --samples 1",
        "--outline 2 --samples 1",
        "--integrator path --samples 1",
    ] {
        let picture = render(flags);
        assert!(!pictures.contains(&picture), "{flags}");
        pictures.push(picture);
    }
    assert!(render("--samples 1") == pictures[1], "two runs differ");
    // A studio does not need the sky, so its file may be missing.
    let sky = scene("[sky]\nkind = 'image'\nimage = 'no.hdr'\n");
    std::fs::write(folder.path("scene.toml"), sky).unwrap();
    render("--integrator studio --samples 1");
}

/// Primary rays can be asked for explicitly; a lit scene is then rendered without light.
#[test]
fn primary_rays_are_an_integrator() {
    let lit = scene("[studio]\n[studio.occlusion]\n[sampling]\nsamples = 3\n");
    let asked = scene("integrator = 'primary'\n");
    let clear = format!("{asked}opacity = 0.5\n");
    let folder =
        Folder::with(&[("scene.toml", LIT), ("lit.toml", &lit), ("asked.toml", &asked), ("clear.toml", &clear)]);
    let render = |arguments: &str| {
        let run = folder.run(&format!("render {arguments} -o out.png --backend cpu")).succeeded();
        (folder.read("out.png"), run.stderr)
    };
    for transparent in ["", " --transparent"] {
        let plain = render(&format!("scene.toml{transparent}"));
        assert_eq!(plain.1, "");
        for view in ["scene.toml --integrator primary", "lit.toml --integrator primary", "asked.toml"] {
            assert!(render(&format!("{view}{transparent}")) == plain, "{view}{transparent}");
        }
        let (picture, said) = render(&format!("clear.toml{transparent}"));
        assert!(picture == plain.0, "opacity shows");
        assert!(said.starts_with("note: primary rays ignore opacity"), "{said}");
    }
    assert!(render("asked.toml --integrator studio --samples 1") != render("asked.toml"));
}

#[test]
fn notes_tell_what_is_not_drawn_as_asked() {
    let glass = "[materials.glass]\nkind = 'dielectric'\n";
    let text = format!("{}material = 'glass'\n", scene(glass));
    let folder = Folder::with(&[("glass.toml", &text), ("water.xyz", "1\n\nO 0 0 0\n")]);
    let run = folder.run("render glass.toml -o out.png --backend cpu --samples 1").succeeded();
    assert!(run.stderr.starts_with("note: metal and glass are matt in a studio"), "{}", run.stderr);
    let run = folder.run("render glass.toml -o out.png --backend cpu --samples 1 --integrator path");
    assert_eq!(run.succeeded().stderr, "");

    let text = "data = 'water.xyz'\n[elements.O]\ncolor = 'blue'\n[elements.Fe]\nopacity = 0.5\n[film]\nwidth = 8\nheight = 8\n";
    std::fs::write(folder.path("atoms.toml"), text).unwrap();
    let run = folder.run("render atoms.toml -o out.png --backend cpu --samples 1").succeeded();
    assert_eq!(
        run.stderr,
        "note: `[elements.Fe]`: no atom of water.xyz has this name; check its spelling or remove the table\n"
    );
}

const DATA: [(&str, &str); 6] = [
    ("water.xyz", WATER),
    ("scene.toml", SCENE),
    ("beads.csv", "x,y,z,d,w,t\n0,0,0,1,0.5,1\n1,0,0.5,0.7,0.9,10\n0,2,0,1.5,nan,30\n"),
    ("kinds.csv", "x,y,z,species\n0,0,0,head\n1,2,0,tail\n3,0,0,head\n"),
    ("clear.csv", "x,y,z,radius,alpha,q\n0,0,0,1,51,1\n0,0.5,1,1,102,0.5\n3,0,0,1,255,0.2\n"),
    ("plain.txt", "0,0,0,1\n1,2,0,2\n3,0,0,3.5\n"),
];

/// The picture that a command renders.
#[track_caller]
fn picture(folder: &Folder, arguments: &str) -> Vec<u8> {
    folder.run(&format!("render {arguments} -o out.png --backend cpu --quiet")).succeeded();
    folder.read("out.png")
}

#[test]
fn a_printed_scene_gives_the_same_bytes() {
    let folder = Folder::with(&DATA);
    for arguments in [
        "water.xyz --size 40x30",
        "water.xyz --size 30x40 --view iso --turn 12 --zoom 1.5 --margin 10% --samples 3",
        "water.xyz --size 24x24 --style studio --ao=2 --outline 2.5 --background tomato --tone agx",
        "water.xyz --size 24x24 --style path --samples 2 --denoise=false --exposure 0.3",
        "water.xyz --size 24x24 --style flat --camera orthographic --bits 16",
        "water.xyz --size 24x24 --style fast --camera panorama",
        "scene.toml --style illustration --seed 7",
        "scene.toml --samples 4",
        "water.xyz --size 60x45 --color-by y --cmap batlow_r --cmap-reverse --range 2%, --legend=left --samples 2",
        "water.xyz --size 60x45 --color-by species --legend --legend-title Kind --scale-bar=Å@0.9,0.9 --label a@top \
         --label b --text-scale 1.5 --text-color navy --panel always --dpi 300 --samples 2",
        "beads.csv --size 60x45 --radius-by d*0.5 --opacity-by w --emission-by t*2 --color-by t --log --samples 2",
        "beads.csv --size 30x20 --style fast --radius-by d --color-by w --missing-color tomato",
        "kinds.csv --size 30x20 --legend --samples 2",
        "clear.csv --size 30x20 --samples 2",
        "clear.csv --size 30x20 --samples 2 --opacity-by q",
        "kinds.csv --size 30x20 --color navy --samples 2",
        "plain.txt --format csv --columns x,y,z,q --size 30x20 --color-by q --samples 2",
        "scene.toml --camera thin-lens --aperture-radius 0.1 --samples 2",
    ] {
        let run = folder.run(&format!("render {arguments} --print-scene --quiet")).succeeded();
        assert_eq!(run.stderr, "", "{arguments}");
        std::fs::write(folder.path("printed.toml"), &run.stdout).unwrap();
        let text = String::from_utf8(run.stdout).unwrap();
        assert!(picture(&folder, arguments) == picture(&folder, "printed.toml"), "{arguments}\n{text}");
        // Printing a printed scene gives the same text again, apart from its name.
        let again = folder.run("render printed.toml --print-scene --quiet").succeeded();
        let again = String::from_utf8(again.stdout).unwrap();
        let body = |text: &str| text.split_once("\n\n").unwrap().1.to_owned();
        assert_eq!(body(&again), body(&text), "{arguments}");
    }
}

#[test]
fn the_line_about_a_picture_has_flags_to_use_again() {
    let folder = Folder::with(&DATA);
    let small = "-o out.png --backend cpu --size 20x15 --samples 1";
    let said = |arguments: &str| folder.run(&format!("render {arguments} {small}")).succeeded().said;
    let start = |text: &str| said(text).unwrap().rsplit_once("; ").unwrap().0.to_owned();
    assert_eq!(start("water.xyz"), "water.xyz: 3 atoms, 2 bonds; --kind molecules --style default");
    assert_eq!(
        start("water.xyz --style flat --view 30,20 --turn 5"),
        "water.xyz: 3 atoms, 2 bonds; --kind molecules --style flat --view 30,20 --turn 5"
    );
    assert_eq!(start("scene.toml"), "scene.toml: 1 sphere");
    assert_eq!(start("kinds.csv"), "kinds.csv: 3 atoms; --kind particles --style default --view z --color-by species");
    assert_eq!(start("kinds.csv --color red"), "kinds.csv: 3 atoms; --kind particles --style default --view z");
    assert_eq!(said("water.xyz --quiet"), None);
}

/// A grey background keeps its bytes, whatever exposure and tone curve do to the spheres in front of it.
#[test]
fn the_background_survives_every_tone_curve() {
    let folder = Folder::with(&DATA);
    for style in ["default", "fast", "flat", "studio", "illustration", "path"] {
        let small = format!("water.xyz --size 24x18 --style {style} --background #808080 --zoom 0.5");
        let small = if style == "fast" { small } else { format!("{small} --samples 1") };
        // With path tracing, the ground hides the background.
        let small = format!("{small} --view z");
        let plain = decode(&picture(&folder, &small)).2;
        for flags in ["--tone filmic", "--tone agx", "--exposure 2", "--exposure -1 --tone agx"] {
            let changed = decode(&picture(&folder, &format!("{small} {flags}"))).2;
            let grey = |pixels: &[u8]| pixels.chunks(3).filter(|p| *p == [0x80; 3]).count();
            assert!(changed.starts_with(&[0x80; 3]), "{style} {flags}: {:?}", &changed[..3]);
            assert!(grey(&changed) >= 300 && plain != changed, "{style} {flags}");
        }
    }
}

/// The opacities in a data file are used if no scene file overrides them.
#[test]
fn a_file_may_say_how_clear_its_spheres_are() {
    let folder = Folder::with(&DATA);
    let small = "clear.csv --size 30x20 --samples 2";
    let own = picture(&folder, small);
    std::fs::write(folder.path("q.csv"), DATA[4].1.replace("alpha", "beta")).unwrap();
    assert!(own != picture(&folder, "q.csv --size 30x20 --samples 2"));
    assert!(own != picture(&folder, &format!("{small} --opacity-by q")));
}

/// Kinds that are not elements have different colours, unless a flag says otherwise.
#[test]
fn kinds_are_colored_where_nothing_else_gives_colors() {
    let folder = Folder::with(&DATA);
    let small = "--size 30x20 --style flat --view z";
    let run = folder.run(&format!("render kinds.csv {small} -o a.png --backend cpu"));
    let note =
        "note: kinds.csv: there are no colors; the spheres are colored by species; --color CSS gives all one color";
    assert!(run.stderr.lines().any(|line| line == note), "{}", run.stderr);
    let by = |flags: &str| picture(&folder, &format!("kinds.csv {small} {flags}"));
    let (default, explicit, one) = (by(""), by("--color-by species"), by("--color #123456"));
    assert!(default == explicit && default != one);
    assert!(by("--color-by x") != default);
    let is = |wanted: [u8; 3]| decode(&one).2.chunks(3).any(|pixel| pixel == wanted);
    assert!(is([0x12, 0x34, 0x56]) && !is([0xe6, 0x9f, 0x00]));
}

/// Notes do not mention names that are not elements if a scene file describes them.
#[test]
fn a_note_leaves_out_what_a_scene_file_gives() {
    let folder = Folder::with(&[("beads.xyz", "3\n\nC 0 0 0\nXa 2 0 0\nXb 4 0 0\n")]);
    let said = |scene: &str| {
        std::fs::write(folder.path("scene.toml"), scene).unwrap();
        let run = folder.run("render scene.toml -o out.png --backend cpu --size 8x8");
        let lines = run.stderr.lines().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(run.code, 0, "{lines:?}");
        lines
    };
    let base = "data = 'beads.xyz'\n";
    let [all] = &said(base)[..] else { panic!() };
    assert!(all.contains("elements: Xa, Xb; they are drawn in pink with radius 2"), "{all}");
    let [one] = &said(&format!("{base}[elements.Xa]\nradius = 1\n"))[..] else { panic!() };
    assert!(one.contains("beads.xyz: these species") && one.contains("elements: Xb; "), "{one}");
    let both = format!("{base}[elements.Xa]\nradius = 1\n[elements.Xb]\ncolor = 'red'\n");
    assert_eq!(said(&both), [""; 0]);
    let [colored] = &said(&format!("color_by = 'species'\n{base}"))[..] else { panic!() };
    assert!(colored.contains("Xa, Xb; they are drawn with radius 2"), "{colored}");
}

#[test]
fn simulations_have_z_up_and_molecules_y() {
    let dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\n\
                ITEM: ATOMS id x y z radius\n1 1 1 1 0.5\n2 2 3 1.5 0.5\n";
    let atoms = "4\n\nO 0 0 0\nO 2 0 0\nO 0 3 0\nO 0 0 4\n";
    let folder = Folder::with(&[("a.dump", dump), ("a.xyz", atoms)]);
    for (arguments, up) in [
        ("a.dump", "up = [0.0, 0.0, 1.0]"),
        ("a.dump --view 10,50 --turn 3", "up = [0.0, 0.0, 1.0]"),
        ("a.dump --up 0,1,0", "up = [0.0, 1.0, 0.0]"),
        ("a.xyz --up 0,0,1", "up = [0.0, 0.0, 1.0]"),
        ("a.xyz", "up = [0.0, 1.0, 0.0]"),
    ] {
        let run = folder.run(&format!("render {arguments} --print-scene --quiet")).succeeded();
        let printed = String::from_utf8(run.stdout).unwrap();
        assert!(printed.contains(up), "{arguments}: {printed}");
    }
}

const TWO_EYES: &str = "[film]\nwidth = 40\nheight = 30\n\
                     [camera.pinhole]\neye = [0, 0, 5]\ndirection = [0, 0, -1]\n\
                     stereo = { separation = 1, convergence = 5 }\n\
                     [[spheres]]\ncenter = [0, 0, 2]\nradius = 0.4\ncolor = 'red'\n";

/// Width, height, and the red columns of every row.
fn red(png: &[u8]) -> (u32, u32, Vec<Vec<usize>>) {
    let (width, height, pixels) = decode(png);
    let rows = pixels.chunks(3 * width as usize).map(|row| {
        let is_red = |pixel: &[u8]| pixel[1] == 0;
        (0..width as usize).filter(|i| is_red(&row[3 * i..3 * i + 3])).collect()
    });
    (width, height, rows.collect())
}

#[test]
fn side_by_side_and_two_files_have_the_same_pictures() {
    let folder = Folder::with(&[("scene.toml", TWO_EYES)]);
    let layers = "--layer depth=depth.npy --layer id=id.npy --backend cpu";
    folder.run(&format!("render scene.toml -o both.png {layers}")).succeeded();
    let two = "--stereo two-files --layer depth=d.npy --layer normal=n.npy --backend cpu";
    folder.run(&format!("render scene.toml -o eye.png {two}")).succeeded();
    assert_eq!(
        folder.files(),
        [
            "both.png",
            "d-left.npy",
            "d-right.npy",
            "depth.npy",
            "eye-left.png",
            "eye-right.png",
            "id.npy",
            "n-left.npy",
            "n-right.npy",
            "scene.toml"
        ]
    );
    let (width, height, both) = red(&folder.read("both.png"));
    assert_eq!((width, height), (80, 30));
    let (_, _, left) = red(&folder.read("eye-left.png"));
    let (_, _, right) = red(&folder.read("eye-right.png"));
    for (both, (left, right)) in both.iter().zip(left.iter().zip(&right)) {
        let joined = left.iter().copied().chain(right.iter().map(|i| i + 40));
        assert_eq!(*both, joined.collect::<Vec<_>>());
    }
    // The sphere is nearer than the screen, so the left eye sees it farther to the right.
    let middle = |rows: &[Vec<usize>]| {
        let all: Vec<usize> = rows.iter().flatten().copied().collect();
        all.iter().sum::<usize>() as f64 / all.len() as f64
    };
    assert!(middle(&left) > middle(&right) + 5.0);

    let array = |name: &str| {
        let bytes = folder.read(name);
        let file = NpyFile::new(&bytes[..]).unwrap();
        (file.shape().to_vec(), file.into_vec::<f32>().unwrap())
    };
    let (shape, depth) = array("depth.npy");
    assert_eq!(shape, [30, 80]);
    let [(_, left), (_, right)] = [array("d-left.npy"), array("d-right.npy")];
    for (row, both) in depth.chunks(80).enumerate() {
        assert_eq!(both[..40], left[row * 40..][..40]);
        assert_eq!(both[40..], right[row * 40..][..40]);
    }
}

#[test]
fn flags_make_two_eyes_as_well() {
    let folder = Folder::with(&[("scene.toml", TWO_EYES)]);
    folder.run("render scene.toml -o table.png --backend cpu").succeeded();
    let flags = "--eye 0,0,5 --direction 0,0,-1 --separation 1 --convergence 5";
    folder.run(&format!("render scene.toml -o flags.png --backend cpu {flags}")).succeeded();
    assert_eq!(folder.read("table.png"), folder.read("flags.png"));
    let around = "--camera panorama --eye 0,0,5 --direction 0,0,-1 --separation 1";
    folder.run(&format!("render scene.toml -o around.png --backend cpu {around}")).succeeded();
    assert_eq!(decode(&folder.read("around.png")).0, 80);
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_work() {
    let folder = Folder::with(&[("scene.toml", TWO_EYES)]);
    std::fs::create_dir(folder.path("eye-left.png")).unwrap();
    let run = folder.run("render scene.toml -o eye.png --stereo two-files --backend cpu");
    assert_eq!((run.code, run.stderr.lines().count()), (2, 1), "{}", run.stderr);
    assert!(run.stderr.contains("eye-left.png: this is a folder"), "{}", run.stderr);
    assert!(!folder.path("eye-right.png").exists());
}
