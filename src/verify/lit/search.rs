//! The check of searches: the nearest hit of a path's ray, and the occlusion of a light. The WGSL twins are
//! `shaders/path/extend.wgsl`, `path/hit_before.wgsl`, `path/occlude.wgsl` and `accel/excluded.wgsl`.

use glam::{DVec3, Vec4};

use super::alternatives::Doubts;
use super::expected::{Expected, Mismatch};
use super::kernel::Hit;
use super::recording::{PathState, flag, slot};
use super::stage::LitStage;
use crate::image::NO_ID;
use crate::scene::Scene;
use crate::verify::camera::{CameraModel, CameraRay, EnteredRay};
use crate::verify::candidates::Candidates;
use crate::verify::hit::{LegalHit, LegalHits, legal_hit};
use crate::verify::line::Line;
use crate::verify::number::Number;
use crate::verify::recording::NO_HIT;
use crate::verify::rounding::{FLUSH, Interval, PAD, gamma};
use crate::verify::sphere::Slack;

const STAGE: LitStage = LitStage::Extend;

/// The data in which searches are made.
#[derive(Clone, Copy)]
pub(in crate::verify) struct Searched<'a> {
    pub(in crate::verify) model: &'a CameraModel,
    pub(in crate::verify) scene: &'a Scene,
    pub(in crate::verify) candidates: &'a Candidates,
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
        let ray = CameraRay {
            line,
            distance: 0.0,
            origin_error: DVec3::ZERO,
            direction_error: DVec3::ZERO,
            distance_error: 0.0,
            may_be_seen: true,
            may_be_unseen: false,
        };
        let entered = ray.entered(model, line.direction);
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
pub(in crate::verify) fn is_same([x, y, z, radius]: [f32; 4], other: [f32; 4]) -> bool {
    Vec4::new(x, y, z, radius.abs()) == Vec4::from(other)
}

fn four(state: &PathState, which: usize) -> [f32; 4] {
    state.slots[which].map(f32::from_bits)
}

/// Judges the nearest hit of a ray; returns whether several answers are legal. `last` is the previous hit of the path.
pub(in crate::verify) fn check_hit(
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
pub(in crate::verify) fn hides(hit: &LegalHit, may_miss: bool, light: Interval) -> (bool, bool) {
    (hit.lowest() < light.high, !may_miss && hit.highest() < light.low)
}

/// Judges the occlusion of a light; if both answers are legal, returns why. `sphere_of_light` is the emitter, if the
/// light is one.
pub(in crate::verify) fn check_open(
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
