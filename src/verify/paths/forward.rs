//! All light that a conforming device may find along a path. Where bounds grow so wide that nothing more can be said, the
//! rest of the path may bring any light up to a bound.

use crate::light::codes::lamp::{DIRECTIONAL, HEAD, SPHERE};
use crate::light::codes::sampling::{CHANCE, MULTIPLE};
use crate::recording::lit::{UploadedLighting, flag, slot};
use crate::scene::material::Material;
use crate::verify::lit::certificate::Address;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::forward::LegalSample;
use crate::verify::lit::kernel::{Kernel, RayHit, RayState};
use crate::verify::lit::search::{Entry, hidden_from_path};
use crate::verify::number::{Number, Vector};
use crate::verify::paths::kernel::radiance_so_far;
use crate::verify::studio::light::Change;

/// The most surfaces that are followed for a sample, along all branches.
const MOST_SURFACES: u32 = 60;

/// The most combinations of decisions at these surfaces.
const MOST_COMBINATIONS: u32 = 4 * MOST_SURFACES + 1;

/// Light that has no bound.
const ANY_LIGHT: f64 = 1e30;

impl LitCheck<'_> {
    /// The light of a path that arrives at a hit, or at nothing. `surfaces` counts the surfaces of the sample so far.
    pub(crate) fn legal_vertex(
        &self,
        address: Address,
        state: &RayState,
        hit: RayHit,
        surfaces: &mut u32,
    ) -> Option<LegalSample> {
        let follow = |kernel: &mut Kernel<'_>| kernel.follow();
        let rest = |(), after, surfaces: &mut u32| Some(self.legal_rest(address, after, surfaces));
        self.legal_outcomes((address, state, hit), (surfaces, MOST_COMBINATIONS), follow, rest)
    }

    /// The light of a path that has left a surface.
    fn legal_rest(&self, address: Address, mut after: RayState, surfaces: &mut u32) -> LegalSample {
        let is_searched = address.surface < self.inputs.max_surfaces && !after.number(slot::PENDING).is_zero();
        if is_searched {
            self.let_light_in(&mut after);
        }
        let so_far = LegalSample {
            light: Change { radiance: radiance_so_far(&after), opacity: after.number(slot::RADIANCE) },
            first: after.vector(slot::FIRST),
        };
        if !after.has(flag::ALIVE) {
            return so_far;
        }
        let next = Address { surface: address.surface + 1, ..address };
        let mut all = None;
        for hit in self.next_hits(&after).unwrap_or_default() {
            let found = if *surfaces < MOST_SURFACES { self.legal_vertex(next, &after, hit, surfaces) } else { None };
            let Some(found) = found else {
                all = None;
                break;
            };
            found.join(&mut all);
        }
        all.unwrap_or_else(|| {
            let rest = after.vector(slot::THROUGHPUT).times(self.most_light(next.surface, &after));
            let light = Change {
                radiance: so_far.light.radiance
                    + rest.map(|c| c.min(Number::known(ANY_LIGHT)) * Number::between(0.0, 1.0)),
                opacity: so_far.light.opacity.union(Number::ONE),
            };
            // The color of the first surface may still be found behind translucent ones.
            let is_known = after.number(slot::FIRST).interval().high < 0.0;
            let first = if is_known { so_far.first } else { Vector([Number::between(0.0, 1.0); 3]) };
            LegalSample { light, first }
        })
    }

    /// Searches for what hides the sampled light.
    fn let_light_in(&self, after: &mut RayState) {
        let (mut may, mut must) = (true, false);
        if let Some(entry) = Entry::aimed(self.corners(), after.vector(slot::ORIGIN), after.vector(slot::SHADOW)) {
            let hidden = hidden_from_path(self, &after.raw, &entry, after.number(slot::SHADOW));
            (may, must) = (hidden.may, hidden.must);
        }
        if may {
            let open = if must { Number::ZERO } else { after.number(slot::PENDING) * Number::between(0.0, 1.0) };
            after.set([slot::PENDING, 3], open);
        }
    }

    /// The most light that can arrive along a path that carries all of it.
    fn most_light(&self, surface: u32, state: &RayState) -> Vector {
        let lighting = &self.inputs.lighting;
        let any = Vector([Number::known(ANY_LIGHT); 3]);
        let Some([end, at_surface]) = self.brightest else { return any };
        let left = f64::from((1 + self.inputs.max_surfaces).saturating_sub(surface));
        let most = [0, 1, 2].map(|channel| end[channel] + left * at_surface[channel]);
        if self.inputs.max_surfaces < lighting.roulette_from {
            return Vector(most.map(Number::known));
        }
        // Where paths end at random, the others carry up to as much as one that carries all, and a little more.
        let through = state.vector(slot::THROUGHPUT).intervals().map(|c| c.high);
        let carried = through.into_iter().fold(1.0, f64::max) * 0.95_f64.powf(-left - 1.0);
        let lifted = [0, 1, 2].map(|channel| most[channel] * carried / through[channel].max(f64::MIN_POSITIVE));
        Vector(lifted.map(|c| Number::known(c.min(ANY_LIGHT))))
    }

    /// The most light that can arrive at the end of a path, and at each surface before it, if everything is matt and
    /// nothing reflects more than arrives. `None` if there is no such bound.
    pub(crate) fn most_light_of_paths(&self) -> Option<[[f64; 3]; 2]> {
        if self.is_studio || !self.is_matt {
            return None;
        }
        let inputs = self.inputs;
        let lighting @ UploadedLighting { light_count, source_count, .. } = &inputs.lighting;
        let scene = self.checker.scene;
        let table = |at: u32| inputs.tables.get(at as usize).copied().unwrap_or_default();
        let numbers = |at: u32| table(at).map(|bits| f64::from(f32::from_bits(bits)));
        let larger = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|channel| a[channel].max(b[channel]));
        let plus = |a: [f64; 3], b: [f64; 3], factor: f64| [0, 1, 2].map(|channel| a[channel] + factor * b[channel]);
        let sources = f64::from((*source_count).max(1));
        let white = |color: [f32; 3]| color.iter().all(|c| *c <= 1.0);
        let mut end = match &inputs.sky {
            None => [lighting.zenith, lighting.horizon, lighting.nadir]
                .map(|c| c.map(f64::from))
                .into_iter()
                .fold([0.0; 3], larger),
            Some(sky) => {
                let strength = f64::from(lighting.environment_strength);
                let brightest = sky.texels.iter().fold([0.0; 3], |most, texel| larger(most, texel.map(f64::from)));
                brightest.map(|c| c * strength)
            }
        };
        end = larger(end, lighting.background.map(f64::from));
        let mut sampled = [0.0; 3];
        // A density of the sky's image may be small where light is faint, so that samples have no simple bound.
        if inputs.sky.is_some() && lighting.light_sampling != CHANCE {
            return None;
        }
        let mut always = [0.0; 3];
        for light in 0..*light_count {
            let [r, g, b, size] = numbers(3 * light + 1);
            let strength = [r, g, b];
            match table(3 * light)[3] {
                HEAD => always = plus(always, strength, 1.0),
                DIRECTIONAL => {
                    sampled = larger(sampled, strength.map(|c| 2.0 * c * sources));
                    // Behind a translucent surface, the whole light of a sun counts that is hit by chance.
                    let is_whole = lighting.light_sampling == CHANCE || !scene.is_opaque();
                    match lighting.light_sampling {
                        _ if is_whole && size > 0.0 => return None,
                        MULTIPLE => end = plus(end, strength, 2.0 * sources),
                        _ => {}
                    }
                }
                SPHERE => sampled = larger(sampled, strength.map(|c| 4.0 * c * sources)),
                _ => return None,
            }
        }
        for emitter in inputs.emitters.chunks_exact(3) {
            let probability = f64::from(f32::from_bits(emitter[1][2]));
            let radiance = [0, 1, 2].map(|channel| f64::from(f32::from_bits(emitter[2][channel])));
            sampled = larger(sampled, radiance.map(|c| 2.0 * c * sources / probability.max(f64::MIN_POSITIVE)));
        }
        let mut own = [0.0; 3];
        for id in 0..scene.shape_count() as u32 {
            let color = scene.color(id).to_array();
            match scene.surface(id).material {
                Material::Emissive { strength } => {
                    own = larger(own, color.map(|c| f64::from(c) * f64::from(strength)));
                }
                _ if !white(color) => return None,
                _ => {}
            }
        }
        let is_white_ground = lighting.flags & flag::GROUND == 0 || white(lighting.ground_color);
        let aside = 1.0 + 1e-3;
        let end = larger(end, own).map(|c| c * aside);
        let at_surface = plus(sampled, always, 1.0).map(|c| c * aside);
        is_white_ground.then_some([end, at_surface])
    }
}
