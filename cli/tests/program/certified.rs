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

/// Replaces a chunk of a PNG, with its checksum.
fn with_text(png: &[u8], change: impl Fn(&str) -> String) -> Vec<u8> {
    let decoder = png::Decoder::new(std::io::Cursor::new(png));
    let mut reader = decoder.read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut samples).unwrap();
    let info = reader.info();
    let text = &info.uncompressed_latin1_text[0];
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, info.width, info.height);
    encoder.set_color(info.color_type);
    encoder.set_depth(info.bit_depth);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    encoder.add_text_chunk(text.keyword.clone(), change(&text.text)).unwrap();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&samples).unwrap();
    writer.finish().unwrap();
    bytes
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
    ] {
        let flags = format!("{flags} --backend cpu --quiet");
        folder.run(&format!("render {scene} -o {picture} --certify {flags}")).succeeded();
        let run = folder.run(&format!("verify {picture} --scene {scene} --json a.json")).succeeded();
        assert!(line(&run, "judged by").ends_with("intervals"), "{picture}");
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

#[test]
fn a_lit_picture_is_checked_by_means() {
    let folder = folder();
    let flags = "--style default --samples 24 --size 64x48 --backend cpu --quiet";
    // Before writing, light and denoiser are judged one after the other. In the file, the mean of all pixels is judged.
    folder.run(&format!("render data.csv -o a.png --certify {flags}")).succeeded();
    let run = folder.run("verify a.png --scene data.csv").succeeded();
    assert!(line(&run, "proved").contains(" 6 "), "{run:?}");
    let run = folder.run(&format!("render data.csv -o b.png --certify {flags} --noise 0.1"));
    run.refused(2, "--certify: --noise and the denoiser exclude");
    let flags = format!("{flags} --denoise=false");
    folder.run(&format!("render data.csv -o a.png --certify {flags}")).succeeded();
    let run = folder.run("verify a.png --scene data.csv").succeeded();
    assert!(line(&run, "judged by").ends_with("means"));
    assert!(line(&run, "rendered by").contains("--samples=24"));
    // Changed samples with a certificate to match are found by their means.
    folder.run(&format!("render data.csv -o b.png --certify {flags} --exposure 0.4")).succeeded();
    let forged = with_text(&folder.read("b.png"), |text| forged(text, "--exposure=0.4"));
    std::fs::write(folder.path("b.png"), forged).unwrap();
    folder.refuses("verify b.png --scene data.csv", 3, "the picture is not legal: ");
}

/// A certificate that lacks an argument, with a digest that matches again.
fn forged(text: &str, argument: &str) -> String {
    use sha2::{Digest, Sha256};
    let line = format!("argument {argument}\n");
    assert!(text.contains(&line), "{text}");
    let text = text.replace(&line, "");
    let before = &text[..text.rfind("sha256 ").unwrap()];
    let digest = Sha256::digest(before.as_bytes());
    let digits: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
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
    let certificate = |png: &[u8]| {
        let reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
        reader.info().uncompressed_latin1_text[0].text.clone()
    };
    let other = with_text(&a, |_| certificate(&b));
    let edited = with_text(&a, |text| text.replace("outcome proved", "outcome Proved"));
    let newer = with_text(&a, |text| text.replace("pinhole-certificate 1", "pinhole-certificate 9"));
    let unknown = with_text(&b, |text| forged(text, "--exposure=0.4"));
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
}
