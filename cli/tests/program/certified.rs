//! Pictures with a certificate in their file: `render --certify` and `verify PICTURE --scene SCENE`.

use crate::support::Folder;

const SCENE: &str = "[film]\nwidth = 48\nheight = 36\n\
                     [camera.pinhole]\neye = [0.3, 0.2, 4]\nlook_at = [0, 0, 0]\n\
                     [[spheres]]\ncenter = [0, 0, 0]\nradius = 0.6\ncolor = \"tomato\"\n\
                     [[spheres]]\ncenter = [0.5, 0, -0.5]\nradius = 0.5\n";

const DATA: &str = "x,y,z,radius\n0,0,0,1\n1.5,0,0,0.7\n0,1.2,0.5,0.4\n";

fn folder() -> Folder {
    Folder::with(&[("scene.toml", SCENE), ("data.csv", DATA)])
}

fn line(run: &crate::support::Run, start: &str) -> String {
    let text = String::from_utf8_lossy(&run.stdout);
    text.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{text}")).to_owned()
}

/// The size, the samples and the certificate of a PNG.
fn parts(png: &[u8]) -> ([u32; 2], Vec<u8>, String) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut samples).unwrap();
    let info = reader.info();
    ([info.width, info.height], samples, info.uncompressed_latin1_text[0].text.clone())
}

fn written(size: [u32; 2], samples: &[u8], certificate: &str) -> Vec<u8> {
    let mut encoding = pinhole::image::encoding::Encoding::default();
    encoding.transparent = samples.len() as u32 == 4 * size[0] * size[1];
    pinhole_figure::write::png::encode_certified(size, &encoding, samples, certificate).unwrap()
}

/// A picture with another certificate.
fn with_text(png: &[u8], change: impl Fn(&str) -> String) -> Vec<u8> {
    let (size, samples, certificate) = parts(png);
    written(size, &samples, &change(&certificate))
}

#[test]
fn a_picture_is_checked_with_the_scene_alone() {
    let folder = folder();
    for (scene, flags, picture) in [
        ("scene.toml", "", "a.png"),
        ("scene.toml", "--bits 16 --exposure -0.5 --tone agx", "b.png"),
        ("scene.toml", "--transparent --size 40x40", "c.png"),
        ("data.csv", "--style fast --view -x --color teal", "d.png"),
        ("scene.toml", "--layer depth=depth.npy", "e.exr"),
        // Samples, noise filter, lines, legend, seed and encoding all count.
        (
            "data.csv",
            "--style default --samples 8 --legend=right --color-by radius --label Water --size 48x36",
            "f.png",
        ),
        ("data.csv", "--style studio --samples 6 --denoise=false --filter gaussian --size 48x36", "g.png"),
        ("data.csv", "--style illustration --bits 16 --transparent --size 48x36", "h.png"),
        ("scene.toml", "--style path --samples 4 --exposure 0.5 --tone agx --size 48x36", "i.png"),
        ("data.csv", "--style path --samples 4 --separation 0.2 --size 48x36", "j.png"),
        ("data.csv", "--style studio --seed 7 --size 48x36", "k.exr"),
    ] {
        let flags = format!("{flags} --backend cpu --quiet");
        folder.run(&format!("render {scene} -o {picture} --certify {flags}")).succeeded();
        let run = folder.run(&format!("verify {picture} --scene {scene} --json a.json")).succeeded();
        assert!(line(&run, "exact").contains("100.0000 %"), "{picture}");
        assert!(line(&run, "violated").contains(" 0 "), "{picture}");
        let json: serde_json::Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
        assert_eq!((&json["outcome"], &json["violated"]), (&"proved".into(), &0.into()));
        // The picture is the same as without a certificate.
        folder.run(&format!("render {scene} -o plain.{} {flags}", &picture[2..])).succeeded();
        if picture.ends_with("png") {
            let decode = |name: &str| image::open(folder.path(name)).unwrap().to_rgba16();
            assert!(decode(picture) == decode(&format!("plain.{}", &picture[2..])), "{picture}");
        }
    }
}

/// Forges the samples of a picture: each function changes the RGB of a picture with a width.
type Forgery = fn(&mut [u8], usize);

const FORGERIES: [(&str, Forgery); 10] = [
    ("one sample + 1", |rgb, width| rgb[3 * (20 * width + 24) + 1] ^= 1),
    ("a black square", |rgb, width| square(width).for_each(|at| rgb[at] = 0)),
    ("garbage", |rgb, width| square(width).for_each(|at| rgb[at] = (at * 7919 % 256) as u8)),
    ("shuffled", |rgb, width| rgb[3 * 10 * width..3 * 30 * width].reverse()),
    ("mirrored", |rgb, width| rgb.chunks_exact_mut(3 * width).for_each(<[u8]>::reverse)),
    ("shifted by a pixel", |rgb, _| rgb.rotate_right(3)),
    ("rows doubled", |rgb, width| rgb.copy_within(3 * 16 * width..3 * 17 * width, 3 * 17 * width)),
    ("all + 1", |rgb, _| rgb.iter_mut().for_each(|sample| *sample = sample.saturating_add(1))),
    ("all black", |rgb, _| rgb.fill(0)),
    ("a hole filled", |rgb, width| {
        let color: [u8; 3] = rgb[..3].try_into().unwrap();
        square(width).step_by(3).for_each(|at| rgb[at..at + 3].copy_from_slice(&color));
    }),
];

/// The samples of a square of 6 × 6 pixels in the middle.
fn square(width: usize) -> impl Iterator<Item = usize> {
    (0..6).flat_map(move |y| (0..18).map(move |x| 3 * ((15 + y) * width + 21) + x))
}

#[test]
fn forged_pictures_with_light_are_not_proved() {
    let folder = folder();
    for (scene, flags) in [
        ("data.csv", "--style default --samples 8 --color-by radius"),
        ("data.csv", "--style studio --samples 6 --denoise=false --filter gaussian"),
        ("data.csv", "--style illustration --samples 8"),
        ("data.csv", "--style default --samples 8 --label Water --exposure 0.5"),
        ("data.csv", "--style studio --samples 4 --separation 0.2"),
        ("scene.toml", "--style path --samples 4 --denoise=false"),
        ("scene.toml", "--style path --samples 4"),
    ] {
        // From here the value of the one sample is decided.
        let flags = if scene == "data.csv" { format!("{flags} --up 0,1,0") } else { flags.to_owned() };
        folder
            .run(&format!("render {scene} -o a.png --certify {flags} --size 48x36 --backend cpu --quiet"))
            .succeeded();
        let png = folder.read("a.png");
        for (name, forge) in FORGERIES {
            let bytes = forged(&png, |rgb| forge(rgb, 48), |text| text.to_owned());
            std::fs::write(folder.path("b.png"), bytes).unwrap();
            let run = folder.run(&format!("verify b.png --scene {scene}"));
            assert_eq!(run.code, 3, "{name}, {flags}: {}", run.stderr);
        }
        // Another certificate for the same samples.
        for [from, to] in [
            ["setting samples 8", "setting samples 7"],
            ["setting samples 6", "setting samples 5"],
            ["setting size 48x36", "setting size 48x36\nsetting seed 5"],
            ["setting filter gaussian", "setting filter box"],
            ["setting label Water", "setting label Waters"],
            ["setting size 48x36", "setting size 48x36\nsetting ao 3"],
        ] {
            let change = |text: &str| text.replace(from, to);
            let bytes = forged(&png, |_| {}, change);
            std::fs::write(folder.path("b.png"), bytes).unwrap();
            if png.windows(from.len()).any(|part| part == from.as_bytes()) {
                let run = folder.run(&format!("verify b.png --scene {scene}"));
                // Some settings suit only studios.
                let code = if run.stderr.contains("do not suit") { 1 } else { 3 };
                assert_eq!(run.code, code, "{to}, {flags}: {}", run.stderr);
            }
        }
    }
}

/// Alpha is judged as colors are.
#[test]
fn forged_alpha_is_found() {
    let folder = folder();
    for flags in ["--style studio --samples 4", "--style flat", "--style path --samples 4 --exposure 1"] {
        let flags = format!("{flags} --transparent --size 48x36 --backend cpu --quiet");
        folder.run(&format!("render data.csv -o a.png --certify {flags}")).succeeded();
        let png = folder.read("a.png");
        for pixel in [4, 20 * 48 + 24] {
            let bytes = forged(&png, |rgba| rgba[4 * pixel + 3] ^= 1, str::to_owned);
            std::fs::write(folder.path("b.png"), bytes).unwrap();
            let run = folder.run("verify b.png --scene data.csv");
            assert_eq!(run.code, 3, "{pixel}, {flags}: {}", run.stderr);
        }
    }
}

/// Settings of a stranger's certificate that would open files, or compute for days, are refused.
#[test]
fn settings_of_strangers_do_no_harm() {
    let folder = folder();
    folder.run("render data.csv -o a.png --certify --style studio --size 48x36 --backend cpu --quiet").succeeded();
    let png = folder.read("a.png");
    let unknown = "does not understand the settings in the certificate";
    for (setting, code, error) in [
        ("samples 16777216", 1, "takes up to "),
        ("ao 1024\nsetting samples 100000", 1, "takes up to "),
        ("size 30000x30000", 1, "the picture is 48x36, but the certificate's settings ask for 30000x30000"),
        ("topology /etc/passwd", 1, unknown),
        ("set sky={image=\"/dev/zero\"}", 1, unknown),
        ("set data.topology=\"/dev/zero\"", 1, unknown),
        ("frames all", 1, unknown),
        ("camera-path /dev/zero", 1, unknown),
        ("adapter x", 1, unknown),
        ("output /tmp/x.png", 1, unknown),
        ("label", 1, "has no valid line `setting`"),
        ("bits 16", 1, "the samples have 8 bits without alpha"),
    ] {
        let bytes = forged(&png, |_| {}, |text| text.replace("scene-sha", &format!("setting {setting}\nscene-sha")));
        std::fs::write(folder.path("b.png"), bytes).unwrap();
        let run = folder.run("verify b.png --scene data.csv");
        assert_eq!((run.code, run.stderr.contains(error)), (code, true), "{setting}: {run:?}");
    }
}

/// A picture with changed samples and a certificate that fits them.
fn forged(png: &[u8], change: impl Fn(&mut [u8]), text: impl Fn(&str) -> String) -> Vec<u8> {
    let (size, mut samples, certificate) = parts(png);
    change(&mut samples);
    let certificate = text(&certificate);
    let digest = pinhole::verify::picture_certificate::samples_digest(size, &samples);
    let start = certificate.find("samples-sha256 ").unwrap() + 15;
    let sealed = resealed(&format!("{}{digest}{}", &certificate[..start], &certificate[start + 64..]));
    written(size, &samples, &sealed)
}

/// A certificate with a digest that fits it.
fn resealed(text: &str) -> String {
    use sha2::{Digest, Sha256};
    let before = &text[..text.rfind("sha256 ").unwrap()];
    let digits: String = Sha256::digest(before.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    format!("{before}sha256 {digits}\n")
}

#[test]
fn what_was_changed_is_refused() {
    let folder = folder();
    let run = |flags: &str| folder.run(&format!("render {flags} --backend cpu --quiet")).succeeded();
    run("scene.toml -o a.png --certify");
    run("scene.toml -o b.png --certify --exposure 0.4");
    run("scene.toml -o plain.png");
    let (a, b) = (folder.read("a.png"), folder.read("b.png"));
    let other = with_text(&a, |_| parts(&b).2);
    let edited = with_text(&a, |text| text.replace("outcome proved", "outcome Proved"));
    let newer = with_text(&a, |text| text.replace("pinhole-certificate 2", "pinhole-certificate 9"));
    let unknown = with_text(&b, |text| resealed(&text.replace("setting exposure 0.4\n", "")));
    for (name, bytes) in [
        ("other.png", other),
        ("edited.png", edited),
        ("newer.png", newer),
        ("cut.png", a[..a.len() / 2].to_vec()),
        ("long.png", [&a[..], b"more"].concat()),
    ] {
        std::fs::write(folder.path(name), bytes).unwrap();
    }
    let changed = SCENE.replace("radius = 0.5", "radius = 0.51");
    std::fs::write(folder.path("changed.toml"), changed).unwrap();
    for (picture, scene, error) in [
        ("other.png", "scene.toml", "the certificate is of other samples; "),
        ("edited.png", "scene.toml", "the picture's certificate was edited"),
        ("newer.png", "scene.toml", "the picture's certificate has the version 9"),
        ("cut.png", "scene.toml", "the PNG file cannot be read: "),
        ("long.png", "scene.toml", "data follow its end, so that viewers may show another picture; "),
        ("plain.png", "scene.toml", "the picture has no certificate; render it with --certify"),
        ("a.png", "changed.toml", "the certificate is of other data than changed.toml"),
        ("a.png", "data.csv", "the certificate is of other data than data.csv"),
    ] {
        let error = format!("error: {picture}: {error}");
        folder.refuses(&format!("verify {picture} --scene {scene}"), 1, &error);
    }
    // A forged certificate names another exposure, with which the samples would differ.
    std::fs::write(folder.path("forged.png"), unknown).unwrap();
    folder.refuses("verify forged.png --scene scene.toml", 3, "the picture is not legal: ");
    // Nothing in it reaches the terminal as it is.
    let evil = "setting tone \u{1b}]0;evil\u{7}\u{9b}2J\n";
    for evil in [evil.to_owned(), evil.replace("tone", "label")] {
        let evil = with_text(&b, |text| resealed(&text.replace("setting exposure 0.4\n", &evil)));
        std::fs::write(folder.path("evil.png"), evil).unwrap();
        let run = folder.run("verify evil.png --scene scene.toml --json a.json");
        let said = [&run.stdout[..], run.stderr.as_bytes()].concat();
        let said =
            String::from_utf8(said).unwrap() + &std::fs::read_to_string(folder.path("a.json")).unwrap_or_default();
        assert!(run.code != 0 && said.lines().all(|line| !line.contains(char::is_control)), "{said:?}");
    }
}
