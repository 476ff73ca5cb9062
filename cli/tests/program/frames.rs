//! Tests of several pictures at once: frames of a file, turntables, movies.

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
    (0..width as usize)
        .filter(|&column| (0..height as usize).any(|row| at(column, row) != background))
        .collect()
}

#[track_caller]
fn assert_same(folder: &Folder, names: [&str; 2]) {
    let [a, b] = names.map(|name| decode(&folder.read(name)));
    assert!(a == b, "{names:?} differ");
}

#[test]
fn frames_have_numbers_and_one_camera() {
    let folder = folder();
    folder.run(&format!("render a.xyz -o f%03d.png --frames 0::2 {SMALL}")).succeeded();
    assert_eq!(folder.files(), ["a.xyz", "f000.png", "f002.png", "f004.png"]);
    let [first, middle, last] =
        ["f000.png", "f002.png", "f004.png"].map(|name| columns(&folder.read(name)));
    // The camera stands still: the sphere goes from the left margin through the middle to the right margin.
    let width = |columns: &[usize]| columns.len();
    assert!(width(&first).abs_diff(width(&middle)) <= 1, "{first:?} {middle:?}");
    assert!(first[0] >= 1 && first[0] <= 6, "{first:?}");
    assert_eq!(middle[0] + middle[middle.len() - 1], 39, "{middle:?}");
    assert_eq!(first[0], 39 - last[last.len() - 1], "{first:?} {last:?}");
}

#[test]
fn one_frame_may_say_where_the_camera_stands() {
    let folder = folder();
    folder
        .run(&format!("render a.xyz -o f%d.png --frames 0:2 --camera-from -5 {SMALL}"))
        .succeeded();
    folder.run(&format!("render a.xyz -o one.png --frame 0 {SMALL}")).succeeded();
    assert_same(&folder, ["f0.png", "one.png"]);
    assert!(decode(&folder.read("f1.png")) != decode(&folder.read("one.png")));
}

#[test]
fn layers_have_names_of_their_own() {
    let folder = folder();
    let command =
        format!("render a.xyz -o f%d.exr --layer depth=d%02d.npy --layer id --frames :2 {SMALL}");
    folder.run(&command).succeeded();
    assert_eq!(folder.files(), ["a.xyz", "d00.npy", "d01.npy", "f0.exr", "f1.exr"]);
}

#[test]
fn resume_leaves_out_what_is_there() {
    let folder = folder();
    std::fs::write(folder.path("f1.png"), "mine").unwrap();
    let command =
        format!("render a.xyz -o f%d.png --frames :3 --resume {SMALL}").replace(" -q", "");
    let run = folder.run(&command).succeeded();
    assert_eq!(run.stderr, "note: 1 of 3 frames are there already and are not rendered again\n");
    assert_eq!(folder.read("f1.png"), b"mine");
    assert_eq!(folder.files(), ["a.xyz", "f0.png", "f1.png", "f2.png"]);
    let run = folder.run(&command).succeeded();
    assert_eq!(run.stderr, "note: 3 of 3 frames are there already and are not rendered again\n");
    // The rest is framed as if all were rendered.
    folder.run(&format!("render a.xyz -o all%d.png --frames :3 {SMALL}")).succeeded();
    assert_same(&folder, ["f2.png", "all2.png"]);
}

/// A frame that cannot be read ends the job; those before it stay, and a movie does not.
#[test]
fn what_was_written_stays_when_a_later_frame_fails() {
    let text = moving().replace("O 4 0 0", "O 4 x 0");
    let folder = Folder::with(&[("a.xyz", &text)]);
    let run = folder.run(&format!("render a.xyz -o f%d.png --frames : --camera-from 0 {SMALL}"));
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(run.stderr.starts_with("error: frame 2: a.xyz: "), "{}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1);
    assert_eq!(folder.files(), ["a.xyz", "f0.png", "f1.png"]);
    let run = folder.run(&format!("render a.xyz -o m.apng --camera-from 0 {SMALL}"));
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert_eq!(folder.files(), ["a.xyz", "f0.png", "f1.png"]);
}

#[test]
fn an_animated_png_has_the_pictures_of_the_files() {
    let folder = folder();
    folder.run(&format!("render a.xyz -o m.apng --fps 10 {SMALL}")).succeeded();
    folder.run(&format!("render a.xyz -o f%d.png --frames : {SMALL}")).succeeded();
    let mut reader =
        png::Decoder::new(std::io::Cursor::new(folder.read("m.apng"))).read_info().unwrap();
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
    let run = folder
        .run(&format!("render a.xyz -o - --raw y4m --frames 1:3 --fps 30 {SMALL}"))
        .succeeded();
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
    let extent = |name: &str| {
        let columns = columns(&folder.read(name));
        columns[columns.len() - 1] - columns[0]
    };
    let [a, b, c, d] = ["t0.png", "t1.png", "t2.png", "t3.png"].map(extent);
    assert!(a > 2 * b && a.abs_diff(c) <= 1 && b.abs_diff(d) <= 1, "{a} {b} {c} {d}");
    folder.run(&format!("render rod.xyz -o t.apng --turntable 3 {SMALL}")).succeeded();
}

/// Colors of a column mean the same in all frames.
#[test]
fn colors_have_one_scale() {
    let head = "Properties=species:S:1:pos:R:3:charge:R:1";
    let text =
        format!("2\n{head}\nO 0 0 0 0.5\nO 4 0 0 1.5\n2\n{head}\nO 0 0 0 1.5\nO 4 0 0 10.5\n");
    let folder = Folder::with(&[("a.xyz", &text)]);
    let rest =
        format!("--color-by charge --integrator primary {SMALL}").replace("--style fast ", "");
    folder.run(&format!("render a.xyz -o f%d.png --frames : {rest}")).succeeded();
    folder.run(&format!("render a.xyz -o one.png --frame 0 --range 0.5,10.5 {rest}")).succeeded();
    assert_same(&folder, ["f0.png", "one.png"]);
}

#[test]
fn frames_of_the_data_of_a_scene() {
    let scene = "data = 'a.xyz'\n[film]\nwidth = 40\nheight = 20\n[camera.pinhole]\neye = [4, 0, 40]\nlook_at = [4, 0, 0]\n";
    let folder = Folder::with(&[("a.xyz", &moving()), ("s.toml", scene)]);
    folder.run("render s.toml -o f%d.png --frames 3: --backend cpu -q").succeeded();
    folder.run("render s.toml -o one.png --frame 4 --backend cpu -q").succeeded();
    assert_same(&folder, ["f4.png", "one.png"]);
    assert_eq!(folder.files(), ["a.xyz", "f3.png", "f4.png", "one.png", "s.toml"]);
}

/// Each is one line, exit code 2, and no file.
#[test]
fn wrong_usage_is_one_line() {
    let scene = "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let folder =
        Folder::with(&[("a.xyz", &moving()), ("s.toml", scene), ("a.csv", "x,y,z\n0,0,0\n")]);
    let before = folder.files();
    for (arguments, expected) in [
        ("a.xyz -o f%d.png", "a % stands for the number of a frame; add --frames RANGE"),
        ("a.xyz -o f.png --frames :", "every frame needs a name of its own"),
        ("a.xyz -o f%s.png --frames :", "the % in this name is not that of a number"),
        (
            "a.xyz -o f%d.png --frames 9",
            "--frames: there is no frame 9; the file has 5 frames, 0 to 4",
        ),
        ("a.xyz -o f%d.png --frames 9:", "--frames: no frame lies in this range"),
        ("a.xyz -o f%d.png --frames a", "write START:END"),
        ("a.xyz -o f%d.png --frames : --camera-from 7", "--camera-from: there is no frame 7"),
        ("a.csv -o f%d.png --frames :", "have no frames"),
        ("a.csv -o m.gif", "make a movie of one frame"),
        ("s.toml -o f%d.png --frames :", "this scene has no `data`"),
        ("a.xyz -o - --frames :", "add --raw y4m"),
        ("a.xyz -o m.gif --raw y4m", "replace -o m.gif by -o -"),
        (
            "a.xyz -o f%d.png --frames : --layer depth=d.npy",
            "d.npy: every frame needs a name of its own",
        ),
        ("a.xyz -o m.gif --layer depth=d.npy", "a movie has no layers"),
        ("a.xyz -o m.gif --transparent", "only .apng may be transparent"),
        ("a.xyz -o m.gif --resume", "--resume applies only to a file for each frame"),
        ("a.xyz -o f.png --resume", "--resume applies only to several pictures"),
        ("a.xyz -o f%d.png --frames : --fps 5", "--fps applies only to movies"),
        ("a.xyz -o m.gif --frame 1", "a movie needs several"),
        ("a.xyz -o m%d.gif", "a movie is one file"),
        ("a.xyz -o f%d.png --frames : --keep-partial", "--keep-partial applies to one picture"),
    ] {
        let run = folder.run(&format!("render {arguments} --backend cpu"));
        assert_eq!(run.code, 2, "{arguments}: {}", run.stderr);
        assert!(
            run.stderr.starts_with("error: ") && run.stderr.contains(expected),
            "{arguments}: {}",
            run.stderr
        );
        assert_eq!(run.stderr.lines().count(), 1, "{arguments}: {}", run.stderr);
        assert_eq!(folder.files(), before, "{arguments}");
    }
}

#[cfg(unix)]
mod with_a_program {
    use std::os::unix::fs::PermissionsExt;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    use super::*;

    /// Runs with a program `ffmpeg` that is this script.
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

    /// Writes all that it reads to the file that its last argument names.
    const COPY: &str = "[ \"$1\" = -version ] && exit 0\nfor last; do :; done\ncat > \"$last\"";

    #[test]
    fn ffmpeg_is_given_all_frames() {
        let folder = folder();
        let arguments = format!("render a.xyz -o m.mp4 {SMALL}").replace("40x20", "39x19");
        assert_eq!(run_with(&folder, COPY, &arguments), (0, String::new()));
        // Odd sides get a pixel.
        assert_eq!(folder.read("m.mp4").len(), 5 * 3 * 40 * 20);
        assert_eq!(folder.files(), ["a.xyz", "m.mp4"]);
    }

    #[test]
    fn a_failure_of_ffmpeg_is_one_line_and_no_file() {
        let folder = folder();
        let fails = "[ \"$1\" = -version ] && exit 0\nhead -c 100 > /dev/null\necho first >&2\necho no such codec >&2\nexit 3";
        let (code, stderr) = run_with(&folder, fails, &format!("render a.xyz -o m.mkv {SMALL}"));
        assert_eq!(
            (code, stderr.as_str()),
            (1, "error: m.mkv: cannot be written: ffmpeg failed: no such codec\n")
        );
        assert_eq!(folder.files(), ["a.xyz"]);
    }

    #[test]
    fn without_ffmpeg_other_formats_are_named() {
        let folder = folder();
        let mut command = folder.command(&format!("render a.xyz -o m.webm {SMALL}"));
        let output = command.env("PATH", folder.path("")).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(
            stderr.contains("ffmpeg") && stderr.contains(".apng, .gif or f%04d.png"),
            "{stderr}"
        );
        assert_eq!(stderr.lines().count(), 1);
        assert_eq!(folder.files(), ["a.xyz"]);
    }

    /// After Ctrl-C there are whole files only, and `--resume` makes the rest.
    #[test]
    fn a_signal_keeps_the_frames_that_are_complete() {
        let text: String =
            (0..400).map(|i| format!("1\n\nO {} 0 0\n", f64::from(i) * 0.01)).collect();
        let folder = Folder::with(&[("a.xyz", &text)]);
        let arguments = "render a.xyz -o f%03d.png --frames : --backend cpu --size 160x120 -q";
        let mut command = folder.command(arguments);
        let child = command.stderr(Stdio::piped()).spawn().unwrap();
        let started = Instant::now();
        while !folder.path("f002.png").exists() {
            assert!(started.elapsed() < Duration::from_secs(60), "no frame was written");
            std::thread::sleep(Duration::from_millis(5));
        }
        let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(130), "{stderr}");
        assert_eq!(
            stderr,
            "stopped; the frames that were written are complete, and --resume goes on after them\n"
        );
        let files = folder.files();
        assert!(files.len() > 3 && files.len() < 401, "{}", files.len());
        for (number, name) in files.iter().skip(1).enumerate() {
            assert_eq!(*name, format!("f{number:03}.png"));
            assert_eq!(decode(&folder.read(name)).0, 160);
        }
    }
}
