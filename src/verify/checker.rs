//! The checker of recordings of a scene.

use super::bias::Deviations;
use super::camera::CameraModel;
use super::candidates::Candidates;
use super::certificate::{Certificate, KEPT, Verdict};
use super::hit::LegalHits;
use super::line::Line;
use super::pixel::PixelCheck;
use super::recording::{Recording, Rendered};
use super::upload;
use super::violation::Violation;
use crate::parallel::{map_parts, ranges};
use crate::scene::{Scene, SceneError};

/// The number of pixels that a thread takes at a time.
const CHUNK: usize = 1 << 12;

/// Judges recordings of a scene.
#[derive(Debug)]
pub struct Checker<'a> {
    pub(super) scene: &'a Scene,
    pub(super) candidates: Candidates,
}

/// The results for a range of pixels.
#[derive(Default)]
struct JudgedPixels {
    verdicts: Vec<Verdict>,
    violations: Vec<Violation>,
    rendered_otherwise: usize,
    worst_depth: f64,
    worst_normal: f64,
    deviations: Deviations,
}

/// In pictures of more pixels, one in some pixels is measured for biases.
const ALL_MEASURED: usize = 1 << 16;
const ONE_IN: usize = 8;

impl Checker<'_> {
    /// The largest number of bytes that the checker needs for each sphere.
    pub const BYTES_PER_SPHERE: u64 = 40;
}

impl<'a> Checker<'a> {
    /// Prepares a scene, which takes 24 bytes for each sphere, and 8 to 16 for boxes.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory.
    pub fn new(scene: &'a Scene) -> Result<Self, SceneError> {
        Ok(Self { scene, candidates: Candidates::new(scene.spheres())? })
    }

    /// Every answer that a conforming device may give for a ray with exactly these numbers, in the scene's frame. The
    /// length of the direction must be about one.
    #[must_use]
    pub fn legal_hits(&self, origin: [f32; 3], direction: [f32; 3]) -> LegalHits {
        let mut legal = LegalHits::default();
        legal.find(&self.candidates, &Line::new(origin, direction));
        legal
    }

    /// Judges every pixel of a recording.
    #[must_use]
    pub fn certify(&self, recording: &Recording) -> Certificate {
        let Recording { camera, uploaded, film, .. } = recording;
        let size = [film.width(), film.height()];
        let mut certificate = Certificate {
            size,
            verdicts: Vec::new(),
            violations: Vec::new(),
            rendered_otherwise: None,
            upload: upload::check(self.scene, &self.candidates, recording).err(),
            worst_depth: 0.0,
            worst_normal: 0.0,
            deviations: Deviations::default(),
        };
        if certificate.upload.is_some() {
            return certificate;
        }
        let check = PixelCheck {
            scene: self.scene,
            candidates: &self.candidates,
            model: CameraModel::new(camera.kind, uploaded, film),
            recording,
        };
        let is_compared = recording.rendered != Rendered::None;
        certificate.rendered_otherwise = is_compared.then_some(0);
        let pixels = ranges(recording.pixels.len(), CHUNK);
        for part in map_parts(pixels, |range| judge(&check, range, size[0])) {
            certificate.verdicts.extend(part.verdicts);
            if let Some(count) = &mut certificate.rendered_otherwise {
                *count += part.rendered_otherwise;
            }
            let room = KEPT.saturating_sub(certificate.violations.len());
            certificate.violations.extend(part.violations.into_iter().take(room));
            certificate.worst_depth = certificate.worst_depth.max(part.worst_depth);
            certificate.worst_normal = certificate.worst_normal.max(part.worst_normal);
            certificate.deviations.join(&part.deviations);
        }
        certificate
    }
}

fn judge(check: &PixelCheck<'_>, range: std::ops::Range<usize>, width: u32) -> JudgedPixels {
    let mut part =
        JudgedPixels { verdicts: Vec::with_capacity(range.len()), ..JudgedPixels::default() };
    let mut legal = LegalHits::default();
    let one_in = if check.recording.pixels.len() > ALL_MEASURED { ONE_IN } else { 1 };
    for index in range {
        // The sides of a film are u32.
        let pixel = [(index % width as usize) as u32, (index / width as usize) as u32];
        let measured = (index % one_in == 0).then_some(&mut part.deviations);
        let judged = check.judge(index, pixel, &mut legal, measured);
        let rendered = check.judge_rendered(index, pixel, &mut legal);
        part.rendered_otherwise += usize::from(rendered.is_some());
        let judged = judged.and_then(|judged| rendered.unwrap_or(Ok(())).map(|()| judged));
        let verdict = match judged {
            Ok(judged) => {
                part.worst_depth = part.worst_depth.max(judged.depth);
                part.worst_normal = part.worst_normal.max(judged.normal);
                judged.verdict
            }
            Err(kind) => {
                if part.violations.len() < KEPT {
                    part.violations.push(Violation { pixel, kind });
                }
                Verdict::Violation
            }
        };
        part.verdicts.push(verdict);
    }
    part
}
