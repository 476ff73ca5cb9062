//! The first pixels of a picture by one ray in which several answers are legal.

use serde::Serialize;

use pinhole::verify::{Certificate, Checker, Recording, Verdict};

/// The largest number of pixels with each verdict.
const SHOWN: usize = 3;

/// A pixel with several legal answers.
#[derive(Serialize)]
pub(super) struct OpenPixel {
    pub(super) pixel: [u32; 2],
    pub(super) verdict: &'static str,
    /// The answer that was found, and the legal ones.
    pub(super) message: String,
}

/// The first ties and silhouettes.
pub(super) fn open_pixels(
    checker: &Checker<'_>,
    recording: &Recording,
    certificate: &Certificate,
) -> Vec<OpenPixel> {
    let width = recording.film.width() as usize;
    let of = |verdict| {
        let all = certificate.verdicts.iter().enumerate();
        let indices = all.filter(move |(_, of)| **of == verdict).map(|(index, _)| index);
        indices.take(SHOWN).filter_map(move |index| {
            let pixel = recording.pixels.get(index)?;
            let ray = pixel.ray?;
            let legal = checker.legal_hits(ray.origin, ray.direction);
            let message = legal.message(pixel.id, pixel.t);
            // The sides of a film are u32.
            let pixel = [(index % width) as u32, (index / width) as u32];
            Some(OpenPixel { pixel, verdict: verdict.name(), message })
        })
    };
    of(Verdict::Tie).chain(of(Verdict::Silhouette)).collect()
}
