//! The check of the cone test: every legal result of `intersect` in `shaders/scene/cone.wgsl`, and of `cross_cone` and
//! `cone_normal` in `cone_crossing.wgsl`. The lines of the kernel are followed number by number (`verify/number`). Decisions that bounds leave open are followed
//! both ways. A ray that is known only within bounds has numbers that are intervals.

use glam::DVec3;

use crate::geometry::cone::ConeInFrame;
use crate::recording::NO_HIT;
use crate::verify::choices::Choices;
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::{FLUSH, Interval, PAD, U, gamma, unit_error};
use crate::verify::sphere::{Line, Slack};

/// Constants of the kernel, by their names there.
pub(crate) const FAR: f32 = 1e30;
pub(crate) const LEAST_RISE: f32 = 1.0 / (1_u64 << 40) as f32;
pub(crate) const LEAST_SQUARE: f32 = 1.0 / (1_u64 << 34) as f32;
pub(crate) const LEAST_LENGTH: f32 = 1e-37;
/// The radius of shapes that are not round (`path/vertex.wgsl`).
pub(crate) const NOT_ROUND: f32 = 1e37;

/// A hit that a device may have.
#[derive(Clone, Copy, Debug)]
pub struct LegalConeHit {
    /// The distance.
    pub t: Interval,
    /// The unit normal.
    pub normal: [Interval; 3],
    /// A bound of the normal's deviation from unit length.
    pub(super) off_unit: f64,
    /// True if the ray enters there, and true if it crosses a disc.
    place: [bool; 2],
}

/// All legal answers to a ray and a cone.
#[derive(Clone, Debug, Default)]
pub struct LegalConeHits {
    /// The hits, one for each combination of open decisions.
    pub hits: Vec<LegalConeHit>,
    /// True if a miss is legal.
    pub may_miss: bool,
    /// True if so many decisions are open that anything is legal.
    pub is_open: bool,
}

impl LegalConeHits {
    /// The legal answers of a device to a ray with these numbers.
    #[must_use]
    pub fn new(origin: [f32; 3], direction: [f32; 3], cone: &ConeInFrame) -> Self {
        Self::of(&Line::new(origin, direction), Slack::default(), cone)
    }

    /// The legal answers to a ray, or to any ray within `slack` of it.
    pub(super) fn of(line: &Line, slack: Slack, cone: &ConeInFrame) -> Self {
        let mut legal = Self::default();
        let mut choices = Choices::default();
        let ray = AnyRay::new(line, slack);
        loop {
            match hit(&ray, cone, &mut choices) {
                Some(hit) => legal.hits.push(hit),
                None => legal.may_miss = true,
            }
            if !choices.advance() {
                break;
            }
        }
        legal.is_open = choices.were_too_many();
        legal
    }

    /// Returns true if a device may have a hit at this distance with this normal, or a miss if the distance is
    /// [`NO_HIT`](crate::recording::NO_HIT).
    #[must_use]
    pub fn allows(&self, t: f32, normal: [f32; 3]) -> bool {
        let is_of = |hit: &LegalConeHit| {
            let are_in = hit.normal.iter().zip(normal).all(|(legal, c)| legal.contains(c.into()));
            hit.t.contains(t.into()) && are_in
        };
        self.is_open || if t >= NO_HIT { self.may_miss } else { self.hits.iter().any(is_of) }
    }

    /// All legal distances at which a ray enters, or those at which it leaves. They may contain others.
    pub(super) fn distances(&self, is_near: bool) -> Option<Interval> {
        if self.is_open {
            return is_near.then_some(ABOVE_ZERO);
        }
        let hits = self.hits.iter().filter(|hit| hit.place[0] == is_near);
        hits.map(|hit| hit.t).reduce(Interval::union)
    }

    /// Returns true if only one answer is legal, apart from its numbers.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        let is_same_place = |hit: &LegalConeHit| hit.place == self.hits[0].place;
        !self.is_open && self.may_miss == self.hits.is_empty() && self.hits.iter().all(is_same_place)
    }
}

const ABOVE_ZERO: Interval = Interval { low: 0.0, high: f64::INFINITY };

/// All rays within bounds.
pub(super) struct AnyRay {
    pub(super) origin: Vector,
    pub(super) direction: Vector,
    /// By how much distances differ because rays start elsewhere along the line, which changes nothing else.
    pub(super) moved: Number,
}

impl AnyRay {
    pub(super) fn new(line: &Line, Slack { across, along, direction }: Slack) -> Self {
        let moved = if along == 0.0 { Number::ZERO } else { Number::around(0.0, PAD * along) };
        // From there, eight roundings lead to the vector of the foot.
        let across = PAD * (across + 8.0 * U * along);
        Self { origin: within(line.origin, across), direction: within(line.direction, PAD * direction), moved }
    }
}

/// All vectors within `error` along each axis. Subnormal numbers may count as zero.
fn within(exact: DVec3, error: f64) -> Vector {
    Vector::around(exact, error).map(|c| if c.interval().size() < FLUSH { c.union(Number::ZERO) } else { c })
}

/// The crossing of a cone by the line of a ray, for one combination of open decisions.
pub(super) struct Crossing {
    /// The distance of the foot, by which the origin may be moved.
    foot_distance: Number,
    /// The vector to the foot from the middle of the axis.
    pub(super) foot: Vector,
    pub(super) half_length: Number,
    length: Number,
    axis: Vector,
    away: Vector,
    aside: Vector,
    slope: Number,
    /// The radius at the height of the foot, and how it grows along the line.
    radius: Number,
    growth: Number,
    /// The distances from the foot.
    pub(super) enters: Number,
    pub(super) leaves: Number,
    enters_disc: bool,
    leaves_disc: bool,
    /// True if the line rises from the start to the end.
    is_up: bool,
    /// True if the discs at which the line enters and leaves are closed.
    is_closed: [bool; 2],
    cone: ConeInFrame,
    /// The line misses the cone if this is negative. `None` if it cannot miss the side.
    discriminant: Option<Number>,
}

impl Crossing {
    pub(super) fn new(ray: &AnyRay, cone: &ConeInFrame, choices: &mut Choices) -> Self {
        let (zero, two, half) = (Number::ZERO, Number::TWO, Number::HALF);
        let [start, end] = [cone.start, cone.end].map(Vector::recorded);
        let AnyRay { origin, direction, moved } = *ray;
        let [first, second] = [cone.first_radius, cone.second_radius].map(|radius| Number::recorded(radius.abs()));
        let span = (end - start).fence();
        let length = span.dot(span).fence().max(Number::known(LEAST_LENGTH.into())).sqrt().fence();
        let axis = span.map(|c| c / length).fence();
        let half_length = half * length;
        let slope = ((second - first).fence() / length).fence();
        let to_middle = ((start - origin).fence() + span * half).fence();
        let b = to_middle.dot(direction).fence();
        let foot = (direction * b - to_middle).fence();
        let height = foot.dot(axis).fence();
        let rise = direction.dot(axis).fence();
        let away = (foot - axis * height).fence();
        let aside = (direction - axis * rise).fence();
        let radius = (half * (first + second) + slope * height).fence();
        let growth = (slope * rise).fence();

        let least = Number::known(LEAST_SQUARE.into());
        let Slab { enters: slab_in, leaves: slab_out, is_up } = Slab::new(rise, height, half_length, choices);

        let across = cross(direction, axis).fence();
        let sine = across.squared().fence();
        let side = foot.dot(across).fence();
        let tilt = away.dot(aside).fence();
        let square = away.squared().fence();
        let a = (sine - growth.squared()).fence();
        let half_b = (tilt - radius * growth).fence();
        let c = (square - radius.squared()).fence();
        let of_cylinder = (sine * radius * radius - side.squared()).fence();
        let discriminant = (of_cylinder + growth * (growth * square - two * tilt * radius).fence()).fence();
        let root = discriminant.max(zero).sqrt();
        let is_flat = choices.decide(a.abs().is_less(least));
        let far = Number::known(FAR.into());
        let limited = |s: Number| s.max(-far).min(far);
        // The lower and the higher root, for either sign of `half_b` that it may have.
        let of_sign = |sum: Number, rest: Number| {
            let sum = sum.fence();
            let quotient = || limited(if sum.is_zero() { -c * far } else { -c / sum });
            let difference = || limited(-rest.fence() / a);
            let second = match sum.squared().is_more(a.abs() * square.max(radius * radius)) {
                _ if is_flat => quotient(),
                Some(true) => quotient(),
                Some(false) => difference(),
                None => quotient().union(difference()),
            };
            let first = match sum.is_less(zero) {
                _ if !is_flat => limited(-sum / a),
                Some(true) => far,
                Some(false) => -far,
                None => far.union(-far),
            };
            (first.min(second), first.max(second))
        };
        let (less, more) = (half_b - root, half_b + root);
        let (negative, positive) = (|| of_sign(less, more), || of_sign(more, less));
        let (low, high) = match half_b.is_less(zero) {
            Some(true) => negative(),
            Some(false) => positive(),
            None => {
                let ((a, b), (c, d)) = (negative(), positive());
                (a.union(c), b.union(d))
            }
        };
        let is_steep = !is_flat && choices.decide(a.is_less(zero));
        let (side_in, side_out) = if !is_steep {
            (low, high)
        } else if choices.decide(growth.is_above_zero()) {
            (high, far)
        } else {
            (-far, low)
        };
        let enters_disc = choices.decide(slab_in.is_more(side_in));
        let leaves_disc = choices.decide(slab_out.is_less(side_out));
        let [start_is_closed, end_is_closed] = cone.are_closed();
        let is_up = !(enters_disc || leaves_disc) || choices.decide(is_up);
        let is_closed = if is_up { [start_is_closed, end_is_closed] } else { [end_is_closed, start_is_closed] };
        Self {
            foot_distance: b + moved,
            foot,
            half_length,
            length,
            axis,
            away,
            aside,
            slope,
            radius,
            growth,
            enters: if enters_disc { slab_in } else { side_in },
            leaves: if leaves_disc { slab_out } else { side_out },
            enters_disc,
            leaves_disc,
            is_up,
            is_closed,
            cone: *cone,
            discriminant: (!is_steep && !is_flat).then_some(discriminant),
        }
    }

    /// The distances from the origin at which the line enters and leaves.
    pub(super) fn distances(&self) -> [Number; 2] {
        [self.foot_distance + self.enters, self.foot_distance + self.leaves]
    }

    /// True for the entry, and for the exit, if it is not through an open end.
    pub(super) fn is_solid(&self) -> [bool; 2] {
        let [closed_in, closed_out] = self.is_closed;
        [closed_in || !self.enters_disc, closed_out || !self.leaves_disc]
    }

    /// True if the line misses the cone.
    fn is_missed(&self, choices: &mut Choices) -> bool {
        if self.discriminant.is_some_and(|it| choices.decide(it.is_less(Number::ZERO))) {
            return true;
        }
        // Both roots, and both planes, are in order.
        let are_of_one_kind = self.enters_disc == self.leaves_disc;
        !are_of_one_kind && choices.decide(self.leaves.is_less(self.enters))
    }

    /// The distance at which a ray that starts on the cone leaves it: `searched_far_side`.
    pub(super) fn far_side(&self) -> Number {
        let [_, leaves] = self.distances();
        if self.is_solid()[1] { leaves.max(Number::ZERO) } else { Number::known(NO_HIT.into()) }
    }

    /// The unit normal where the line enters, or where it leaves, and a bound of its deviation from unit length. If the
    /// `point` there is known that the kernel computed from the same distance, it narrows the bounds: grazing rays hardly
    /// say where they hit.
    pub(super) fn normal(&self, is_near: bool, point: Option<DVec3>, choices: &mut Choices) -> (Vector, f64) {
        let Self { axis, slope, .. } = *self;
        let (from_foot, is_disc) =
            if is_near { (self.enters, self.enters_disc) } else { (self.leaves, self.leaves_disc) };
        let (normal, off_unit) = if is_disc {
            (if is_near == self.is_up { -axis } else { axis }, unit_error(self.length.interval().low))
        } else {
            let mut outward = (self.away + self.aside * from_foot).fence();
            let mut radius = (self.radius + from_foot * self.growth).fence();
            if let Some(point) = point {
                let (by_point, radius_there) = self.by_point(point, from_foot);
                outward = outward.zip(by_point, Number::narrowed);
                radius = radius.narrowed(radius_there);
            }
            let normal = (outward - axis * (slope * radius)).fence();
            let square = normal.squared().fence();
            let off_unit = unit_error(square.interval().low.max(0.0).sqrt());
            let normal = if choices.decide(square.is_less(Number::known(LEAST_LENGTH.into()))) {
                if choices.decide(slope.is_above_zero()) { -axis } else { axis }
            } else {
                let length = square.sqrt();
                normal.map(|c| (c / length).clamp(-1.0 - 1e-5, 1.0 + 1e-5))
            };
            (normal, off_unit)
        };
        (normal.fence(), off_unit)
    }

    /// The vector from the axis to a point at this distance from the foot, and the radius there.
    fn by_point(&self, point: DVec3, from_foot: Number) -> (Vector, Number) {
        let ([start, end], [first, second], axis) = (self.cone.ends(), self.cone.radii(), self.cone.axis());
        let (span, middle, mean) = (end - start, 0.5 * (start + end), 0.5 * (first + second));
        let from_middle = point - middle;
        // The middle and the point are rounded three times.
        let of_point = U * (point.length() + middle.length() + span.length());
        // The vector to the point has two roundings, the parts of the foot and of the direction across the axis five each,
        // and their sum two. The axis, a difference divided by its length, is off by eleven at most, and taken twice.
        let size = self.foot.squared().interval().high.sqrt() + from_foot.interval().size();
        let error = PAD * (of_point + gamma(10) * size + gamma(22) * from_middle.length() + 16.0 * FLUSH);
        let height = from_middle.dot(axis);
        let slope = (second - first) / span.length();
        // The slope is off by as much as the axis. Each radius is rounded four times, and is at most twice the mean.
        let of_slope = gamma(11) * slope.abs() * size;
        let radius_error = slope.abs() * error + PAD * (of_slope + gamma(8) * mean) + FLUSH;
        (Vector::around(from_middle - height * axis, error), Number::around(mean + slope * height, radius_error))
    }
}

/// The answer of the kernel for one combination of open decisions. `None` for a miss.
fn hit(ray: &AnyRay, cone: &ConeInFrame, choices: &mut Choices) -> Option<LegalConeHit> {
    let crossing = Crossing::new(ray, cone, choices);
    if crossing.is_missed(choices) {
        return None;
    }
    let [near, far] = crossing.distances();
    let [is_solid_in, is_solid_out] = crossing.is_solid();
    let is_near = is_solid_in && choices.decide(near.is_above_zero());
    let is_far = !is_near && is_solid_out && choices.decide(far.is_above_zero());
    if !is_near && !is_far {
        return None;
    }
    let (t, is_disc) = if is_near { (near, crossing.enters_disc) } else { (far, crossing.leaves_disc) };
    let (normal, off_unit) = crossing.normal(is_near, None, choices);
    let t = t.interval().intersection(ABOVE_ZERO);
    Some(LegalConeHit { t, normal: normal.intervals(), off_unit, place: [is_near, is_disc] })
}

/// All distances at which a ray that starts on a cone may leave it. The second number is true if it may leave it through an
/// open end.
pub(super) fn legal_far_side(line: &Line, slack: Slack, cone: &ConeInFrame) -> (Option<Interval>, bool) {
    let (ray, mut choices) = (AnyRay::new(line, slack), Choices::default());
    let (mut closed, mut is_open): (Option<Interval>, _) = (None, false);
    loop {
        let crossing = Crossing::new(&ray, cone, &mut choices);
        if crossing.is_solid()[1] {
            let here = crossing.far_side().interval();
            closed = Some(closed.map_or(here, |all| all.union(here)));
        } else {
            is_open = true;
        }
        if !choices.advance() {
            break;
        }
    }
    if choices.were_too_many() { (Some(ABOVE_ZERO), true) } else { (closed, is_open) }
}

/// The crossing of the slab between the planes of the discs by a ray.
struct Slab {
    enters: Number,
    leaves: Number,
    /// True if the ray enters at the plane of the start; `None` if undecided.
    is_up: Option<bool>,
}

impl Slab {
    fn new(rise: Number, height: Number, half_length: Number, choices: &mut Choices) -> Self {
        let least = Number::known(LEAST_RISE.into());
        let at = |risen: Number| [-half_length - height, half_length - height].map(|way| way / risen);
        let Interval { low, high } = rise.interval();
        let is_less = rise.abs().is_less(least);
        let steepest = low.abs().max(high.abs()).max(LEAST_RISE.into());
        let [below, above] = [half_length + height, half_length - height].map(|room| room.interval().low / steepest);
        if is_less.is_none() && low < 0.0 && high > 0.0 && below > 0.0 && above > 0.0 {
            // The planes are far away on both sides, whichever way the ray goes.
            let beyond = below.min(above) * (1.0 - 1e-5);
            let farthest = f64::from(FAR).powi(2);
            let (enters, leaves) = (Number::between(-farthest, -beyond), Number::between(beyond, farthest));
            return Self { enters, leaves, is_up: None };
        }
        let is_down = || rise.is_less(Number::ZERO);
        let risen = if choices.decide(is_less) { if choices.decide(is_down()) { -least } else { least } } else { rise };
        let is_up = choices.decide(risen.is_above_zero());
        let [at_start, at_end] = at(risen);
        let (enters, leaves) = if is_up { (at_start, at_end) } else { (at_end, at_start) };
        Self { enters, leaves, is_up: Some(is_up) }
    }
}

fn cross(Vector([a, b, c]): Vector, Vector([p, q, r]): Vector) -> Vector {
    Vector([b * r - c * q, c * p - a * r, a * q - b * p])
}
