//! One invocation of a shading kernel, followed number by number from its input to its legal output, and the place
//! where its ray hits a shape or the ground. The WGSL twins are `shaders/path/vertex.wgsl` and
//! `sphere_place.wgsl`.

use glam::DVec3;

use crate::camera::sampling::{pair, pixel_seed};
use crate::geometry::cone::ConeInFrame;
use crate::geometry::math::wide;
use crate::image::NO_ID;
use crate::recording::NO_HIT;
use crate::recording::lit::{LitInputs, PathState, UploadedLighting, flag, slot};
use crate::scene::{Scene, Shape};
use crate::verify::choices::Choices;
use crate::verify::cone::{AnyRay, Crossing, NOT_ROUND};
use crate::verify::hit::shape_of;
use crate::verify::lit::certificate::{Address, LitStage};
use crate::verify::lit::judge::{Judge, Mismatch, Name};
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::{FLUSH, Interval, PAD, U, gamma, unit_error};
use crate::verify::sphere::{Chord, Line, Slack, SphereTest, normal_at};

/// The hit of a ray as the device recorded it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub(crate) t: f32,
    pub(crate) id: u32,
    pub(crate) shape_index: u32,
    pub(crate) distance: f32,
}

impl Hit {
    pub(crate) fn new([t, id, shape_index, distance]: [u32; 4]) -> Self {
        Self { t: f32::from_bits(t), id, shape_index, distance: f32::from_bits(distance) }
    }
}

/// The state of a ray as a kernel reads it. Every number is an interval; those of a recording are known exactly.
#[derive(Clone, Debug)]
pub(crate) struct RayState {
    /// The state as it was recorded. If nothing was, it has flags, ids and indices alone.
    pub(crate) raw: PathState,
    numbers: [[Number; 4]; PathState::SLOTS],
}

impl RayState {
    pub(crate) fn recorded(raw: PathState) -> Self {
        Self { raw, numbers: raw.slots.map(|four| four.map(|bits| Number::recorded(f32::from_bits(bits)))) }
    }

    pub(crate) fn vector(&self, slot: usize) -> Vector {
        let [x, y, z, _] = self.numbers[slot];
        Vector([x, y, z])
    }

    pub(crate) fn number(&self, slot: usize) -> Number {
        self.numbers[slot][3]
    }

    /// A number of a slot, by its index from 0 to 3.
    pub(crate) fn number_at(&self, [slot, index]: [usize; 2]) -> Number {
        self.numbers[slot][index]
    }

    pub(crate) fn has(&self, flag: u32) -> bool {
        self.raw.has(flag)
    }

    /// Sets a number of a slot, by its index from 0 to 3.
    pub(crate) fn set(&mut self, [slot, index]: [usize; 2], number: Number) {
        self.numbers[slot][index] = number.fence();
    }
}

/// The hit of a ray as a kernel reads it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayHit {
    /// The distance from where the ray enters the scene's box, and the distance from its origin to there.
    pub(crate) t: Number,
    pub(crate) distance: Number,
    pub(crate) id: u32,
    pub(crate) shape_index: u32,
}

impl From<Hit> for RayHit {
    fn from(Hit { t, id, shape_index, distance }: Hit) -> Self {
        Self { t: Number::recorded(t), distance: Number::recorded(distance), id, shape_index }
    }
}

/// What becomes of a kernel's results.
pub(crate) enum Output<'a> {
    /// They are compared with what the device recorded.
    Recorded(&'a PathState),
    /// All of them are legal.
    Legal(Box<RayState>),
}

/// One invocation of the kernel, for one combination of its open decisions.
pub(crate) struct Kernel<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) inputs: &'a LitInputs,
    /// Whether this is the kernel for scenes in which every material is matt or emissive.
    pub(crate) is_matt: bool,
    pub(crate) address: Address,
    pub(crate) before: &'a RayState,
    pub(crate) hit: RayHit,
    pub(crate) after: Output<'a>,
    pub(crate) judge: Judge,
    pub(crate) choices: &'a mut Choices,
}

impl<'a> Kernel<'a> {
    pub(crate) fn lighting(&self) -> &'a UploadedLighting {
        &self.inputs.lighting
    }

    /// A pair of random numbers of the pixel.
    pub(crate) fn numbers(&self, sample: u32, number: u32) -> [u32; 2] {
        pair(pixel_seed(self.address.pixel, self.lighting().seed), sample, number)
    }

    /// An entry of the tables; zeros beyond the end of the tables.
    pub(crate) fn table(&self, at: u32) -> [u32; 4] {
        self.inputs.tables.get(at as usize).copied().unwrap_or_default()
    }

    pub(crate) fn emitter_words(&self, at: u32) -> [u32; 4] {
        self.inputs.emitters.get(at as usize).copied().unwrap_or_default()
    }

    pub(crate) fn table_numbers(&self, at: u32) -> [f32; 4] {
        self.table(at).map(f32::from_bits)
    }

    /// Three recorded numbers of a slot of the result, if it was recorded.
    pub(crate) fn recorded(&self, slot: usize) -> Option<Vector> {
        match self.after {
            Output::Recorded(after) => Some(Vector::recorded(after.vector(slot))),
            Output::Legal(_) => None,
        }
    }

    /// Writes three numbers of a slot. Their bounds are narrow or wide relative to `size` or the largest of them.
    pub(crate) fn write(&mut self, name: Name, slot: usize, legal: Vector, size: f64) -> Result<(), Mismatch> {
        match &mut self.after {
            Output::Recorded(after) => self.judge.vector_of(name, after.vector(slot), legal, size),
            Output::Legal(state) => {
                (0..3).for_each(|index| state.set([slot, index], legal.0[index]));
                Ok(())
            }
        }
    }

    /// Writes a number of a slot, by its index from 0 to 3.
    pub(crate) fn write_number(
        &mut self,
        name: Name,
        at: [usize; 2],
        legal: Number,
        size: f64,
    ) -> Result<(), Mismatch> {
        let [slot, index] = at;
        match &mut self.after {
            Output::Recorded(after) => {
                self.judge.number_of(name, f32::from_bits(after.slots[slot][index]), legal, size)
            }
            Output::Legal(state) => {
                state.set(at, legal);
                Ok(())
            }
        }
    }

    /// Writes a word of a slot that is not a number.
    pub(crate) fn write_bits(&mut self, name: Name, [slot, index]: [usize; 2], legal: u32) -> Result<(), Mismatch> {
        match &mut self.after {
            Output::Recorded(after) => self.judge.bits(name, after.slots[slot][index], legal),
            Output::Legal(state) => {
                state.raw.slots[slot][index] = legal;
                Ok(())
            }
        }
    }

    /// Checks that slots have not changed. If the result was not recorded, it began as the state before.
    pub(crate) fn same(&mut self, name: Name, slots: &[usize]) -> Result<(), Mismatch> {
        let Output::Recorded(after) = self.after else { return Ok(()) };
        slots.iter().try_for_each(|slot| self.judge.same(name, [&self.before.raw, after], *slot))
    }
}

/// The exact number in [0, 1) that the upper 24 bits represent.
pub(crate) fn unit(bits: u32) -> Number {
    Number::known(crate::camera::sampling::unit(bits))
}

/// A surface that was hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub(crate) position: Vector,
    /// Unit normal on the visible side.
    pub(crate) normal: Vector,
    /// True if the visible side is the inside of a shape.
    pub(crate) is_back: bool,
    /// Distance along the ray.
    pub(crate) distance: Number,
    /// Centre and radius of the sphere. The radius is 0 for the ground, and [`NOT_ROUND`] for a cone.
    pub(crate) sphere: [f32; 4],
    /// The cone, if it is one.
    pub(crate) cone: Option<ConeInFrame>,
    pub(crate) color: [f32; 3],
    /// Index of the material. The ground has the first material.
    pub(crate) material_index: u32,
    /// The opacities of the material and of the colour, which the kernel multiplies.
    pub(crate) opacities: [f32; 2],
}

impl Vertex {
    /// True if it is not the ground.
    pub(crate) fn is_shape(&self) -> bool {
        self.sphere[3] > 0.0
    }

    /// The distance from a point of a shape through its inside to the far side: `exit_distance_of`.
    pub(crate) fn exit_distance(&self, direction: Vector, choices: &mut Choices) -> Number {
        if let Some(cone) = &self.cone {
            let ray = AnyRay { origin: self.position, direction, moved: Number::ZERO };
            return Crossing::new(&ray, cone, choices).far_side();
        }
        let [x, y, z, _] = self.sphere;
        let to_center = Vector::recorded([x, y, z]) - self.position;
        (Number::TWO * to_center.dot(direction)).max(Number::ZERO)
    }
}

/// The place where a ray hits a shape.
pub(super) struct Place {
    pub(super) position: Vector,
    /// Unit normal, which points out of the shape.
    pub(super) outward: Vector,
    /// Whether the ray hits the inside.
    pub(super) is_back: bool,
}

const HIT: Name = (LitStage::Vertex, "the hit");
const POSITION: Name = (LitStage::Vertex, "the point that was hit");

impl Kernel<'_> {
    /// The surface that the ray hits; `None` for a miss.
    pub(crate) fn vertex(&mut self) -> Result<Option<Vertex>, Mismatch> {
        let (before, hit) = (self.before, self.hit);
        let (origin, direction) = (before.vector(slot::ORIGIN), before.vector(slot::DIRECTION));
        // A camera ray starts at the box of the shapes, and may have crossed the ground before.
        let behind = if self.address.surface == 0 { before.number(slot::FIRST) } else { Number::ZERO };
        let ground = if before.has(flag::ON_GROUND) { None } else { self.ground_distance(origin, direction, behind) };
        let has_shape = hit.id != NO_ID;
        let to_shape = if has_shape { hit.distance + hit.t } else { Number::known(NO_HIT.into()) };
        if let Some(distance) = ground
            && self.choices.decide(distance.is_less(to_shape))
        {
            return self.ground_vertex(origin, direction, distance).map(Some);
        }
        if has_shape { self.shape_vertex(to_shape).map(Some) } else { Ok(None) }
    }

    /// The distance at which a ray hits the ground from above. It may be negative, down to −`behind`.
    pub(crate) fn ground_distance(&mut self, origin: Vector, direction: Vector, behind: Number) -> Option<Number> {
        let lighting = self.lighting();
        if lighting.flags & flag::GROUND == 0 {
            return None;
        }
        let normal = Vector::recorded(lighting.ground_normal);
        let toward = direction.dot(normal);
        if !self.choices.decide(toward.is_less(Number::ZERO)) {
            return None;
        }
        let height = (origin - Vector::recorded(lighting.ground_point)).dot(normal);
        let toward = toward.min(Number::known(-f64::MIN_POSITIVE));
        let t = height / -toward;
        self.choices.decide((-behind).is_less(t)).then_some(t)
    }

    /// Writes the point, and returns it. If it was recorded, it is exact from then on.
    pub(super) fn at(&mut self, position: Vector, size: f64) -> Result<Vector, Mismatch> {
        self.write(POSITION, slot::ORIGIN, position, size)?;
        Ok(self.recorded(slot::ORIGIN).unwrap_or_else(|| position.fence()))
    }

    fn ground_vertex(&mut self, origin: Vector, direction: Vector, distance: Number) -> Result<Vertex, Mismatch> {
        let lighting = self.lighting();
        let normal = Vector::recorded(lighting.ground_normal);
        let on_ray = origin + direction * distance;
        let above = (on_ray - Vector::recorded(lighting.ground_point)).dot(normal);
        let position = (on_ray - normal * above).fence();
        let size = distance.interval().high;
        let position = self.at(position, size)?;
        Ok(Vertex {
            position,
            normal,
            is_back: false,
            distance,
            sphere: [0.0; 4],
            cone: None,
            color: lighting.ground_color,
            material_index: 0,
            opacities: [1.0; 2],
        })
    }

    fn shape_vertex(&mut self, distance: Number) -> Result<Vertex, Mismatch> {
        let hit = self.hit;
        let Some(shape) = shape_of(self.scene, hit.id) else {
            return Err(self.judge.fail(HIT, format!("there is no shape {}", hit.id)));
        };
        let (Place { position, outward, is_back }, sphere, cone) = match shape {
            Shape::Sphere(sphere) => (self.place_on_sphere(sphere)?, sphere, None),
            Shape::Cone(cone) => (self.place_on_cone(&cone)?, [0.0, 0.0, 0.0, NOT_ROUND], Some(cone)),
        };
        let appearance = self.scene.checked_appearance();
        let surface = appearance.surfaces()[appearance.surface_index(hit.id) as usize];
        Ok(Vertex {
            position,
            normal: if is_back { -outward } else { outward },
            is_back,
            distance,
            sphere,
            cone,
            color: self.scene.color(hit.id).to_array(),
            material_index: appearance.material_row(hit.id) + 1,
            opacities: [surface.opacity, appearance.alpha(hit.id)],
        })
    }

    fn place_on_sphere(&mut self, sphere: [f32; 4]) -> Result<Place, Mismatch> {
        let (before, hit, [x, y, z, radius]) = (self.before, self.hit, sphere);
        let direction = before.vector(slot::DIRECTION);
        let (line, origin, slack) = self.entered();
        let Some(test) = SphereTest::new(&line, sphere, slack) else {
            return Err(self.judge.fail(HIT, format!("sphere {} cannot be hit", hit.id)));
        };
        let center = Vector::recorded([x, y, z]);
        let middle = (center - origin).dot(direction);
        let is_far_side = self.is_far_side();
        let (half, exact) = if is_far_side {
            let exact = (wide([x, y, z]) - line.origin).dot(line.direction).abs();
            (middle.abs().interval(), exact)
        } else {
            (test.half, test.exact_half())
        };
        let is_behind = is_far_side || self.choices.decide(middle.is_less(hit.t));
        let chord = Chord { half, exact, is_behind };
        let (normal, error) = normal_at(&test, &line, chord, radius, slack);
        let mut outward = Vector::around(normal, error);

        let r = Number::recorded(radius);
        let far = Number::known(64.0) * (hit.t + hit.distance);
        let is_on_ray = self.choices.decide(r.is_more(far));
        let position = if is_on_ray { origin + direction * hit.t } else { center + outward * r };
        let position = self.at(position.fence(), radius.into())?;
        if !is_on_ray && matches!(self.after, Output::Recorded(_)) {
            outward = self.normal_by_point(outward, position, sphere)?;
        }
        let is_back = self.choices.decide(outward.dot(direction).is_above_zero());
        Ok(Place { position, outward, is_back })
    }

    /// Whether the hit is the far side of the shape on which the ray starts.
    pub(super) fn is_far_side(&self) -> bool {
        self.before.has(flag::INSIDE) && self.hit.id == self.before.raw.departure().id
    }

    /// The normal, narrowed by means of the point on the sphere that was computed from it.
    fn normal_by_point(
        &mut self,
        outward: Vector,
        position: Vector,
        [x, y, z, radius]: [f32; 4],
    ) -> Result<Vector, Mismatch> {
        let (center, r) = (wide([x, y, z]), f64::from(radius));
        let away = DVec3::from(position.intervals().map(|axis| axis.low)) - center;
        // The errors of a product and a sum.
        let size = center.abs() + r * (1.0 + unit_error(r));
        let error = PAD * gamma(2) * size + DVec3::splat(2.0 * FLUSH);
        let legal = Interval::around(r, PAD * (r * unit_error(r) + error.length()));
        if !legal.contains(away.length()) {
            let words = format!("{:e} from the sphere's centre; legal is {legal}", away.length());
            return Err(self.judge.fail(POSITION, words));
        }
        let by_point = [0, 1, 2].map(|axis| {
            let (away, error) = (away[axis], error[axis]);
            Number::between((away - error) / r, (away + error) / r)
        });
        Ok(outward.zip(Vector(by_point), Number::narrowed))
    }

    /// The ray, from where it enters the scene's box: its line, its start, and the maximum difference of the kernel's ray.
    pub(super) fn entered(&self) -> (Line, Vector, Slack) {
        let before = self.before;
        entered(before.vector(slot::ORIGIN), before.vector(slot::DIRECTION), self.hit.distance)
    }
}

/// A ray that starts where it enters the scene's box: its line, its start, and the maximum difference of the kernel's
/// ray.
fn entered(origin: Vector, direction: Vector, distance: Number) -> (Line, Vector, Slack) {
    let [(start, moved_start), (along, turned)] = [origin, direction].map(Vector::ball);
    let Interval { low, high } = distance.interval();
    let middle = 0.5 * (low + high);
    let moved = start + middle * along;
    let mut line = Line::exact(moved, along);
    let mut error = moved_start + middle * turned;
    if high != 0.0 {
        error += PAD * (gamma(2) * (start.abs() + (high * along).abs())) + DVec3::splat(2.0 * FLUSH);
    }
    let around = error + (high - middle) * (along.abs() + turned);
    let origin = [0, 1, 2].map(|axis| Number::around(moved[axis], around[axis]));
    let turned = PAD * turned.length();
    line.bend += 2.5 * turned;
    let length = if error == DVec3::ZERO { 0.0 } else { PAD * error.length() + U * FLUSH };
    let slack = Slack { across: length, along: length + PAD * (high - middle), direction: turned };
    (line, Vector(origin), slack)
}
