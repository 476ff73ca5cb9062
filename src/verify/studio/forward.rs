//! All light that a conforming device may find at the surfaces of a studio that a ray passes.

use crate::recording::lit::{flag, slot};
use crate::verify::choices::Choices;
use crate::verify::lit::certificate::Address;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::forward::LegalSample;
use crate::verify::lit::kernel::{Kernel, RayHit, RayState};
use crate::verify::lit::search::Obstacle;
use crate::verify::number::Number;
use crate::verify::studio::light::Change;
use crate::verify::studio::surface::HitKind;

/// The most surfaces that are followed for a sample, along all branches.
const MOST_SURFACES: u32 = 400;

impl LitCheck<'_> {
    /// The light of a surface that is hit, or of the ground or the background, and of what is seen through it. `surfaces`
    /// counts the surfaces of the sample so far.
    pub(crate) fn legal_surface(
        &self,
        address: Address,
        state: &RayState,
        hit: RayHit,
        surfaces: &mut u32,
    ) -> Option<LegalSample> {
        let is_last = address.surface + 1 >= self.inputs.max_surfaces;
        let rest = |met, after: RayState, surfaces: &mut u32| {
            let own = Change { radiance: after.vector(slot::RADIANCE), opacity: after.number(slot::RADIANCE) };
            let lit = match met {
                HitKind::Surface => own.plus(self.legal_lights(address, &after)?),
                HitKind::Nothing | HitKind::Emitter => own,
            };
            match after.has(flag::ALIVE) {
                true => self.legal_behind(address, after, lit, surfaces),
                false => Some(LegalSample { light: lit, first: after.vector(slot::FIRST) }),
            }
        };
        let follow = |kernel: &mut Kernel<'_>| kernel.follow_surface(is_last);
        self.legal_outcomes((address, state, hit), (surfaces, MOST_SURFACES), follow, rest)
    }

    /// The light of all surfaces behind one that has this light so far.
    fn legal_behind(
        &self,
        address: Address,
        mut state: RayState,
        lit: Change,
        surfaces: &mut u32,
    ) -> Option<LegalSample> {
        (0..3).for_each(|channel| state.set([slot::RADIANCE, channel], lit.radiance.0[channel]));
        state.set([slot::RADIANCE, 3], lit.opacity);
        let next = Address { surface: address.surface + 1, ..address };
        let mut all = None;
        for hit in self.next_hits(&state)? {
            self.legal_surface(next, &state, hit, surfaces)?.join(&mut all);
        }
        all
    }

    /// The light that lamps and ambient light add to a surface.
    fn legal_lights(&self, address: Address, after: &RayState) -> Option<Change> {
        let candidates = &self.checker.candidates;
        let lighting = &self.inputs.lighting;
        let total = self.outcomes(address, after, Number::union, |kernel| kernel.light_to_catch())?;
        let mut sum = Change::NONE;
        for light in 0..lighting.light_count {
            let hidden = match self.kernel(address, after, &mut Choices::default()).casts_shadow(light) {
                true => {
                    self.outcomes(address, after, Obstacle::or, |kernel| kernel.is_light_hidden(candidates, light))?
                }
                false => Obstacle::NEVER,
            };
            let added = |is_hidden: bool| {
                self.outcomes(address, after, Change::union, |kernel| kernel.light_added(light, is_hidden, total))
            };
            sum = sum.plus(match (hidden.may, hidden.must) {
                (false, _) => added(false)?,
                (true, true) => added(true)?,
                (true, false) => added(false)?.union(added(true)?),
            });
        }
        let (mut least, mut most) = (0, 0);
        for index in 0..lighting.occlusion_samples {
            let search = |kernel: &mut Kernel<'_>| kernel.is_direction_hidden(candidates, index);
            let hidden = self.outcomes(address, after, Obstacle::or, search)?;
            most += u32::from(hidden.may);
            least += u32::from(hidden.may && hidden.must);
        }
        let gathered = (least..=most).map(|hidden| {
            let count = lighting.occlusion_samples;
            self.outcomes(address, after, Change::union, |kernel| kernel.ambient_added(count, hidden, total))
        });
        let gathered = gathered.reduce(|one, other| Some(one?.union(other?)))??;
        Some(if lighting.occlusion_samples == 0 { sum } else { sum.plus(gathered) })
    }
}
