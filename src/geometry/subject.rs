//! The subject of a camera: the spheres or the box that it frames.

use glam::DVec3;

use crate::geometry::bounds::Bounds;
use crate::geometry::cone::ConeInFrame;
use crate::parallel;

/// The spheres, or the box, that a camera frames so that all of it is in the picture.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The origin of the frame of the spheres, in world space.
    origin: DVec3,
    /// Centres in that frame, and radii. If there are no spheres, the box is framed.
    spheres: &'a [[f32; 4]],
    /// Cones in that frame.
    cones: &'a [ConeInFrame],
    /// The number of added spheres, which come after the spheres of the data.
    added: usize,
    bounds: Bounds,
    free_sides: [f64; 4],
    whole: Option<WholeSubject>,
}

/// Properties of all spheres of the data, given if the subject has only those that reach farthest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WholeSubject {
    pub(crate) mean_radius: f64,
    /// The corners of the box of the centres.
    pub(crate) centers: [[f32; 3]; 2],
}

impl From<Bounds> for Subject<'_> {
    fn from(bounds: Bounds) -> Self {
        Self::spheres(DVec3::ZERO, &[], bounds)
    }
}

impl From<&Bounds> for Subject<'_> {
    fn from(bounds: &Bounds) -> Self {
        (*bounds).into()
    }
}

impl<'a> Subject<'a> {
    /// A subject of spheres in a frame: centre (x, y, z) relative to `origin`, and radius. `bounds` is their box, which
    /// is framed if there are no spheres.
    pub(crate) fn spheres(origin: DVec3, spheres: &'a [[f32; 4]], bounds: Bounds) -> Self {
        Self { origin, spheres, cones: &[], added: 0, bounds, free_sides: [0.0; 4], whole: None }
    }

    /// The subject with cones.
    pub(crate) fn with_cones(self, cones: &'a [ConeInFrame]) -> Self {
        Self { cones, ..self }
    }

    /// The subject whose last `added` spheres are framed but do not affect the style.
    pub(crate) fn with_added(self, added: usize) -> Self {
        Self { added, ..self }
    }

    /// The spheres with the properties of the larger scene that reaches as far as they do.
    pub(crate) fn with_whole(self, whole: WholeSubject) -> Self {
        Self { whole: Some(whole), ..self }
    }

    /// The spheres of the data, or all spheres if the data has none.
    fn of_data(&self) -> &'a [[f32; 4]] {
        match self.spheres.len().saturating_sub(self.added) {
            0 => self.spheres,
            count => &self.spheres[..count],
        }
    }

    /// The subject, which a camera frames beside free parts of the picture, such as that of a legend. The free
    /// parts are on the sides of low x, high x, low y and high y of the film, as fractions of its width and height,
    /// each at most [`Subject::MOST_FREE`]. If the margin of the camera is larger, it is kept. Cameras whose pictures
    /// are round do not support free parts.
    #[must_use]
    pub fn with_free_sides(self, free_sides: [f64; 4]) -> Self {
        let free_sides = free_sides.map(|side| if side > 0.0 { side.min(Self::MOST_FREE) } else { 0.0 });
        Self { free_sides, ..self }
    }

    /// The largest fraction of the picture that can be free on one side.
    pub const MOST_FREE: f64 = 0.45;

    /// The fractions of the picture that are free on the sides of low x, high x, low y and high y.
    pub(crate) fn free_sides(&self) -> [f64; 4] {
        self.free_sides
    }

    /// The axis-aligned box in world space.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// True if there are no shapes, so that the box itself is framed.
    pub(crate) fn is_box(&self) -> bool {
        self.spheres.is_empty() && self.cones.is_empty()
    }

    /// The spheres that may reach farthest in some direction, with some others. [`Subject::supports`] returns the same for
    /// them, and takes less time.
    ///
    /// For each of the eight diagonal directions there is a centre that lies farthest in it. A box whose corners are no
    /// farther out along any axis than the centre of their own diagonal is within the hull of the eight centres: for every
    /// direction n, the centre of the diagonal with the signs of n reaches as far as the box. So spheres in that box never
    /// reach farthest.
    pub(crate) fn outer_spheres(&self) -> Vec<[f32; 4]> {
        if self.spheres.is_empty() {
            return Vec::new();
        }
        let signs: [[f32; 3]; 8] = std::array::from_fn(|k| [0, 1, 2].map(|i| if k >> i & 1 == 1 { 1.0 } else { -1.0 }));
        let along = |[a, b, c]: [f32; 3], [x, y, z, _]: [f32; 4]| a * x + b * y + c * z;
        let most_of = |_, chunk: &'a [[f32; 4]]| {
            let farther = |most: [f32; 8], sphere: &[f32; 4]| -> [f32; 8] {
                std::array::from_fn(|k| most[k].max(along(signs[k], *sphere)))
            };
            (chunk, chunk.iter().fold([f32::NEG_INFINITY; 8], farther))
        };
        let chunks = parallel::map_chunks(self.spheres, most_of);
        let farthest: [[f32; 4]; 8] = std::array::from_fn(|k| {
            let (chunk, _) = chunks.iter().max_by(|(_, a), (_, b)| a[k].total_cmp(&b[k])).copied().unwrap_or_default();
            let order = |a: &&[f32; 4], b: &&[f32; 4]| along(signs[k], **a).total_cmp(&along(signs[k], **b));
            chunk.iter().max_by(order).copied().unwrap_or_default()
        });
        let end = |axis: usize, side: f32| {
            let centers = farthest.iter().zip(signs).filter(|(_, signs)| signs[axis] * side > 0.0);
            side * centers.map(|(center, _)| side * center[axis]).fold(f32::INFINITY, f32::min)
        };
        let box_of = [0, 1, 2].map(|axis| [end(axis, -1.0), end(axis, 1.0)].map(f64::from));
        // Supports are rounded, so that a sphere at the side of the box could reach farther by the last bit.
        let slack = 1e-9 * box_of.iter().flatten().fold(0.0, |most: f64, end| most.max(end.abs()));
        let is_outer = |sphere: &&[f32; 4]| {
            let [x, y, z, radius] = sphere.map(f64::from);
            [x, y, z].iter().zip(&box_of).any(|(x, [low, high])| x - radius < low + slack || x + radius > high - slack)
        };
        let outer = |_, chunk: &[[f32; 4]]| chunk.iter().filter(is_outer).copied().collect::<Vec<_>>();
        parallel::map_chunks(self.spheres, outer).concat()
    }

    /// The subject with other spheres.
    pub(crate) fn with_spheres<'b>(&self, spheres: &'b [[f32; 4]]) -> Subject<'b>
    where
        'a: 'b,
    {
        Subject { spheres, ..*self }
    }

    /// The reach of the subject along each direction, measured from the middle of its box. It is the largest n·p of all
    /// its points p. The directions need not have unit length.
    ///
    /// This is the support function. For a sphere with the centre c and the radius r it is n·c + |n|·r, and for a disc with
    /// the unit normal a it is n·c + |n − (n·a) a|·r.
    #[must_use]
    pub fn supports<const N: usize>(&self, directions: [DVec3; N]) -> [f64; N] {
        let center = self.bounds.center();
        let lengths = directions.map(DVec3::length);
        let most = |a: [f64; N], b: [f64; N]| std::array::from_fn(|i| a[i].max(b[i]));
        let nothing = [f64::NEG_INFINITY; N];
        if self.is_box() {
            let corners = self.bounds.corners().map(|corner| corner - center);
            return corners.map(|corner| directions.map(|n| n.dot(corner))).into_iter().fold(nothing, most);
        }
        let shift = self.origin - center;
        let of_chunk = |_, chunk: &[[f32; 4]]| {
            chunk.iter().fold(nothing, |reach, sphere| {
                let [x, y, z, radius] = sphere.map(f64::from);
                let c = shift + DVec3::new(x, y, z);
                most(reach, std::array::from_fn(|i| directions[i].dot(c) + lengths[i] * radius))
            })
        };
        let reach = parallel::map_chunks(self.spheres, of_chunk).into_iter().fold(nothing, most);
        let of_cones = |_, chunk: &[ConeInFrame]| {
            let reach_of = |cone: &ConeInFrame| {
                let axis = cone.axis();
                directions.map(|n| n.dot(shift) + cone.support(axis, n))
            };
            chunk.iter().fold(nothing, |reach, cone| most(reach, reach_of(cone)))
        };
        parallel::map_chunks(self.cones, of_cones).into_iter().fold(reach, most)
    }

    /// The axis (0, 1 or 2) along which all centres of the data's spheres lie in one plane, if there is exactly one.
    #[must_use]
    pub fn flat_axis(&self) -> Option<usize> {
        let joined = |[low, high]: [[f32; 3]; 2], [l, h]: [[f32; 3]; 2]| {
            let lower = std::array::from_fn(|i| low[i].min(l[i]));
            [lower, std::array::from_fn(|i| high[i].max(h[i]))]
        };
        let of_chunk = |_, chunk: &[[f32; 4]]| chunk.iter().map(|&[x, y, z, _]| [[x, y, z]; 2]).reduce(joined);
        let extents = || parallel::map_chunks(self.of_data(), of_chunk).into_iter().flatten().reduce(joined);
        let [low, high] = self.whole.map(|whole| whole.centers).or_else(extents)?;
        let sizes: [f32; 3] = std::array::from_fn(|i| high[i] - low[i]);
        let widest = sizes.into_iter().fold(0.0, f32::max);
        let mut flat = (0..3).filter(|i| sizes[*i] <= 1e-6 * widest);
        flat.next().filter(|_| flat.next().is_none())
    }

    /// The mean radius of the data's spheres. `None` for a box.
    #[must_use]
    pub fn mean_radius(&self) -> Option<f64> {
        if let Some(whole) = self.whole {
            return Some(whole.mean_radius);
        }
        let of_chunk = |_, chunk: &[[f32; 4]]| chunk.iter().map(|s| f64::from(s[3])).sum::<f64>();
        let sum: f64 = parallel::map_chunks(self.of_data(), of_chunk).into_iter().sum();
        (!self.spheres.is_empty()).then(|| sum / self.of_data().len() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Not all spheres of a ball or a block are left, which reach as far in every direction. So do those of a scene without
    /// an inside.
    #[test]
    fn outer_spheres_reach_as_far_as_all() {
        let mut rng = fastrand::Rng::with_seed(2);
        for (shape, most) in [(0, 0.9), (1, 0.5), (2, 1.0)] {
            let mut number = || 2.0 * rng.f32() - 1.0;
            let spheres: Vec<[f32; 4]> = (0..3_000)
                .map(|_| [number(), number(), number(), 0.05 * number().abs()])
                .map(|[x, y, z, r]| [x, y, if shape == 2 { 0.0 } else { z }, r])
                .filter(|[x, y, z, _]| shape > 0 || x * x + y * y + z * z < 1.0)
                .collect();
            let subject = Subject::spheres(DVec3::X, &spheres, Bounds::between(DVec3::NEG_ONE, DVec3::ONE));
            let outer = subject.outer_spheres();
            assert!(!outer.is_empty() && outer.len() as f32 <= most * spheres.len() as f32, "{shape}: {}", outer.len());
            for _ in 0..300 {
                let direction = DVec3::new(number().into(), number().into(), number().into());
                let reach = |subject: &Subject<'_>| subject.supports([direction]).map(f64::to_bits);
                assert_eq!(reach(&subject.with_spheres(&outer)), reach(&subject));
            }
        }
    }
}
