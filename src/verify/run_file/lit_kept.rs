//! What is kept of the surfaces of a sample. Of each surface, pixels are left out whose ray has ended before it and
//! whose state does not change there; they keep the state that they have. Nothing is judged of what such a ray hits.

use super::RunFileError;
use super::container::contradiction;
use crate::verify::lit::PathState;
use crate::verify::lit::recording::{flag, slot};
use crate::verify::paths::RecordedSurface;
use crate::verify::studio::{StudioLight, StudioSurface};

/// The pixels of all surfaces of a sample that are kept, surface by surface.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Kept {
    /// The number of pixels of each surface.
    pub(super) counts: Vec<u32>,
    /// Their indices in the rectangle, ascending at each surface.
    pub(super) pixels: Vec<u32>,
    pub(super) hits: Vec<[u32; 4]>,
    pub(super) states: Vec<PathState>,
    /// Along paths, the visibility of the light.
    pub(super) open: Vec<u32>,
    /// In studios, for each pixel the batches of lights, and then those of directions.
    pub(super) lights: StudioLight,
}

impl Kept {
    fn push(&mut self, pixel: usize, hit: [u32; 4], state: PathState) {
        // A rectangle has fewer than 2³² pixels.
        self.pixels.push(pixel as u32);
        self.hits.push(hit);
        self.states.push(state);
    }

    fn end_surface(&mut self) {
        let before: u32 = self.counts.iter().sum();
        self.counts.push((self.pixels.len() as u32).saturating_sub(before));
    }

    pub(super) fn of_paths(start: &[PathState], surfaces: &[RecordedSurface]) -> Self {
        let mut kept = Self::default();
        let mut states = start.to_vec();
        for surface in surfaces {
            for (pixel, state) in states.iter_mut().enumerate() {
                let (after, open) = (surface.scattered[pixel], surface.open[pixel]);
                if state.has(flag::ALIVE) || after != *state || open != after.bits(slot::PENDING) {
                    kept.push(pixel, surface.hits[pixel], after);
                    kept.open.push(open);
                }
                *state = after.with_visibility(open);
            }
            kept.end_surface();
        }
        kept
    }

    pub(super) fn of_studio(start: &[PathState], surfaces: &[StudioSurface]) -> Self {
        let mut kept = Self::default();
        let mut states = start.to_vec();
        for surface in surfaces {
            for (pixel, state) in states.iter_mut().enumerate() {
                let after = surface.shaded[pixel];
                let batches = || surface.lights.iter().chain(&surface.ambient);
                let is_kept = state.has(flag::ALIVE)
                    || after != *state
                    || batches().any(|light| !is_unlit(&after, light, pixel));
                *state = after;
                for light in batches() {
                    *state = state.with_light(light.radiance[pixel], light.left[pixel]);
                    if is_kept {
                        kept.lights.hidden.push(light.hidden[pixel]);
                        kept.lights.radiance.push(light.radiance[pixel]);
                        kept.lights.left.push(light.left[pixel]);
                    }
                }
                if is_kept {
                    kept.push(pixel, surface.hits[pixel], after);
                }
            }
            kept.end_surface();
        }
        kept
    }

    /// The pixels of each surface with their positions in the lists.
    fn surfaces(&self, pixels: usize) -> Result<Vec<std::ops::Range<usize>>, RunFileError> {
        let mut end = 0_usize;
        let surfaces = self.counts.iter().map(|count| {
            let range = end..end.saturating_add(*count as usize);
            end = range.end;
            let of = self.pixels.get(range.clone()).unwrap_or_default();
            let is_right = of.len() == range.len()
                && of.is_sorted_by(|a, b| a < b)
                && of.last().is_none_or(|last| (*last as usize) < pixels);
            let words = "the pixels of a surface are not ascending pixels of its rectangle";
            is_right.then_some(range).ok_or_else(|| contradiction(words))
        });
        let surfaces = surfaces.collect::<Result<_, _>>()?;
        let words = "a sample has pixels that belong to no surface";
        (end == self.pixels.len()).then_some(surfaces).ok_or_else(|| contradiction(words))
    }

    /// The surfaces of paths; the lists of all fields have one length.
    pub(super) fn paths(&self, start: &[PathState]) -> Result<Vec<RecordedSurface>, RunFileError> {
        let mut states = start.to_vec();
        let surfaces = self.surfaces(start.len())?.into_iter().map(|range| {
            let mut surface = RecordedSurface {
                hits: vec![[0; 4]; states.len()],
                open: states.iter().map(|state| state.bits(slot::PENDING)).collect(),
                scattered: states.clone(),
            };
            for at in range {
                let pixel = self.pixels[at] as usize;
                surface.hits[pixel] = self.hits[at];
                surface.scattered[pixel] = self.states[at];
                surface.open[pixel] = self.open[at];
            }
            for (pixel, state) in states.iter_mut().enumerate() {
                *state = surface.scattered[pixel].with_visibility(surface.open[pixel]);
            }
            surface
        });
        Ok(surfaces.collect())
    }

    /// The surfaces of a studio with these numbers of batches of lights and of directions.
    pub(super) fn studio(
        &self,
        start: &[PathState],
        [lights, directions]: [usize; 2],
    ) -> Result<Vec<StudioSurface>, RunFileError> {
        let batches = lights + directions;
        let mut states = start.to_vec();
        let surfaces = self.surfaces(start.len())?.into_iter().map(|range| {
            let unlit = StudioLight {
                hidden: vec![0; states.len()],
                radiance: states.iter().map(|state| state.slots[slot::RADIANCE]).collect(),
                left: states.iter().map(|state| state.bits(slot::NORMAL)).collect(),
            };
            let mut all = vec![unlit; batches];
            let (mut hits, mut shaded) = (vec![[0; 4]; states.len()], states.clone());
            for at in range {
                let pixel = self.pixels[at] as usize;
                (hits[pixel], shaded[pixel]) = (self.hits[at], self.states[at]);
                states[pixel] = shaded[pixel];
                for (light, of) in all.iter_mut().zip(at * batches..) {
                    light.hidden[pixel] = self.lights.hidden[of];
                    light.radiance[pixel] = self.lights.radiance[of];
                    light.left[pixel] = self.lights.left[of];
                    states[pixel] =
                        states[pixel].with_light(light.radiance[pixel], light.left[pixel]);
                }
            }
            let ambient = all.split_off(lights);
            StudioSurface { hits, shaded, lights: all, ambient }
        });
        Ok(surfaces.collect())
    }
}

/// Whether the light of a batch leaves a ray as it is. Where nothing is searched for, there are no bits.
fn is_unlit(state: &PathState, light: &StudioLight, pixel: usize) -> bool {
    let bits = state.bits(slot::NORMAL);
    (light.hidden[pixel] == 0 || light.hidden[pixel] == bits)
        && light.left[pixel] == bits
        && light.radiance[pixel] == state.slots[slot::RADIANCE]
}
