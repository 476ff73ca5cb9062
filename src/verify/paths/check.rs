//! The check of all stages of all paths of a recording.

use super::certificate::{PathCertificate, PathStage, PathViolation, StageCounts};
use super::expected::{Expected, Mismatch};
use super::kernel::{Address, Hit, Kernel, radiance_so_far};
use super::recording::{NO_EMITTER, PathRecording, PathState, RecordedSample, flag, slot};
use super::search::{self, Searched};
use super::{start, upload};
use crate::image::color::LUMINANCE;
use crate::parallel::{map_parts, ranges};
use crate::scene::material::{Material, SurfaceProperties};
use crate::verify::camera::CameraModel;
use crate::verify::certificate::KEPT;
use crate::verify::checker::Checker;
use crate::verify::choices::Choices;
use crate::verify::hit::LegalHits;
use crate::verify::number::{Number, Vector};

/// The number of pixels that a thread takes at a time.
const CHUNK: usize = 256;

/// The verdict about a stage.
enum StageOutcome {
    Decided,
    Open,
    Undecided,
}

/// The data with which paths are judged.
struct PathCheck<'a> {
    checker: &'a Checker<'a>,
    recording: &'a PathRecording,
    model: CameraModel,
    is_matt: bool,
}

impl Checker<'_> {
    /// Judges every stage of every path. The recording must be of the scene of this checker.
    #[must_use]
    pub fn certify_paths(&self, recording: &PathRecording) -> PathCertificate {
        let upload = upload::check(self.scene, &self.candidates, recording).err();
        let mut certificate = PathCertificate { upload, ..PathCertificate::default() };
        if certificate.upload.is_some() {
            return certificate;
        }
        let is_matt = |surface: &SurfaceProperties| match surface.material {
            Material::Lambert { specular, .. } => specular == 0.0,
            Material::Emissive { .. } => true,
            Material::Conductor { .. } | Material::Dielectric { .. } => false,
        };
        let check = PathCheck {
            checker: self,
            recording,
            model: CameraModel::new(recording.camera.kind, &recording.uploaded, &recording.film),
            is_matt: self.scene.appearance().surfaces().iter().all(is_matt),
        };
        for sample in &recording.samples {
            let pixels = ranges(sample.start.len(), CHUNK);
            for part in map_parts(pixels, |range| check.judge(sample, range)) {
                certificate.join(part);
            }
        }
        certificate
    }
}

impl PathCertificate {
    /// Adds the results for other paths.
    pub fn join(&mut self, part: Self) {
        self.paths += part.paths;
        self.start = self.start.plus(part.start);
        self.extend = self.extend.plus(part.extend);
        self.scatter = self.scatter.plus(part.scatter);
        self.occlude = self.occlude.plus(part.occlude);
        self.accumulate = self.accumulate.plus(part.accumulate);
        self.violation_count += part.violation_count;
        self.upload = self.upload.take().or(part.upload);
        let room = KEPT.saturating_sub(self.violations.len());
        self.violations.extend(part.violations.into_iter().take(room));
    }
}

impl StageCounts {
    fn count(&mut self, verdict: &StageOutcome) {
        self.checked += 1;
        match verdict {
            StageOutcome::Decided => self.decided += 1,
            StageOutcome::Open => self.open += 1,
            StageOutcome::Undecided => self.undecided += 1,
        }
    }
}

/// Records the verdict about a stage.
fn note(
    counts: &mut StageCounts,
    violations: &mut Vec<PathViolation>,
    Address { pixel, sample, surface }: Address,
    result: Result<StageOutcome, Mismatch>,
) {
    match result {
        Ok(verdict) => counts.count(&verdict),
        Err(mismatch) => {
            counts.checked += 1;
            let (stage, message) = (mismatch.stage, mismatch.to_string());
            violations.push(PathViolation { pixel, sample, surface, stage, message });
        }
    }
}

/// Evaluates a stage for every combination of open decisions, until one leads to the device's result.
fn along_choices(
    mut follow: impl FnMut(&mut Choices) -> Result<Expected, Mismatch>,
) -> Result<StageOutcome, Mismatch> {
    let mut choices = Choices::default();
    let mut nearest: Option<Mismatch> = None;
    loop {
        match follow(&mut choices) {
            Ok(expected) if expected.is_wide => return Ok(StageOutcome::Undecided),
            Ok(_) if choices.were_open() => return Ok(StageOutcome::Open),
            Ok(_) => return Ok(StageOutcome::Decided),
            Err(mismatch) => {
                if nearest.as_ref().is_none_or(|best| mismatch.after > best.after) {
                    nearest = Some(mismatch);
                }
            }
        }
        if !choices.advance() {
            break;
        }
    }
    match nearest {
        Some(mismatch) if !choices.were_too_many() => Err(mismatch),
        _ => Ok(StageOutcome::Undecided),
    }
}

fn simple(is_open: bool) -> StageOutcome {
    if is_open { StageOutcome::Open } else { StageOutcome::Decided }
}

impl PathCheck<'_> {
    fn judge(&self, sample: &RecordedSample, range: std::ops::Range<usize>) -> PathCertificate {
        let mut part = PathCertificate::default();
        let mut legal = LegalHits::default();
        for index in range {
            part.paths += 1;
            self.judge_path(sample, index, &mut part, &mut legal);
        }
        part.violation_count = part.violations.len() as u64;
        part.violations.truncate(KEPT);
        part
    }

    fn judge_path(
        &self,
        recorded: &RecordedSample,
        index: usize,
        part: &mut PathCertificate,
        legal: &mut LegalHits,
    ) {
        let PathRecording { origin, size, .. } = self.recording;
        let width = size[0].max(1) as usize;
        // The sides of a film are u32.
        let pixel = [origin[0] + (index % width) as u32, origin[1] + (index / width) as u32];
        let mut address = Address { pixel, sample: recorded.sample, surface: 0 };
        let mut state = recorded.start[index];
        let PathCertificate { violations, start, extend, scatter, occlude, accumulate, .. } = part;
        note(start, violations, address, self.start(address, &state));
        let mut last = None;
        for (surface, stage) in (0..).zip(&recorded.surfaces) {
            address.surface = surface;
            let mut after = stage.scattered[index];
            if state.has(flag::ALIVE) {
                let hit = Hit::new(stage.hits[index]);
                note(extend, violations, address, self.extend(&state, last, hit, legal));
                note(scatter, violations, address, self.scatter(address, &state, hit, &after));
                last = Some(hit);
            } else {
                // The state of a path that has ended does not change.
                let mut expected = Expected::default();
                let same = (0..PathState::SLOTS).try_for_each(|which| {
                    let name = (PathStage::Scatter, "a path that has ended");
                    expected.same(name, [&state, &after], which)
                });
                if let Err(mismatch) = same {
                    note(scatter, violations, address, Err(mismatch));
                }
            }
            let open = f32::from_bits(stage.open[index]);
            let is_searched = surface < self.recording.max_depth
                && self.recording.lighting.source_count > 0
                && after.number(slot::SHADOW) > 0.0;
            if is_searched {
                note(occlude, violations, address, self.occlude(&after, open));
            } else if stage.open[index] != after.bits(slot::PENDING) {
                let words = format!("{open:?}, without a search");
                let fail = Expected::default().fail(
                    PathStage::Occlude,
                    "the visibility of the light",
                    words,
                );
                note(occlude, violations, address, Err(fail));
            }
            if stage.open[index] != after.bits(slot::PENDING) {
                // A light that is occluded is not searched again.
                after.slots[slot::PENDING][3] = stage.open[index];
                after.slots[slot::SHADOW][3] = 0;
            }
            state = after;
        }
        if state.has(flag::ALIVE) {
            let words = "the path was not followed to its end".to_owned();
            let fail = Expected::default().fail(PathStage::Extend, "the hit", words);
            note(extend, violations, address, Err(fail));
        }
        note(accumulate, violations, address, Self::accumulate(&state, recorded.sums[index]));
    }

    fn start(&self, address: Address, state: &PathState) -> Result<StageOutcome, Mismatch> {
        along_choices(|choices| {
            let mut expected = Expected::default();
            let (recording, model) = (self.recording, &self.model);
            start::check(recording, model, address, state, &mut expected, choices)?;
            Ok(expected)
        })
    }

    fn searched(&self) -> Searched<'_> {
        let Checker { scene, candidates, .. } = self.checker;
        Searched { model: &self.model, scene, candidates }
    }

    fn extend(
        &self,
        state: &PathState,
        last: Option<Hit>,
        hit: Hit,
        legal: &mut LegalHits,
    ) -> Result<StageOutcome, Mismatch> {
        let mut expected = Expected::default();
        search::check_hit(self.searched(), state, last, hit, &mut expected, legal).map(simple)
    }

    fn scatter(
        &self,
        address: Address,
        before: &PathState,
        hit: Hit,
        after: &PathState,
    ) -> Result<StageOutcome, Mismatch> {
        along_choices(|choices| {
            let mut kernel = Kernel {
                scene: self.checker.scene,
                recording: self.recording,
                is_matt: self.is_matt,
                address,
                before,
                hit,
                after,
                expected: Expected::default(),
                choices,
            };
            kernel.follow()?;
            Ok(kernel.expected)
        })
    }

    fn occlude(&self, state: &PathState, open: f32) -> Result<StageOutcome, Mismatch> {
        let mut expected = Expected::default();
        let PathRecording { emitters, .. } = self.recording;
        let emitter = state.departure().emitter;
        let sphere_of_light = (emitter != NO_EMITTER)
            .then(|| emitters.get((emitter as usize).saturating_mul(3)))
            .flatten()
            .map(|sphere| sphere.map(f32::from_bits));
        search::check_open(self.searched(), state, sphere_of_light, open, &mut expected).map(simple)
    }

    /// Judges the contribution of a sample to the picture.
    fn accumulate(state: &PathState, sums: [[u32; 4]; 2]) -> Result<StageOutcome, Mismatch> {
        const COLOR: (PathStage, &str) = (PathStage::Accumulate, "the sample's color");
        const ALPHA: (PathStage, &str) = (PathStage::Accumulate, "the sample's opacity");
        const ALBEDO: (PathStage, &str) = (PathStage::Accumulate, "the first surface's color");
        const SQUARE: (PathStage, &str) = (PathStage::Accumulate, "the square of the luminance");
        let [[r, g, b, alpha], [x, y, z, square]] = sums.map(|sum| sum.map(f32::from_bits));
        let mut expected = Expected::default();
        let color = radiance_so_far(state);
        expected.vector(COLOR, [r, g, b], color)?;
        expected.number(ALPHA, alpha, Number::recorded(state.number(slot::RADIANCE)))?;
        expected.vector(ALBEDO, [x, y, z], Vector::recorded(state.vector(slot::FIRST)))?;
        let weights = Vector(LUMINANCE.map(Number::constant));
        expected.number(SQUARE, square, color.dot(weights).squared())?;
        Ok(if expected.is_wide { StageOutcome::Undecided } else { StageOutcome::Decided })
    }
}
