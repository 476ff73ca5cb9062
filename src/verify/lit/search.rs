//! The check of searches: the nearest hit of a path's ray, and the occlusion of a light. It also names the other legal
//! answers of an open search. The WGSL twins are `shaders/path/extend.wgsl`, `path/hit_before.wgsl`,
//! `path/occlude.wgsl` and `accel/excluded.wgsl`.

use glam::{DVec3, Vec4};

use crate::image::NO_ID;
use crate::recording::NO_HIT;
use crate::recording::lit::{Departure, NO_EMITTER, PathState, flag, slot};
use crate::verify::camera::{CameraModel, CameraRay, EnteredRay};
use crate::verify::checker::Checker;
use crate::verify::hit::{Candidates, LegalHit, LegalHits, key_of_sphere, legal_hit};
use crate::verify::lit::certificate::LitStage;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::judge::{Judge, Mismatch, Name, StageResult, searched};
use crate::verify::lit::kernel::Hit;
use crate::verify::number::Number;
use crate::verify::rounding::{FLUSH, Interval, PAD, gamma};
use crate::verify::sphere::{Line, Slack};
use crate::verify::tree::Candidate;

const STAGE: LitStage = LitStage::Extend;

/// A ray that starts where it enters a box of spheres.
pub(crate) struct Entry {
    pub(crate) line: Line,
    pub(crate) slack: Slack,
    /// The distance at which the ray enters the box.
    pub(crate) enter: Interval,
    /// Whether the device may find that the ray hits the box, and whether it may find that it does not.
    pub(crate) may_hit_box: bool,
    pub(crate) may_miss_box: bool,
}

impl Entry {
    /// A ray of a path. `distance` is the distance from the origin to the scene's box, if it was recorded.
    fn new(model: &CameraModel, origin: [f32; 3], direction: [f32; 3], distance: Option<f32>) -> Self {
        let mut line = Line::new(origin, direction);
        let EnteredRay { enter, may_hit_box, may_miss_box, .. } = CameraRay::exact(line).entered(model, line.direction);
        let mut slack = Slack::default();
        let from = distance.map_or(enter, |distance| Interval::around(distance.into(), 0.0));
        if from.high != 0.0 {
            let middle = 0.5 * (from.low + from.high);
            let along = middle * line.direction;
            let rounded = PAD * gamma(6) * (line.origin.abs() + along.abs()) + DVec3::splat(2.0 * FLUSH);
            let across = rounded.length();
            slack = Slack { across, along: across + from.high - middle, direction: 0.0 };
            line = Line::exact(line.origin + along, line.direction);
        }
        Self { line, slack, enter, may_hit_box, may_miss_box }
    }

    /// Finds the legal hits of a ray that leaves a sphere. If it goes through the inside, `own` is the sphere's id and the
    /// distance to its far side.
    pub(crate) fn find(
        &self,
        candidates: &Candidates,
        departed: Option<[f32; 4]>,
        own: Option<(u32, Interval)>,
        legal: &mut LegalHits,
    ) {
        legal.clear();
        if let Some((_, far_side)) = own {
            (legal.miss, legal.limit) = (false, far_side.high);
        }
        if self.may_hit_box {
            let is_departed = |sphere| departed.is_some_and(|own| is_same(sphere, own));
            legal.find_nearer(candidates, &self.line, self.slack, is_departed);
            legal.miss |= self.may_miss_box && own.is_none();
        }
        if let (Some((id, far_side)), Some(sphere)) = (own, departed)
            && far_side.low <= legal.limit
        {
            legal.spheres.push(LegalHit { id, near: None, far: Some(far_side), key: key_of_sphere(sphere) });
        }
    }

    /// Whether spheres hide a light at a distance from the ray's origin.
    pub(crate) fn hidden(
        &self,
        candidates: &Candidates,
        distance: Number,
        is_exempt: impl Fn(&Candidate<[f32; 4]>) -> bool,
    ) -> Obstacle {
        let Self { line, slack, enter, may_hit_box, may_miss_box } = self;
        let rest = (distance - Number::between(enter.low, enter.high)).interval();
        let mut found = Obstacle::NEVER;
        if !may_hit_box || rest.high <= 0.0 {
            return found;
        }
        candidates.spheres.visit(line, slack.across + slack.along, rest.high, |candidate| {
            if is_exempt(candidate) {
                return rest.high;
            }
            if let Some((hit, may_miss)) = legal_hit(candidate, line, *slack) {
                let may = hit.lowest() < rest.high;
                let must = !may_miss && hit.highest() < rest.low;
                found.may |= may;
                found.must |= must;
                if may && !must {
                    found.doubts.add(candidate, line, may_miss);
                }
            }
            // A certain answer ends the search.
            if found.must { -1.0 } else { rest.high }
        });
        found.must &= !may_miss_box && rest.low > 0.0;
        found
    }
}

/// Whether an obstacle may hide the light, and whether one must.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Obstacle {
    pub(crate) may: bool,
    pub(crate) must: bool,
    /// The spheres that may hide the light but need not.
    pub(crate) doubts: Doubts,
}

impl Obstacle {
    pub(crate) const NEVER: Self = Self { may: false, must: false, doubts: Doubts::NONE };
    pub(crate) const ALWAYS: Self = Self { may: true, must: true, doubts: Doubts::NONE };

    /// The answer to one of two questions, if it is not known which one is asked.
    pub(crate) fn or(self, other: Self) -> Self {
        Self { may: self.may || other.may, must: self.must && other.must, doubts: self.doubts.and(other.doubts) }
    }
}

/// Whether a sphere equals the sphere that a ray leaves or ends on. They are compared by value, because
/// the sign of a zero does not matter.
pub(crate) fn is_same([x, y, z, radius]: [f32; 4], other: [f32; 4]) -> bool {
    Vec4::new(x, y, z, radius.abs()) == Vec4::from(other)
}

/// Judges the nearest hit of a ray. `last` is the previous hit of the path.
pub(crate) fn check_hit(
    LitCheck { checker: Checker { scene, candidates }, model, .. }: &LitCheck<'_>,
    state: &PathState,
    last: Option<Hit>,
    found: Hit,
    legal: &mut LegalHits,
) -> Result<StageResult, Mismatch> {
    let mut judge = Judge::default();
    let Hit { t, id, distance, .. } = found;
    let (origin, direction) = (state.vector(slot::ORIGIN), state.vector(slot::DIRECTION));
    let entry = Entry::new(model, origin, direction, (id != NO_ID).then_some(distance));
    let departure = state.departure();
    let departed = scene.spheres().get(departure.id as usize).copied();
    // The exit distance was compared when the path was scattered, and is known exactly.
    let far_side = f64::from(departure.exit_distance);
    let own = last.filter(|_| departed.is_some() && state.has(flag::INSIDE));
    let far_side = Interval { low: far_side, high: far_side };
    entry.find(candidates, departed, own.map(|last| (last.id, far_side)), legal);
    let is_open = legal.count() > 1;
    let fail = |what, words: String| Err(judge.fail((STAGE, what), words));
    if id == NO_ID {
        if !legal.miss {
            return fail("a miss", format!("legal is {legal}"));
        }
        return if t.to_bits() == NO_HIT.to_bits() {
            Ok(searched(is_open, || legal.alternatives()))
        } else {
            fail("the distance of a miss", format!("{t:?}; legal is {NO_HIT:?}"))
        };
    }
    if !legal.allows(id, t.into()) {
        return fail("the hit", format!("sphere {id} at {t:?}; legal is {legal}"));
    }
    let Interval { low, high } = entry.enter;
    let enter = match own {
        Some(last) if last.id == id => {
            judge.bits((STAGE, "the hit's shape index"), found.shape_index, last.shape_index)?;
            Number::ZERO
        }
        _ => Number::between(low, high),
    };
    judge.number((STAGE, "where the ray enters the scene's box"), distance, enter)?;
    Ok(searched(is_open, || legal.alternatives()))
}

/// Whether spheres hide the sampled light of a path, other than the sphere that it leaves and the one that shines.
pub(crate) fn hidden_from_path(
    LitCheck { checker: Checker { scene, candidates }, inputs, .. }: &LitCheck<'_>,
    state: &PathState,
    entry: &Entry,
    distance: Number,
) -> Obstacle {
    let Departure { id, emitter, .. } = state.departure();
    let departed = scene.spheres().get(id as usize).copied();
    let sphere_of_light = (emitter != NO_EMITTER)
        .then(|| inputs.emitters.get((emitter as usize).saturating_mul(3)))
        .flatten()
        .map(|sphere| sphere.map(f32::from_bits));
    let exempt = [departed, sphere_of_light];
    entry
        .hidden(candidates, distance, |candidate| exempt.into_iter().flatten().any(|own| is_same(candidate.shape, own)))
}

pub(crate) const OPEN: Name = (LitStage::Occlude, "the visibility of the light");

/// Judges the occlusion of a light.
pub(crate) fn check_open(check: &LitCheck<'_>, state: &PathState, open: f32) -> Result<StageResult, Mismatch> {
    let mut judge = Judge::default();
    let before = state.number(slot::PENDING);
    let [x, y, z, distance] = state.slots[slot::SHADOW].map(f32::from_bits);
    let entry = Entry::new(&check.model, state.vector(slot::ORIGIN), [x, y, z], None);
    let hidden = hidden_from_path(check, state, &entry, Number::recorded(distance));
    let is_hidden = open == 0.0;
    if (is_hidden && !hidden.may) || (!is_hidden && hidden.must) {
        let words =
            if is_hidden { "occluded, but no surface is in between" } else { "visible, but a surface is in between" };
        return Err(judge.fail(OPEN, words));
    }
    if !is_hidden {
        judge.bits(OPEN, open.to_bits(), before.to_bits())?;
    }
    Ok(searched(hidden.may && !hidden.must, || hidden.doubts.alternatives()))
}

/// The largest number of alternatives that are named.
const MOST: usize = 4;

impl LegalHits {
    /// The legal answers, the nearest first. If there are more than four, the miss and the nearest.
    pub(crate) fn alternatives(&self) -> Vec<String> {
        let mut hits: Vec<&LegalHit> = self.spheres.iter().collect();
        hits.sort_by(|a, b| a.lowest().total_cmp(&b.lowest()));
        let place = |hit: &LegalHit| {
            // Written like the f32 beside them, because a device gives only f32.
            let [low, high] = hit.crossings().next().map_or([0.0; 2], |at| [at.low as f32, at.high as f32]);
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

/// The spheres that may hide a light but need not.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Doubts(Vec<String>);

impl Doubts {
    pub(crate) const NONE: Self = Self(Vec::new());

    /// Adds a sphere that the ray may miss, or else whose surface may be behind the light.
    pub(crate) fn add(&mut self, Candidate { shape: sphere, id }: &Candidate<[f32; 4]>, line: &Line, may_miss: bool) {
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

    /// The doubts of both.
    pub(crate) fn and(mut self, other: Self) -> Self {
        for doubt in other.0 {
            if self.0.len() < MOST && !self.0.contains(&doubt) {
                self.0.push(doubt);
            }
        }
        self
    }

    /// The legal answers, in words.
    pub(crate) fn alternatives(&self) -> Vec<String> {
        match self.0.is_empty() {
            true => vec!["hidden or not: the surface itself, a ground, or the box of the scene".to_owned()],
            false => self.0.iter().map(|doubt| format!("hidden or not: {doubt}")).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legal_hits_are_named_by_distance() {
        let ball = |z: f32, r: f32| [0.0, 0.0, z, r];
        let line = Line::new([0.0; 3], [0.0, 0.0, 1.0]);
        let named = |spheres: &[[f32; 4]]| {
            let mut legal = LegalHits::default();
            legal.find(&Candidates::new(spheres, &[]).unwrap(), &line);
            legal.alternatives()
        };
        // Two spheres that begin where a third begins, and one far behind.
        let equal = [ball(9.0, 1.0), ball(10.0, 2.0), ball(8.5, 0.5), ball(20.0, 1.0)];
        let found = named(&equal);
        assert_eq!(found.len(), 3, "{found:?}");
        for (id, words) in found.iter().enumerate() {
            assert!(found.iter().any(|w| w.starts_with(&format!("sphere {id} at "))), "{found:?}");
            let ends = words.split(" at ").nth(1).unwrap().split(" to ");
            let ends: Vec<f32> = ends.map(|end| end.parse().unwrap()).collect();
            // All intervals contain the surface, and their bounds are some 2⁻¹⁹ of the distance to centres.
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
        // If there are many answers, four are named, and the miss is one of them.
        let many: Vec<_> = (1..9).map(|i| [1.0, 0.0, i as f32, 1.0]).collect();
        assert_eq!(first_words(&many), ["sphere 0", "sphere 1", "sphere 2", "a miss"]);
    }

    #[test]
    fn doubts_say_how_near_a_silhouette_is() {
        let line = Line::new([0.0; 3], [0.0, 0.0, 1.0]);
        let touched = Candidate { shape: [2.0, 0.0, 5.0, 2.0 + 1e-6], id: 77 };
        let mut doubts = Doubts::NONE;
        doubts.add(&touched, &line, true);
        doubts.add(&Candidate { id: 5, ..touched }, &line, false);
        let words = [
            "hidden or not: sphere 77, 4.8e-7 of its radius beside its silhouette",
            "hidden or not: sphere 5, which ends where the search does",
        ];
        assert_eq!(doubts.alternatives(), words);
        // The same doubt counts once, and at most four doubts are kept.
        assert_eq!(doubts.clone().and(doubts.clone()), doubts);
        let mut others = Doubts::NONE;
        (0..9).for_each(|id| others.add(&Candidate { id, ..touched }, &line, false));
        assert_eq!(others.alternatives().len(), 4);
        assert_eq!(doubts.and(others).alternatives().len(), 4);
        assert_eq!(Doubts::NONE.alternatives().len(), 1);
    }
}
