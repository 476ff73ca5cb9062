//! A run file of an adapter, for tests that read it or parts of it.

use std::io::Cursor;

use pinhole::Scene;
use pinhole::verify::run_file::{Run, RunFile};
use pinhole::verify::{LitRecording, Recording};

/// Two samples that an adapter took, and the picture with one ray per pixel: `pinhole verify light.toml --paths 2
/// --save light.run` in `tests/cpu/run_file_light`. A new version of the format needs a new recording.
pub(crate) fn recorded() -> (Scene, Recording, LitRecording) {
    let mut source = Cursor::new(include_bytes!("../cpu/run_file_light/light.run"));
    let file = RunFile::open(&mut source).unwrap();
    let Run { scene, recording, .. } = file.run().unwrap();
    let run = file.run().unwrap();
    let mut made: Option<LitRecording> = None;
    let mut add = |one: &LitRecording| match &mut made {
        Some(made) => made.samples.extend(one.samples.clone()),
        None => made = Some(one.clone()),
    };
    assert!(file.light(&run, &mut add).unwrap());
    (scene, recording, made.unwrap())
}

/// The samples of a recording in a rectangle only.
pub(crate) fn cut(made: &LitRecording, [x, y, width, height]: [u32; 4]) -> LitRecording {
    let mut cut = made.clone();
    let whole = made.given.size[0];
    let indices: Vec<usize> =
        (y..y + height).flat_map(|j| (x..x + width).map(move |i| (j * whole + i) as usize)).collect();
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
            only(&mut surface.states, &indices);
            only(&mut surface.open, &indices);
        }
    }
    cut
}
