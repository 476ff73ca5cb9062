//! A device that does whatever WGSL leaves it free to do, at random: for tests that it is never accused.

use fastrand::Rng;

/// How it rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Habit {
    /// As every real device.
    Nearest,
    /// Always up, or always down: errors add up.
    Up,
    Down,
    /// Either neighbour, each time anew; fused or not; sums in any order; quotients and roots off by what
    /// they may be; small numbers become zero.
    Random,
}

pub(crate) struct LegalDevice {
    pub(crate) habit: Habit,
    pub(crate) random: Rng,
}

/// Where its sphere test ends.
pub(crate) const NO_HIT: f32 = 1e30;

impl LegalDevice {
    /// One of the neighbours of a number, or the number itself if there is such an f32.
    fn round(&mut self, exact: f64) -> f32 {
        let nearest = exact as f32;
        let (down, up) = match f64::from(nearest).total_cmp(&exact) {
            std::cmp::Ordering::Equal => (nearest, nearest),
            std::cmp::Ordering::Less => (nearest, nearest.next_up()),
            std::cmp::Ordering::Greater => (nearest.next_down(), nearest),
        };
        let rounded = match self.habit {
            Habit::Nearest => nearest,
            Habit::Up => up,
            Habit::Down => down,
            Habit::Random => {
                if self.random.bool() {
                    up
                } else {
                    down
                }
            }
        };
        if self.habit == Habit::Random && rounded.is_subnormal() && self.random.bool() {
            0.0
        } else {
            rounded
        }
    }

    /// Off by up to so many ULP.
    fn off(&mut self, exact: f64, ulps: f64) -> f32 {
        let rounded = self.round(exact);
        if self.habit == Habit::Nearest || rounded == 0.0 {
            return rounded;
        }
        let ulp = f64::from(rounded.abs().next_up()) - f64::from(rounded.abs());
        let part = match self.habit {
            Habit::Up => 1.0,
            Habit::Down => -1.0,
            _ => self.random.f64() * 2.0 - 1.0,
        };
        // Truncated, so that it is off by no more.
        let off = exact + part * (ulps - 0.5) * ulp * 0.99;
        off as f32
    }

    fn add(&mut self, a: f32, b: f32) -> f32 {
        self.round(f64::from(a) + f64::from(b))
    }

    fn mul(&mut self, a: f32, b: f32) -> f32 {
        self.round(f64::from(a) * f64::from(b))
    }

    /// a b + c, perhaps fused.
    fn mul_add(&mut self, a: f32, b: f32, c: f32) -> f32 {
        if self.habit == Habit::Random && self.random.bool() {
            self.round(f64::from(a) * f64::from(b) + f64::from(c))
        } else {
            let product = self.mul(a, b);
            self.add(product, c)
        }
    }

    fn divide(&mut self, a: f32, b: f32) -> f32 {
        self.off(f64::from(a) / f64::from(b), 2.5)
    }

    fn sqrt(&mut self, a: f32) -> f32 {
        self.off(f64::from(a).sqrt(), 4.5)
    }

    /// A sum of products, in any order.
    fn dot(&mut self, products: &mut [(f32, f32)]) -> f32 {
        if self.habit == Habit::Random {
            self.random.shuffle(products);
        }
        let mut sum = self.mul(products[0].0, products[0].1);
        for (a, b) in &products[1..] {
            sum = self.mul_add(*a, *b, sum);
        }
        sum
    }

    /// `intersect_sphere` of shaders/sphere.wgsl.
    pub(crate) fn intersect(
        &mut self,
        (origin, direction): ([f32; 3], [f32; 3]),
        [x, y, z, radius]: [f32; 4],
    ) -> f32 {
        let center = [x, y, z];
        let d = direction;
        let l = [0, 1, 2].map(|k| self.add(center[k], -origin[k]));
        let b = self.dot(&mut [(l[0], d[0]), (l[1], d[1]), (l[2], d[2])]);
        let f = [0, 1, 2].map(|k| self.mul_add(-b, d[k], l[k]));
        let squares = |v: [f32; 3], sign: f32| v.map(|x| (sign * x, x));
        let [fx, fy, fz] = squares(f, -1.0);
        let discriminant = self.dot(&mut [(radius, radius), fx, fy, fz]);
        let [lx, ly, lz] = squares(l, 1.0);
        let c = self.dot(&mut [lx, ly, lz, (-radius, radius)]);
        let half_chord = self.sqrt(discriminant.max(0.0));
        let from_foot = if c > 0.0 { -half_chord } else { half_chord };
        let t = if self.mul(b, from_foot) >= 0.0 {
            self.add(b, from_foot)
        } else {
            let divisor = self.add(b, -from_foot);
            self.divide(c, divisor)
        };
        if discriminant >= 0.0 && t > 0.0 { t } else { NO_HIT }
    }
}
