//! The cameras of a simulated device that uses all the freedom of WGSL.

use std::f64::consts::PI;

use pinhole::camera::CameraKind;
use pinhole::verify::UploadedView;

use super::legal_device::{Habit, LegalDevice};

/// A ray before it is moved to the scene's box.
pub(crate) struct LegalRay {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    pub(crate) distance: f32,
    pub(crate) is_seen: bool,
}

impl LegalDevice {
    /// Does what `camera_ray` of the cameras in `shaders/camera` does.
    pub(crate) fn camera_ray(
        &mut self,
        kind: CameraKind,
        view: &UploadedView,
        [x, y]: [f32; 2],
        lens: [f32; 2],
    ) -> LegalRay {
        let (right, up, forward) = (view.right, view.up, view.forward);
        match kind {
            CameraKind::Orthographic => {
                let origin = self.vector(|this, k| this.dot(&mut [(x, right[k]), (y, up[k]), (1.0, view.origin[k])]));
                LegalRay { origin, direction: forward, distance: view.advance, is_seen: true }
            }
            CameraKind::Pinhole => {
                let aside = self.vector(|this, k| this.dot(&mut [(x, right[k]), (y, up[k])]));
                let toward = self.vector(|this, k| this.dot(&mut [(x, right[k]), (y, up[k]), (1.0, forward[k])]));
                let (direction, length) = self.unit(toward);
                let origin = self.vector(|this, k| this.mul_add(view.advance, aside[k], view.origin[k]));
                let distance = self.mul(view.advance, length);
                LegalRay { origin, direction, distance, is_seen: true }
            }
            CameraKind::ThinLens => self.thin_lens(view, [x, y], lens),
            CameraKind::Panorama => self.panorama(view, [x, y]),
            CameraKind::Fisheye => self.fisheye(view, [x, y]),
            other => panic!("{other:?} has no legal device"),
        }
    }

    /// A vector divided by its length, and its length.
    fn unit(&mut self, toward: [f32; 3]) -> ([f32; 3], f32) {
        let squared = self.dot(&mut toward.map(|x| (x, x)));
        let length = self.sqrt(squared);
        let inverse = self.divide(1.0, length);
        (self.vector(|this, k| this.mul(toward[k], inverse)), length)
    }

    /// The vector a p + b q.
    fn sum(&mut self, a: f32, p: [f32; 3], b: f32, q: [f32; 3]) -> [f32; 3] {
        self.vector(|this, k| this.dot(&mut [(a, p[k]), (b, q[k])]))
    }

    fn thin_lens(&mut self, view: &UploadedView, [x, y]: [f32; 2], lens: [f32; 2]) -> LegalRay {
        let (right, up, forward) = (view.right, view.up, view.forward);
        let [first, second, _] = view.numbers;
        let disk = self.concentric_disk(lens);
        let on_lens = [self.mul(disk[0], first), self.mul(disk[1], second)];
        let offset = self.sum(on_lens[0], right, on_lens[1], up);
        let aside = self.sum(x, right, y, up);
        let toward = self.vector(|this, k| this.dot(&mut [(1.0, aside[k]), (1.0, forward[k]), (-1.0, offset[k])]));
        let (direction, length) = self.unit(toward);
        let far = self.vector(|this, k| this.mul(view.advance, aside[k]));
        let before = self.add(1.0, -view.advance);
        let near = self.vector(|this, k| this.mul(before, offset[k]));
        let origin = self.vector(|this, k| this.dot(&mut [(1.0, view.origin[k]), (1.0, far[k]), (1.0, near[k])]));
        let distance = self.mul(view.advance, length);
        LegalRay { origin, direction, distance, is_seen: true }
    }

    fn panorama(&mut self, view: &UploadedView, [x, y]: [f32; 2]) -> LegalRay {
        let [aside, straight, left] = view.numbers;
        let [sin, cos] = self.sin_cos_half_turns(x);
        let heading = self.sum(sin, view.right, cos, view.forward);
        let tangent = self.sum(cos, view.right, -sin, view.forward);
        let [sin, cos] = self.sin_cos_half_turns(0.5 * y);
        let ahead = self.sum(cos, heading, sin, view.up);
        let toward = self.sum(straight, ahead, -left, tangent);
        let (direction, _) = self.unit(toward);
        let origin = self.sum(1.0, view.origin, aside, tangent);
        LegalRay { origin, direction, distance: 0.0, is_seen: true }
    }

    fn fisheye(&mut self, view: &UploadedView, [x, y]: [f32; 2]) -> LegalRay {
        let [first, second, half_angle] = view.numbers;
        let spot = [self.mul(x, first), self.mul(y, second)];
        let squared = self.dot(&mut spot.map(|x| (x, x)));
        let radius = if squared > 0.0 { self.sqrt(squared) } else { 0.0 };
        let part = self.mul(radius.min(1.0), half_angle);
        let [sin, cos] = self.sin_cos_half_turns(part);
        let least = radius.max(2_f32.powi(-40));
        let side = spot.map(|x| self.divide(x, least));
        let aside = self.sum(side[0], view.right, side[1], view.up);
        let toward = self.sum(sin, aside, cos, view.forward);
        let (direction, _) = self.unit(toward);
        LegalRay { origin: view.origin, direction, distance: 0.0, is_seen: radius <= 1.0 }
    }

    /// Does what the function of shaders/math/disk.wgsl does.
    fn concentric_disk(&mut self, square: [f32; 2]) -> [f32; 2] {
        let spot = square.map(|x| self.mul_add(2.0, x, -1.0));
        let is_wide = spot[0].abs() > spot[1].abs();
        let (radius, along) = if is_wide { (spot[0], spot[1]) } else { (spot[1], spot[0]) };
        let part = self.divide(along, if radius == 0.0 { 1.0 } else { radius });
        let pi = self.round(PI);
        let angle = self.mul(0.25 * pi, part);
        let [sin, cos] = self.sin_cos_eighth(angle);
        let point = if is_wide { [cos, sin] } else { [sin, cos] };
        point.map(|x| self.mul(radius, x))
    }

    /// Does what the functions of shaders/math/trigonometry.wgsl do.
    fn sin_cos_half_turns(&mut self, half_turns: f32) -> [f32; 2] {
        let quarters = (2.0 * half_turns).round_ties_even();
        let rest = half_turns - 0.5 * quarters;
        let pi = self.round(PI);
        let angle = self.mul(pi, rest);
        let [sin, cos] = self.sin_cos_eighth(angle);
        match (quarters as i32).rem_euclid(4) {
            0 => [sin, cos],
            1 => [cos, -sin],
            2 => [-sin, -cos],
            _ => [-cos, sin],
        }
    }

    fn sin_cos_eighth(&mut self, angle: f32) -> [f32; 2] {
        let z = self.mul(angle, angle);
        let sine = [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0];
        let cosine = [-1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0, -1.0 / 3_628_800.0];
        let sine = self.polynomial(&sine, z, angle);
        let cosine = self.polynomial(&cosine, z, 1.0);
        [self.add(angle, sine), self.add(1.0, cosine)]
    }

    /// The polynomial factor · z · (c₀ + z (c₁ + …)), as written or multiplied out.
    fn polynomial(&mut self, coefficients: &[f64], z: f32, factor: f32) -> f32 {
        let coefficients: Vec<f32> = coefficients.iter().map(|c| self.round(*c)).collect();
        if self.habit == Habit::Random && self.random.bool() {
            let mut power = factor;
            let mut products: Vec<(f32, f32)> = coefficients
                .iter()
                .map(|c| {
                    power = self.mul(power, z);
                    (*c, power)
                })
                .collect();
            return self.dot(&mut products);
        }
        let (last, others) = coefficients.split_last().unwrap();
        let sum = others.iter().rev().fold(*last, |sum, c| self.mul_add(z, sum, *c));
        let sum = self.mul(z, sum);
        self.mul(factor, sum)
    }
}
