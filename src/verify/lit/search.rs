//! The check of searches: the nearest hit of a path's ray, and the occlusion of a light. It also names the other legal
//! answers of an open search. The WGSL twins are `shaders/path/extend.wgsl`, `path/hit_before.wgsl`,
//! `path/occlude.wgsl` and `accel/excluded.wgsl`.

use glam::{DVec3, Vec4};

use crate::image::NO_ID;
use crate::recording::NO_HIT;
use crate::recording::lit::{Departure, NO_EMITTER, PathState, flag, slot};
use crate::scene::Shape;
use crate::verify::camera::{CameraModel, CameraRay, EnteredRay};
use crate::verify::certificate::shape_name;
use crate::verify::checker::Checker;
use crate::verify::cone::legal_far_side;
use crate::verify::hit::{Candidates, LegalHit, LegalHits, key_of, legal_cone_hit, legal_hit, shape_of};
use crate::verify::lit::certificate::LitStage;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::judge::{Judge, Mismatch, Name, StageResult, searched};
use crate::verify::lit::kernel::Hit;
use crate::verify::number::Number;
use crate::verify::rounding::{FLUSH, Interval, PAD, gamma};
use crate::verify::sphere::{Line, Slack};

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

    /// Finds the legal hits of a ray that leaves a shape. If it goes through the inside to a far side, `own` is the shape's id
    /// and the distance to that side.
    pub(crate) fn find(
        &self,
        candidates: &Candidates,
        departed: Option<Shape>,
        own: Option<(u32, Interval)>,
        legal: &mut LegalHits,
    ) {
        legal.clear();
        if let Some((_, far_side)) = own {
            (legal.miss, legal.limit) = (false, far_side.high);
        }
        if self.may_hit_box {
            let is_departed = |shape| departed.is_some_and(|own| is_same(shape, own));
            legal.find_nearer(candidates, &self.line, self.slack, is_departed);
            legal.miss |= self.may_miss_box && own.is_none();
        }
        if let (Some((id, far_side)), Some(shape)) = (own, departed)
            && far_side.low <= legal.limit
        {
            legal.spheres.push(LegalHit { id, near: None, far: Some(far_side), key: key_of(shape) });
        }
    }

    /// Whether shapes hide a light at a distance from the ray's origin.
    pub(crate) fn hidden(
        &self,
        candidates: &Candidates,
        distance: Number,
        role_of: impl Fn(u32, Shape) -> Role,
    ) -> Obstacle {
        let Self { line, slack, enter, may_hit_box, may_miss_box } = self;
        let rest = (distance - Number::between(enter.low, enter.high)).interval();
        let mut found = Obstacle::NEVER;
        if !may_hit_box || rest.high <= 0.0 {
            return found;
        }
        let doubt = |id: u32, found: &mut Obstacle, [may, must]: [bool; 2], why: &dyn Fn() -> String| {
            found.may |= may;
            found.must |= must;
            if may && !must {
                found.doubts.add(|| format!("{}, {}", shape_name(candidates.first_cone, id), why()));
            }
        };
        let ends = || "which ends where the search does".to_owned();
        candidates.spheres.visit(line, slack.across + slack.along, rest.high, |candidate| {
            let (id, sphere) = (candidate.id, candidate.shape);
            if role_of(id, Shape::Sphere(sphere)) != Role::Occluder {
                return rest.high;
            }
            if let Some((hit, may_miss)) = legal_hit(candidate, line, *slack) {
                let answer = [hit.lowest() < rest.high, !may_miss && hit.highest() < rest.low];
                let beside = || format!("{:.1e} of its radius beside its silhouette", line.beside_silhouette(sphere));
                doubt(id, &mut found, answer, if may_miss { &beside } else { &ends });
            }
            // A certain answer ends the search.
            if found.must { -1.0 } else { rest.high }
        });
        candidates.cones.visit(line, slack.across + slack.along, rest.high, |candidate| {
            let role = role_of(candidate.id, Shape::Cone(candidate.shape));
            if role == Role::Exempt || found.must {
                return rest.high;
            }
            if let Some((hit, may_miss)) = legal_cone_hit(candidate, line, *slack) {
                let [mut may, mut must] = [hit.lowest() < rest.high, !may_miss && hit.highest() < rest.low];
                if role == Role::FarSide {
                    let (far, is_open) = legal_far_side(line, *slack, &candidate.shape);
                    may &= far.is_some_and(|far| far.low < rest.high);
                    must &= !is_open && far.is_some_and(|far| far.high < rest.low);
                }
                let beside = || "beside its silhouette".to_owned();
                doubt(candidate.id, &mut found, [may, must], if may_miss { &beside } else { &ends });
            }
            if found.must { -1.0 } else { rest.high }
        });
        found.must &= !may_miss_box && rest.low > 0.0;
        found
    }
}

/// How a shape takes part in the search for what hides a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// The ray starts or ends on it, or light passes through it.
    Exempt,
    /// The ray starts inside it, and the search finds its far side alone.
    FarSide,
    Occluder,
}

/// Whether an obstacle may hide the light, and whether one must.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Obstacle {
    pub(crate) may: bool,
    pub(crate) must: bool,
    /// The shapes that may hide the light but need not.
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

/// Whether a shape equals the shape that a ray leaves or ends on. They are compared by value, because the sign of a zero does
/// not matter.
pub(crate) fn is_same(shape: Shape, other: Shape) -> bool {
    match (shape, other) {
        (Shape::Sphere([x, y, z, radius]), Shape::Sphere(other)) => {
            Vec4::new(x, y, z, radius.abs()) == Vec4::from(other)
        }
        (shape, other) => shape == other,
    }
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
    let departed = shape_of(scene, departure.id);
    // The exit distance was compared when the path was scattered, and is known exactly.
    let far_side = f64::from(departure.exit_distance);
    let is_left_inside = departed.is_some() && state.has(flag::INSIDE) && departure.exit_distance < NO_HIT;
    let own = last.filter(|_| is_left_inside);
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
        return fail("the hit", legal.message(id, t));
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

/// Whether shapes hide the sampled light of a path, other than the shape that it leaves and the one that shines.
pub(crate) fn hidden_from_path(
    LitCheck { checker: Checker { scene, candidates }, inputs, .. }: &LitCheck<'_>,
    state: &PathState,
    entry: &Entry,
    distance: Number,
) -> Obstacle {
    let Departure { id, emitter, .. } = state.departure();
    let departed = shape_of(scene, id);
    let sphere_of_light = (emitter != NO_EMITTER)
        .then(|| inputs.emitters.get((emitter as usize).saturating_mul(3)))
        .flatten()
        .map(|sphere| Shape::Sphere(sphere.map(f32::from_bits)));
    let exempt = [departed, sphere_of_light];
    let is_exempt = |shape| exempt.into_iter().flatten().any(|own| is_same(shape, own));
    entry.hidden(candidates, distance, |_, shape| if is_exempt(shape) { Role::Exempt } else { Role::Occluder })
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
                true => format!("{} at {low:?} to {high:?}", shape_name(self.first_cone, hit.id)),
                false => format!("{} at {low:?}", shape_name(self.first_cone, hit.id)),
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

/// The shapes that may hide a light but need not.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Doubts(Vec<String>);

impl Doubts {
    pub(crate) const NONE: Self = Self(Vec::new());

    /// Adds a shape, in words.
    fn add(&mut self, words: impl FnOnce() -> String) {
        if self.0.len() < MOST {
            self.0.push(words());
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
        let entry = Entry {
            line: Line::new([0.0; 3], [0.0, 0.0, 1.0]),
            slack: Slack::default(),
            enter: Interval::ZERO,
            may_hit_box: true,
            may_miss_box: false,
        };
        let hidden = |sphere: [f32; 4], distance: f32| {
            let candidates = Candidates::new(&[sphere], &[]).unwrap();
            entry.hidden(&candidates, Number::recorded(distance), |_, _| Role::Occluder).doubts
        };
        let doubts = hidden([2.0, 0.0, 5.0, 2.0 + 1e-6], 9.0);
        assert_eq!(doubts.alternatives(), ["hidden or not: sphere 0, 4.8e-7 of its radius beside its silhouette"]);
        let at_end = hidden([0.0, 0.0, 5.0, 1.0], 4.0).alternatives();
        assert_eq!(at_end, ["hidden or not: sphere 0, which ends where the search does"]);
        // The same doubt counts once, and at most four doubts are kept.
        assert_eq!(doubts.clone().and(doubts.clone()), doubts);
        let mut others = Doubts::NONE;
        (0..9).for_each(|id| others.add(|| format!("sphere {id}")));
        assert_eq!(others.alternatives().len(), 4);
        assert_eq!(doubts.and(others).alternatives().len(), 4);
        assert_eq!(Doubts::NONE.alternatives().len(), 1);
    }
}
