//! Tests of several pictures at once: frames of a file, turntables, moving cameras, movies, and the colours common to
//! all pictures.

use crate::support::{Folder, decode};

/// Five frames of one atom that moves along x, from 0 to 8.
fn moving() -> String {
    (0..5).map(|frame| format!("1\nframe {frame}\nO {} 0 0\n", 2 * frame)).collect()
}

const SMALL: &str = "--backend cpu --size 40x20 --style fast --view z -q";

fn folder() -> Folder {
    Folder::with(&[("a.xyz", &moving())])
}

/// The columns of a picture that are not background.
fn columns(png: &[u8]) -> Vec<usize> {
    let (width, height, rgb) = decode(png);
    let background = &rgb[..3];
    let at = |column: usize, row: usize| &rgb[3 * (row * width as usize + column)..][..3];
    (0..width as usize).filter(|&column| (0..height as usize).any(|row| at(column, row) != background)).collect()
}

/// The first and the last of these columns.
fn ends(png: &[u8]) -> [usize; 2] {
    let columns = columns(png);
    [columns[0], columns[columns.len() - 1]]
}

#[track_caller]
fn assert_same(folder: &Folder, names: [&str; 2]) {
    let [a, b] = names.map(|name| decode(&folder.read(name)));
    assert!(a == b, "{names:?} differ");
}

/// Several files make the pictures of one file with their frames, however they are named.
#[test]
fn files_whose_names_differ_in_a_number_are_frames() {
    let folder = folder();
    for frame in 0..5 {
        let text = format!("1\nframe {frame}\nO {} 0 0\n", 2 * frame);
        std::fs::write(folder.path(&format!("s.{}.xyz", 10 * frame)), text).unwrap();
    }
    folder.run(&format!("render a.xyz -o a%d.png {SMALL}")).succeeded();
    let two = "s.40.xyz s.20.xyz";
    let all = "s.0.xyz s.10.xyz s.20.xyz s.30.xyz s.40.xyz";
    for (number, names) in [all, "s.*.xyz", two, "s.{20,40}.xyz"].into_iter().enumerate() {
        folder.run(&format!("{names} -o b{number}_%d.png --camera-from 0 {SMALL}")).succeeded();
    }
    for frame in 0..5 {
        let names = [0, 1].map(|number| format!("b{number}_{frame}.png"));
        assert_same(&folder, [&names[0], &names[1]]);
    }
    folder.run(&format!("s.*.xyz -o c%d.png {SMALL}")).succeeded();
    (0..5).for_each(|frame| assert_same(&folder, [&format!("a{frame}.png"), &format!("c{frame}.png")]));
    [0, 1].iter().for_each(|frame| assert_same(&folder, [&format!("b2_{frame}.png"), &format!("b3_{frame}.png")]));
    // One picture says that there are more.
    let run = folder.run("s.*.xyz --backend cpu --size 40x20").succeeded();
    assert!(run.stderr.contains("the first of several frames") && run.stderr.contains("wrote s.png"), "{}", run.stderr);
    folder.refuses(&format!("{all} s.png -o d.gif"), 2, "s.png: this is a picture, not a frame; quote the name");
    folder.refuses("s.0.xyz s.png -o d.gif", 2, "s.png: only files of data");
    folder.refuses("none.*.xyz -o d.gif", 1, "a number in the place of the *");
}

#[test]
fn other_files_are_seen_together() {
    let folder = folder();
    for (name, x) in [("one.xyz", 0), ("two.xyz", 5)] {
        std::fs::write(folder.path(name), format!("1\n\nO {x} 0 0\n")).unwrap();
    }
    std::fs::write(folder.path("both.xyz"), "2\n\nO 0 0 0\nO 5 0 0\n").unwrap();
    // The picture has the name of the first.
    folder.run(&format!("one.xyz two.xyz {SMALL}")).succeeded();
    folder.run(&format!("both.xyz -o both.png {SMALL}")).succeeded();
    assert_same(&folder, ["one.png", "both.png"]);
    std::fs::write(folder.path("scene.toml"), "data = '{one.xyz,two.xyz}'\n").unwrap();
    let by_file = format!("--color-by file --kind plain {SMALL}");
    folder.run(&format!("one.xyz two.xyz -o c.png {by_file}")).succeeded();
    folder.run(&format!("scene.toml -o d.png {SMALL}")).succeeded();
    assert_ne!(folder.read("c.png"), folder.read("one.png"));
    folder.run(&format!("one.xyz two.xyz -o e%d.png {SMALL}")).succeeded();
    assert_ne!(folder.read("e0.png"), folder.read("e1.png"));
    folder.refuses(&format!("one.xyz missing.xyz {SMALL}"), 2, "missing.xyz: there is no such file");
}

#[test]
fn frames_have_numbers_and_one_camera() {
    let folder = folder();
    folder.run(&format!("render a.xyz -o f%03d.png --frames 0::2 {SMALL}")).succeeded();
    assert_eq!(folder.files(), ["a.xyz", "f000.png", "f002.png", "f004.png"]);
    let [first, middle, last] = ["f000.png", "f002.png", "f004.png"].map(|name| columns(&folder.read(name)));
    // The camera does not move, so the sphere goes from the left margin through the middle to the right margin.
    let width = |columns: &[usize]| columns.len();
    assert!(width(&first).abs_diff(width(&middle)) <= 1, "{first:?} {middle:?}");
    assert!(first[0] >= 1 && first[0] <= 6, "{first:?}");
    assert_eq!(middle[0] + middle[middle.len() - 1], 39, "{middle:?}");
    assert_eq!(first[0], 39 - last[last.len() - 1], "{first:?} {last:?}");
}

#[test]
fn one_frame_may_say_where_the_camera_stands() {
    let folder = folder();
    folder.run(&format!("render a.xyz -o f%d.png --frames 0:2 --camera-from -5 {SMALL}")).succeeded();
    folder.run(&format!("render a.xyz -o one.png --frame 0 {SMALL}")).succeeded();
    assert_same(&folder, ["f0.png", "one.png"]);
    assert!(decode(&folder.read("f1.png")) != decode(&folder.read("one.png")));
}

#[test]
fn layers_have_names_of_their_own() {
    let folder = folder();
    let command = format!("render a.xyz -o f%d.exr --layer depth=d%02d.npy --layer id --frames :2 {SMALL}");
    folder.run(&command).succeeded();
    assert_eq!(folder.files(), ["a.xyz", "d00.npy", "d01.npy", "f0.exr", "f1.exr"]);
}

#[test]
fn resume_leaves_out_what_is_there() {
    let folder = folder();
    std::fs::write(folder.path("f1.png"), "mine").unwrap();
    let command = format!("render a.xyz -o f%d.png --frames :3 --resume {SMALL}").replace(" -q", "");
    let run = folder.run(&command).succeeded();
    assert_eq!(run.stderr, "note: 1 of 3 frames are there already and are not rendered again\n");
    assert_eq!(folder.read("f1.png"), b"mine");
    assert_eq!(folder.files(), ["a.xyz", "f0.png", "f1.png", "f2.png"]);
    let run = folder.run(&command).succeeded();
    assert_eq!(run.stderr, "note: 3 of 3 frames are there already and are not rendered again\n");
    // The other frames are framed as if all were rendered.
    folder.run(&format!("render a.xyz -o all%d.png --frames :3 {SMALL}")).succeeded();
    assert_same(&folder, ["f2.png", "all2.png"]);
}

/// A frame that cannot be read ends the job. Earlier frames stay, but a movie does not.
#[test]
fn what_was_written_stays_when_a_later_frame_fails() {
    let text = moving().replace("O 4 0 0", "O 4 x 0");
    let folder = Folder::with(&[("a.xyz", &text)]);
    let run = folder.run(&format!("render a.xyz -o f%d.png --frames : --camera-from 0 {SMALL}"));
    run.refused(1, "error: frame 2: a.xyz: ");
    assert_eq!(folder.files(), ["a.xyz", "f0.png", "f1.png"]);
    folder.refuses(&format!("render a.xyz -o m.apng --camera-from 0 {SMALL}"), 1, "");
}

#[test]
fn an_animated_png_has_the_pictures_of_the_files() {
    let folder = folder();
    folder.run(&format!("render a.xyz -o m.apng --fps 10 {SMALL}")).succeeded();
    folder.run(&format!("render a.xyz -o f%d.png --frames : {SMALL}")).succeeded();
    let mut reader = png::Decoder::new(std::io::Cursor::new(folder.read("m.apng"))).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (5, 0));
    for frame in 0..5 {
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut rgb).unwrap();
        let delay = reader.info().frame_control().unwrap();
        assert_eq!((delay.delay_num, delay.delay_den), (1, 10));
        assert!(rgb == decode(&folder.read(&format!("f{frame}.png"))).2, "frame {frame}");
    }
}

#[test]
fn a_gif_has_all_frames_with_their_times() {
    let folder = folder();
    folder.run(&format!("render a.xyz -o m.gif --frames ::-1 {SMALL}")).succeeded();
    let bytes = folder.read("m.gif");
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(&bytes[..]).unwrap();
    let mut delays = Vec::new();
    let mut lefts = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        delays.push(frame.delay);
        let background = frame.buffer[..4].to_vec();
        let is_sphere = |column: usize| frame.buffer[4 * (10 * 40 + column)..][..4] != background;
        lefts.push((0..40).position(is_sphere).unwrap());
    }
    assert_eq!(delays, [4; 5]);
    assert!(lefts.windows(2).all(|pair| pair[0] > pair[1]), "{lefts:?}");
}

#[test]
fn y4m_on_standard_output() {
    let folder = folder();
    let run = folder.run(&format!("render a.xyz -o - --raw y4m --frames 1:3 --fps 30 {SMALL}")).succeeded();
    let header = b"YUV4MPEG2 W40 H20 F30:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
    assert_eq!(&run.stdout[..header.len()], header);
    assert_eq!(run.stdout.len(), header.len() + 2 * (6 + 3 * 40 * 20));
    assert_eq!(&run.stdout[header.len()..][..6], b"FRAME\n");
    assert_eq!(folder.files(), ["a.xyz"]);
}

/// Two atoms at the ends of a rod: seen from the side, the rod is long, then short, then long again.
#[test]
fn a_turntable_goes_once_around() {
    let folder = Folder::with(&[("rod.xyz", "2\nrod\nO -4 0 0\nO 4 0 0\n")]);
    folder.run(&format!("render rod.xyz -o t%d.png --turntable 4 {SMALL}")).succeeded();
    assert_eq!(folder.files(), ["rod.xyz", "t0.png", "t1.png", "t2.png", "t3.png"]);
    let [a, b, c, d] = ["t0.png", "t1.png", "t2.png", "t3.png"].map(|name| {
        let [first, last] = ends(&folder.read(name));
        last - first
    });
    assert!(a > 2 * b && a.abs_diff(c) <= 1 && b.abs_diff(d) <= 1, "{a} {b} {c} {d}");
    folder.run(&format!("render rod.xyz -o t.apng --turntable 3 {SMALL}")).succeeded();
}

#[test]
fn frames_of_the_data_of_a_scene() {
    let scene =
        "data = 'a.xyz'\n[film]\nwidth = 40\nheight = 20\n[camera.pinhole]\neye = [4, 0, 40]\nlook_at = [4, 0, 0]\n";
    let folder = Folder::with(&[("a.xyz", &moving()), ("s.toml", scene)]);
    folder.run("render s.toml -o f%d.png --frames 3: --backend cpu -q").succeeded();
    folder.run("render s.toml -o one.png --frame 4 --backend cpu -q").succeeded();
    assert_same(&folder, ["f4.png", "one.png"]);
    assert_eq!(folder.files(), ["a.xyz", "f3.png", "f4.png", "one.png", "s.toml"]);
}

#[cfg(unix)]
mod with_a_program {
    use std::os::unix::fs::PermissionsExt;
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    use super::*;
    use crate::support::send;

    /// Runs the program with a script in the place of `ffmpeg`.
    fn run_with(folder: &Folder, script: &str, arguments: &str) -> (i32, String) {
        let tools = tempfile::tempdir().unwrap();
        let program = tools.path().join("ffmpeg");
        std::fs::write(&program, format!("#!/bin/sh\n{script}\n")).unwrap();
        std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
        let mut command = folder.command(arguments);
        let path = format!("{}:/usr/bin:/bin", tools.path().display());
        let output = command.env("PATH", path).output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
    }

    /// Copies the input to the file that the last argument names.
    const COPY: &str = "[ \"$1\" = -version ] && exit 0\nfor last; do :; done\ncat > \"$last\"";

    #[test]
    fn ffmpeg_is_given_all_frames() {
        let folder = folder();
        let arguments = format!("render a.xyz -o m.mp4 {SMALL}").replace("40x20", "39x19");
        assert_eq!(run_with(&folder, COPY, &arguments), (0, String::new()));
        // Odd sides are one pixel longer.
        assert_eq!(folder.read("m.mp4").len(), 5 * 3 * 40 * 20);
        assert_eq!(folder.files(), ["a.xyz", "m.mp4"]);
    }

    #[test]
    fn a_failure_of_ffmpeg_is_one_line_and_no_file() {
        let folder = folder();
        let fails =
            "[ \"$1\" = -version ] && exit 0\nhead -c 100 > /dev/null\necho first >&2\necho no such codec >&2\nexit 3";
        let (code, stderr) = run_with(&folder, fails, &format!("render a.xyz -o m.mkv {SMALL}"));
        assert_eq!((code, stderr.as_str()), (1, "error: m.mkv: cannot be written: ffmpeg failed: no such codec\n"));
        assert_eq!(folder.files(), ["a.xyz"]);
    }

    #[test]
    fn without_ffmpeg_other_formats_are_named() {
        let folder = folder();
        let mut command = folder.command(&format!("render a.xyz -o m.webm {SMALL}"));
        let output = command.env("PATH", folder.path("")).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains("ffmpeg") && stderr.contains(".apng, .gif or f%04d.png"), "{stderr}");
        assert_eq!(stderr.lines().count(), 1);
        assert_eq!(folder.files(), ["a.xyz"]);
    }

    /// After Ctrl-C there are only whole files, and `--resume` makes the others.
    #[test]
    fn a_signal_keeps_the_frames_that_are_complete() {
        let text: String = (0..400).map(|i| format!("1\n\nO {} 0 0\n", f64::from(i) * 0.01)).collect();
        let folder = Folder::with(&[("a.xyz", &text)]);
        let arguments = "render a.xyz -o f%03d.png --frames : --backend cpu --size 160x120 -q";
        let mut command = folder.command(arguments);
        let child = command.stderr(Stdio::piped()).spawn().unwrap();
        let started = Instant::now();
        while !folder.path("f002.png").exists() {
            assert!(started.elapsed() < Duration::from_secs(60), "no frame was written");
            std::thread::sleep(Duration::from_millis(5));
        }
        send("-INT", &child);
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(130), "{stderr}");
        assert_eq!(stderr, "stopped; the frames that were written are complete, and --resume goes on after them\n");
        let files = folder.files();
        assert!(files.len() > 3 && files.len() < 401, "{}", files.len());
        for (number, name) in files.iter().skip(1).enumerate() {
            assert_eq!(*name, format!("f{number:03}.png"));
            assert_eq!(decode(&folder.read(name)).0, 160);
        }
    }
}

const MOVED: &str = "--backend cpu --size 40x20 --style fast -q";

/// One sphere, seen from the right, from the front and from the left.
const PATH: &str = "ease = false\n\
    [[keys]]\nframe = 0\neye = [-4, 0, 20]\nlook_at = [-4, 0, 0]\n\
    [[keys]]\nframe = 2\neye = [4, 0, 20]\nlook_at = [4, 0, 0]\n";

const SPHERE: &str = "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\n";

#[test]
fn one_scene_has_the_pictures_up_to_the_last_key() {
    let folder = Folder::with(&[("s.toml", SPHERE), ("p.toml", PATH)]);
    folder.run(&format!("render s.toml -o f%d.png --camera-path p.toml {MOVED}")).succeeded();
    assert_eq!(folder.files(), ["f0.png", "f1.png", "f2.png", "p.toml", "s.toml"]);
    let [a, b, c] = ["f0.png", "f1.png", "f2.png"].map(|name| ends(&folder.read(name)));
    // The camera moves to the right, so the sphere moves to the left through the middle of the picture.
    assert!(a[0] > b[1] && b[0] > c[1], "{a:?} {b:?} {c:?}");
    assert_eq!([b[0] + b[1], a[0] + c[1]], [39; 2]);
    // At a key, the camera is the same as from flags.
    let flags = "--eye 4,0,20 --look-at 4,0,0";
    folder.run(&format!("render s.toml -o one.png {flags} {MOVED}")).succeeded();
    assert!(decode(&folder.read("one.png")) == decode(&folder.read("f2.png")));
    // --frames chooses some pictures, which do not change.
    folder.run(&format!("render s.toml -o g%d.png --camera-path p.toml --frames 1: {MOVED}")).succeeded();
    assert!(decode(&folder.read("g1.png")) == decode(&folder.read("f1.png")));
    assert!(!folder.files().contains(&"g0.png".to_owned()));
}

#[test]
fn a_scene_file_has_its_own_path() {
    let keys = PATH.replace("[[keys]]", "[[camera_path.keys]]");
    let scene = format!("{SPHERE}[camera_path]\n{keys}");
    let folder = Folder::with(&[("s.toml", &scene), ("p.toml", PATH), ("bare.toml", SPHERE)]);
    folder.run(&format!("render s.toml -o m.apng {MOVED}")).succeeded();
    folder.run(&format!("render bare.toml -o n.apng --camera-path p.toml {MOVED}")).succeeded();
    assert!(folder.read("m.apng") == folder.read("n.apng"));
    let loud = MOVED.replace(" -q", "");
    for (command, note) in [
        ("-o one.png", "`camera_path` is not used, because this is one picture"),
        ("-o t%d.png --turntable 2", "--turntable replaced `camera_path`"),
        ("-o u%d.png --camera-path p.toml", "--camera-path replaced `camera_path`"),
    ] {
        let run = folder.run(&format!("render s.toml {command} {loud}")).succeeded();
        assert!(run.stderr.contains(note), "{command}: {}", run.stderr);
    }
}

/// Each frame of a trajectory is seen from its own position on the path.
#[test]
fn a_trajectory_is_seen_from_a_moving_camera() {
    // The atom moves with the camera.
    let frames: String = (0..3).map(|i| format!("1\n\nO {} 0 0\n", 4 * i - 4)).collect();
    let folder = Folder::with(&[("a.xyz", &frames), ("p.toml", PATH)]);
    folder.run(&format!("render a.xyz -o f%d.png --camera-path p.toml {MOVED}")).succeeded();
    let all = ["f0.png", "f1.png", "f2.png"].map(|name| ends(&folder.read(name)));
    assert!(all.iter().all(|[first, last]| first + last == 39), "{all:?}");
    // With one frame, the camera sees a sphere that does not move.
    let rest = format!("--camera-path p.toml --frame 1 {MOVED}");
    folder.run(&format!("render a.xyz -o g%d.png {rest}")).succeeded();
    let [a, b, c] = ["g0.png", "g1.png", "g2.png"].map(|name| ends(&folder.read(name)));
    assert!(a[0] > b[1] && b[0] > c[1], "{a:?} {b:?} {c:?}");
}

/// Seconds are multiplied by the number of pictures for each second.
#[test]
fn times_are_seconds_of_the_movie() {
    let path = PATH.replace("frame = 2", "time = 0.5").replace("frame", "time");
    let folder = Folder::with(&[("s.toml", SPHERE), ("p.toml", &path), ("q.toml", PATH)]);
    let rest = format!("--camera-path p.toml --fps 4 {MOVED}");
    folder.run(&format!("render s.toml -o f%d.png {rest}")).succeeded();
    folder.run(&format!("render s.toml -o g%d.png --camera-path q.toml {MOVED}")).succeeded();
    for number in 0..3 {
        let [a, b] = ["f", "g"].map(|name| folder.read(&format!("{name}{number}.png")));
        assert!(decode(&a) == decode(&b), "{number}");
    }
    assert!(!folder.files().contains(&"f3.png".to_owned()));
}

/// Two atoms at the ends of a rod. The rod is long from its side and short from its end, and it always fits.
#[test]
fn views_go_around_the_scene() {
    let path =
        "[[keys]]\nframe = 0\nview = '0,0'\nzoom = 1\n[[keys]]\nframe = 2\nview = '0,0'\nturn = 180\nzoom = 0.5\n";
    let rod = "2\nrod\nO -4 0 0\nO 4 0 0\n";
    let folder = Folder::with(&[("rod.xyz", rod), ("p.toml", path)]);
    folder.run(&format!("render rod.xyz -o f%d.png --camera-path p.toml {MOVED}")).succeeded();
    let [a, b, c] = ["f0.png", "f1.png", "f2.png"].map(|name| {
        let [first, last] = ends(&folder.read(name));
        assert!(first > 0 && last < 39 && first + last == 39, "{name}: {first} {last}");
        last - first
    });
    assert!(a > 2 * b && a.abs_diff(2 * c) <= 2, "{a} {b} {c}");
}

/// A scene whose spheres lie in the middle rows, so that a legend at the top covers none.
const FLAT: &str = "data = 'a.xyz'\nshading = 'flat'\n[film]\nwidth = 80\nheight = 80\n\
                     [camera.orthographic]\neye = [3, 0, 9]\nlook_at = [3, 0, 0]\nhalf_extent = [4, 4]\n";

/// A frame of spheres at x = 0, 2, 4, 6, each with a value of the column `v`.
fn frame(kind: char, values: &[&str]) -> String {
    let head = format!("{}\nProperties=species:S:1:pos:R:3:radius:R:1:v:{kind}:1\n", values.len());
    let rows = values.iter().enumerate().map(|(i, value)| format!("C {} 0 0 1 {value}\n", 2 * i));
    head + &rows.collect::<String>()
}

/// Renders frames. Returns the colours in the middles of the spheres, and the pixels above the spheres.
fn colors_of(kind: char, frames: &[&[&str]], flags: &str) -> (Vec<Vec<[u8; 3]>>, Vec<Vec<u8>>) {
    let text: String = frames.iter().map(|values| frame(kind, values)).collect();
    let folder = Folder::with(&[("a.xyz", &text), ("scene.toml", FLAT)]);
    let legend = "--legend=top --text-scale 0.5";
    let frames_flag = format!("-o f%d.png --frames : --color-by v -q --backend cpu {legend} {flags}");
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
    let (colors, legends) = colors_of('S', &[&["c", "a"], &["b", "c"], &["c"]], "");
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
    // The first and the last frame alone have so few whole numbers that they would be categories.
    let (colors, legends) = colors_of('R', &[&["0", "7"], &["0.5", "3", "0"], &["7"]], "");
    assert_eq!(colors[0][0], [0x44, 0x01, 0x54]);
    assert_eq!(colors[0][1], [0xfd, 0xe7, 0x25]);
    assert_eq!([colors[1][2], colors[2][0]], [colors[0][0], colors[0][1]]);
    assert!(legends.iter().all(|legend| *legend == legends[0]));
}

#[test]
fn what_the_frame_of_the_camera_lacks_has_the_color_of_missing_values() {
    let (colors, legends) = colors_of('S', &[&["b", "a"], &["c", "b"]], "--camera-from 0");
    assert_eq!(colors[1][0], [0x80; 3]);
    assert_eq!(colors[1][1], colors[0][0]);
    assert!(legends.iter().all(|legend| *legend == legends[0]));
}

/// Types of a dump colour the spheres without a flag, even in a frame with one type.
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
    let flags = "--backend cpu --size 80x40 --style fast --view z --radius 1 --kind plain -q";
    folder.run(&format!("render a.lammpstrj -o f%d.png --frames : {flags}")).succeeded();
    let right = ["f0.png", "f1.png"].map(|name| {
        let (_, _, rgb) = decode(&folder.read(name));
        let last = (0..80).rev().find(|x| rgb[3 * (20 * 80 + x)..][..3] != rgb[..3]).unwrap();
        let start = 3 * (20 * 80 + last - 6);
        [rgb[start], rgb[start + 1], rgb[start + 2]]
    });
    assert_eq!(right[0], right[1]);
}
