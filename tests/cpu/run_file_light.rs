//! Run files with light: what is saved of it leads to the same certificate, and nothing else is taken for it.

use std::io::Cursor;

use pinhole::camera::{OrthographicCamera, Pose};
use pinhole::image::denoise::GUIDES;
use pinhole::verify::run_file::{
    self, Extras, LitSamples, Run, RunFile, RunFileError, ShownPicture, write_with,
};
use pinhole::verify::{Checker, LitCertificate, LitRecording, Outcome, PathRecording, Recording};
use pinhole::{
    Appearance, Colors, Film, LayerSet, LinearRgb, Material, RenderSettings, Scene, SphereArray,
    SurfaceProperties, View, cpu,
};

use crate::run_file::{
    bytes_of_header, is_contradiction, provenance, signed, with_header, with_numbers,
};

fn kept(recording: &PathRecording) -> LitSamples {
    let mut samples = LitSamples::new(Box::new(Cursor::new(Vec::new())));
    samples.add(LitRecording::Paths(recording)).unwrap();
    samples
}

fn written(scene: &Scene, picture: &Recording, extras: Extras<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_with(scene, picture, &provenance(), extras, &mut bytes).unwrap();
    bytes
}

fn with_light(scene: &Scene, picture: &Recording, made: &PathRecording) -> Vec<u8> {
    let samples = kept(made);
    written(scene, picture, Extras { light: Some(&samples), ..Extras::default() })
}

/// The certificate of the light in a file.
fn replayed(bytes: &[u8]) -> Result<Option<LitCertificate>, RunFileError> {
    let mut source = Cursor::new(bytes);
    let file = RunFile::open(&mut source)?;
    let run = file.run()?;
    let checker = Checker::new(&run.scene).unwrap();
    let mut certificate = LitCertificate::default();
    let has_light = file.light(&run, &mut |one| certificate.join(checker.certify_lit(one)))?;
    Ok(has_light.then_some(certificate))
}

/// Two samples that an adapter took, and the picture by one ray for each pixel: `pinhole verify light.toml --paths 2
/// --save light.run` in `tests/cpu/run_file_light`. Whenever the format has another version, they are recorded again.
fn recorded() -> (Scene, Recording, PathRecording) {
    let mut source = Cursor::new(include_bytes!("run_file_light/light.run"));
    let file = RunFile::open(&mut source).unwrap();
    let Run { scene, recording, .. } = file.run().unwrap();
    let run = file.run().unwrap();
    let mut made: Option<PathRecording> = None;
    let mut add = |one: LitRecording<'_>| {
        let LitRecording::Paths(one) = one else { panic!("it is of paths") };
        match &mut made {
            Some(made) => made.samples.extend(one.samples.clone()),
            None => made = Some(one.clone()),
        }
    };
    assert!(file.light(&run, &mut add).unwrap());
    (scene, recording, made.unwrap())
}

/// The samples of a recording in a rectangle alone.
fn cut(made: &PathRecording, [x, y, width, height]: [u32; 4]) -> PathRecording {
    let mut cut = made.clone();
    let whole = made.given.size[0];
    let indices: Vec<usize> = (y..y + height)
        .flat_map(|j| (x..x + width).map(move |i| (j * whole + i) as usize))
        .collect();
    fn only<T: Clone>(list: &mut Vec<T>, indices: &[usize]) {
        *list = indices.iter().map(|index| list[*index].clone()).collect();
    }
    (cut.given.origin, cut.given.size) = ([x, y], [width, height]);
    for sample in &mut cut.samples {
        only(&mut sample.start, &indices);
        only(&mut sample.film.before, &indices);
        only(&mut sample.film.after, &indices);
        for surface in &mut sample.surfaces {
            only(&mut surface.hits, &indices);
            only(&mut surface.scattered, &indices);
            only(&mut surface.open, &indices);
        }
    }
    cut
}

#[test]
fn what_is_saved_is_judged_as_before() {
    let (scene, picture, mut made) = recorded();
    let checker = Checker::new(&scene).unwrap();
    let legal = checker.certify_paths(&made);
    assert!(legal.violation_count == 0 && legal.stages().checked > 1000, "{legal}");
    let bytes = with_light(&scene, &picture, &made);
    assert_eq!(replayed(&bytes).unwrap(), Some(legal));
    // What the device did wrong is kept, in rays that go on and in those that have ended.
    let surfaces = &mut made.samples[1].surfaces;
    surfaces[0].scattered[40].slots[3][1] ^= 1 << 20;
    surfaces.last_mut().unwrap().scattered[7].slots[4][0] ^= 1;
    let wrong = checker.certify_paths(&made);
    assert_eq!((wrong.outcome(), wrong.violation_count >= 2), (Outcome::Violated, true));
    assert_eq!(replayed(&with_light(&scene, &picture, &made)).unwrap(), Some(wrong));
    // And so is what it was given.
    made.given.lighting.zenith[1] += 0.1;
    let other = checker.certify_paths(&made);
    assert!(other.upload.is_some());
    assert_eq!(replayed(&with_light(&scene, &picture, &made)).unwrap(), Some(other));
}

/// A small file, which still has everything.
fn small() -> (Scene, Recording, Vec<u8>) {
    let (scene, picture, made) = recorded();
    let bytes = with_light(&scene, &picture, &cut(&made, [4, 4, 3, 1]));
    (scene, picture, bytes)
}

#[test]
fn rectangles_differ_and_pictures_do_not() {
    let (scene, picture, made) = recorded();
    let part = |samples: std::ops::Range<usize>| {
        let samples = made.samples[samples].to_vec();
        PathRecording { given: made.given.clone(), samples }
    };
    let mut samples = LitSamples::new(Box::new(Cursor::new(Vec::new())));
    samples.add(LitRecording::Paths(&part(0..1))).unwrap();
    // One pixel of the second sample.
    let mut other = cut(&part(1..2), [3, 2, 1, 1]);
    samples.add(LitRecording::Paths(&other)).unwrap();
    let bytes = written(&scene, &picture, Extras { light: Some(&samples), ..Extras::default() });
    let certificate = replayed(&bytes).unwrap().unwrap();
    assert_eq!((certificate.paths, certificate.violation_count), (109, 0), "{certificate}");
    // Lists that do not have the size of the rectangle, and samples of another picture.
    other.given.size = [2, 1];
    assert!(samples.add(LitRecording::Paths(&other)).is_err());
    let mut other = part(1..2);
    other.given.settings.sampling.seed += 1;
    let error = samples.add(LitRecording::Paths(&other)).unwrap_err();
    assert!(error.to_string().contains("different pictures"), "{error}");
    // Another camera than that of the picture.
    let mut other = part(0..1);
    other.given.camera.vectors.origin.x += 1.0;
    let light = kept(&other);
    let extras = Extras { light: Some(&light), ..Extras::default() };
    let error = write_with(&scene, &picture, &provenance(), extras, &mut Vec::new()).unwrap_err();
    assert!(error.to_string().contains("another camera"), "{error}");
    // What is forgotten is not written.
    samples.clear();
    let bytes = written(&scene, &picture, Extras { light: Some(&samples), ..Extras::default() });
    assert_eq!(replayed(&bytes).unwrap(), None);
}

#[test]
fn every_byte_that_is_another_or_missing_is_noticed() {
    let bytes = small().2;
    for place in 0..bytes.len() {
        let mut altered = bytes.clone();
        altered[place] ^= 1 << (place % 8);
        assert!(replayed(&altered).is_err(), "{place}");
    }
    for length in (0..bytes.len()).step_by(97) {
        assert!(replayed(&bytes[..length]).is_err(), "{length}");
    }
}

#[test]
fn hostile_contents_with_a_right_digest() {
    let (scene, _, bytes) = small();
    let request = "the light is not that of this scene and these settings";
    let word = |word: u32| word.to_le_bytes();
    for (name, at, numbers, words) in [
        // Something else was requested.
        ("camera", 0, &1_f64.to_le_bytes()[..], request),
        ("palette", 0, &word(0), request),
        // Samples of no picture.
        ("sample_0_place", 4, &word(10), "the rectangle of sample 0 is not in the picture"),
        ("sample_1_place", 12, &word(0), "the rectangle of sample 1 is not in the picture"),
        ("sample_1_place", 12, &word(u32::MAX), "the rectangle of sample 1"),
        ("sample_0_place", 16, &word(2), "the array `sample_0_hits` is"),
        ("sample_0_place", 16, &word(6), "the rectangle of sample 0"),
    ] {
        let error = replayed(&with_numbers(&bytes, name, at, numbers)).unwrap_err();
        is_contradiction(&error, words);
    }
    for (from, to, words) in [
        ("\"lit_samples\":\"2\"", "\"lit_samples\":\"3\"", "`sample_2_place` is missing"),
        ("\"lit_samples\":\"2\"", "\"lit_samples\":\"0\"", "there are 0 samples"),
        ("\"lit_samples\":\"2\"", "\"lit_samples\":\"5000\"", "there must be 1 to 4096"),
        ("\"lit_samples\":\"2\"", "\"lit_samples\":\"two\"", "`lit_samples` is not a valid number"),
        ("\"sample_0_open\"", "\"sample_0_oven\"", "`sample_0_open` is missing"),
        // Something else was requested, what says nothing, and no number.
        ("\\\"max_depth\\\":", "\\\"max_depth\\\":1", request),
        ("\\\"sampling\\\":", "\\\"samplings\\\":", request),
        ("\"given\":\"{", "\"given\":\"[", "the text `given`: "),
        ("\\\"zenith\\\":[", "\\\"zenith\\\":[null,", "the text `given`: "),
        ("\"tables\"", "\"tablet\"", "the array `tables` is missing"),
        ("\"request_sha256\"", "\"request_sha257\"", "the text `request_sha256` is missing"),
        ("\"sample_0_start\"", "\"sample_1_start\"", "header"),
    ] {
        is_contradiction(&replayed(&with_header(&bytes, from, to)).unwrap_err(), words);
    }
    // Spheres of another scene with the digest of theirs.
    let sphere = with_numbers(&bytes, "spheres", 12, &0.07_f32.to_le_bytes());
    let mut spheres = scene.spheres().to_vec();
    spheres[0][3] = 0.07;
    let other = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
    let [before, after] = [&scene, &other].map(run_file::scene_sha256);
    let error = replayed(&with_header(&sphere, &before, &after)).unwrap_err();
    is_contradiction(&error, request);
}

#[test]
fn noise_with_a_right_digest_is_judged_or_refused() {
    let bytes = small().2;
    let start = 8 + bytes_of_header(&bytes);
    let mut random = fastrand::Rng::with_seed(12);
    let mut judged = 0;
    for _ in 0..3000 {
        let mut altered = bytes.clone();
        for _ in 0..random.usize(1..4) {
            let first = if random.u8(..8) > 0 { start } else { 0 };
            let place = random.usize(first..altered.len());
            let length = random.usize(1..=8).min(altered.len() - place);
            altered[place..place + length].fill([0, 0xff, 0x7f, random.u8(..)][random.usize(..4)]);
        }
        if let Ok(Some(certificate)) = replayed(&signed(altered)) {
            judged += u32::from(certificate.outcome() == Outcome::Violated);
        }
    }
    assert!(judged > 300, "{judged}");
}

#[test]
fn materials_and_pictures_are_kept() {
    let (_, picture, _) = small();
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

    let size = [3, 2];
    let shown = ShownPicture { size, srgb: vec![[1, 2, 3]; 6], samples: 4, wanted: 64 };
    let pose = Pose::looking_at([2.0, 0.1, 5.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
    let camera = OrthographicCamera::new(pose, [6.0, 4.0]).unwrap();
    let view = View::new(&camera, Film::new(size[0], size[1]).unwrap());
    let noisy = cpu::render(&scene, &view, &RenderSettings::studio(), GUIDES).unwrap();
    let denoised = cpu::denoise(&noisy).unwrap();
    let extras =
        Extras { denoised: Some([&noisy, &denoised]), shown: Some(&shown), ..Extras::default() };
    let bytes = written(&scene, &picture, extras);
    let mut source = Cursor::new(&bytes);
    let file = RunFile::open(&mut source).unwrap();
    let run = file.run().unwrap();
    assert_eq!(run.scene.appearance(), scene.appearance());
    assert_eq!(file.shown().unwrap(), Some(shown));
    let [again, quiet] = file.denoised().unwrap().unwrap();
    assert_eq!((again.color(), quiet.color()), (noisy.color(), denoised.color()));
    assert_eq!((again.normal(), again.depth()), (noisy.normal(), noisy.depth()));
    assert_eq!((again.albedo(), again.variance()), (noisy.albedo(), noisy.variance()));
    assert_eq!((again.layers(), quiet.layers()), (GUIDES, LayerSet::COLOR));
    // No such material, one that is out of range, and one that no sphere has.
    let number = |x: f32| x.to_le_bytes();
    for (name, at, numbers, words) in [
        ("surfaces", 20, number(4.0), "the surface 1: there is no such material"),
        ("surfaces", 24, number(f32::NAN), "the surface 1: `roughness` is NaN"),
        ("surface_index", 0, 9_u32.to_le_bytes(), "the scene: "),
    ] {
        let error = run_file::read(&with_numbers(&bytes, name, at, &numbers)).unwrap_err();
        is_contradiction(&error, words);
    }
}
