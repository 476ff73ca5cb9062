//! Cones as what hides light: pieces that are not much longer than they are thick, each in a ball, so that they are sorted
//! by size and place as spheres are.

use glam::DVec3;

use crate::geometry::cone::ConeInFrame;
use crate::scene::SharedShapes;

/// The length of a piece, in terms of its largest radius and of the side of cells. The larger one counts.
const LENGTH: [f64; 2] = [3.0, 2.0];

/// The most pieces beside one for each cone. For more, all pieces are longer.
const MOST: f64 = 4e6;

/// The part of a cone between two places on its axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Index among the cones.
    pub(super) cone: u32,
    /// The places, as parts of the axis.
    pub(super) from: f32,
    pub(super) to: f32,
}

/// A cone, and a place on its axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) start: DVec3,
    /// From the start to the end.
    pub(super) span: DVec3,
    pub(super) length: f64,
    radii: [f64; 2],
}

impl Axis {
    pub(super) fn of(cone: &ConeInFrame) -> Self {
        let [start, end] = cone.ends();
        Self { start, span: end - start, length: (end - start).length(), radii: cone.radii() }
    }

    pub(super) fn at(&self, part: f64) -> DVec3 {
        self.start + part * self.span
    }

    pub(super) fn radius(&self, part: f64) -> f64 {
        self.radii[0] + part * (self.radii[1] - self.radii[0])
    }

    /// The radius of the largest ball around a point of the axis that is inside the cone.
    fn inner_radius(&self, part: f64) -> f64 {
        let cosine = self.length / self.length.hypot(self.radii[1] - self.radii[0]);
        (self.radius(part) * cosine).min(part * self.length).min((1.0 - part) * self.length)
    }
}

/// The pieces of all cones of a scene, and balls for its spheres and for them. Without cones, there are none.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    pub(super) all: Vec<Piece>,
    /// The spheres, and then a ball around each piece.
    pub(super) balls: Vec<[f32; 4]>,
}

impl Pieces {
    /// Pieces for cells of this side.
    pub(super) fn new(side: f64, shapes: &SharedShapes) -> Self {
        if shapes.cones.is_empty() {
            return Self::default();
        }
        let wanted = |cone: &ConeInFrame, grown: f64| {
            let axis = Axis::of(cone);
            let radius = axis.radius(0.0).max(axis.radius(1.0));
            (axis.length / (LENGTH[0] * radius).max(LENGTH[1] * side) / grown).ceil().max(1.0)
        };
        let beside = |grown: f64| shapes.cones.iter().map(|cone| wanted(cone, grown) - 1.0).sum::<f64>();
        let mut grown = 1.0;
        while beside(grown) > MOST {
            grown *= 2.0;
        }
        let (mut all, mut balls) = (Vec::new(), shapes.spheres.clone());
        for (index, cone) in (0..).zip(&shapes.cones) {
            let (axis, count) = (Axis::of(cone), wanted(cone, grown));
            for number in 0..count as u32 {
                let [from, to] = [0.0, 1.0].map(|end| (f64::from(number) + end) / count);
                let half = 0.5 * (to - from) * axis.length;
                let radius = half.hypot(axis.radius(from).max(axis.radius(to))) * (1.0 + 1e-6);
                let [x, y, z] = axis.at(0.5 * (from + to)).as_vec3().to_array();
                balls.push([x, y, z, radius as f32]);
                all.push(Piece { cone: index, from: from as f32, to: to as f32 });
            }
        }
        Self { all, balls }
    }

    /// The pieces, with their balls.
    pub(super) fn with_balls<'a>(&'a self, shapes: &SharedShapes) -> impl Iterator<Item = (&'a Piece, &'a [f32; 4])> {
        self.all.iter().zip(self.balls.iter().skip(shapes.spheres.len()))
    }
}

impl Piece {
    /// Balls inside the cone that fill the piece.
    pub(super) fn beads(self, cone: &ConeInFrame) -> impl Iterator<Item = (DVec3, f64)> {
        let axis = Axis::of(cone);
        let [from, to] = [self.from, self.to].map(f64::from);
        let mean = 0.5 * (axis.radius(from) + axis.radius(to));
        let count = ((to - from) * axis.length / mean).ceil().clamp(1.0, 16.0);
        (0..count as u32).map(move |number| {
            let part = from + (f64::from(number) + 0.5) / count * (to - from);
            (axis.at(part), axis.inner_radius(part))
        })
    }

    /// The piece as a cone.
    pub(super) fn cut(self, cone: &ConeInFrame) -> ConeInFrame {
        let axis = Axis::of(cone);
        let [from, to] = [self.from, self.to].map(f64::from);
        let place = |part: f64| axis.at(part).as_vec3().to_array();
        ConeInFrame {
            start: place(from),
            first_radius: axis.radius(from) as f32,
            end: place(to),
            second_radius: axis.radius(to) as f32,
        }
    }
}
