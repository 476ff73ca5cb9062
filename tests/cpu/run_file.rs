//! Run files: written files are read again and lead to the same certificate, and nothing else is taken for a run file.

use std::collections::BTreeMap;

use pinhole::camera::film::YAxis;
use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::image::NO_ID;
use pinhole::internals::ConeInFrame;
use pinhole::scene::cone::{Caps, Cone};
use pinhole::verify::run_file::{self, Provenance, RunFileError};
use pinhole::verify::{PlainRender, Recording, RequestedCamera, TracedPixel, TracedRay};
use pinhole::{
    Appearance, Colors, Film, LayerSet, LinearRgb, Material, Scene, Shading, Sphere, SphereArray, SurfaceProperties,
    View, cpu,
};
use sha2::{Digest, Sha256};

use crate::support::shaded;
use crate::verify::uploaded;

/// A recording made by hand. Its numbers come from no device, and every kind of number occurs.
pub(crate) fn made(scene: &Scene, camera: &dyn Camera, film: Film) -> Recording {
    let grey = LinearRgb::new([0.25, 0.5, 1.5]).unwrap();
    let settings = shaded(Shading::Flat, grey);
    let image = cpu::render(scene, &View::new(camera, film), &settings, LayerSet::DATA).unwrap();
    let pixels = image.id().unwrap().iter().zip(image.depth().unwrap()).map(|(id, depth)| {
        let direction = [-0.0, f32::from_bits(1), -1.0];
        let ray = TracedRay { origin: [1.0, f32::NAN, *depth], direction, distance: 0.1 };
        let ray = (*id != NO_ID).then_some(ray);
        let shading_ray = ray.map(|ray| TracedRay { distance: 0.2, ..ray });
        TracedPixel { ray, t: 0.3 * depth, id: *id, shading_ray }
    });
    let vectors = camera.vectors();
    Recording {
        camera: RequestedCamera { kind: camera.kind(), vectors },
        uploaded: uploaded(&vectors, vectors.origin - scene.origin(), 0.0, [[-1e3; 3], [1e3; 3]]),
        film,
        primary: settings.primary().unwrap(),
        pixels: pixels.collect(),
        image,
        rendered: PlainRender::None,
    }
}

fn provenance() -> Provenance {
    Provenance {
        version: "0.1.0".to_owned(),
        command: "pinhole verify 'a \"sha256\":\"b' --size 3x2 \u{e9}\n".to_owned(),
        adapter: "An adapter".to_owned(),
        backend: "Vulkan".to_owned(),
        limits: BTreeMap::from([("max_buffer_size".to_owned(), u64::MAX)]),
        ..Provenance::default()
    }
}

fn pose() -> Pose {
    Pose::looking_at([3.0, 2.0, 9.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap()
}

fn written(scene: &Scene, recording: &Recording) -> Vec<u8> {
    let mut bytes = Vec::new();
    run_file::write(scene, recording, &provenance(), &mut bytes).unwrap();
    bytes
}

/// A run file of three spheres in two colours, in a frame of its own, with 3 by 2 pixels.
fn small() -> Vec<u8> {
    let far = |x: f64, color| Sphere::new([4e6 + x, 0.1, 0.0], 1.5, color);
    let scene = Scene::new(&[far(0.0, LinearRgb::WHITE), far(0.4, LinearRgb::BLACK), far(2.0, LinearRgb::WHITE)]);
    let eye = [4e6, 0.0, 9.0];
    let pose = Pose::looking_along(eye, [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::new(pose, 2.0, [0.9, 0.6]).unwrap();
    let film = Film::new(3, 2).unwrap().with_y_axis(YAxis::Down);
    let scene = scene.unwrap();
    let mut recording = made(&scene, &camera, film);
    // Compares with a picture with another background.
    let (view, settings) = (View::new(&camera, film), shaded(Shading::Flat, LinearRgb::WHITE));
    recording.compare(cpu::render(&scene, &view, &settings, LayerSet::DATA).unwrap());
    written(&scene, &recording)
}

/// A run file of a sphere and three cones in two colours. The second cone is a tube, and the third one is pointed.
fn with_cones() -> Vec<u8> {
    let cones = [
        Cone::cylinder([0.0; 3], [0.0, 0.0, 1.0], 0.5),
        Cone::cylinder([2.0, 0.0, 0.0], [2.0, 1.0, 0.0], 0.25).with_caps(Caps::None),
        Cone::new([-1.0, 0.0, 0.0], [-1.0, 3.0, 0.0], [0.5, 0.0]).with_caps(Caps::Second),
    ];
    let colors = Colors::distinct(&[LinearRgb::WHITE, LinearRgb::WHITE, LinearRgb::WHITE, LinearRgb::BLACK]);
    let spheres = SphereArray::F32(vec![[0.0, 2.0, 0.0, 1.0]]);
    let scene = Scene::from_shapes(spheres, &cones, colors.into()).unwrap();
    let camera = OrthographicCamera::new(pose(), [4.0, 4.0]).unwrap();
    written(&scene, &made(&scene, &camera, Film::new(2, 1).unwrap()))
}

#[test]
fn cones_are_read_and_checked() {
    let bytes = with_cones();
    let run = run_file::read(&bytes).unwrap();
    assert_eq!((run.scene.len(), run.scene.shape_count()), (1, 4));
    let closed = |cone: &ConeInFrame| [cone.first_radius, cone.second_radius].map(f32::is_sign_positive);
    let closed: Vec<_> = run.scene.cones().iter().map(closed).collect();
    assert_eq!(closed, [[true; 2], [false; 2], [false, true]]);
    assert_eq!([1, 2, 3].map(|id| run.scene.color(id)), [LinearRgb::WHITE, LinearRgb::WHITE, LinearRgb::BLACK]);
    assert_eq!(run.scene.bounds().map(|bounds| bounds.max().y), Some(3.0));
    for (place, number, words) in [
        (0, f32::NAN, "cone 0: its start is [NaN, 0.0, 0.0]"),
        (3, f32::INFINITY, "cone 0: its radius is inf"),
        (6, 0.0, "cone 0: it has no length"),
        (16 + 3, 1e-9, "cone 2: its length"),
        (16 + 3, 0.0, "cone 2: both radii are 0"),
        (16 + 7, -1.0, "`scene_sha256` is not the digest of the shapes"),
    ] {
        contradicts(&with_numbers(&bytes, "cones", 4 * place, &number.to_le_bytes()), words);
    }
    contradicts(&with_header(&bytes, "[3,8]", "[4,6]"), "the array `cones` is F32 [4, 6]; it must be F32 [4, 8]");
}

/// A run file with one pixel, and no spheres.
fn smallest() -> Vec<u8> {
    let scene = Scene::new(&[]).unwrap();
    let camera = OrthographicCamera::new(pose(), [1.0, 1.0]).unwrap();
    written(&scene, &made(&scene, &camera, Film::new(1, 1).unwrap()))
}

/// Replaces the digest by that of the bytes, as if the file had been written like this.
fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
    let before = b"\"sha256\":\"";
    let Some(place) = bytes.windows(before.len()).position(|window| window == before) else {
        return bytes;
    };
    let digits = place + before.len()..place + before.len() + 64;
    bytes[digits.clone()].fill(b'0');
    let digest = data_encoding::HEXLOWER.encode(&Sha256::digest(&bytes));
    bytes[digits].copy_from_slice(digest.as_bytes());
    bytes
}

/// Replaces a part of the header, which may change its length, and signs the file.
fn with_header(bytes: &[u8], from: &str, to: &str) -> Vec<u8> {
    let length = u64::from_le_bytes(*bytes.first_chunk().unwrap()) as usize;
    let header = str::from_utf8(&bytes[8..8 + length]).unwrap();
    assert!(header.contains(from), "{header} lacks {from}");
    let header = header.replacen(from, to, 1);
    let length = (header.len() as u64).to_le_bytes();
    signed([&length, header.as_bytes(), &bytes[8 + bytes_of_header(bytes)..]].concat())
}

fn bytes_of_header(bytes: &[u8]) -> usize {
    u64::from_le_bytes(*bytes.first_chunk().unwrap()) as usize
}

/// Writes numbers into an array, and signs the file.
fn with_numbers(bytes: &[u8], name: &str, at: usize, numbers: &[u8]) -> Vec<u8> {
    let file = safetensors::SafeTensors::deserialize(bytes).unwrap();
    let data = file.tensor(name).unwrap().data();
    let start = data.as_ptr() as usize - bytes.as_ptr() as usize + at;
    let mut altered = bytes.to_vec();
    altered[start..start + numbers.len()].copy_from_slice(numbers);
    signed(altered)
}

#[track_caller]
fn contradicts(bytes: &[u8], words: &str) {
    let error = run_file::read(bytes).unwrap_err();
    let RunFileError::Contents(message) = &error else { panic!("{error}") };
    assert!(message.contains(words), "{message} lacks {words}");
    assert_eq!(error.to_string().lines().count(), 1, "{error}");
}

#[test]
fn what_is_read_is_what_was_written_to_the_bit() {
    for bytes in [small(), smallest(), with_cones()] {
        let run = run_file::read(&bytes).unwrap();
        assert_eq!(run.provenance, provenance());
        // Compares the whole file. NaN equals nothing.
        assert!(written(&run.scene, &run.recording) == bytes);
        // A file that is not changed keeps its digest.
        assert!(signed(bytes.clone()) == bytes);
    }
    let run = run_file::read(&small()).unwrap();
    assert_eq!(run.recording.film.y_axis(), YAxis::Down);
    assert!(run.scene.origin().x > 3.9e6, "the scene has a frame of its own");
    assert_eq!(run.scene.color(1), LinearRgb::BLACK);
    assert!(run.recording.pixels.iter().any(|pixel| pixel.ray.is_some()));
    assert!(run.recording.pixels.iter().any(|pixel| pixel.ray.is_none()));
}

/// The format's own reader reads the whole file.
#[test]
fn others_read_it() {
    let bytes = small();
    let file = safetensors::SafeTensors::deserialize(&bytes).unwrap();
    assert_eq!(file.tensor("normal").unwrap().shape(), [2, 3, 3]);
    assert_eq!(file.tensor("traced").unwrap().dtype(), safetensors::Dtype::BOOL);
    let run = run_file::read(&bytes).unwrap();
    let spheres: Vec<u8> = run.scene.spheres().as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    assert_eq!(file.tensor("spheres").unwrap().data(), spheres);
    let digest = data_encoding::HEXLOWER.encode(&Sha256::digest(&spheres));
    assert_eq!(run_file::scene_sha256(&run.scene), digest);
}

#[test]
fn what_is_cut_off_is_refused() {
    let bytes = small();
    for length in 0..bytes.len() {
        let error = run_file::read(&bytes[..length]).unwrap_err();
        let expected = if length < 8 + 17 {
            RunFileError::NotRun
        } else {
            let expected = if length < 8 + bytes_of_header(&bytes) { 8 + bytes_of_header(&bytes) } else { bytes.len() };
            RunFileError::Truncated { found: length as u64, expected: expected as u64 }
        };
        assert_eq!(error, expected, "{length}");
    }
    let longer = [&bytes[..], b"x"].concat();
    assert_eq!(run_file::read(&longer).unwrap_err(), RunFileError::Altered);
    contradicts(&signed(longer), "bytes after the last array");
}

#[test]
fn other_files_and_other_versions() {
    for other in [&b""[..], b"PK\x03\x04", b"{}", &[0; 100], b"\x02\0\0\0\0\0\0\0{}"] {
        assert_eq!(run_file::read(other).unwrap_err(), RunFileError::NotRun);
    }
    let bytes = small();
    for version in ["6", "7", "9"] {
        let other = format!("\"pinhole_run\":\"{version}\"");
        let error = run_file::read(&with_header(&bytes, "\"pinhole_run\":\"8\"", &other)).unwrap_err();
        assert_eq!(error, RunFileError::Version(version.to_owned()));
        let words = "this program reads version 8; record it again with `verify --save`";
        assert_eq!(error.to_string(), format!("run file of version {version}; {words}"));
    }
    let foreign = with_header(&bytes, "pinhole_run", "pinhole_fun");
    assert_eq!(run_file::read(&foreign).unwrap_err(), RunFileError::NotRun);
}

#[test]
fn hostile_contents_with_a_right_digest() {
    let bytes = small();
    for (from, to, words) in [
        ("\"hit_t\"", "\"hit_u\"", "the array `hit_t` is missing"),
        ("\"command\"", "\"commend\"", "the text `command` is missing"),
        ("\"pinhole\"", "\"fishbowl\"", "there is no camera `fishbowl`"),
        ("\"shading\":\"flat\"", "\"shading\":\"round\"", "there is no shading `round`"),
        ("[3,4]", "[4,3]", "the array `spheres` is F32 [4, 3]; it must be F32 [4, 4]"),
        ("[2,3,3]", "[3,2,3]", "it must be"),
        ("[2,3,3]", "[18]", "does not have the shape (H, W, 3)"),
        ("[2,3,3]", "[18,0,3]", "header"),
        ("\"U32\"", "\"F32\"", "it must be U32"),
        ("18446744073709551615", "many", "the limit `max_buffer_size` is not a valid number"),
    ] {
        contradicts(&with_header(&bytes, from, to), words);
    }
    // A header whose sizes add up to more than the file.
    let most = u64::MAX / 9;
    let arrays: Vec<String> = (0..9)
        .map(|i| {
            let (start, end) = (i * most, (i + 1) * most);
            format!("\"{i}\":{{\"dtype\":\"U8\",\"shape\":[{most}],\"data_offsets\":[{start},{end}]}}")
        })
        .collect();
    let header = format!("{{\"__metadata__\":{{\"pinhole_run\":\"8\"}},{}}}", arrays.join(","));
    let length = (header.len() as u64).to_le_bytes();
    let error = run_file::read(&[&length, header.as_bytes()].concat()).unwrap_err();
    assert!(matches!(error, RunFileError::Truncated { .. }), "{error}");
}

#[test]
fn what_scenes_cameras_and_settings_refuse() {
    let bytes = small();
    let nan = f32::NAN.to_le_bytes();
    for (name, at, numbers, words) in [
        ("spheres", 12, &0_f32.to_le_bytes()[..], "`scene_sha256`|sphere 0: its radius is 0.0"),
        ("spheres", 16, &nan, "sphere 1: its center"),
        ("scene_origin", 0, &f64::INFINITY.to_le_bytes(), "the scene: its origin"),
        ("spheres", 0, &7_f32.to_le_bytes(), "`scene_sha256` is not the digest of the shapes"),
        (
            "color_index",
            8,
            &2_u32.to_le_bytes(),
            "sphere 2 has no color: its index is out of range; the palette has 2 colors",
        ),
        ("palette", 4, &(-1_f32).to_le_bytes(), "the array `palette`: the color"),
        ("background", 4, &nan, "the array `background`: the color"),
        ("camera", 24, &[0; 24], "the camera: the length of right is 0.0"),
        ("camera", 0, &f64::NAN.to_le_bytes(), "the camera: the origin is"),
        ("traced", 5, &[2], "the array `traced` has a value other than 0 and 1 at index 5"),
    ] {
        let words = words.split('|').next_back().unwrap();
        contradicts(&with_numbers(&bytes, name, at, numbers), words);
    }
    // An empty scene needs no colour, but one with spheres does.
    let scene = Scene::from_f32(Vec::new(), LinearRgb::BLACK).unwrap();
    let camera = OrthographicCamera::new(pose(), [1.0, 1.0]).unwrap();
    let bytes = written(&scene, &made(&scene, &camera, Film::new(1, 1).unwrap()));
    assert!(run_file::read(&bytes).is_ok());
}

#[test]
fn every_byte_that_is_another_is_noticed() {
    let bytes = smallest();
    for place in 0..bytes.len() {
        for flip in [1, 0x20, 0x80] {
            let mut altered = bytes.clone();
            altered[place] ^= flip;
            assert!(run_file::read(&altered).is_err(), "{place} ^ {flip}");
        }
    }
    let mut altered = bytes;
    *altered.last_mut().unwrap() ^= 1;
    assert_eq!(run_file::read(&altered).unwrap_err(), RunFileError::Altered);
}

#[test]
fn materials_are_kept() {
    let materials = [
        Material::Lambert { specular: 0.25, roughness: 0.5 },
        Material::Conductor { roughness: 0.125 },
        Material::Dielectric { ior: 1.5, roughness: 0.0, attenuation_distance: None },
        Material::Dielectric { ior: 1.3, roughness: 0.1, attenuation_distance: Some(2.0) },
        Material::Emissive { strength: 7.0 },
    ];
    let surfaces = materials.map(|material| SurfaceProperties { material, opacity: 0.75 });
    let spheres: Vec<_> = (0..5_u8).map(|i| [f32::from(i), 0.0, 0.0, 0.4]).collect();
    let colors = Appearance::new(Colors::Rgba8(vec![[9, 8, 7, 200]; 5]));
    let appearance = colors.with_surfaces(surfaces.to_vec(), vec![4, 3, 2, 1, 0]);
    let array = SphereArray::F32(spheres);
    let scene = Scene::from_parts(array, appearance).unwrap();

    let camera = OrthographicCamera::new(pose(), [6.0, 4.0]).unwrap();
    let bytes = written(&scene, &made(&scene, &camera, Film::new(3, 2).unwrap()));
    let run = run_file::read(&bytes).unwrap();
    assert_eq!(run.scene.appearance(), scene.appearance());
    // A material that does not exist, one that is out of range, and one that no sphere has.
    let number = |x: f32| x.to_le_bytes();
    for (name, at, numbers, words) in [
        ("surfaces", 20, number(4.0), "the surface 1: there is no such material"),
        ("surfaces", 24, number(f32::NAN), "the surface 1: `roughness` is NaN"),
        ("surface_index", 0, 9_u32.to_le_bytes(), "the scene: "),
    ] {
        contradicts(&with_numbers(&bytes, name, at, &numbers), words);
    }
}
