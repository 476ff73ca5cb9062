//! A simulated device that uses, at random, all the freedom that WGSL leaves. The checker must never accuse it.

use fastrand::Rng;
use pinhole::camera::CameraKind;
use pinhole::camera::film::YAxis;
use pinhole::image::{NO_ID, Pixel};
use pinhole::internals::{ConeInFrame, NO_HIT};
use pinhole::verify::{Recording, TracedPixel, TracedRay, UploadedView};
use pinhole::{Film, Image, Scene};

/// The rounding of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Habit {
    /// To the nearest number, like most real devices, which compute in plain f32.
    Nearest,
    /// Always up, or always down, so that errors add up.
    Up,
    Down,
    /// Up for each bit that is set, lowest bit first, and else down. Quotients and roots are off by the legal limit.
    Chosen(u64),
    /// Randomly to either neighbour in each operation, with fused or separate products, and sums in any order.
    /// Quotients and roots have any legal error. Subnormal numbers become zero.
    Random,
}

pub(crate) struct LegalDevice {
    pub(crate) habit: Habit,
    pub(crate) random: Rng,
}

impl LegalDevice {
    /// Rounds a number to one of its neighbours, or returns the number itself if it is an f32.
    pub(crate) fn round(&mut self, exact: f64) -> f32 {
        let nearest = exact as f32;
        if self.habit == Habit::Nearest {
            return nearest;
        }
        let (down, up) = match f64::from(nearest).total_cmp(&exact) {
            std::cmp::Ordering::Equal => (nearest, nearest),
            std::cmp::Ordering::Less => (nearest, nearest.next_up()),
            std::cmp::Ordering::Greater => (nearest.next_down(), nearest),
        };
        let habit = self.habit;
        let rounded = match habit {
            Habit::Up => up,
            Habit::Chosen(_) if self.next_bit() => up,
            Habit::Random if self.random.bool() => up,
            _ => down,
        };
        if self.habit == Habit::Random && rounded.is_subnormal() && self.random.bool() { 0.0 } else { rounded }
    }

    /// The direction in which the next operation of [`Habit::Chosen`] rounds.
    fn next_bit(&mut self) -> bool {
        let Habit::Chosen(bits) = self.habit else { return false };
        self.habit = Habit::Chosen(bits.rotate_right(1));
        bits & 1 != 0
    }

    /// A result that is off by up to `ulps` ULP.
    pub(crate) fn off(&mut self, exact: f64, ulps: f64) -> f32 {
        let rounded = self.round(exact);
        if self.habit == Habit::Nearest || rounded == 0.0 {
            return rounded;
        }
        let ulp = f64::from(rounded.abs().next_up()) - f64::from(rounded.abs());
        let habit = self.habit;
        let part = match habit {
            Habit::Up => 1.0,
            Habit::Chosen(_) if self.next_bit() => 1.0,
            Habit::Down | Habit::Chosen(_) => -1.0,
            _ => self.random.f64() * 2.0 - 1.0,
        };
        // Truncated, so that the error does not exceed `ulps`.
        let off = exact + part * (ulps - 0.5) * ulp * 0.99;
        off as f32
    }

    pub(crate) fn add(&mut self, a: f32, b: f32) -> f32 {
        self.round(f64::from(a) + f64::from(b))
    }

    pub(crate) fn mul(&mut self, a: f32, b: f32) -> f32 {
        self.round(f64::from(a) * f64::from(b))
    }

    /// Computes a b + c, possibly fused.
    pub(crate) fn mul_add(&mut self, a: f32, b: f32, c: f32) -> f32 {
        if self.habit == Habit::Random && self.random.bool() {
            self.round(f64::from(a) * f64::from(b) + f64::from(c))
        } else {
            let product = self.mul(a, b);
            self.add(product, c)
        }
    }

    /// The quotient, or the product with the inverse, by which compilers may replace it.
    pub(crate) fn divide(&mut self, a: f32, b: f32) -> f32 {
        if matches!(self.habit, Habit::Chosen(_)) || self.habit != Habit::Nearest && self.random.bool() {
            let inverse = self.off(1.0 / f64::from(b), 2.5);
            return self.mul(a, inverse);
        }
        self.off(f64::from(a) / f64::from(b), 2.5)
    }

    pub(crate) fn sqrt(&mut self, a: f32) -> f32 {
        self.off(f64::from(a).sqrt(), 4.5)
    }

    /// The sum of products, in any order.
    pub(crate) fn dot(&mut self, products: &mut [(f32, f32)]) -> f32 {
        if self.habit == Habit::Random {
            self.random.shuffle(products);
        }
        let mut sum = self.mul(products[0].0, products[0].1);
        for (a, b) in &products[1..] {
            sum = self.mul_add(*a, *b, sum);
        }
        sum
    }

    /// The lines of `intersect_sphere` in shaders/scene/sphere.wgsl that lead to the roots.
    pub(crate) fn triangle(&mut self, ray: &TracedRay, [x, y, z, radius]: [f32; 4]) -> Triangle {
        let (center, d) = ([x, y, z], ray.direction);
        let l = [0, 1, 2].map(|k| self.add(center[k], -ray.origin[k]));
        let b = self.dot(&mut [0, 1, 2].map(|k| (l[k], d[k])));
        let foot = [0, 1, 2].map(|k| self.mul_add(-b, d[k], l[k]));
        let squares = |v: [f32; 3], sign: f32| v.map(|x| (sign * x, x));
        let [fx, fy, fz] = squares(foot, -1.0);
        let discriminant = match self.habit {
            // In the order of the kernel. Other habits may use any order.
            Habit::Nearest => self.dot(&mut [fx, fy, fz]) + radius * radius,
            _ => self.dot(&mut [(radius, radius), fx, fy, fz]),
        };
        let [lx, ly, lz] = squares(l, 1.0);
        let c = self.dot(&mut [lx, ly, lz, (-radius, radius)]);
        let half_chord = self.sqrt(discriminant.max(0.0));
        let from_foot = if c > 0.0 { -half_chord } else { half_chord };
        Triangle { b, foot, discriminant, c, from_foot }
    }

    /// Does what `intersect_sphere` of shaders/scene/sphere.wgsl does.
    pub(crate) fn intersect(&mut self, ray: &TracedRay, sphere: [f32; 4]) -> f32 {
        let Triangle { b, discriminant, c, from_foot, .. } = self.triangle(ray, sphere);
        let t = if self.mul(b, from_foot) >= 0.0 {
            self.add(b, from_foot)
        } else {
            let divisor = self.add(b, -from_foot);
            self.divide(c, divisor)
        };
        if discriminant >= 0.0 && t > 0.0 { t } else { NO_HIT }
    }
}

/// A distance that no ray reaches, `FAR` of `shaders/scene/cone_side.wgsl`.
const FAR: f32 = 1e30;

impl LegalDevice {
    fn dot_of(&mut self, a: [f32; 3], b: [f32; 3]) -> f32 {
        self.dot(&mut [0, 1, 2].map(|k| (a[k], b[k])))
    }

    /// The distance and the normal of a hit: does what `intersect` and `cone_normal` of shaders/scene/cone.wgsl do.
    pub(crate) fn cone(&mut self, ray: &TracedRay, cone: &ConeInFrame) -> (f32, [f32; 3]) {
        let (origin, d) = (ray.origin, ray.direction);
        let [first, second] = [cone.first_radius, cone.second_radius].map(f32::abs);
        let span = self.vector(|this, k| this.add(cone.end[k], -cone.start[k]));
        let square = self.dot_of(span, span);
        let length = self.sqrt(square.max(1e-37));
        let axis = self.vector(|this, k| this.divide(span[k], length));
        let widening = self.add(second, -first);
        let slope = self.divide(widening, length);
        let to_middle = self.vector(|this, k| {
            let to_start = this.add(cone.start[k], -origin[k]);
            this.mul_add(0.5, span[k], to_start)
        });
        let b = self.dot_of(to_middle, d);
        let foot = self.vector(|this, k| this.mul_add(b, d[k], -to_middle[k]));
        let (height, rise) = (self.dot_of(foot, axis), self.dot_of(d, axis));
        let away = self.vector(|this, k| this.mul_add(-height, axis[k], foot[k]));
        let aside = self.vector(|this, k| this.mul_add(-rise, axis[k], d[k]));
        let both = self.add(first, second);
        let radius = self.mul_add(slope, height, 0.5 * both);
        let growth = self.mul(slope, rise);

        let across = self.vector(|this, k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            this.dot(&mut [(d[i], axis[j]), (-d[j], axis[i])])
        });
        let sine = self.dot_of(across, across);
        let side = self.dot_of(foot, across);
        let tilt = self.dot_of(away, aside);
        let square = self.dot_of(away, away);
        let a = self.mul_add(-growth, growth, sine);
        let half_b = self.mul_add(-radius, growth, tilt);
        let c = self.mul_add(-radius, radius, square);
        let widened = self.mul(sine, radius);
        let of_cylinder = self.dot(&mut [(widened, radius), (-side, side)]);
        let of_growth = self.dot(&mut [(growth, square), (-2.0 * tilt, radius)]);
        let discriminant = self.mul_add(growth, of_growth, of_cylinder);
        let root = self.sqrt(discriminant.max(0.0));
        let to_far = if half_b < 0.0 { -root } else { root };
        let (sum, rest) = (self.add(half_b, to_far), self.add(half_b, -to_far));
        let is_flat = a.abs() < 2_f32.powi(-34);
        let one = match (is_flat, sum < 0.0) {
            (true, true) => FAR,
            (true, false) => -FAR,
            (false, _) => self.divide(-sum, a).clamp(-FAR, FAR),
        };
        let square_of_sum = self.mul(sum, sum);
        let size = square.max(self.mul(radius, radius));
        let is_quotient = is_flat || square_of_sum > self.mul(a.abs(), size);
        let two = if is_quotient {
            self.divide(-c, if sum == 0.0 { 1.0 / FAR } else { sum }).clamp(-FAR, FAR)
        } else {
            self.divide(-rest, a).clamp(-FAR, FAR)
        };
        let (low, high) = (one.min(two), one.max(two));
        let is_steep = a < 0.0 && !is_flat;
        let (side_in, side_out) = match (is_steep, growth > 0.0) {
            (false, _) => (low, high),
            (true, true) => (high, FAR),
            (true, false) => (-FAR, low),
        };

        let least = 2_f32.powi(-40);
        let risen = if rise.abs() >= least { rise } else { least * if rise < 0.0 { -1.0 } else { 1.0 } };
        let mut plane = |end: f32| {
            let way = self.add(end, -height);
            self.divide(way, risen)
        };
        let (at_start, at_end) = (plane(-0.5 * length), plane(0.5 * length));
        let (slab_in, slab_out) = (at_start.min(at_end), at_start.max(at_end));
        let (enters_disc, leaves_disc) = (slab_in > side_in, slab_out < side_out);
        let (enters, leaves) = (slab_in.max(side_in), slab_out.min(side_out));
        let is_crossed = (discriminant >= 0.0 || is_steep || is_flat) && enters <= leaves;
        let is_up = risen > 0.0;
        let [start_closed, end_closed] = [cone.first_radius, cone.second_radius].map(f32::is_sign_positive);
        let (closed_in, closed_out) = if is_up { (start_closed, end_closed) } else { (end_closed, start_closed) };
        let (near, far) = (self.add(b, enters), self.add(b, leaves));
        let is_near = is_crossed && (closed_in || !enters_disc) && near > 0.0;
        let is_far = is_crossed && (closed_out || !leaves_disc) && far > 0.0;
        let (t, from_foot, is_disc) = match (is_near, is_far) {
            (true, _) => (near, enters, enters_disc),
            (false, true) => (far, leaves, leaves_disc),
            (false, false) => (NO_HIT, leaves, leaves_disc),
        };
        if is_disc {
            return (t, if is_near == is_up { axis.map(|c| -c) } else { axis });
        }
        let outward = self.vector(|this, k| this.mul_add(from_foot, aside[k], away[k]));
        let radius = self.mul_add(from_foot, growth, radius);
        let sloped = self.mul(slope, radius);
        let normal = self.vector(|this, k| this.mul_add(-sloped, axis[k], outward[k]));
        let square = self.dot_of(normal, normal);
        if square < 1e-37 {
            return (t, if slope > 0.0 { axis.map(|c| -c) } else { axis });
        }
        let length = self.sqrt(square);
        (t, self.vector(|this, k| this.divide(normal[k], length)))
    }
}

/// The right triangle of ray, foot point and hit.
pub(crate) struct Triangle {
    b: f32,
    pub(crate) foot: [f32; 3],
    discriminant: f32,
    c: f32,
    pub(crate) from_foot: f32,
}

/// The kernels of a picture, in their order.
impl LegalDevice {
    pub(crate) fn vector(&mut self, mut component: impl FnMut(&mut Self, usize) -> f32) -> [f32; 3] {
        [0, 1, 2].map(|k| component(self, k))
    }

    /// Does what `relative_location` of shaders/camera/film.wgsl does.
    fn location(&mut self, film: &Film, pixel: [u32; 2]) -> [f32; 2] {
        let sign = if film.y_axis() == YAxis::Up { -1.0 } else { 1.0 };
        let along = |this: &mut Self, i: u32, side: u32| {
            let doubled = 2 * i64::from(i) + 1 - i64::from(side);
            this.divide(doubled as f32, side as f32)
        };
        let x = along(self, pixel[0], film.width());
        [x, sign * along(self, pixel[1], film.height())]
    }

    /// The ray of a pixel in the scene's box, and whether it meets the box.
    pub(crate) fn ray(
        &mut self,
        kind: CameraKind,
        view: &UploadedView,
        film: &Film,
        pixel: [u32; 2],
    ) -> (TracedRay, bool) {
        let location = self.location(film, pixel);
        let ray = self.camera_ray(kind, view, location, [0.5; 2]);
        let (entered, is_inside) = self.enter(view, ray.origin, ray.direction);
        let distance = self.add(ray.distance, entered.distance);
        (TracedRay { distance, ..entered }, ray.is_seen && is_inside)
    }

    /// Does what `enter_scene` of shaders/scene/enter.wgsl does. Also returns whether the ray meets the box.
    pub(crate) fn enter(&mut self, view: &UploadedView, origin: [f32; 3], direction: [f32; 3]) -> (TracedRay, bool) {
        let (mut near, mut far) = (0.0_f32, f32::MAX);
        for k in 0..3 {
            let size = direction[k].abs().max(2_f32.powi(-40));
            let inverse = self.divide(1.0, if direction[k] >= 0.0 { size } else { -size });
            let mut plane = |wall: f32| {
                let away = self.add(wall, -origin[k]);
                self.mul(away, inverse)
            };
            let (a, b) = (plane(view.scene_min[k]), plane(view.scene_max[k]));
            (near, far) = (near.max(a.min(b)), far.min(a.max(b)));
        }
        let origin = self.vector(|this, k| this.mul_add(near, direction[k], origin[k]));
        (TracedRay { origin, direction, distance: near }, near <= far)
    }

    /// Does what `sphere_normal` of shaders/scene/sphere.wgsl does.
    fn normal(&mut self, ray: &TracedRay, sphere: [f32; 4]) -> [f32; 3] {
        let Triangle { foot, from_foot, .. } = self.triangle(ray, sphere);
        let d = ray.direction;
        let outward = self.vector(|this, k| this.mul_add(from_foot, d[k], -foot[k]));
        let squared = self.dot(&mut outward.map(|x| (x, x)));
        let length = self.sqrt(squared);
        self.vector(|this, k| this.divide(outward[k], length))
    }

    /// Renders a picture of headlight-lit spheres and cones. `made` is a recording of the same view, of which only the device's
    /// input is used.
    pub(crate) fn record(&mut self, scene: &Scene, made: &Recording) -> Recording {
        let Recording { camera, uploaded, film, primary, .. } = made;
        let mut layers = Vec::new();
        let mut pixels = Vec::new();
        for j in 0..film.height() {
            for i in 0..film.width() {
                let (ray, is_inside) = self.ray(camera.kind, uploaded, film, [i, j]);
                let (mut t, mut id) = (NO_HIT, NO_ID);
                for (sphere, place) in scene.spheres().iter().zip(0..) {
                    let is_first = !scene.spheres()[..place as usize].contains(sphere);
                    if is_inside && is_first {
                        let here = self.intersect(&ray, *sphere);
                        if here < t {
                            (t, id) = (here, place);
                        }
                    }
                }
                for (cone, place) in scene.cones().iter().zip(scene.len() as u32..) {
                    let here = if is_inside { self.cone(&ray, cone).0 } else { NO_HIT };
                    if here < t {
                        (t, id) = (here, place);
                    }
                }
                let mut shading_ray = None;
                layers.push(if id == NO_ID {
                    Pixel::miss(primary.background.to_array())
                } else {
                    // Another kernel computes the ray again.
                    let (again, _) = self.ray(camera.kind, uploaded, film, [i, j]);
                    shading_ray = Some(again);
                    let normal = match scene.spheres().get(id as usize) {
                        Some(sphere) => self.normal(&again, *sphere),
                        None => self.cone(&again, &scene.cones()[id as usize - scene.len()]).1,
                    };
                    let d = again.direction;
                    let cosine = self.dot(&mut [0, 1, 2].map(|k| (normal[k], d[k]))).abs();
                    let color = scene.color(id).to_array().map(|c| self.mul(c, cosine));
                    let depth = self.add(ray.distance, t);
                    Pixel { color, depth, normal, id, ..Pixel::miss(color) }
                });
                pixels.push(TracedPixel { ray: Some(ray), t, id, shading_ray });
            }
        }
        let image = image_of(film, &layers);
        Recording { pixels, image, ..made.clone() }
    }
}

/// A picture with all layers of the pixels, row by row from the top.
fn image_of(film: &Film, pixels: &[Pixel]) -> Image {
    Image::from_layers(
        [film.width(), film.height()],
        pixels.iter().map(|pixel| pixel.color).collect(),
        pixels.iter().map(|pixel| pixel.depth).collect(),
        pixels.iter().map(|pixel| pixel.normal).collect(),
        pixels.iter().map(|pixel| pixel.id).collect(),
    )
    .unwrap()
}
