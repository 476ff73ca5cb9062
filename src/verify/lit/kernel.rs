//! One invocation of a shading kernel, which is followed number by number: from its input to its legal output.

use super::expected::Expected;
use super::recording::{LitInputs, PathState, UploadedLighting};
use crate::scene::Scene;
use crate::verify::choices::Choices;
use crate::verify::number::Number;

/// The hit of a ray as the device recorded it.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct Hit {
    pub(in crate::verify) t: f32,
    pub(in crate::verify) id: u32,
    pub(in crate::verify) shape_index: u32,
    pub(in crate::verify) distance: f32,
}

impl Hit {
    pub(in crate::verify) fn new([t, id, shape_index, distance]: [u32; 4]) -> Self {
        Self { t: f32::from_bits(t), id, shape_index, distance: f32::from_bits(distance) }
    }
}

/// The address of a surface: pixel, sample, and index on the path.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct Address {
    pub(in crate::verify) pixel: [u32; 2],
    pub(in crate::verify) sample: u32,
    pub(in crate::verify) surface: u32,
}

/// One invocation of the kernel, for one combination of its open decisions.
pub(in crate::verify) struct Kernel<'a> {
    pub(in crate::verify) scene: &'a Scene,
    pub(in crate::verify) inputs: &'a LitInputs,
    /// Whether this is the kernel for scenes in which every material is matt or emissive.
    pub(in crate::verify) is_matt: bool,
    pub(in crate::verify) address: Address,
    pub(in crate::verify) before: &'a PathState,
    pub(in crate::verify) hit: Hit,
    pub(in crate::verify) after: &'a PathState,
    pub(in crate::verify) expected: Expected,
    pub(in crate::verify) choices: &'a mut Choices,
}

impl<'a> Kernel<'a> {
    pub(in crate::verify) fn lighting(&self) -> &'a UploadedLighting {
        &self.inputs.lighting
    }

    /// An entry of the tables; zeros beyond their end.
    pub(in crate::verify) fn table(&self, at: u32) -> [u32; 4] {
        self.inputs.tables.get(at as usize).copied().unwrap_or_default()
    }

    pub(in crate::verify) fn emitter_words(&self, at: u32) -> [u32; 4] {
        self.inputs.emitters.get(at as usize).copied().unwrap_or_default()
    }

    pub(in crate::verify) fn table_numbers(&self, at: u32) -> [f32; 4] {
        self.table(at).map(f32::from_bits)
    }
}

/// The number in [0, 1) that the upper 24 bits stand for, exactly.
pub(in crate::verify) fn unit(bits: u32) -> Number {
    Number::known(crate::camera::sampling::unit(bits))
}
