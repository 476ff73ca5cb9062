//! The check of all stages of all samples of a recording.

use super::light::Change;
use super::recording::{BITS, StudioLight, StudioRecording, StudioSample};
use super::search::Hidden;
use super::surface::Met;
use crate::verify::camera::CameraModel;
use crate::verify::checker::Checker;
use crate::verify::choices::Choices;
use crate::verify::hit::LegalHits;
use crate::verify::lit::certificate::LitCertificate;
use crate::verify::lit::expected::{Expected, Mismatch};
use crate::verify::lit::judge::{
    Judged, StageOutcome, along_choices, judge_pixels, searched, unchanged,
};
use crate::verify::lit::kernel::{Address, Hit, Kernel};
use crate::verify::lit::recording::{LitInputs, PathState, flag, slot};
use crate::verify::lit::search::{self, Searched};
use crate::verify::lit::stage::LitStage;
use crate::verify::lit::{film, start, upload};
use crate::verify::number::{Number, Vector};

const ENDED: (LitStage, &str) = (LitStage::Surface, "a ray that has ended");

/// The data with which samples are judged.
struct StudioCheck<'a> {
    checker: &'a Checker<'a>,
    inputs: &'a LitInputs,
    model: CameraModel,
}

/// Which of two kinds of light a [`StudioLight`] holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Lights,
    Ambient,
}

impl Checker<'_> {
    /// Judges every stage of every sample. The recording must be of the scene of this checker.
    #[must_use]
    pub fn certify_studio(&self, recording: &StudioRecording) -> LitCertificate {
        let given = &recording.given;
        let upload = upload::check(self.scene, &self.candidates, given)
            .and_then(|()| recording.check_size())
            .err();
        let mut certificate = LitCertificate {
            upload,
            film_pixels: given.film.pixel_count(),
            film_samples: given.settings.sampling.samples,
            is_studio: true,
            rectangles: vec![given.rectangle()],
            ..LitCertificate::default()
        };
        if certificate.upload.is_some() {
            return certificate;
        }
        let model = CameraModel::new(given.camera.kind, &given.uploaded, &given.film);
        let check = StudioCheck { checker: self, inputs: given, model };
        for sample in &recording.samples {
            certificate.join(judge_pixels(sample.start.len(), |index, part, legal| {
                check.judge_sample(sample, index, part, legal);
            }));
        }
        certificate
    }
}

impl StudioCheck<'_> {
    fn judge_sample(
        &self,
        recorded: &StudioSample,
        index: usize,
        part: &mut LitCertificate,
        legal: &mut LegalHits,
    ) {
        let pixel = self.inputs.pixel(index);
        let mut address = Address { pixel, sample: recorded.sample, surface: 0 };
        let mut state = recorded.start[index];
        let started = start::judge(self.inputs, &self.model, address, &state);
        part.note(LitStage::Start, address, started);
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
            } else if let Err(mismatch) = unchanged(ENDED, [&state, &after]) {
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
            let words = "the ray was not followed to its end".to_owned();
            let fail = Expected::default().fail(LitStage::Extend, "the hit", words);
            part.note(LitStage::Extend, address, Err(fail));
        }
        let color = Vector::recorded(state.vector(slot::RADIANCE));
        let sums = film::check(color, &state, &recorded.film, index);
        part.note(LitStage::Accumulate, address, sums);
    }

    fn extend(
        &self,
        state: &PathState,
        last: Option<Hit>,
        hit: Hit,
        legal: &mut LegalHits,
    ) -> Result<Judged, Mismatch> {
        let Checker { scene, candidates, .. } = self.checker;
        let given = Searched { model: &self.model, scene, candidates };
        let mut expected = Expected::default();
        let is_open = search::check_hit(given, state, last, hit, &mut expected, legal)?;
        Ok(searched(is_open, || legal.alternatives()))
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

    /// A kernel that only reads the state of a ray.
    fn kernel<'b>(
        &'b self,
        address: Address,
        state: &'b PathState,
        choices: &'b mut Choices,
    ) -> Kernel<'b> {
        Kernel {
            scene: self.checker.scene,
            inputs: self.inputs,
            is_matt: false,
            address,
            before: state,
            hit: Hit::new([0; 4]),
            after: state,
            expected: Expected::default(),
            choices,
        }
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
        let names = match found.kind {
            Kind::Lights => [
                (LitStage::Illuminate, "the radiance with these lights"),
                (LitStage::Illuminate, "the opacity with these lights"),
                (LitStage::Illuminate, "the bits that are left"),
            ],
            Kind::Ambient => [
                (LitStage::Gather, "the radiance with ambient light"),
                (LitStage::Gather, "the opacity with ambient light"),
                (LitStage::Gather, "the bits that are left"),
            ],
        };
        let mut expected = Expected::default();
        let before = state.vector(slot::RADIANCE);
        let [r, g, b, opacity] = found.light.radiance[found.index].map(f32::from_bits);
        let size = before.into_iter().fold(0.0, |size: f64, c| size.max(f64::from(c.abs())));
        let radiance = Vector::recorded(before) + sum.radiance;
        expected.vector_of(names[0], [r, g, b], radiance, size)?;
        let alpha = Number::recorded(state.number(slot::RADIANCE)) + sum.opacity;
        expected.number(names[1], opacity, alpha)?;
        expected.bits(names[2], found.light.left[found.index], 0)?;
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
