//! The rectangles of tiles in which spheres can be seen, from which lists of spheres for each tile are made
//! (`tile_lists.rs`). They need no structure. A tile is a square of [`SIDE`] pixels.
//!
//! # Why no sphere is lost
//! A kernel finds the hits of the ray that it made, which is not the exact ray. Rays of pixels are computed from the
//! numbers of a camera in f32, which the host takes as they are. In units of u = 2⁻²⁴, and of S, the length that
//! [`TileView::new`] adds up, a device's ray is off by less than 60 u S wherever it is in the scene's box: a test in
//! `gpu/headless/tile_plan.rs` compares this with the bounds of `verify/camera`. `slab.rs` shows that a ray that hits
//! according to the kernel comes within r + 51 u D of the centre, where D is the diagonal of the box, and the margin is
//! 128 u D. So the exact ray of a pixel that hits comes within r + margin + 64 u S of the centre, and the sphere with that
//! radius is seen there.
//!
//! The sphere is seen between the two planes through the eye that touch it and contain one side of the picture. A plane
//! at the location x has the normal x A + B, with A = right × up and B = forward × up. It touches a sphere with centre c
//! and radius r if (x A·c + B·c)² = r² |x A + B|², which is a quadratic equation. With N = A × B, its discriminant is
//! r² |N|² (ρ² − r²), where ρ is the distance of the centre from the axis through the eye along N, so that no difference
//! of large numbers is taken (Mara et al., "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere",
//! JCGT 2013, have the same bounds for cameras without a shift). Of a sphere through the eye's plane, which does not meet
//! the axis, the part in front is seen from one root on, on the side where the sphere meets the plane; a sphere that comes
//! near the axis is seen everywhere along it. All of this is in f64, whose errors are less than [`PAD`].
//!
//! The *near* distance of a sphere is a lower bound of `distance + t` of its hits in kernels: the reported point is
//! within r + margin of the centre, and the ray and its distances from the eye are off by less than 64 u (S + T), where T
//! is the largest distance of the box from the eye. The same again is left for rounding it, and for the sum.

use glam::DVec3;

use crate::geometry::math::unit;

/// Side of a tile in pixels: that of the workgroups of kernels.
pub(crate) const SIDE: u32 = 8;

/// Extra pixels on each side of a sphere's rectangle, for errors in f64: relative to the picture they are less than
/// 2⁻³², because spheres that come as near to an axis as [`NEAR_AXIS`] allows are seen everywhere along it.
const PAD: f64 = 1.0 / (1 << 12) as f64;

/// A sphere is near an axis if the square of its distance from there is at most that of its radius times 1 plus this.
const NEAR_AXIS: f64 = 1e-6;

/// The error of camera rays as a fraction of the lengths from which they are computed: 64 u.
const RAY_PART: f64 = 1.0 / (1 << 18) as f64;

/// The numbers of a camera on a device, and the part of its film that is rendered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileCamera {
    /// The eye in the scene's frame, or a point of the plane at which parallel rays start, moved by `advance` times
    /// `forward`.
    pub(crate) origin: DVec3,
    pub(crate) advance: f64,
    /// The vectors from the centre of the view plane to its right and lower sides, and from the eye to its centre.
    pub(crate) right: DVec3,
    pub(crate) down: DVec3,
    pub(crate) forward: DVec3,
    /// True if all rays have the direction `forward`.
    pub(crate) is_parallel: bool,
    /// Width and height of the whole film.
    pub(crate) film: [u32; 2],
    /// The first pixel of the part, and its size.
    pub(crate) first: [u32; 2],
    pub(crate) size: [u32; 2],
}

/// A camera, prepared for the rectangles of many spheres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileView {
    eye: DVec3,
    /// Unit vector, across which the plane through the eye lies.
    depth: DVec3,
    axes: [Axis; 2],
    is_parallel: bool,
    /// Number of tiles along each side.
    tiles: [u32; 2],
    /// The length that is added to radii, for rounding on the device.
    widening: f64,
    /// The length by which hits may be nearer than the nearest point of a sphere.
    nearer: f64,
}

/// Lists for tiles. The spheres of a tile are those from `starts[tile]` to `starts[tile + 1]`, with repetition: a sphere
/// is in the list of every tile in which it may be seen.
#[derive(Clone, Debug, Default)]
pub struct TileLists {
    /// Number of tiles along a row.
    pub columns: u32,
    /// For each tile, row by row, the place of its first sphere, and at the end the number of places.
    pub starts: Vec<u32>,
    /// For each place, a lower bound of the distance of hits from the eye, which never falls within a list.
    pub nears: Vec<f32>,
}

/// One axis of the picture: a location on it is a plane through the eye, or one along parallel rays.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// The normal of the plane at location x is x a + b.
    a: DVec3,
    b: DVec3,
    aa: f64,
    ab: f64,
    bb: f64,
    /// Unit vector of a × b, and its length.
    n: DVec3,
    n_length: f64,
    /// The size of b, and how much b · p grows from one location to the next along parallel rays.
    b_length: f64,
    b_per_location: f64,
    /// Half of the film's side in pixels.
    half: f64,
    /// The pixels of the part, as the first and the last.
    pixels: [f64; 2],
}

/// The tiles in which a sphere may be seen: the first and the last of each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TileRange {
    pub(crate) first: [u16; 2],
    pub(crate) last: [u16; 2],
}

impl TileRange {
    /// Number of tiles.
    pub(crate) fn count(&self) -> u64 {
        (0..2).map(|axis| u64::from(self.last[axis] - self.first[axis]) + 1).product()
    }
}

impl TileView {
    /// Prepares a camera for spheres with the given margin, whose box has these corners.
    /// `None` if the camera's vectors lie in a plane, up to rounding.
    pub(crate) fn new(camera: &TileCamera, margin: f64, corners: &[DVec3; 8]) -> Option<Self> {
        let TileCamera { origin, advance, right, down, forward, is_parallel, film, first, size } = *camera;
        let eye = origin - advance * forward;
        let axis = |along: DVec3, across: DVec3, index: usize| {
            let half = f64::from(film[index]) / 2.0;
            let pixels = [first[index], first[index] + size[index] - 1].map(f64::from);
            Axis::new(along, across, forward, half, pixels)
        };
        let depth = unit(right.cross(down))?;
        let farthest = |from: DVec3| corners.iter().map(|corner| (*corner - from).length()).fold(0.0, f64::max);
        let aside = (right.length() + down.length()) * if is_parallel { 1.0 } else { advance };
        let lengths = origin.length() + 2.0 * aside + farthest(origin);
        Some(Self {
            eye,
            depth: if depth.dot(forward) < 0.0 { -depth } else { depth },
            axes: [axis(right, down, 0)?, axis(down, right, 1)?],
            is_parallel,
            tiles: size.map(|side| side.div_ceil(SIDE)),
            widening: margin + RAY_PART * lengths,
            nearer: margin + 2.0 * RAY_PART * (farthest(eye) + lengths),
        })
    }

    /// The length that is added to radii.
    #[cfg(test)]
    pub(crate) fn widening(&self) -> f64 {
        self.widening
    }

    /// Number of tiles along a row.
    pub(crate) fn columns(&self) -> usize {
        self.tiles[0] as usize
    }

    /// Number of tiles.
    pub(crate) fn count(&self) -> usize {
        self.tiles.iter().map(|count| *count as usize).product()
    }

    /// The near distance of a sphere.
    #[inline]
    pub(crate) fn near(&self, [x, y, z, radius]: [f32; 4]) -> f32 {
        let center = DVec3::new(x.into(), y.into(), z.into()) - self.eye;
        let distance = if self.is_parallel { self.depth.dot(center) } else { center.length() };
        ((distance - f64::from(radius) - self.nearer) as f32).next_down()
    }

    /// The tiles in which a sphere may be seen. `None` if no ray of a pixel can hit it.
    #[inline]
    pub(crate) fn range(&self, [x, y, z, radius]: [f32; 4]) -> Option<TileRange> {
        let center = DVec3::new(x.into(), y.into(), z.into()) - self.eye;
        let wide = f64::from(radius) + self.widening;
        let depth = self.depth.dot(center);
        if depth <= -wide {
            return None;
        }
        let mut range = TileRange { first: [0; 2], last: self.tiles.map(|count| (count - 1) as u16) };
        for (index, axis) in self.axes.iter().enumerate() {
            let seen = if self.is_parallel { axis.parallel(center, wide) } else { axis.perspective(center, wide) };
            let [first, last] = axis.pixels_of(seen)?;
            (range.first[index], range.last[index]) = (first, last);
        }
        Some(range)
    }
}

impl Axis {
    fn new(along: DVec3, across: DVec3, forward: DVec3, half: f64, pixels: [f64; 2]) -> Option<Self> {
        let (a, b) = (along.cross(across), forward.cross(across));
        let sign = a.dot(forward).signum();
        let (a, b) = (sign * a, sign * b);
        let n = a.cross(b);
        Some(Self {
            a,
            b,
            aa: a.length_squared(),
            ab: a.dot(b),
            bb: b.length_squared(),
            n: unit(n)?,
            n_length: n.length(),
            b_length: b.length(),
            b_per_location: b.dot(along),
            half,
            pixels,
        })
    }

    /// The locations between which the part of a sphere is seen that is in front of the eye's plane.
    #[inline]
    fn perspective(&self, center: DVec3, radius: f64) -> [f64; 2] {
        let (along_a, along_b) = (self.a.dot(center), self.b.dot(center));
        let squared = radius * radius;
        let from_axis = center.cross(self.n).length_squared();
        if from_axis <= squared * (1.0 + NEAR_AXIS) {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        // a x² + 2 b x + c = 0, by the form of the roots in which nothing cancels.
        let a = along_a * along_a - squared * self.aa;
        let b = along_a * along_b - squared * self.ab;
        let c = along_b * along_b - squared * self.bb;
        let q = -(b + (radius * self.n_length * (from_axis - squared).sqrt()).copysign(b));
        let (one, other) = (q / a, c / q);
        if a > 0.0 {
            return [one.min(other), one.max(other)];
        }
        // The sphere goes through the eye's plane, on one side of the axis.
        let is_beyond = along_b * self.aa < along_a * self.ab;
        if is_beyond { [one.max(other), f64::INFINITY] } else { [f64::NEG_INFINITY, one.min(other)] }
    }

    /// The locations between which a sphere is seen by parallel rays.
    #[inline]
    fn parallel(&self, center: DVec3, radius: f64) -> [f64; 2] {
        let (middle, reach) = (center.dot(self.b) / self.b_per_location, radius * self.b_length / self.b_per_location);
        [middle - reach.abs(), middle + reach.abs()]
    }

    /// The first and the last tile with a pixel whose centre lies between two locations.
    #[inline]
    fn pixels_of(&self, [low, high]: [f64; 2]) -> Option<[u16; 2]> {
        let [first, last] = self.pixels;
        let low = ((low + 1.0) * self.half - 0.5 - PAD).ceil().max(first);
        let high = ((high + 1.0) * self.half - 0.5 + PAD).floor().min(last);
        // A part has at most 2^16 tiles along a side, so the casts are exact.
        (low <= high).then(|| [low, high].map(|pixel| ((pixel - first) as u32 / SIDE) as u16))
    }
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;

    fn vector(rng: &mut Rng, size: f64) -> DVec3 {
        DVec3::from([(); 3].map(|()| size * (2.0 * rng.f64() - 1.0)))
    }

    /// A camera in any place that looks anywhere, also with a shifted view plane, and with a part of its film.
    fn camera(rng: &mut Rng) -> TileCamera {
        let [forward, right, down] = [(); 3].map(|()| vector(rng, 1.0));
        let across = unit(forward.cross(right)).unwrap();
        let film = [rng.u32(1..90), rng.u32(1..90)];
        let first = film.map(|side| rng.u32(0..side));
        let size = [0, 1].map(|axis| rng.u32(1..=film[axis] - first[axis]));
        TileCamera {
            origin: vector(rng, 3.0),
            advance: if rng.bool() { 0.0 } else { rng.f64() },
            right: right * 10_f64.powf(rng.f64() - 0.5),
            down: across * 10_f64.powf(rng.f64() - 0.5) + 0.1 * down,
            forward,
            is_parallel: rng.bool(),
            film,
            first,
            size,
        }
    }

    /// The start and the direction of the ray of a pixel, from the eye.
    fn ray(camera: &TileCamera, pixel: [u32; 2]) -> [DVec3; 2] {
        let location = |axis: usize| (2.0 * f64::from(pixel[axis]) + 1.0) / f64::from(camera.film[axis]) - 1.0;
        let aside = location(0) * camera.right + location(1) * camera.down;
        let eye = camera.origin - camera.advance * camera.forward;
        if camera.is_parallel { [eye + aside, camera.forward] } else { [eye, aside + camera.forward] }
    }

    /// The distance of the first point in front of the start at which a ray meets a sphere.
    fn hit([start, direction]: [DVec3; 2], [x, y, z, radius]: [f32; 4]) -> Option<f64> {
        let to_center = DVec3::new(x.into(), y.into(), z.into()) - start;
        let direction = direction / direction.length();
        let along = to_center.dot(direction);
        let squared = f64::from(radius).powi(2) - (to_center - along * direction).length_squared();
        let half = (squared >= 0.0).then(|| squared.sqrt())?;
        [along - half, along + half].into_iter().find(|t| *t > 0.0)
    }

    /// Counts the hits of all pixels, and those that are not in the tiles of their sphere or nearer than its near
    /// distance. `seen` may change a sphere before its tiles are found.
    fn hits_and_losses(seen: impl Fn([f32; 4]) -> [f32; 4]) -> [u32; 2] {
        let mut rng = Rng::with_seed(3);
        let mut counts = [0; 2];
        for _ in 0..300 {
            let camera = camera(&mut rng);
            let corners = [DVec3::splat(-4.0), DVec3::splat(4.0)];
            let view = TileView::new(&camera, 0.0, &[0, 1, 0, 1, 0, 1, 0, 1].map(|of| corners[of])).unwrap();
            for _ in 0..40 {
                let radius = 10_f64.powf(3.0 * rng.f64() - 2.5);
                let [x, y, z] = vector(&mut rng, 3.0).as_vec3().to_array();
                let sphere = [x, y, z, radius as f32];
                let (range, near) = (view.range(seen(sphere)), view.near(seen(sphere)));
                for pixel in [(); 60].map(|()| [0, 1].map(|axis| camera.first[axis] + rng.u32(0..camera.size[axis]))) {
                    let Some(t) = hit(ray(&camera, pixel), sphere) else { continue };
                    let tile = [0, 1].map(|axis| ((pixel[axis] - camera.first[axis]) / SIDE) as u16);
                    let is_in =
                        |axis: usize, range: &TileRange| (range.first[axis]..=range.last[axis]).contains(&tile[axis]);
                    let is_listed = range.is_some_and(|range| is_in(0, &range) && is_in(1, &range));
                    counts[0] += 1;
                    counts[1] += u32::from(!is_listed || f64::from(near) > t);
                }
            }
        }
        counts
    }

    #[test]
    fn every_hit_is_in_the_tiles_of_its_sphere() {
        let [hits, losses] = hits_and_losses(|sphere| sphere);
        assert!(hits > 20_000, "{hits}");
        assert_eq!(losses, 0);
    }

    #[test]
    fn smaller_spheres_lose_hits() {
        let [_, losses] = hits_and_losses(|[x, y, z, radius]| [x, y, z, 0.97 * radius]);
        assert!(losses > 10, "{losses}");
    }

    /// Rectangles are not much larger than spheres, which are seen in one tile if they are small.
    #[test]
    fn rectangles_are_tight() {
        let camera = TileCamera {
            origin: DVec3::ZERO,
            advance: 0.0,
            right: DVec3::X,
            down: DVec3::Y,
            forward: DVec3::Z,
            is_parallel: false,
            film: [800, 800],
            first: [0, 0],
            size: [800, 800],
        };
        let view = TileView::new(&camera, 0.0, &[DVec3::splat(2.0); 8]).unwrap();
        let at = |x: f32, radius: f32| view.range([x, 0.0, 1.0, radius]);
        // A pixel is 1/400 wide. The sphere touches the pixels from 404 to 411 and from 396 to 403.
        let range = TileRange { first: [50, 49], last: [51, 50] };
        assert_eq!(at(0.02, 0.009), Some(range));
        // Between the centres of pixels there is nothing.
        assert_eq!(at(0.0, 0.001), None);
        assert_eq!(view.range([0.0, 0.0, -1.0, 0.5]), None);
        // The eye is in the sphere.
        assert_eq!(at(0.0, 1.5).map(|range| range.count()), Some(10_000));
        // Spheres through the eye's plane, beside the picture and at its right edge.
        assert_eq!(view.range([5.0, 0.0, 0.5, 0.5]), None);
        assert_eq!(view.range([-5.0, 0.0, -0.2, 0.5]), None);
        let range = TileRange { first: [68, 0], last: [99, 99] };
        assert_eq!(view.range([1.0, 0.0, 0.4, 0.8]), Some(range));
    }
}
