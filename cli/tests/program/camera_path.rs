//! Tests of movies whose camera moves along keyframes.

use crate::support::{Folder, decode};

const SMALL: &str = "--backend cpu --size 40x20 --style fast -q";

/// One sphere, seen from the right, from the front and from the left.
const PATH: &str = "ease = false\n\
    [[keys]]\nframe = 0\neye = [-4, 0, 20]\nlook_at = [-4, 0, 0]\n\
    [[keys]]\nframe = 2\neye = [4, 0, 20]\nlook_at = [4, 0, 0]\n";

const SCENE: &str = "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\n";

/// The first and the last column of a picture that is not background.
fn columns(png: &[u8]) -> [usize; 2] {
    let (width, height, rgb) = decode(png);
    let at = |column: usize, row: usize| &rgb[3 * (row * width as usize + column)..][..3];
    let mut seen = (0..width as usize)
        .filter(|&column| (0..height as usize).any(|row| at(column, row) != at(0, 0)));
    let first = seen.next().unwrap();
    [first, seen.next_back().unwrap_or(first)]
}

#[test]
fn one_scene_has_the_pictures_up_to_the_last_key() {
    let folder = Folder::with(&[("s.toml", SCENE), ("p.toml", PATH)]);
    folder.run(&format!("render s.toml -o f%d.png --camera-path p.toml {SMALL}")).succeeded();
    assert_eq!(folder.files(), ["f0.png", "f1.png", "f2.png", "p.toml", "s.toml"]);
    let [a, b, c] = ["f0.png", "f1.png", "f2.png"].map(|name| columns(&folder.read(name)));
    // The camera goes to the right, so the sphere goes to the left, through the middle of the picture.
    assert!(a[0] > b[1] && b[0] > c[1], "{a:?} {b:?} {c:?}");
    assert_eq!([b[0] + b[1], a[0] + c[1]], [39; 2]);
    // At a key, the camera is the one that flags give.
    let flags = "--eye 4,0,20 --look-at 4,0,0";
    folder.run(&format!("render s.toml -o one.png {flags} {SMALL}")).succeeded();
    assert!(decode(&folder.read("one.png")) == decode(&folder.read("f2.png")));
    // --frames chooses some pictures, which stay as they are.
    folder
        .run(&format!("render s.toml -o g%d.png --camera-path p.toml --frames 1: {SMALL}"))
        .succeeded();
    assert!(decode(&folder.read("g1.png")) == decode(&folder.read("f1.png")));
    assert!(!folder.files().contains(&"g0.png".to_owned()));
}

#[test]
fn a_scene_file_has_its_own_path() {
    let keys = PATH.replace("[[keys]]", "[[camera_path.keys]]");
    let scene = format!("{SCENE}[camera_path]\n{keys}");
    let folder = Folder::with(&[("s.toml", &scene), ("p.toml", PATH), ("bare.toml", SCENE)]);
    folder.run(&format!("render s.toml -o m.apng {SMALL}")).succeeded();
    folder.run(&format!("render bare.toml -o n.apng --camera-path p.toml {SMALL}")).succeeded();
    assert!(folder.read("m.apng") == folder.read("n.apng"));
    let loud = SMALL.replace(" -q", "");
    for (command, note) in [
        ("-o one.png", "`camera_path` is not used, because this is one picture"),
        ("-o t%d.png --turntable 2", "--turntable replaced `camera_path`"),
        ("-o u%d.png --camera-path p.toml", "--camera-path replaced `camera_path`"),
    ] {
        let run = folder.run(&format!("render s.toml {command} {loud}")).succeeded();
        assert!(run.stderr.contains(note), "{command}: {}", run.stderr);
    }
}

/// Each frame of a trajectory is seen from its place on the path.
#[test]
fn a_trajectory_is_seen_from_a_moving_camera() {
    // The atom goes with the camera.
    let frames: String = (0..3).map(|i| format!("1\n\nO {} 0 0\n", 4 * i - 4)).collect();
    let folder = Folder::with(&[("a.xyz", &frames), ("p.toml", PATH)]);
    folder.run(&format!("render a.xyz -o f%d.png --camera-path p.toml {SMALL}")).succeeded();
    let all = ["f0.png", "f1.png", "f2.png"].map(|name| columns(&folder.read(name)));
    assert!(all.iter().all(|[first, last]| first + last == 39), "{all:?}");
    // Of one frame, the camera sees a sphere that stands still.
    let rest = format!("--camera-path p.toml --frame 1 {SMALL}");
    folder.run(&format!("render a.xyz -o g%d.png {rest}")).succeeded();
    let [a, b, c] = ["g0.png", "g1.png", "g2.png"].map(|name| columns(&folder.read(name)));
    assert!(a[0] > b[1] && b[0] > c[1], "{a:?} {b:?} {c:?}");
}

/// Seconds are multiplied by the pictures of each second.
#[test]
fn times_are_seconds_of_the_movie() {
    let path = PATH.replace("frame = 2", "time = 0.5").replace("frame", "time");
    let folder = Folder::with(&[("s.toml", SCENE), ("p.toml", &path), ("q.toml", PATH)]);
    let rest = format!("--camera-path p.toml --fps 4 {SMALL}");
    folder.run(&format!("render s.toml -o f%d.png {rest}")).succeeded();
    folder.run(&format!("render s.toml -o g%d.png --camera-path q.toml {SMALL}")).succeeded();
    for number in 0..3 {
        let [a, b] = ["f", "g"].map(|name| folder.read(&format!("{name}{number}.png")));
        assert!(decode(&a) == decode(&b), "{number}");
    }
    assert!(!folder.files().contains(&"f3.png".to_owned()));
}

/// Two atoms at the ends of a rod: from the side the rod is long, from its end short, and it always fits.
#[test]
fn views_go_around_the_scene() {
    let path = "[[keys]]\nframe = 0\nview = '0,0'\nzoom = 1\n[[keys]]\nframe = 2\nview = '0,0'\nturn = 180\nzoom = 0.5\n";
    let rod = "2\nrod\nO -4 0 0\nO 4 0 0\n";
    let folder = Folder::with(&[("rod.xyz", rod), ("p.toml", path)]);
    folder.run(&format!("render rod.xyz -o f%d.png --camera-path p.toml {SMALL}")).succeeded();
    let [a, b, c] = ["f0.png", "f1.png", "f2.png"].map(|name| {
        let [first, last] = columns(&folder.read(name));
        assert!(first > 0 && last < 39 && first + last == 39, "{name}: {first} {last}");
        last - first
    });
    assert!(a > 2 * b && a.abs_diff(2 * c) <= 2, "{a} {b} {c}");
}

/// Each is one line, exit code 2 or 1, and no file.
#[test]
fn wrong_paths_are_one_line() {
    let late = PATH.replace("frame = 2", "frame = 0");
    let inside = PATH.replace("look_at = [4, 0, 0]", "look_at = [4, 0, 20]");
    let folder = Folder::with(&[
        ("s.toml", SCENE),
        ("p.toml", PATH),
        ("late.toml", &late),
        ("inside.toml", &inside),
        ("typo.toml", &PATH.replace("eye", "eey")),
        ("one.toml", "[[keys]]\nframe = 0\nview = 'x'\n"),
        ("far.toml", &PATH.replace("frame = 2", "frame = 1e8")),
        ("fov.toml", &format!("{PATH}vertical_fov = 20\n")),
    ]);
    let before = folder.files();
    for (arguments, code, expected) in [
        ("-o f.png --camera-path p.toml", 2, "every frame needs a name of its own"),
        ("-o f%d.png --camera-path p.toml --view x", 2, "cannot be used with"),
        ("-o f%d.png --camera-path p.toml --turntable 3", 2, "cannot be used with"),
        ("-o f%d.png --camera-path p.toml --camera-from 0", 2, "--camera-from applies only"),
        ("-o f%d.png --camera-path p.toml --frames 7", 2, "there is no frame 7"),
        ("-o f%d.png --camera-path none.toml", 1, "none.toml: "),
        ("-o f%d.png --camera-path late.toml", 1, "late.toml: line 6, column 1: key 1 is at 0.0"),
        ("-o f%d.png --camera-path inside.toml", 1, "line 6, column 1: key 1: the eye and the"),
        ("-o f%d.png --camera-path typo.toml", 1, "line 4, column 1: unknown key `eey`"),
        ("-o f%d.png --camera-path one.toml", 1, "at least two keys, but there is only one"),
        ("-o f%d.png --camera-path far.toml", 2, "at most 100000 pictures"),
        (
            "-o f%d.png --camera-path fov.toml --camera fisheye",
            1,
            "the camera cannot follow its path: unknown field `vertical_fov`",
        ),
        ("-o f%d.png --camera-path s.toml", 1, "unknown key `spheres`"),
    ] {
        let run = folder.run(&format!("render s.toml {arguments} --backend cpu"));
        assert_eq!(run.code, code, "{arguments}: {}", run.stderr);
        assert!(
            run.stderr.starts_with("error: ") && run.stderr.contains(expected),
            "{arguments}: {}",
            run.stderr
        );
        assert_eq!(folder.files(), before, "{arguments}");
    }
}
