//! The data with which light paths and studios are judged.

use crate::recording::lit::LitInputs;
use crate::scene::material::{Material, SurfaceProperties};
use crate::verify::camera::CameraModel;
use crate::verify::checker::Checker;
use crate::verify::choices::Choices;
use crate::verify::lit::certificate::Address;
use crate::verify::lit::judge::Judge;
use crate::verify::lit::kernel::{Hit, Kernel, Output, RayState};

pub(crate) struct LitCheck<'a> {
    pub(crate) checker: &'a Checker<'a>,
    pub(crate) inputs: &'a LitInputs,
    pub(crate) model: CameraModel,
    pub(crate) is_studio: bool,
    pub(crate) is_matt: bool,
    /// The brightest light at the end of a path and at its surfaces, if that is needed and has a bound.
    pub(crate) brightest: Option<[[f64; 3]; 2]>,
}

impl<'a> LitCheck<'a> {
    pub(crate) fn new(checker: &'a Checker<'a>, inputs: &'a LitInputs) -> Self {
        let is_matt = |surface: &SurfaceProperties| match surface.material {
            Material::Lambert { specular, .. } => specular == 0.0,
            Material::Emissive { .. } => true,
            Material::Conductor { .. } | Material::Dielectric { .. } => false,
        };
        Self {
            checker,
            inputs,
            model: CameraModel::new(inputs.camera.kind, &inputs.uploaded, &inputs.film),
            is_studio: inputs.is_studio(),
            is_matt: checker.scene.appearance().surfaces().iter().all(is_matt),
            brightest: None,
        }
    }

    /// A kernel that reads the state of a ray. As yet it has no hit and changes nothing.
    pub(crate) fn kernel<'b>(&'b self, address: Address, state: &'b RayState, choices: &'b mut Choices) -> Kernel<'b> {
        Kernel {
            scene: self.checker.scene,
            inputs: self.inputs,
            is_matt: self.is_matt,
            address,
            before: state,
            hit: Hit::new([0; 4]).into(),
            after: Output::Recorded(&state.raw),
            judge: Judge::default(),
            choices,
        }
    }
}
