//! The unit normals that a device may write for a hit.

use glam::DVec3;

use crate::geometry::cone::ConeInFrame;
use crate::scene::Shape;
use crate::verify::cone::{LegalConeHit, LegalConeHits};
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::{PAD, unit_error};
use crate::verify::sphere::{Chord, Line, Slack, SphereTest, normal_at};

/// The unit normals that a device may write: all normals within a distance of one of these.
#[derive(Clone, Debug, Default)]
pub(super) struct LegalNormals {
    /// Those of a sphere.
    sides: [Option<(DVec3, f64)>; 2],
    of_cone: Vec<(DVec3, f64)>,
    /// The largest deviation from unit length.
    off_unit: f64,
}

impl LegalNormals {
    /// The legal normals of a shape for a ray, or for a ray within `slack` of it.
    pub(super) fn new(line: &Line, shape: Shape, slack: Slack) -> Self {
        match shape {
            Shape::Sphere(sphere) => Self::of_sphere(line, sphere, slack),
            Shape::Cone(cone) => Self::of_cone(line, &cone, slack),
        }
    }

    fn of_sphere(line: &Line, sphere: [f32; 4], slack: Slack) -> Self {
        let Some(test) = SphereTest::new(line, sphere, slack) else {
            return Self::default();
        };
        let side = |is_behind: bool| {
            let chord = Chord { half: test.half, exact: test.exact_half(), is_behind };
            normal_at(&test, line, chord, sphere[3], slack)
        };
        let sides = [test.may_start_outside().then(|| side(false)), test.may_start_inside().then(|| side(true))];
        Self { sides, of_cone: Vec::new(), off_unit: unit_error(sphere[3].into()) }
    }

    fn of_cone(line: &Line, cone: &ConeInFrame, slack: Slack) -> Self {
        let legal = LegalConeHits::of(line, slack, cone);
        if legal.is_open {
            return Self { of_cone: vec![(DVec3::ZERO, 4.0)], off_unit: f64::INFINITY, ..Self::default() };
        }
        let ball = |hit: &LegalConeHit| {
            let (middle, half) = Vector(hit.normal.map(|c| Number::between(c.low, c.high))).ball();
            (middle, PAD * half.length())
        };
        Self {
            of_cone: legal.hits.iter().map(ball).collect(),
            off_unit: legal.hits.iter().fold(0.0, |most, hit| hit.off_unit.max(most)),
            ..Self::default()
        }
    }

    /// The distance of a normal from the nearest exact normal, relative to its bound. Above 1 it is not legal.
    pub(super) fn fraction(&self, normal: DVec3) -> f64 {
        let fractions = self.crossings().map(|(exact, error)| (normal - exact).length() / error);
        // `f64::min` would ignore NaN.
        fractions.reduce(|a, b| if a < b { a } else { b }).unwrap_or(f64::INFINITY)
    }

    /// True for a normal whose length is 1, up to the errors of a device.
    pub(super) fn is_unit(&self, normal: DVec3) -> bool {
        (normal.length() - 1.0).abs() <= self.off_unit
    }

    /// The exact normal and the bound of its error, if there is only one.
    pub(super) fn only(&self) -> Option<(DVec3, f64)> {
        let mut all = self.crossings();
        all.next().filter(|_| all.next().is_none())
    }

    /// The exact normals, and the bounds of their errors.
    pub(super) fn crossings(&self) -> impl Iterator<Item = (DVec3, f64)> {
        self.sides.into_iter().flatten().chain(self.of_cone.iter().copied())
    }
}
