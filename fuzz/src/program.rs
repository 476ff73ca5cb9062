//! The files that the program reads: pictures with certificates, answers of other renderers, run files, files of bricks,
//! and the folders of jobs. Digests are made to fit, so that they do not hide what comes after them.

use std::fs;
use std::path::Path;

use pinhole::camera::{Camera, PinholeCamera, Pose};
use pinhole::image::encoding::Encoding;
use pinhole::verify::picture_certificate::samples_digest;
use pinhole::verify::run_file::{Provenance, write};
use pinhole::verify::{PlainRender, Recording, RequestedCamera, TracedPixel, TracedRay, UploadedView};
use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, View, cpu};
use pinhole_figure::read::picture as pictures;
use pinhole_figure::write::png;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

use crate::figures::DATA;
use crate::seals::DIGITS;
use crate::{Target, checked, seals};

const SCENE: &str = "data = 'data.csv'\n[film]\nwidth = 3\nheight = 2\n";

/// The text in the place of the folder in good files, so that they are the same in all folders.
const FOLDER: &str = "@@";

const PART: &str = "job/parts/000000.part";

/// Runs commands of the program, in which `@` is the folder, up to the first that fails.
fn run<const N: usize>(folder: &Path, commands: [&str; N]) -> Result<(), String> {
    let folder = folder.to_str().unwrap();
    commands.into_iter().try_for_each(|command| {
        let words = format!("pinhole {command}");
        pinhole_cli::run_command(words.split_whitespace().map(|word| word.replace('@', folder).into()).collect())
    })
}

/// Runs commands of the program that may fail.
fn check<const N: usize>(folder: &Path, commands: [&str; N]) -> Result<(), String> {
    checked(run(folder, commands)).map(drop)
}

/// A target whose folder has the scene of [`SCENE`]. `seeds` makes good files in it.
fn target(
    folder: TempDir,
    seeds: impl FnOnce(&Path) -> Vec<Vec<u8>>,
    read: impl Fn(&Path, &[u8]) -> Result<(), String> + Send + Sync + 'static,
) -> Target {
    let path = folder.path().to_owned();
    fs::write(path.join("data.csv"), DATA).unwrap();
    fs::write(path.join("scene.toml"), SCENE).unwrap();
    // The first command starts the threads.
    rendered(&path, "a.png", "");
    // A command takes a thousand times as long as a reader.
    Target { tries: 2400, ..Target::new(folder, seeds(&path), move |bytes| read(&path, bytes)) }
}

/// Runs commands that must succeed, and reads the file that they write.
fn written<const N: usize>(folder: &Path, commands: [&str; N], name: &str) -> Vec<u8> {
    run(folder, commands).unwrap_or_else(|error| panic!("{commands:?}: {error}"));
    fs::read(folder.join(name)).unwrap()
}

fn rendered(folder: &Path, name: &str, flags: &str) -> Vec<u8> {
    written(folder, [&format!("render @/scene.toml -o @/{name} --backend cpu -q {flags}")], name)
}

/// Pictures as they are judged.
pub(crate) fn picture(folder: TempDir) -> Target {
    let seeds = |folder: &Path| {
        let flags = ["a.png", "a.png --bits 16 --transparent", "a.png --certify", "a.exr", "a.exr --certify"];
        let flags = flags.into_iter().chain(["b.png --certify --style studio --samples 2 --label Water --dpi 300"]);
        flags.map(|words| rendered(folder, &words[..5], words[5..].trim_start())).collect()
    };
    target(folder, seeds, |folder, bytes| {
        let bytes = if bytes.starts_with(b"\x89PNG") { seals::png(bytes.to_vec()) } else { bytes.to_vec() };
        match checked(pictures::read(&bytes))? {
            Some(picture) if picture.certificate.is_some() => {
                fs::write(folder.join("picture"), bytes).unwrap();
                check(folder, ["verify @/picture --scene @/scene.toml --work 1e5"])
            }
            _ => Ok(()),
        }
    })
}

/// Certificates without the line of their digest, in a picture of black pixels.
pub(crate) fn certificate(folder: TempDir) -> Target {
    const SIZE: [u32; 2] = [3, 2];
    const SAMPLES: [u8; 18] = [0; 18];
    let seeds = |folder: &Path| {
        let flags = [
            "",
            "--style studio --samples 2 --color-by charge --legend=right --label Water --exposure 0.5 --tone agx",
            "--style path --samples 2 --select species==H --view iso --zoom 2 --set film.height=2 --seed 7",
            "--style illustration --camera orthographic --background teal --outline 2 --bits 8",
        ];
        let text = |flags: &str| {
            let picture = pictures::read(&rendered(folder, "a.png", &format!("--certify {flags}"))).unwrap();
            let mut text = picture.certificate.unwrap().into_bytes();
            seals::put(&mut text, "samples-sha256 ", &samples_digest(SIZE, &SAMPLES));
            text.truncate(text.len() - "sha256 \n".len() - DIGITS);
            text
        };
        flags.into_iter().map(text).collect()
    };
    target(folder, seeds, |folder, bytes| {
        let Ok(text) = str::from_utf8(bytes) else { return Ok(()) };
        let text = format!("{text}sha256 {}\n", seals::hex(bytes));
        let Ok(picture) = png::encode_certified(SIZE, &Encoding::default(), &SAMPLES, &text) else { return Ok(()) };
        fs::write(folder.join("picture"), picture).unwrap();
        check(folder, ["verify @/picture --scene @/scene.toml --work 1e5"])
    })
}

/// Arrays of ids, depths, normals and rays of another renderer.
pub(crate) fn answers(folder: TempDir) -> Target {
    let seeds = |folder: &Path| {
        let layers = ["id", "depth", "normal"];
        rendered(folder, "a.png", &layers.map(|layer| format!("--layer {layer}=@/{layer}.npy")).join(" "));
        layers.map(|layer| fs::read(folder.join(layer).with_extension("npy")).unwrap()).to_vec()
    };
    target(folder, seeds, |folder, bytes| {
        fs::write(folder.join("file"), bytes).unwrap();
        ["file", "id.npy --depth @/file", "id.npy --normal @/file", "id.npy --rays @/file"]
            .into_iter()
            .try_for_each(|arrays| check(folder, [&format!("certify @/scene.toml --id @/{arrays}")]))
    })
}

/// Recordings of one ray of each pixel, which come from no device.
pub(crate) fn run_file(folder: TempDir) -> Target {
    let seeds = |_: &Path| {
        let scene = Scene::from_f32(vec![[0.0, 0.0, 0.0, 1.0], [1.0, 0.5, 0.0, 0.5]], LinearRgb::WHITE).unwrap();
        let pose = Pose::looking_at([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
        let (camera, film) = (PinholeCamera::new(pose, 1.0, [0.5, 0.5]).unwrap(), Film::new(3, 2).unwrap());
        let settings = RenderSettings::default();
        let image = cpu::render(&scene, &View::new(&camera, film), &settings, LayerSet::DATA).unwrap();
        let vectors = camera.vectors();
        let [origin, right, up, forward] =
            [vectors.origin, vectors.right, vectors.up, vectors.forward].map(|v| v.as_vec3().to_array());
        let ray = Some(TracedRay { origin: [0.0, 0.0, 1.5], direction: [0.0, 0.0, -1.0], distance: 3.5 });
        let pixel = |id: &u32| TracedPixel { ray, t: 0.5, id: *id, shading_ray: ray };
        let recording = Recording {
            camera: RequestedCamera { kind: camera.kind(), vectors },
            uploaded: UploadedView {
                origin,
                advance: 0.0,
                right,
                up,
                forward,
                numbers: [0.0; 3],
                scene_min: [-1.5; 3],
                scene_max: [2.0; 3],
            },
            film,
            primary: settings.primary().unwrap(),
            pixels: image.id().unwrap().iter().map(pixel).collect(),
            image,
            rendered: PlainRender::None,
        };
        let mut bytes = Vec::new();
        write(&scene, &recording, &Provenance::default(), &mut bytes).unwrap();
        vec![bytes]
    };
    target(folder, seeds, |folder, bytes| {
        fs::write(folder.join("run"), seals::run(bytes.to_vec())).unwrap();
        check(folder, ["verify --replay @/run"])
    })
}

pub(crate) fn bricks(folder: TempDir) -> Target {
    let seeds = |folder: &Path| {
        fs::write(folder.join("bare.csv"), "x,y,z,radius\n0,0,0,1\n2,0,0,1\n0,3,0,0.5\n").unwrap();
        ["data", "bare"]
            .map(|name| written(folder, [&format!("sort @/{name}.csv -o @/a.bricks --bricks 2")], "a.bricks"))
            .to_vec()
    };
    target(folder, seeds, |folder, bytes| {
        fs::write(folder.join("b.bricks"), seals::bricks(bytes)).unwrap();
        check(folder, ["info @/b.bricks", "render @/b.bricks -o @/b.png --backend cpu --size 3x2 -q"])
    })
}

/// The descriptions of jobs of one part, each in a line, and then the part. All lack the digests of the whole.
pub(crate) fn job(folder: TempDir) -> Target {
    const SHA256: &str = "\"sha256\":\"";
    let made = |folder: &Path, flags: &str| {
        let _ = fs::remove_dir_all(folder.join("job"));
        let split = format!("job split @/scene.toml --tiles 1x1 --backend cpu -o @/job -q {flags}");
        let part = written(folder, [&split, "job part @/job 0 -q"], PART);
        let text = fs::read_to_string(folder.join("job/job.json")).unwrap();
        let text: String = text.lines().map(|line| line.trim().replacen("\": ", "\":", 1)).collect();
        let (before, after) = text.split_once(SHA256).unwrap();
        let text = format!("{before}{SHA256}{}\n", &after[DIGITS..]).replace(folder.to_str().unwrap(), FOLDER);
        [text.as_bytes(), &part[..part.len() - DIGITS / 2]].concat()
    };
    let flags = ["--style fast", "--style studio --samples 2 --layer depth --exr", "--style fast --turntable 1"];
    let seeds = |folder: &Path| flags.map(|flags| made(folder, flags)).to_vec();
    target(folder, seeds, |folder, bytes| {
        let (text, part) = bytes.split_at(bytes.iter().position(|byte| *byte == b'\n').unwrap_or(bytes.len()));
        let Ok(text) = str::from_utf8(text) else { return Ok(()) };
        let text = text.replace(FOLDER, folder.to_str().unwrap());
        let (digest, mut part) = (seals::hex(text.as_bytes()), part.get(1..).unwrap_or_default().to_vec());
        fs::write(folder.join("job/job.json"), text.replacen(SHA256, &format!("{SHA256}{digest}"), 1)).unwrap();
        seals::put(&mut part, "\"job\":\"", &digest);
        part.extend(Sha256::digest(&part));
        fs::write(folder.join(PART), part).unwrap();
        let kinds = [("--exr", "exr"), ("--turntable", "apng")];
        let extension = kinds.iter().find(|(flag, _)| text.contains(flag)).map_or("png", |kind| kind.1);
        check(folder, ["job status @/job --missing --check", &format!("job merge @/job -q -o @/merged.{extension}")])
    })
}
