//! The data with which light paths and studios are judged.

use crate::recording::lit::{LitInputs, PathState};
use crate::verify::camera::CameraModel;
use crate::verify::checker::Checker;
use crate::verify::choices::Choices;
use crate::verify::lit::certificate::Address;
use crate::verify::lit::judge::Judge;
use crate::verify::lit::kernel::{Hit, Kernel};

pub(crate) struct LitCheck<'a> {
    pub(crate) checker: &'a Checker<'a>,
    pub(crate) inputs: &'a LitInputs,
    pub(crate) model: CameraModel,
    pub(crate) is_studio: bool,
    pub(crate) is_matt: bool,
}

impl LitCheck<'_> {
    /// A kernel that reads the state of a ray. As yet it has no hit and changes nothing.
    pub(crate) fn kernel<'b>(&'b self, address: Address, state: &'b PathState, choices: &'b mut Choices) -> Kernel<'b> {
        Kernel {
            scene: self.checker.scene,
            inputs: self.inputs,
            is_matt: self.is_matt,
            address,
            before: state,
            hit: Hit::new([0; 4]),
            after: state,
            judge: Judge::default(),
            choices,
        }
    }
}
