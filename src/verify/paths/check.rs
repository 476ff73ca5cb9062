//! The check of all stages of all paths of a recording.

use super::kernel::radiance_so_far;
use super::recording::{PathRecording, RecordedSample};
use crate::scene::material::{Material, SurfaceProperties};
use crate::verify::camera::CameraModel;
use crate::verify::checker::Checker;
use crate::verify::hit::LegalHits;
use crate::verify::lit::certificate::LitCertificate;
use crate::verify::lit::expected::{Expected, Mismatch};
use crate::verify::lit::film;
use crate::verify::lit::judge::{Judged, along_choices, judge_pixels, searched, unchanged};
use crate::verify::lit::kernel::{Address, Hit, Kernel};
use crate::verify::lit::recording::{LitInputs, NO_EMITTER, PathState, flag, slot};
use crate::verify::lit::search::{self, Searched};
use crate::verify::lit::stage::LitStage;
use crate::verify::lit::{start, upload};

const ENDED: (LitStage, &str) = (LitStage::Scatter, "a path that has ended");

/// The data with which paths are judged.
struct PathCheck<'a> {
    checker: &'a Checker<'a>,
    inputs: &'a LitInputs,
    model: CameraModel,
    is_matt: bool,
}

impl Checker<'_> {
    /// Judges every stage of every path. The recording must be of the scene of this checker.
    #[must_use]
    pub fn certify_paths(&self, recording: &PathRecording) -> LitCertificate {
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
        let check = PathCheck {
            checker: self,
            inputs: given,
            model: CameraModel::new(given.camera.kind, &given.uploaded, &given.film),
            is_matt: self.scene.appearance().surfaces().iter().all(is_matt),
        };
        for sample in &recording.samples {
            certificate.join(judge_pixels(sample.start.len(), |index, part, legal| {
                check.judge_path(sample, index, part, legal);
            }));
        }
        certificate
    }
}

impl PathCheck<'_> {
    fn judge_path(
        &self,
        recorded: &RecordedSample,
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
            let after = stage.scattered[index];
            if state.has(flag::ALIVE) {
                let hit = Hit::new(stage.hits[index]);
                part.note(LitStage::Extend, address, self.extend(&state, last, hit, legal));
                part.note(LitStage::Scatter, address, self.scatter(address, &state, hit, &after));
                last = Some(hit);
            } else if let Err(mismatch) = unchanged(ENDED, [&state, &after]) {
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
                let fail = Expected::default().fail(
                    LitStage::Occlude,
                    "the visibility of the light",
                    words,
                );
                part.note(LitStage::Occlude, address, Err(fail));
            }
            state = after.with_visibility(stage.open[index]);
        }
        if state.has(flag::ALIVE) {
            let words = "the path was not followed to its end".to_owned();
            let fail = Expected::default().fail(LitStage::Extend, "the hit", words);
            part.note(LitStage::Extend, address, Err(fail));
        }
        part.note(
            LitStage::Accumulate,
            address,
            film::check(radiance_so_far(&state), &state, &recorded.film, index),
        );
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
    ) -> Result<Judged, Mismatch> {
        let mut expected = Expected::default();
        let is_open = search::check_hit(self.searched(), state, last, hit, &mut expected, legal)?;
        Ok(searched(is_open, || legal.alternatives()))
    }

    fn scatter(
        &self,
        address: Address,
        before: &PathState,
        hit: Hit,
        after: &PathState,
    ) -> Result<Judged, Mismatch> {
        along_choices(|choices| {
            let mut kernel = Kernel {
                scene: self.checker.scene,
                inputs: self.inputs,
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

    fn occlude(&self, state: &PathState, open: f32) -> Result<Judged, Mismatch> {
        let mut expected = Expected::default();
        let LitInputs { emitters, .. } = self.inputs;
        let emitter = state.departure().emitter;
        let sphere_of_light = (emitter != NO_EMITTER)
            .then(|| emitters.get((emitter as usize).saturating_mul(3)))
            .flatten()
            .map(|sphere| sphere.map(f32::from_bits));
        let doubts =
            search::check_open(self.searched(), state, sphere_of_light, open, &mut expected)?;
        Ok(searched(doubts.is_some(), || doubts.unwrap_or_default().alternatives()))
    }
}
