//! The check of all stages of all samples of a recording, along paths or in a studio.

use crate::scene::material::{Material, SurfaceProperties};
use crate::verify::camera::CameraModel;
use crate::verify::checker::Checker;
use crate::verify::choices::Choices;
use crate::verify::hit::LegalHits;
use crate::verify::lit::certificate::{Address, LitCertificate, LitStage};
use crate::verify::lit::check::{LitCheck, unfinished};
use crate::verify::lit::film::check_sums;
use crate::verify::lit::judge::{
    Expected, Judged, Mismatch, StageOutcome, along_choices, judge_pixels, searched, unchanged,
};
use crate::verify::lit::kernel::{Hit, Kernel};
use crate::verify::lit::recording::{
    BITS, LitInputs, LitRecording, LitSurface, NO_EMITTER, PathRecording, PathState,
    RecordedSample, RectangleRecording, RectangleSample, StudioLight, StudioRecording,
    StudioSample, flag, slot,
};
use crate::verify::lit::search::check_open;
use crate::verify::lit::upload;
use crate::verify::number::{Number, Vector};
use crate::verify::paths::kernel::radiance_so_far;
use crate::verify::studio::light::Change;
use crate::verify::studio::search::Hidden;
use crate::verify::studio::surface::Met;

/// The stage and the name of a number, for reports.
type Name = (LitStage, &'static str);

const ENDED_PATH: Name = (LitStage::Scatter, "a path that has ended");
const ENDED_RAY: Name = (LitStage::Surface, "a ray that has ended");

impl Checker<'_> {
    /// Judges every stage of every sample. The recording must be of the scene of this checker.
    #[must_use]
    pub fn certify_lit(&self, recording: LitRecording<'_>) -> LitCertificate {
        match recording {
            LitRecording::Paths(recording) => self.certify_paths(recording),
            LitRecording::Studio(recording) => self.certify_studio(recording),
        }
    }

    /// Judges every stage of every path. The recording must be of the scene of this checker.
    #[must_use]
    pub fn certify_paths(&self, recording: &PathRecording) -> LitCertificate {
        self.certify_samples(recording, |check, sample, index, part, legal| {
            check.judge_path(sample, index, part, legal);
        })
    }

    /// Judges every stage of every sample. The recording must be of the scene of this checker.
    #[must_use]
    pub fn certify_studio(&self, recording: &StudioRecording) -> LitCertificate {
        let certificate = self.certify_samples(recording, |check, sample, index, part, legal| {
            check.judge_sample(sample, index, part, legal);
        });
        LitCertificate { is_studio: true, ..certificate }
    }

    /// `judge` is called with the index of a pixel.
    fn certify_samples<S: LitSurface>(
        &self,
        recording: &RectangleRecording<S>,
        judge: impl Fn(&LitCheck<'_>, &RectangleSample<S>, usize, &mut LitCertificate, &mut LegalHits)
        + Sync,
    ) -> LitCertificate {
        let given = &recording.given;
        let upload = upload::check(self.scene, &self.candidates, given)
            .and_then(|()| recording.check_size())
            .err();
        let mut certificate = LitCertificate {
            upload,
            film_pixels: given.film.pixel_count(),
            film_samples: given.settings.sampling.samples,
            rectangles: vec![given.rectangle()],
            ..LitCertificate::default()
        };
        if certificate.upload.is_some() {
            return certificate;
        }
        let is_matt = |surface: &SurfaceProperties| match surface.material {
            Material::Lambert { specular, .. } => specular == 0.0,
            Material::Emissive { .. } => true,
            Material::Conductor { .. } | Material::Dielectric { .. } => false,
        };
        let check = LitCheck {
            checker: self,
            inputs: given,
            model: CameraModel::new(given.camera.kind, &given.uploaded, &given.film),
            is_matt: self.scene.appearance().surfaces().iter().all(is_matt),
        };
        for sample in &recording.samples {
            certificate.join(judge_pixels(sample.start.len(), |index, part, legal| {
                judge(&check, sample, index, part, legal);
            }));
        }
        certificate
    }
}

impl LitCheck<'_> {
    fn judge_path(
        &self,
        recorded: &RecordedSample,
        index: usize,
        part: &mut LitCertificate,
        legal: &mut LegalHits,
    ) {
        let (mut address, mut state) = self.start(recorded, index, part);
        let mut last = None;
        for (surface, stage) in (0..).zip(&recorded.surfaces) {
            address.surface = surface;
            let after = stage.scattered[index];
            if state.has(flag::ALIVE) {
                let hit = Hit::new(stage.hits[index]);
                part.note(LitStage::Extend, address, self.extend(&state, last, hit, legal));
                part.note(LitStage::Scatter, address, self.scatter(address, &state, hit, &after));
                last = Some(hit);
            } else if let Err(mismatch) = unchanged(ENDED_PATH, [&state, &after]) {
                part.note(LitStage::Scatter, address, Err(mismatch));
            }
            let open = f32::from_bits(stage.open[index]);
            let is_searched = surface < self.inputs.max_surfaces
                && self.inputs.lighting.source_count > 0
                && after.number(slot::SHADOW) > 0.0;
            if is_searched {
                part.note(LitStage::Occlude, address, self.occlude(&after, open));
            } else if stage.open[index] != after.bits(slot::PENDING) {
                let words = format!("{open:?}, without a search");
                let what = "the visibility of the light";
                let fail = Expected::default().fail(LitStage::Occlude, what, words);
                part.note(LitStage::Occlude, address, Err(fail));
            }
            state = after.with_visibility(stage.open[index]);
        }
        let color = radiance_so_far(&state);
        if state.has(flag::ALIVE) {
            part.note(LitStage::Extend, address, Err(unfinished("path")));
        }
        let sums = check_sums(color, &state, &recorded.film, index);
        part.note(LitStage::Accumulate, address, sums);
    }

    fn judge_sample(
        &self,
        recorded: &StudioSample,
        index: usize,
        part: &mut LitCertificate,
        legal: &mut LegalHits,
    ) {
        let (mut address, mut state) = self.start(recorded, index, part);
        let mut last = None;
        for (surface, stage) in (0..).zip(&recorded.surfaces) {
            address.surface = surface;
            let mut after = stage.shaded[index];
            let mut met = Some(Met::Nothing);
            if state.has(flag::ALIVE) {
                let hit = Hit::new(stage.hits[index]);
                let result = self.extend(&state, last, hit, legal);
                part.note(LitStage::Extend, address, result);
                let (result, found) = self.surface(address, &state, hit, &after);
                part.note(LitStage::Surface, address, result);
                (met, last) = (found, Some(hit));
            } else if let Err(mismatch) = unchanged(ENDED_RAY, [&state, &after]) {
                part.note(LitStage::Surface, address, Err(mismatch));
            }
            for (kind, lights) in [(Kind::Lights, &stage.lights), (Kind::Ambient, &stage.ambient)] {
                for (batch, light) in (0..).zip(lights) {
                    let found = Light { kind, first: batch * BITS, light, index };
                    self.judge_light(address, met, &after, found, part);
                    after = after.with_light(light.radiance[index], light.left[index]);
                }
            }
            state = after;
        }
        if state.has(flag::ALIVE) {
            part.note(LitStage::Extend, address, Err(unfinished("ray")));
        }
        let color = Vector::recorded(state.vector(slot::RADIANCE));
        let sums = check_sums(color, &state, &recorded.film, index);
        part.note(LitStage::Accumulate, address, sums);
    }

    fn scatter(
        &self,
        address: Address,
        before: &PathState,
        hit: Hit,
        after: &PathState,
    ) -> Result<Judged, Mismatch> {
        along_choices(|choices| {
            let mut kernel = self.kernel(address, before, choices);
            (kernel.hit, kernel.after) = (hit, after);
            kernel.follow()?;
            Ok(kernel.expected)
        })
    }

    fn occlude(&self, state: &PathState, open: f32) -> Result<Judged, Mismatch> {
        let mut expected = Expected::default();
        let LitInputs { emitters, .. } = self.inputs;
        let emitter = state.departure().emitter;
        let sphere_of_light = (emitter != NO_EMITTER)
            .then(|| emitters.get((emitter as usize).saturating_mul(3)))
            .flatten()
            .map(|sphere| sphere.map(f32::from_bits));
        let doubts = check_open(self.searched(), state, sphere_of_light, open, &mut expected)?;
        Ok(searched(doubts.is_some(), || doubts.unwrap_or_default().alternatives()))
    }

    /// Judges what is seen of a surface, and says what was met, if that is known.
    fn surface(
        &self,
        address: Address,
        before: &PathState,
        hit: Hit,
        after: &PathState,
    ) -> (Result<Judged, Mismatch>, Option<Met>) {
        let mut met = None;
        let is_last = address.surface + 1 >= self.inputs.max_surfaces;
        let result = along_choices(|choices| {
            let mut kernel = self.kernel(address, before, choices);
            (kernel.hit, kernel.after) = (hit, after);
            met = Some(kernel.follow_surface(is_last)?);
            Ok(kernel.expected)
        });
        (result, met)
    }

    /// Judges which of some lights are hidden, and the light of the others.
    fn judge_light(
        &self,
        address: Address,
        met: Option<Met>,
        state: &PathState,
        found: Light<'_>,
        part: &mut LitCertificate,
    ) {
        match met {
            // What the ray met is not legal, so that nothing can be said about its light.
            None => {}
            Some(Met::Nothing | Met::Emitter) => {
                if let Err(mismatch) = found.unlit(state) {
                    part.note(LitStage::Illuminate, address, Err(mismatch));
                }
            }
            Some(Met::Surface) => {
                let (searches, sums) = match found.kind {
                    Kind::Lights => (LitStage::Shadow, LitStage::Illuminate),
                    Kind::Ambient => (LitStage::Ambient, LitStage::Gather),
                };
                for offset in 0..BITS {
                    let result = self.hidden(address, state, found, offset);
                    if let Some(result) = result.transpose() {
                        part.note(searches, address, result);
                    }
                }
                part.note(sums, address, self.added(address, state, found));
            }
        }
    }

    /// Judges whether a light or a direction of ambient light is hidden; `None` if it is not searched for.
    fn hidden(
        &self,
        address: Address,
        state: &PathState,
        found: Light<'_>,
        offset: u32,
    ) -> Result<Option<Judged>, Mismatch> {
        let is_hidden = found.bits() & (1 << offset) != 0;
        let index = found.first + offset;
        let candidates = &self.checker.candidates;
        let is_searched = index < self.count(found.kind)
            && (found.kind == Kind::Ambient
                || self.kernel(address, state, &mut Choices::default()).casts_shadow(index));
        let legal = if is_searched {
            self.outcomes(address, state, Hidden::or, |kernel| match found.kind {
                Kind::Lights => kernel.is_light_hidden(candidates, index),
                Kind::Ambient => kernel.is_direction_hidden(candidates, index),
            })
        } else {
            Some(Hidden::NEVER)
        };
        let Some(Hidden { may, must, doubts }) = legal else {
            return Ok(Some(StageOutcome::Undecided.into()));
        };
        let answer = match (is_hidden, may, must) {
            (true, false, _) if !is_searched => "hidden, but it is not searched for",
            (true, false, _) => "hidden, but nothing is in between",
            (false, _, true) => "visible, but something is in between",
            _ if !is_searched => return Ok(None),
            _ => return Ok(Some(searched(may && !must, || doubts.alternatives()))),
        };
        let (stage, what) = match found.kind {
            Kind::Lights => (LitStage::Shadow, "light"),
            Kind::Ambient => (LitStage::Ambient, "direction"),
        };
        let words = format!("{what} {index} is {answer}");
        Err(Expected::default().fail(stage, "what is hidden", words))
    }

    fn count(&self, kind: Kind) -> u32 {
        match kind {
            Kind::Lights => self.inputs.lighting.light_count,
            Kind::Ambient => self.inputs.lighting.occlusion_samples,
        }
    }

    /// The outcomes of a kernel for all combinations of its open decisions, joined; `None` if they are too many.
    fn outcomes<T>(
        &self,
        address: Address,
        state: &PathState,
        join: impl Fn(T, T) -> T,
        mut follow: impl FnMut(&mut Kernel<'_>) -> T,
    ) -> Option<T> {
        let mut choices = Choices::default();
        let mut all = follow(&mut self.kernel(address, state, &mut choices));
        while choices.advance() {
            all = join(all, follow(&mut self.kernel(address, state, &mut choices)));
        }
        (!choices.were_too_many()).then_some(all)
    }

    /// Judges the light that is added to a surface.
    fn added(
        &self,
        address: Address,
        state: &PathState,
        found: Light<'_>,
    ) -> Result<Judged, Mismatch> {
        let total = self.outcomes(address, state, Number::union, |kernel| kernel.light_to_catch());
        let sum = total.and_then(|total| self.sum(address, state, found, total));
        let Some(sum) = sum else { return Ok(StageOutcome::Undecided.into()) };
        let (stage, radiance, opacity) = match found.kind {
            Kind::Lights => (
                LitStage::Illuminate,
                "the radiance with these lights",
                "the opacity with these lights",
            ),
            Kind::Ambient => (
                LitStage::Gather,
                "the radiance with ambient light",
                "the opacity with ambient light",
            ),
        };
        let mut expected = Expected::default();
        let before = state.vector(slot::RADIANCE);
        let [r, g, b, found_opacity] = found.light.radiance[found.index].map(f32::from_bits);
        let size = before.into_iter().fold(0.0, |size: f64, c| size.max(f64::from(c.abs())));
        let legal = Vector::recorded(before) + sum.radiance;
        expected.vector_of((stage, radiance), [r, g, b], legal, size)?;
        let alpha = Number::recorded(state.number(slot::RADIANCE)) + sum.opacity;
        expected.number((stage, opacity), found_opacity, alpha)?;
        expected.bits((stage, "the bits that are left"), found.light.left[found.index], 0)?;
        Ok(expected.into())
    }

    /// The sum of all light of a batch, given which lights are hidden. Where decisions of a light are open, its part is
    /// everything between the outcomes.
    fn sum(
        &self,
        address: Address,
        state: &PathState,
        found: Light<'_>,
        total: Number,
    ) -> Option<Change> {
        let count = self.count(found.kind).saturating_sub(found.first).min(BITS);
        let bits = found.bits();
        if found.kind == Kind::Ambient {
            let hidden = bits.count_ones();
            return self.outcomes(address, state, Change::union, |kernel| {
                kernel.ambient_added(count, hidden, total)
            });
        }
        (0..count).try_fold(Change::NONE, |sum, offset| {
            let is_hidden = bits & (1 << offset) != 0;
            let light = self.outcomes(address, state, Change::union, |kernel| {
                kernel.light_added(found.first + offset, is_hidden, total)
            });
            light.map(|light| sum.plus(light))
        })
    }
}

/// The kind of light that a [`StudioLight`] holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Lights,
    Ambient,
}

/// The light of a pixel from a batch.
#[derive(Clone, Copy)]
struct Light<'a> {
    kind: Kind,
    /// Index of the first light or direction.
    first: u32,
    light: &'a StudioLight,
    /// Index of the pixel.
    index: usize,
}

impl Light<'_> {
    fn bits(&self) -> u32 {
        self.light.hidden[self.index]
    }

    /// Checks that a ray on which no surface is lit does not change.
    fn unlit(&self, state: &PathState) -> Result<(), Mismatch> {
        const KEPT: (LitStage, &str) = (LitStage::Illuminate, "a ray without a lit surface");
        let mut expected = Expected::default();
        let bits = state.bits(slot::NORMAL);
        let (hidden, left) = (self.bits(), self.light.left[self.index]);
        // Without a search there are no bits.
        if hidden != 0 {
            expected.bits(KEPT, hidden, bits)?;
        }
        expected.bits(KEPT, left, bits)?;
        let radiance = self.light.radiance[self.index].into_iter();
        radiance
            .zip(state.slots[slot::RADIANCE])
            .try_for_each(|(found, legal)| expected.bits(KEPT, found, legal))
    }
}
