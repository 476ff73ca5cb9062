//! The check of searches: the nearest hit of a path's ray, and the occlusion of a light; and what else is legal where a
//! search is open, in words. The WGSL twins are `shaders/path/extend.wgsl`, `path/hit_before.wgsl`, `path/occlude.wgsl`
//! and `accel/excluded.wgsl`.

use glam::{DVec3, Vec4};

use crate::image::NO_ID;
use crate::scene::Scene;
use crate::verify::camera::{CameraModel, CameraRay, EnteredRay};
use crate::verify::hit::{Candidate, Candidates, LegalHit, LegalHits, legal_hit};
use crate::verify::lit::certificate::LitStage;
use crate::verify::lit::judge::{Expected, Mismatch};
use crate::verify::lit::kernel::Hit;
use crate::verify::lit::recording::{PathState, flag, slot};
use crate::verify::number::Number;
use crate::verify::recording::NO_HIT;
use crate::verify::rounding::{FLUSH, Interval, PAD, gamma};
use crate::verify::sphere::{Line, Slack};

const STAGE: LitStage = LitStage::Extend;

/// The data in which searches are made.
#[derive(Clone, Copy)]
pub(crate) struct Searched<'a> {
    pub(crate) model: &'a CameraModel,
    pub(crate) scene: &'a Scene,
    pub(crate) candidates: &'a Candidates,
}

/// A ray of a path, starting where it enters the scene's box.
struct Entry {
    entered: EnteredRay,
    line: Line,
    slack: Slack,
}

impl Entry {
    /// `distance` is the distance from the origin to the scene's box, if it was recorded.
    fn new(
        model: &CameraModel,
        origin: [f32; 3],
        direction: [f32; 3],
        distance: Option<f32>,
    ) -> Self {
        let line = Line::new(origin, direction);
        let entered = CameraRay::exact(line).entered(model, line.direction);
        let enter = match distance {
            Some(distance) => Interval::around(distance.into(), 0.0),
            None => entered.enter,
        };
        if enter.high == 0.0 {
            return Self { entered, line, slack: Slack::default() };
        }
        let middle = 0.5 * (enter.low + enter.high);
        let along = middle * line.direction;
        let rounded =
            PAD * gamma(6) * (line.origin.abs() + along.abs()) + DVec3::splat(2.0 * FLUSH);
        let across = rounded.length();
        let slack = Slack { across, along: across + enter.high - middle, direction: 0.0 };
        Self { entered, line: Line::exact(line.origin + along, line.direction), slack }
    }
}

/// Whether a sphere equals one that a ray leaves or ends on. Compared by value, because the sign of a zero does not
/// matter.
pub(crate) fn is_same([x, y, z, radius]: [f32; 4], other: [f32; 4]) -> bool {
    Vec4::new(x, y, z, radius.abs()) == Vec4::from(other)
}

fn four(state: &PathState, which: usize) -> [f32; 4] {
    state.slots[which].map(f32::from_bits)
}

/// Judges the nearest hit of a ray; returns whether several answers are legal. `last` is the previous hit of the path.
pub(crate) fn check_hit(
    Searched { model, scene, candidates }: Searched<'_>,
    state: &PathState,
    last: Option<Hit>,
    found: Hit,
    expected: &mut Expected,
    legal: &mut LegalHits,
) -> Result<bool, Mismatch> {
    let Hit { t, id, distance, .. } = found;
    let (origin, direction) = (state.vector(slot::ORIGIN), state.vector(slot::DIRECTION));
    let entry = Entry::new(model, origin, direction, (id != NO_ID).then_some(distance));
    legal.clear();
    let departure = state.departure();
    let departed = scene.spheres().get(departure.id as usize).copied();
    // The exit distance was compared when the path was scattered, and is known exactly.
    let far_side = f64::from(departure.exit_distance);
    let own = last.zip(departed).filter(|_| state.has(flag::INSIDE));
    if own.is_some() {
        legal.miss = false;
        legal.limit = far_side;
    }
    if entry.entered.may_hit_box {
        let is_departed = |sphere| departed.is_some_and(|own| is_same(sphere, own));
        legal.find_nearer(candidates, &entry.line, entry.slack, is_departed);
        legal.miss |= entry.entered.may_miss_box && own.is_none();
    }
    if let Some((Hit { id, .. }, sphere)) = own
        && far_side <= legal.limit
    {
        let (near, far) = (None, Some(Interval { low: far_side, high: far_side }));
        legal.spheres.push(LegalHit { id, near, far, sphere: sphere.map(f32::to_bits) });
    }
    let is_open = legal.count() > 1;
    let fail = |what, words| Err(expected.fail(STAGE, what, words));
    if id == NO_ID {
        if !legal.miss {
            return fail("a miss", format!("legal is {legal}"));
        }
        return if t.to_bits() == NO_HIT.to_bits() {
            Ok(is_open)
        } else {
            fail("the distance of a miss", format!("{t:?}; legal is {NO_HIT:?}"))
        };
    }
    if !legal.allows(id, t.into()) {
        return fail("the hit", format!("sphere {id} at {t:?}; legal is {legal}"));
    }
    let Interval { low, high } = entry.entered.enter;
    let enter = match own {
        Some((last, _)) if last.id == id => {
            expected.bits((STAGE, "the hit's shape index"), found.shape_index, last.shape_index)?;
            Number::ZERO
        }
        _ => Number::between(low, high),
    };
    expected.number((STAGE, "where the ray enters the scene's box"), distance, enter)?;
    Ok(is_open)
}

/// Whether a sphere may hide a light at this distance, and whether it must.
pub(crate) fn hides(hit: &LegalHit, may_miss: bool, light: Interval) -> (bool, bool) {
    (hit.lowest() < light.high, !may_miss && hit.highest() < light.low)
}

/// Judges the occlusion of a light; if both answers are legal, returns why. `sphere_of_light` is the emitter, if the
/// light is one.
pub(crate) fn check_open(
    Searched { model, scene, candidates }: Searched<'_>,
    state: &PathState,
    sphere_of_light: Option<[f32; 4]>,
    open: f32,
    expected: &mut Expected,
) -> Result<Option<Doubts>, Mismatch> {
    const OPEN: (LitStage, &str) = (LitStage::Occlude, "the visibility of the light");
    let before = state.number(slot::PENDING);
    let [x, y, z, distance] = four(state, slot::SHADOW);
    let entry = Entry::new(model, state.vector(slot::ORIGIN), [x, y, z], None);
    let Interval { low, high } = entry.entered.enter;
    let rest = (Number::recorded(distance) - Number::between(low, high)).interval();
    let (mut may_be_hidden, mut must_be_hidden) = (false, false);
    let mut doubts = Doubts::NONE;
    let departure = state.departure();
    let is_exempt = |sphere: [f32; 4]| {
        let departed = scene.spheres().get(departure.id as usize);
        let own = departed.is_some_and(|own| is_same(sphere, *own));
        own || sphere_of_light.is_some_and(|own| is_same(sphere, own))
    };
    if entry.entered.may_hit_box && rest.high > 0.0 {
        let moved = entry.slack.across + entry.slack.along;
        candidates.visit(&entry.line, moved, rest.high, |candidate| {
            if is_exempt(candidate.sphere) {
                return rest.high;
            }
            if let Some((hit, may_miss)) = legal_hit(candidate, &entry.line, entry.slack) {
                let (may, must) = hides(&hit, may_miss, rest);
                may_be_hidden |= may;
                must_be_hidden |= must;
                if may && !must {
                    doubts.add(candidate, &entry.line, may_miss);
                }
            }
            // A certain answer ends the search.
            if must_be_hidden { -1.0 } else { rest.high }
        });
    }
    must_be_hidden &= !entry.entered.may_miss_box && rest.low > 0.0;
    let is_hidden = open == 0.0;
    if (is_hidden && !may_be_hidden) || (!is_hidden && must_be_hidden) {
        let words = if is_hidden {
            "occluded, but no surface is in between"
        } else {
            "visible, but a surface is in between"
        };
        return Err(expected.fail(LitStage::Occlude, OPEN.1, words.to_owned()));
    }
    if !is_hidden {
        expected.bits(OPEN, open.to_bits(), before.to_bits())?;
    }
    Ok((may_be_hidden && !must_be_hidden).then_some(doubts))
}

/// The largest number of alternatives that are named.
const MOST: usize = 4;

impl LegalHits {
    /// The legal answers, the nearest first; of more than four, the miss and the nearest.
    pub(crate) fn alternatives(&self) -> Vec<String> {
        let mut hits: Vec<&LegalHit> = self.spheres.iter().collect();
        hits.sort_by(|a, b| a.lowest().total_cmp(&b.lowest()));
        let place = |hit: &LegalHit| {
            // Written like the f32 next to them: a device gives no others.
            let crossing = [hit.near, hit.far].into_iter().flatten().next();
            let [low, high] = crossing.map_or([0.0; 2], |at| [at.low as f32, at.high as f32]);
            match low < high {
                true => format!("sphere {} at {low:?} to {high:?}", hit.id),
                false => format!("sphere {} at {low:?}", hit.id),
            }
        };
        let nearest = hits.iter().take(MOST - usize::from(self.miss));
        let mut all: Vec<String> = nearest.map(|hit| place(hit)).collect();
        if self.miss {
            all.push("a miss".to_owned());
        }
        all
    }
}

/// The spheres that may hide a light and need not.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Doubts(Vec<String>);

impl Doubts {
    pub(crate) const NONE: Self = Self(Vec::new());

    /// Adds a sphere that the ray may miss, or else whose surface may be behind the light.
    pub(crate) fn add(
        &mut self,
        Candidate { sphere, id }: &Candidate,
        line: &Line,
        may_miss: bool,
    ) {
        if self.0.len() < MOST {
            self.0.push(match may_miss {
                true => {
                    let beside = line.beside_silhouette(*sphere);
                    format!("sphere {id}, {beside:.1e} of its radius beside its silhouette")
                }
                false => format!("sphere {id}, which ends where the search does"),
            });
        }
    }

    /// Those of both.
    pub(crate) fn and(mut self, other: Self) -> Self {
        for doubt in other.0 {
            if self.0.len() < MOST && !self.0.contains(&doubt) {
                self.0.push(doubt);
            }
        }
        self
    }

    /// What is open, in words.
    pub(crate) fn alternatives(&self) -> Vec<String> {
        match self.0.is_empty() {
            true => vec![
                "hidden or not: the surface itself, a ground, or the box of the scene".to_owned(),
            ],
            false => self.0.iter().map(|doubt| format!("hidden or not: {doubt}")).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::hit::Candidates;

    #[test]
    fn legal_hits_are_named_by_distance() {
        let ball = |z: f32, r: f32| [0.0, 0.0, z, r];
        let line = Line::new([0.0; 3], [0.0, 0.0, 1.0]);
        let named = |spheres: &[[f32; 4]]| {
            let mut legal = LegalHits::default();
            legal.find(&Candidates::new(spheres).unwrap(), &line);
            legal.alternatives()
        };
        // Two spheres that begin where a third does, and one far behind.
        let equal = [ball(9.0, 1.0), ball(10.0, 2.0), ball(8.5, 0.5), ball(20.0, 1.0)];
        let found = named(&equal);
        assert_eq!(found.len(), 3, "{found:?}");
        for (id, words) in found.iter().enumerate() {
            assert!(found.iter().any(|w| w.starts_with(&format!("sphere {id} at "))), "{found:?}");
            let ends = words.split(" at ").nth(1).unwrap().split(" to ");
            let ends: Vec<f32> = ends.map(|end| end.parse().unwrap()).collect();
            // All surfaces are there, and the bounds of the sphere test are some 2⁻¹⁹ of the distance to centres.
            assert!(ends[0] <= 8.0 && 8.0 <= ends[1] && ends[1] - ends[0] < 1e-4, "{found:?}");
        }
        // The ray touches a sphere, so that it may miss it.
        let first_words = |spheres: &[[f32; 4]]| -> Vec<String> {
            let named = named(spheres).into_iter();
            named.map(|words| words.split(" at ").next().unwrap().to_owned()).collect()
        };
        let touched = [1.0, 0.0, 5.0, 1.0];
        assert_eq!(first_words(&[touched, ball(9.0, 1.0)]), ["sphere 0", "sphere 1"]);
        assert_eq!(first_words(&[ball(9.0, 1.0), touched]), ["sphere 1", "sphere 0"]);
        assert_eq!(first_words(&[touched]), ["sphere 0", "a miss"]);
        assert_eq!(named(&[]), ["a miss"]);
        // Of many, four are named, and the miss is one of them.
        let many: Vec<_> = (1..9).map(|i| [1.0, 0.0, i as f32, 1.0]).collect();
        assert_eq!(first_words(&many), ["sphere 0", "sphere 1", "sphere 2", "a miss"]);
    }

    #[test]
    fn doubts_say_how_near_a_silhouette_is() {
        let line = Line::new([0.0; 3], [0.0, 0.0, 1.0]);
        let touched = Candidate { sphere: [2.0, 0.0, 5.0, 2.0 + 1e-6], id: 77 };
        let mut doubts = Doubts::NONE;
        doubts.add(&touched, &line, true);
        doubts.add(&Candidate { id: 5, ..touched }, &line, false);
        let words = [
            "hidden or not: sphere 77, 4.8e-7 of its radius beside its silhouette",
            "hidden or not: sphere 5, which ends where the search does",
        ];
        assert_eq!(doubts.alternatives(), words);
        // The same doubt counts once, and not more than four do.
        assert_eq!(doubts.clone().and(doubts.clone()), doubts);
        let mut others = Doubts::NONE;
        (0..9).for_each(|id| others.add(&Candidate { id, ..touched }, &line, false));
        assert_eq!(others.alternatives().len(), 4);
        assert_eq!(doubts.and(others).alternatives().len(), 4);
        assert_eq!(Doubts::NONE.alternatives().len(), 1);
    }
}
