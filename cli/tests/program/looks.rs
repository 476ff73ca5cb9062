//! Tests of styles, views, printed scenes, and of the line about a picture.

use crate::support::{Folder, SCENE, WATER, decode};

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
        assert!(
            picture(&folder, arguments) == picture(&folder, "printed.toml"),
            "{arguments}\n{text}"
        );
        // What is printed of a printed scene is the same again, but for its name.
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
    let said =
        |arguments: &str| folder.run(&format!("render {arguments} {small}")).succeeded().said;
    let start = |text: &str| said(text).unwrap().rsplit_once("; ").unwrap().0.to_owned();
    assert_eq!(start("water.xyz"), "water.xyz: 3 atoms; --style default --view y");
    assert_eq!(
        start("water.xyz --style flat --view 30,20 --turn 5"),
        "water.xyz: 3 atoms; --style flat --view 30,20 --turn 5"
    );
    assert_eq!(start("scene.toml"), "scene.toml: 1 sphere");
    assert_eq!(
        start("kinds.csv"),
        "kinds.csv: 3 atoms; --style default --view z --color-by species"
    );
    assert_eq!(start("kinds.csv --color red"), "kinds.csv: 3 atoms; --style default --view z");
    assert_eq!(said("water.xyz --quiet"), None);
}

/// A grey background keeps its bytes, whatever the exposure and the tone curve do to the spheres before it.
#[test]
fn the_background_survives_every_tone_curve() {
    let folder = Folder::with(&DATA);
    for style in ["default", "fast", "flat", "studio", "illustration", "path"] {
        let small =
            format!("water.xyz --size 24x18 --style {style} --background #808080 --zoom 0.5");
        let small = if style == "fast" { small } else { format!("{small} --samples 1") };
        // The ground of paths hides the background.
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

/// More samples smooth the picture, and change neither its light nor its background.
#[test]
fn samples_do_not_change_the_light() {
    let folder = Folder::with(&DATA);
    let mean = |arguments: &str| {
        let (.., pixels) = decode(&picture(&folder, arguments));
        // The mean of light, not of bytes, which follow a curve.
        let light = |byte: &u8| (f64::from(*byte) / 255.0).powf(2.2);
        pixels.iter().map(light).sum::<f64>() / pixels.len() as f64
    };
    for input in ["scene.toml", "water.xyz --size 40x30"] {
        let (plain, smooth) = (mean(input), mean(&format!("{input} --samples 24")));
        assert!((plain - smooth).abs() < 0.015, "{input}: {plain}, {smooth}");
    }
}

#[test]
fn views_that_contradict_are_refused() {
    let folder = Folder::with(&DATA);
    for (flags, word) in [
        ("--view x --eye 0,0,9 --look-at 0,0,0", "--view"),
        ("--view up", "iso"),
        ("--margin 0.6", "margin"),
        ("--margin 1%x", "10%"),
        ("--zoom 0", "zoom"),
        ("--eye 0,0,9 --look-at 0,0,0 --margin 0.1", "margin"),
        ("--camera fisheye --zoom 2", "fisheye"),
        ("--style nice", "illustration"),
        ("--background nocolor", "--background"),
        ("--style fast --samples 4", "--style"),
    ] {
        let run = folder.run(&format!("render water.xyz -o out.png --backend cpu {flags}"));
        assert_eq!(run.code, 2, "{flags}: {}", run.stderr);
        assert!(run.stderr.contains(word), "{flags}: {}", run.stderr);
    }
    // Every named view works, whatever is up.
    for view in ["x", "-x", "y", "-y", "z", "-z", "iso", "10,-90"] {
        for up in ["", "--up 0,0,1", "--up 1,0,0"] {
            picture(&folder, &format!("water.xyz --size 12x9 --samples 1 --view {view} {up}"));
        }
    }
}

/// Opacities of a file itself are not lost where no scene file asks for them.
#[test]
fn a_file_may_say_how_clear_its_spheres_are() {
    let folder = Folder::with(&DATA);
    let small = "clear.csv --size 30x20 --samples 2";
    let own = picture(&folder, small);
    std::fs::write(folder.path("q.csv"), DATA[4].1.replace("alpha", "beta")).unwrap();
    assert!(own != picture(&folder, "q.csv --size 30x20 --samples 2"));
    assert!(own != picture(&folder, &format!("{small} --opacity-by q")));
}

/// Kinds that are no elements are told apart, unless a flag says otherwise.
#[test]
fn kinds_are_colored_where_nothing_else_gives_colors() {
    let folder = Folder::with(&DATA);
    let small = "--size 30x20 --style flat --view z";
    let run = folder.run(&format!("render kinds.csv {small} -o a.png --backend cpu"));
    let note = "note: kinds.csv: there are no colors; the spheres are colored by species; --color CSS gives all one color";
    assert!(run.stderr.lines().any(|line| line == note), "{}", run.stderr);
    let by = |flags: &str| picture(&folder, &format!("kinds.csv {small} {flags}"));
    let (default, explicit, one) = (by(""), by("--color-by species"), by("--color #123456"));
    assert!(default == explicit && default != one);
    assert!(by("--color-by x") != default);
    let is = |wanted: [u8; 3]| decode(&one).2.chunks(3).any(|pixel| pixel == wanted);
    assert!(is([0x12, 0x34, 0x56]) && !is([0xe6, 0x9f, 0x00]));
}

/// What a scene file says about names that are no elements is not asked for again.
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
