//! The check of all stages of all samples of a recording, along paths or in a studio.

use crate::recording::lit::{
    BITS, LitRecording, PathState, RecordedSample, RecordedSurface, StudioLight, UploadedLighting, flag, slot,
};
use crate::verify::checker::Checker;
use crate::verify::choices::Choices;
use crate::verify::hit::LegalHits;
use crate::verify::lit::certificate::{Address, LitCertificate, LitStage};
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::film::{check_sums, judge_start};
use crate::verify::lit::judge::{
    Judge, Mismatch, Name, StageOutcome, StageResult, along_choices, judge_pixels, searched,
};
use crate::verify::lit::kernel::{Hit, Kernel, Output, RayState};
use crate::verify::lit::search::{OPEN, Obstacle, check_hit, check_open};
use crate::verify::lit::upload;
use crate::verify::number::{Number, Vector};
use crate::verify::paths::kernel::radiance_so_far;
use crate::verify::studio::light::Change;
use crate::verify::studio::surface::HitKind;

impl Checker<'_> {
    /// Judges every stage of every sample. The recording must show the scene of this checker.
    #[must_use]
    pub fn certify_lit(&self, recording: &LitRecording) -> LitCertificate {
        let given = &recording.given;
        let upload = upload::check(self.scene, &self.candidates, given).and_then(|()| recording.check_size()).err();
        let mut certificate = LitCertificate {
            upload,
            film_pixels: given.film.pixel_count(),
            film_samples: given.settings.sampling.samples,
            rectangles: vec![given.rectangle()],
            is_studio: given.is_studio(),
            ..LitCertificate::default()
        };
        if certificate.upload.is_some() {
            return certificate;
        }
        let check = LitCheck::new(self, given);
        for sample in &recording.samples {
            certificate.join(judge_pixels(sample.start.len(), |index, part, legal| {
                check.judge_sample(sample, index, part, legal);
            }));
        }
        certificate
    }
}

impl LitCheck<'_> {
    /// Judges a sample of the pixel with this index.
    pub(crate) fn judge_sample(
        &self,
        recorded: &RecordedSample,
        index: usize,
        part: &mut LitCertificate,
        legal: &mut LegalHits,
    ) {
        let (stage, ray, ended) = match self.is_studio {
            true => (LitStage::Surface, "ray", "a ray that has ended"),
            false => (LitStage::Scatter, "path", "a path that has ended"),
        };
        let pixel = self.inputs.pixel(index);
        let mut address = Address { pixel, sample: recorded.sample, surface: 0 };
        let mut state = recorded.start[index];
        let started = judge_start(self.inputs, &self.model, address, &state);
        part.note(LitStage::Start, address, started);
        let mut last = None;
        for (surface, found) in (0..).zip(&recorded.surfaces) {
            address.surface = surface;
            let after = found.states[index];
            let mut met = Some(HitKind::Nothing);
            if state.has(flag::ALIVE) {
                let hit = Hit::new(found.hits[index]);
                let result = check_hit(self, &state, last, hit, legal);
                part.note(LitStage::Extend, address, result);
                let (result, seen) = self.shade(address, &state, hit, &after);
                part.note(stage, address, result);
                (met, last) = (seen, Some(hit));
            } else if let Err(mismatch) = Judge::default().unchanged((stage, ended), [&state, &after]) {
                part.note(stage, address, Err(mismatch));
            }
            state = match self.is_studio {
                true => self.judge_lights(address, met, after, found, index, part),
                false => self.judge_open(address, after, found.open[index], part),
            };
        }
        if state.has(flag::ALIVE) {
            let words = format!("the {ray} was not followed to its end");
            let unfinished = Judge::default().fail((LitStage::Extend, "the hit"), words);
            part.note(LitStage::Extend, address, Err(unfinished));
        }
        let color = match self.is_studio {
            true => Vector::recorded(state.vector(slot::RADIANCE)),
            false => radiance_so_far(&RayState::recorded(state)),
        };
        let sums = check_sums(color, &state, &recorded.film, index);
        part.note(LitStage::Accumulate, address, sums);
    }

    /// Judges the shading of a surface. Returns what a ray of a studio hit, if that is known.
    fn shade(
        &self,
        address: Address,
        before: &PathState,
        hit: Hit,
        after: &PathState,
    ) -> (Result<StageResult, Mismatch>, Option<HitKind>) {
        let mut met = None;
        let is_last = address.surface + 1 >= self.inputs.max_surfaces;
        let known = RayState::recorded(*before);
        let result = along_choices(|choices| {
            let mut kernel = self.kernel(address, &known, choices);
            (kernel.hit, kernel.after) = (hit.into(), Output::Recorded(after));
            match self.is_studio {
                true => met = Some(kernel.follow_surface(is_last)?),
                false => kernel.follow()?,
            }
            Ok(kernel.judge)
        });
        (result, met)
    }

    /// Judges whether the sampled light of a path is occluded, and returns the state with the answer.
    fn judge_open(&self, address: Address, after: PathState, bits: u32, part: &mut LitCertificate) -> PathState {
        let open = f32::from_bits(bits);
        let is_searched = address.surface < self.inputs.max_surfaces
            && self.inputs.lighting.source_count > 0
            && after.number(slot::SHADOW) > 0.0;
        if is_searched {
            part.note(LitStage::Occlude, address, check_open(self, &after, open));
        } else if bits != after.bits(slot::PENDING) {
            let words = format!("{open:?}, without a search");
            let fail = Judge::default().fail(OPEN, words);
            part.note(LitStage::Occlude, address, Err(fail));
        }
        after.with_visibility(bits)
    }

    /// Judges the light of a surface of a studio, and returns the state with it.
    fn judge_lights(
        &self,
        address: Address,
        met: Option<HitKind>,
        mut after: PathState,
        surface: &RecordedSurface,
        index: usize,
        part: &mut LitCertificate,
    ) -> PathState {
        let UploadedLighting { light_count, occlusion_samples, .. } = self.inputs.lighting;
        for (kind, count, lights) in
            [(&LIGHTS, light_count, &surface.lights), (&AMBIENT, occlusion_samples, &surface.ambient)]
        {
            for (batch, light) in (0..).zip(lights) {
                let found = Light { kind, count, first: batch * BITS, light, index };
                self.judge_light(address, met, &after, found, part);
                after = after.with_light(light.radiance[index], light.left[index]);
            }
        }
        after
    }

    /// Judges which lights of a batch are hidden, and the light of the others.
    fn judge_light(
        &self,
        address: Address,
        met: Option<HitKind>,
        state: &PathState,
        found: Light<'_>,
        part: &mut LitCertificate,
    ) {
        match met {
            // The hit is not legal, so its light cannot be judged.
            None => {}
            Some(HitKind::Nothing | HitKind::Emitter) => {
                if let Err(mismatch) = found.unlit(state) {
                    part.note(LitStage::Illuminate, address, Err(mismatch));
                }
            }
            Some(HitKind::Surface) => {
                let state = &RayState::recorded(*state);
                for offset in 0..BITS {
                    let result = self.hidden(address, state, found, offset);
                    if let Some(result) = result.transpose() {
                        part.note(found.kind.searches, address, result);
                    }
                }
                part.note(found.kind.sums, address, self.added(address, state, found));
            }
        }
    }

    /// Judges whether a light or a direction of ambient light is hidden; `None` if it is not searched for.
    fn hidden(
        &self,
        address: Address,
        state: &RayState,
        found: Light<'_>,
        offset: u32,
    ) -> Result<Option<StageResult>, Mismatch> {
        let is_hidden = found.bits() & (1 << offset) != 0;
        let index = found.first + offset;
        let candidates = &self.checker.candidates;
        let is_searched = index < found.count
            && (found.kind.is_ambient || self.kernel(address, state, &mut Choices::default()).casts_shadow(index));
        let legal = if is_searched {
            self.outcomes(address, state, Obstacle::or, |kernel| match found.kind.is_ambient {
                false => kernel.is_light_hidden(candidates, index),
                true => kernel.is_direction_hidden(candidates, index),
            })
        } else {
            Some(Obstacle::NEVER)
        };
        let Some(Obstacle { may, must, doubts }) = legal else {
            return Ok(Some(StageOutcome::Undecided.into()));
        };
        let answer = match (is_hidden, may, must) {
            (true, false, _) if !is_searched => "hidden, but it is not searched for",
            (true, false, _) => "hidden, but nothing is in between",
            (false, _, true) => "visible, but something is in between",
            _ if !is_searched => return Ok(None),
            _ => return Ok(Some(searched(may && !must, || doubts.alternatives()))),
        };
        let words = format!("{} {index} is {answer}", found.kind.one);
        Err(Judge::default().fail((found.kind.searches, "what is hidden"), words))
    }

    /// The union of a kernel's outcomes for all combinations of its open decisions; `None` if there are too many.
    pub(crate) fn outcomes<T>(
        &self,
        address: Address,
        state: &RayState,
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
    fn added(&self, address: Address, state: &RayState, found: Light<'_>) -> Result<StageResult, Mismatch> {
        let total = self.outcomes(address, state, Number::union, |kernel| kernel.light_to_catch());
        let sum = total.and_then(|total| self.sum(address, state, found, total));
        let Some(sum) = sum else { return Ok(StageOutcome::Undecided.into()) };
        let Kind { sums: stage, radiance, opacity, .. } = *found.kind;
        let mut judge = Judge::default();
        let before = state.raw.vector(slot::RADIANCE);
        let [r, g, b, found_opacity] = found.light.radiance[found.index].map(f32::from_bits);
        let size = before.into_iter().fold(0.0, |size: f64, c| size.max(f64::from(c.abs())));
        let legal = state.vector(slot::RADIANCE) + sum.radiance;
        judge.vector_of((stage, radiance), [r, g, b], legal, size)?;
        let alpha = state.number(slot::RADIANCE) + sum.opacity;
        judge.number((stage, opacity), found_opacity, alpha)?;
        judge.bits((stage, "the bits that are left"), found.light.left[found.index], 0)?;
        Ok(judge.into())
    }

    /// The sum of all light of a batch, given which lights are hidden. If decisions of a light are open, its part is
    /// everything between the outcomes.
    fn sum(&self, address: Address, state: &RayState, found: Light<'_>, total: Number) -> Option<Change> {
        let count = found.count.saturating_sub(found.first).min(BITS);
        let bits = found.bits();
        if found.kind.is_ambient {
            let hidden = bits.count_ones();
            return self.outcomes(address, state, Change::union, |kernel| kernel.ambient_added(count, hidden, total));
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

/// The kind of lights in a [`StudioLight`].
struct Kind {
    is_ambient: bool,
    /// The word for one light or direction.
    one: &'static str,
    searches: LitStage,
    sums: LitStage,
    radiance: &'static str,
    opacity: &'static str,
}

const LIGHTS: Kind = Kind {
    is_ambient: false,
    one: "light",
    searches: LitStage::Shadow,
    sums: LitStage::Illuminate,
    radiance: "the radiance with these lights",
    opacity: "the opacity with these lights",
};

const AMBIENT: Kind = Kind {
    is_ambient: true,
    one: "direction",
    searches: LitStage::Ambient,
    sums: LitStage::Gather,
    radiance: "the radiance with ambient light",
    opacity: "the opacity with ambient light",
};

/// The light of a pixel from a batch.
#[derive(Clone, Copy)]
struct Light<'a> {
    kind: &'static Kind,
    /// The number of lights or directions of this kind.
    count: u32,
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

    /// Checks that a ray does not change if no surface on it is lit.
    fn unlit(&self, state: &PathState) -> Result<(), Mismatch> {
        const KEPT: Name = (LitStage::Illuminate, "a ray without a lit surface");
        let mut judge = Judge::default();
        let bits = state.bits(slot::NORMAL);
        let (hidden, left) = (self.bits(), self.light.left[self.index]);
        // Bits are set only by a search.
        if hidden != 0 {
            judge.bits(KEPT, hidden, bits)?;
        }
        judge.bits(KEPT, left, bits)?;
        let radiance = self.light.radiance[self.index].into_iter();
        radiance.zip(state.slots[slot::RADIANCE]).try_for_each(|(found, legal)| judge.bits(KEPT, found, legal))
    }
}
