//! Recordings of light that are written into a run file and read again, as on a machine without a device.

use std::io::Cursor;

use pinhole::image::Image;
use pinhole::render::PrimarySettings;
use pinhole::verify::run_file::{Extras, LitSamples, Provenance, RunFile, write_with};
use pinhole::verify::{
    Checker, LitCertificate, LitInputs, LitRecording, NO_HIT, Recording, Rendered, TracedPixel,
};
use pinhole::{LayerSet, Scene};

/// A recording of the same view by one ray for each pixel, which hits nothing.
fn nothing(given: &LitInputs) -> Recording {
    let size = [given.film.width(), given.film.height()];
    let pixel = TracedPixel { ray: None, t: NO_HIT, id: pinhole::image::NO_ID, shading_ray: None };
    Recording {
        camera: given.camera,
        uploaded: given.uploaded,
        film: given.film,
        primary: PrimarySettings::default(),
        pixels: vec![pixel; given.film.pixel_count() as usize],
        image: Image::new(size[0], size[1], LayerSet::DATA).unwrap(),
        rendered: Rendered::None,
    }
}

/// Asserts that a recording leads to the same certificate, to the bit, after it was saved.
pub(crate) fn gives(scene: &Scene, recording: LitRecording<'_>, certificate: &LitCertificate) {
    let given = match recording {
        LitRecording::Paths(paths) => &paths.given,
        LitRecording::Studio(studio) => &studio.given,
        _ => panic!("another kind of recording"),
    };
    let mut samples = LitSamples::new(Box::new(Cursor::new(Vec::new())));
    if samples.add(recording).is_err() {
        // Lists of another size cannot be saved, and are not legal.
        assert!(certificate.upload.is_some(), "{certificate}");
        return;
    }
    let extras = Extras { light: Some(&samples), ..Extras::default() };
    let mut bytes = Vec::new();
    write_with(scene, &nothing(given), &Provenance::default(), extras, &mut bytes).unwrap();
    let mut source = Cursor::new(&bytes);
    let file = RunFile::open(&mut source).unwrap();
    let run = file.run().unwrap();
    let checker = Checker::new(&run.scene).unwrap();
    let mut again = LitCertificate::default();
    assert!(file.light(&run, &mut |one| again.join(checker.certify_lit(one))).unwrap());
    // Every number and text; no number is NaN.
    assert_eq!(&again, certificate);
}
