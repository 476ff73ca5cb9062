//! All light that a conforming device may find for a pixel, from the camera to the mean of its samples. The kernels are
//! those of the check of recordings, but their results are intervals instead of recorded numbers.

use glam::{DVec2, DVec3};

use crate::camera::View;
use crate::camera::sampling::{pair, pixel_seed, unit};
use crate::geometry::math::wide;
use crate::image::NO_ID;
use crate::image::color::LUMINANCE;
use crate::light::emitters::{EmissiveSphere, Emitters};
use crate::recording::lighting::{HostLighting, emitter_records, max_surfaces, uploaded_sky};
use crate::recording::lit::{LitInputs, PathState, flag, slot};
use crate::recording::{NO_HIT, RequestedCamera};
use crate::render::RenderSettings;
use crate::scene::Scene;
use crate::verify::Checker;
use crate::verify::choices::Choices;
use crate::verify::hit::{LegalHits, shape_of};
use crate::verify::lit::certificate::Address;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::film::location;
use crate::verify::lit::judge::Mismatch;
use crate::verify::lit::kernel::{Kernel, Output, RayHit, RayState};
use crate::verify::lit::search::Entry;
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::{FLUSH, Interval, PAD, U};
use crate::verify::studio::light::Change;
use crate::verify::uploaded::{expected_box, expected_view};

/// The numbers that a device gets for a picture with light; `None` for other pictures.
pub(crate) fn inputs(checker: &Checker<'_>, view: &View<'_>, settings: &RenderSettings) -> Option<LitInputs> {
    let scene = checker.scene;
    if scene.is_empty() || settings.integrator.is_primary() {
        return None;
    }
    let camera = RequestedCamera::of(view.camera);
    let uploaded = expected_view(&camera, scene.origin(), checker.candidates.bounds());
    let emitters = Emitters::of(scene);
    let host = HostLighting::new(settings, scene.origin(), scene.checked_appearance(), &emitters, &camera.vectors);
    let emissive = || emitter_records(&emitters, &EmissiveSphere::all(scene, &emitters));
    let emitters_of_device = host.sources.emitters.then(emissive).unwrap_or_default();
    Some(LitInputs {
        camera,
        occluders: box_of_occluders(scene).unwrap_or([uploaded.scene_min, uploaded.scene_max]),
        uploaded,
        film: view.film,
        origin: [0; 2],
        size: [view.film.width(), view.film.height()],
        settings: settings.clone(),
        max_surfaces: max_surfaces(settings, scene.is_opaque()),
        lighting: host.lighting,
        tables: host.tables.iter().map(|four| four.map(f32::to_bits)).collect(),
        emitters: emitters_of_device.iter().map(|four| four.map(f32::to_bits)).collect(),
        sky: uploaded_sky(settings),
    })
}

/// The box of the opaque shapes, if there are some and not all are opaque.
fn box_of_occluders(scene: &Scene) -> Option<[[f32; 3]; 2]> {
    let ids = scene.opaque_ids().filter(|_| !scene.is_opaque());
    let of_shape = |id: u32| scene.shared_shapes().shape(id).corners().map(|corner| corner.as_vec3());
    let [min, max] = ids.map(of_shape).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
    Some(expected_box(min, max).map(|corner| corner.to_array()))
}

impl LitCheck<'_> {
    /// The means of all samples of a pixel; `None` if hardly anything is known.
    pub(crate) fn legal_pixel(&self, pixel: [u32; 2]) -> Option<PixelLight> {
        let mut hits = LegalHits::default();
        let samples = self.inputs.settings.sampling.samples.max(1);
        let (mut color, mut albedo, mut alpha) = ([Mean::default(); 3], [Mean::default(); 3], Mean::default());
        let mut luminances = Vec::with_capacity(samples as usize);
        for sample in 0..samples {
            let LegalSample { light, first } = self.legal_sample(Address { pixel, sample, surface: 0 }, &mut hits)?;
            alpha.add(light.opacity.interval());
            let light = light.radiance;
            color.iter_mut().zip(light.intervals()).for_each(|(mean, more)| mean.add(more));
            albedo.iter_mut().zip(first.intervals()).for_each(|(mean, more)| mean.add(more));
            luminances.push(light.dot(Vector(LUMINANCE.map(Number::constant))).interval());
        }
        let count = f64::from(samples);
        // The rounding errors of the sum of colours are added to it, so that those of the errors and of the mean remain.
        let color = color.map(|mean| mean.of(count, PAD * (2.0 + count * count * U) * U));
        let plain = PAD * (count + 2.0) * U;
        let albedo = albedo.map(|mean| mean.of(count, plain));
        Some(PixelLight { color, alpha: alpha.of(count, plain), albedo, variance: variance(&luminances) })
    }

    /// The distance between rays that start at different places along the axis, because their origins are rounded. A
    /// device may choose another start, up to the size of the box away.
    pub(crate) fn moved(&self, origin: DVec3) -> f64 {
        2.0 * U * (origin.length() + self.model.diagonal())
    }

    /// The light of a sample; `None` if hardly anything is known.
    fn legal_sample(&self, address: Address, hits: &mut LegalHits) -> Option<LegalSample> {
        let Address { pixel, sample, .. } = address;
        let lighting = &self.inputs.lighting;
        let seed = pixel_seed(pixel, lighting.seed);
        let location = location(&self.inputs.film, &lighting.filter_table, pixel, pair(seed, sample, 0));
        let ray = self.model.ray_through_lens(location, DVec2::from(pair(seed, sample, 1).map(unit)));
        let background = if lighting.flags & flag::TRANSPARENT == 0 { lighting.background } else { [0.0; 3] };
        let nothing = LegalSample {
            light: Change { radiance: Vector::recorded(background), opacity: Number::ZERO },
            first: Vector::ZERO,
        };
        let mut all = ray.may_be_unseen.then_some(nothing);
        if !ray.may_be_seen {
            return all;
        }
        let any = ray.any(&self.model);
        let mut state = RayState::recorded(start());
        let moved = self.moved(ray.line.origin);
        let origin_error = PAD * (ray.origin_error + DVec3::splat(moved));
        for (slot, middle, error) in [
            (slot::ORIGIN, ray.line.origin, origin_error),
            (slot::DIRECTION, ray.line.direction, PAD * ray.direction_error),
        ] {
            (0..3).for_each(|axis| state.set([slot, axis], Number::around(middle[axis], error[axis])));
        }
        state.set([slot::FIRST, 3], Number::around(ray.distance, PAD * ray.distance_error));
        any.moved(moved).find(&self.checker.candidates, hits);
        let Interval { low, high } = any.enter;
        let distance = Number::between(low, high);
        // A start at another place makes all distances as much longer or shorter.
        let apart = high - low + moved;
        for hit in ray_hits(hits, apart, |_| distance) {
            let light = match self.is_studio {
                true => self.legal_surface(address, &state, hit, &mut 0)?,
                false => self.legal_vertex(address, &state, hit, &mut 0)?,
            };
            light.join(&mut all);
        }
        all
    }

    /// The corners of the scene's box.
    pub(crate) fn corners(&self) -> [DVec3; 2] {
        [self.inputs.uploaded.scene_min, self.inputs.uploaded.scene_max].map(wide)
    }

    /// The legal hits of the next ray; `None` if hardly anything is known of it.
    pub(crate) fn next_hits(&self, state: &RayState) -> Option<Vec<RayHit>> {
        let entry = Entry::aimed(self.corners(), state.vector(slot::ORIGIN), state.vector(slot::DIRECTION))?;
        let id = state.raw.departure().id;
        let departed = shape_of(self.checker.scene, id);
        let far_side = state.number_at([slot::DEPARTURE, 2]).interval();
        let is_inside = departed.is_some() && state.has(flag::INSIDE) && far_side.low < NO_HIT.into();
        let own = is_inside.then_some((id, far_side));
        let mut legal = LegalHits::default();
        entry.find(&self.checker.candidates, departed, own, &mut legal);
        let Interval { low, high } = entry.enter;
        let is_own = |hit: u32| is_inside && hit == id;
        let distance = |hit: u32| if is_own(hit) { Number::ZERO } else { Number::between(low, high) };
        Some(ray_hits(&legal, 0.0, distance).collect())
    }

    /// The light of a hit, for all combinations of decisions that bounds leave open. `follow` runs the kernel, and `rest`
    /// finds the light of the state that it leaves. `surfaces` counts the surfaces of the sample, up to `most`.
    pub(crate) fn legal_outcomes<T>(
        &self,
        (address, state, hit): (Address, &RayState, RayHit),
        (surfaces, most): (&mut u32, u32),
        follow: impl Fn(&mut Kernel<'_>) -> Result<T, Mismatch>,
        rest: impl Fn(T, RayState, &mut u32) -> Option<LegalSample>,
    ) -> Option<LegalSample> {
        let (mut choices, mut all) = (Choices::default(), None);
        loop {
            *surfaces += 1;
            if *surfaces > most {
                return None;
            }
            let mut kernel = self.kernel(address, state, &mut choices);
            (kernel.hit, kernel.after) = (hit, Output::Legal(Box::new(state.clone())));
            // A combination of decisions that no device takes is a mismatch.
            if let (Ok(met), Output::Legal(after)) = (follow(&mut kernel), kernel.after) {
                rest(met, *after, surfaces)?.join(&mut all);
            }
            if !choices.advance() {
                break;
            }
        }
        all.filter(|_| !choices.were_too_many())
    }
}

/// The hits that are legal, each `apart` nearer or farther, with the distance before that of its sphere.
fn ray_hits(legal: &LegalHits, apart: f64, distance: impl Fn(u32) -> Number) -> impl Iterator<Item = RayHit> {
    let found = legal.spheres.iter().flat_map(move |hit| {
        let distance = distance(hit.id);
        hit.crossings().filter(|side| side.low <= legal.limit).map(move |side| RayHit {
            t: Number::between((side.low - apart).max(0.0), side.high + apart),
            distance,
            id: hit.id,
            shape_index: 0,
        })
    });
    let miss = RayHit { t: Number::known(NO_HIT.into()), distance: Number::ZERO, id: NO_ID, shape_index: 0 };
    found.chain(legal.miss.then_some(miss))
}

/// The means of a pixel's samples.
#[derive(Clone, Debug)]
pub(crate) struct PixelLight {
    pub(crate) color: [Interval; 3],
    pub(crate) alpha: Interval,
    /// The mean colour of the first surfaces.
    pub(crate) albedo: [Interval; 3],
    /// The variance of the mean luminance.
    pub(crate) variance: Interval,
}

/// The light of a sample, and the colour of its first surface.
#[derive(Clone, Copy)]
pub(crate) struct LegalSample {
    pub(crate) light: Change,
    pub(crate) first: Vector,
}

impl LegalSample {
    /// Adds the sample to those that are legal.
    pub(crate) fn join(self, all: &mut Option<Self>) {
        *all = Some(all.map_or(self, |all| Self {
            light: all.light.union(self.light),
            first: all.first.zip(self.first, Number::union),
        }));
    }
}

/// A sum of intervals.
#[derive(Clone, Copy, Default)]
struct Mean {
    low: f64,
    high: f64,
    size: f64,
}

impl Mean {
    fn add(&mut self, more: Interval) {
        self.low += more.low;
        self.high += more.high;
        self.size += more.low.abs().max(more.high.abs());
    }

    /// The mean of so many terms, with this error relative to the sum of their magnitudes.
    fn of(self, count: f64, relative: f64) -> Interval {
        let error = relative * self.size + 4.0 * count * FLUSH;
        Interval { low: (self.low - error) / count, high: (self.high + error) / count }
    }
}

/// The variance of the mean of luminances. The device subtracts the square of the mean from the mean of squares, of which
/// each has some roundings.
fn variance(luminances: &[Interval]) -> Interval {
    let count = luminances.len() as f64;
    if count < 2.0 {
        return Interval::ZERO;
    }
    let mut mean = Mean::default();
    luminances.iter().for_each(|light| mean.add(*light));
    let middle = 0.5 * (mean.low + mean.high) / count;
    let (mut least, mut most, mut squares) = (0.0, 0.0, 0.0);
    for light in luminances {
        let (low, high) = (light.low - middle, light.high - middle);
        least += low.max(-high).max(0.0).powi(2);
        most += low.powi(2).max(high.powi(2));
        squares += light.low.powi(2).max(light.high.powi(2));
    }
    let aside = (0.5 * (mean.high - mean.low) / count).powi(2);
    let error = PAD * 24.0 * U * squares / count + 4.0 * FLUSH;
    let spread = Interval { low: (least / count - aside - error).max(0.0), high: most / count + error };
    let relative = PAD * 2.0 * U;
    Interval {
        low: spread.low / (count - 1.0) * (1.0 - relative),
        high: spread.high / (count - 1.0) * (1.0 + relative),
    }
}

/// The state of a ray at the camera, without its origin and its direction.
fn start() -> PathState {
    let mut state = PathState::EMPTY;
    state.slots[slot::ORIGIN][3] = flag::ALIVE | flag::FULL;
    state.slots[slot::DEPARTURE][0] = NO_ID;
    state.slots[slot::THROUGHPUT] = [1.0_f32.to_bits(); 4];
    state
}
