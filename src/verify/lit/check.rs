//! Shared by the checks of light paths and of studios: the camera ray of a sample, and the hits of rays.

use crate::verify::camera::CameraModel;
use crate::verify::checker::Checker;
use crate::verify::choices::Choices;
use crate::verify::hit::LegalHits;
use crate::verify::lit::certificate::{Address, LitCertificate, LitStage};
use crate::verify::lit::film::judge_start;
use crate::verify::lit::judge::{Expected, Judged, Mismatch, searched};
use crate::verify::lit::kernel::{Hit, Kernel};
use crate::verify::lit::recording::{LitInputs, PathState, RecordedSample};
use crate::verify::lit::search::{Searched, check_hit};

/// The data with which samples are judged.
pub(crate) struct LitCheck<'a> {
    pub(crate) checker: &'a Checker<'a>,
    pub(crate) inputs: &'a LitInputs,
    pub(crate) model: CameraModel,
    pub(crate) is_studio: bool,
    pub(crate) is_matt: bool,
}

impl LitCheck<'_> {
    /// Judges the state of a path at the camera, and returns it with its address.
    pub(crate) fn start(
        &self,
        recorded: &RecordedSample,
        index: usize,
        part: &mut LitCertificate,
    ) -> (Address, PathState) {
        let pixel = self.inputs.pixel(index);
        let address = Address { pixel, sample: recorded.sample, surface: 0 };
        let state = recorded.start[index];
        let started = judge_start(self.inputs, &self.model, address, &state);
        part.note(LitStage::Start, address, started);
        (address, state)
    }

    pub(crate) fn searched(&self) -> Searched<'_> {
        let Checker { scene, candidates, .. } = self.checker;
        Searched { model: &self.model, scene, candidates }
    }

    pub(crate) fn extend(
        &self,
        state: &PathState,
        last: Option<Hit>,
        hit: Hit,
        legal: &mut LegalHits,
    ) -> Result<Judged, Mismatch> {
        let mut expected = Expected::default();
        let is_open = check_hit(self.searched(), state, last, hit, &mut expected, legal)?;
        Ok(searched(is_open, || legal.alternatives()))
    }

    /// A kernel that reads the state of a ray, and as yet has no hit and changes nothing.
    pub(crate) fn kernel<'b>(
        &'b self,
        address: Address,
        state: &'b PathState,
        choices: &'b mut Choices,
    ) -> Kernel<'b> {
        Kernel {
            scene: self.checker.scene,
            inputs: self.inputs,
            is_matt: self.is_matt,
            address,
            before: state,
            hit: Hit::new([0; 4]),
            after: state,
            expected: Expected::default(),
            choices,
        }
    }
}

/// The error for a path that is alive after the last recorded surface.
pub(crate) fn unfinished(what: &str) -> Mismatch {
    let words = format!("the {what} was not followed to its end");
    Expected::default().fail(LitStage::Extend, "the hit", words)
}
