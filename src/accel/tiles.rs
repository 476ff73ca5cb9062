//! The rectangles of tiles in which spheres can be seen, from which lists of spheres for each tile are made
//! (`tile_lists.rs`). They need no structure. A tile is a square of [`SIDE`] pixels.
//!
//! # Why no sphere is lost
//! A kernel finds the hits of the ray that it made, which is not the exact ray. Rays of pixels are computed from the
//! numbers of a camera in f32, which the host takes as they are. In units of u = 2⁻²⁴, and of S, the length that
//! [`TileView::new`] adds up, a device's ray is off by less than 60 u S wherever it is in the scene's box, or 300 u S for
//! fisheye cameras: a test in `gpu/headless/tile_plan.rs` compares this with the bounds of `verify/camera`. `slab.rs` shows that a ray that hits
//! according to the kernel comes within r + 51 u D of the centre, where D is the diagonal of the box, and the margin is
//! 128 u D. So the exact ray of a pixel that hits comes within r + margin + 64 u S (or 512 u S) of the centre, and the sphere with that
//! radius is seen there.
//!
//! The sphere is seen between the two planes through the eye that touch it and contain one side of the picture. A plane at
//! the location x has the normal x A + B, with A = right × up, along the depth z, and B = forward × up. With the unit vector
//! s at a right angle to z in the plane of A and B, x is an affine function of y, the quotient of a point's coordinates along
//! s and z, also for cameras with a shifted view plane. The plane touches a sphere with centre c and radius r if
//! (c·s − y c·z)² = r² (1 + y²), a quadratic equation whose discriminant is r² (ρ² − r²), where ρ is the distance of the
//! centre from the axis through the eye at right angles to s and z (Mara et al., "2D Polyhedral Bounds of a Clipped,
//! Perspective-Projected 3D Sphere", JCGT 2013). Of a sphere through the eye's plane, which does not meet the axis, the part
//! in front is seen from one root on, on the side where the sphere meets the plane; a sphere that comes near the axis is seen
//! everywhere along it. All of this is in f64, whose errors are less than [`PAD`].
//!
//! A fisheye camera maps an angle to a length. From the direction of view to the angle t, it stretches lengths on the unit
//! sphere at most by t / sin t, which grows with t: arcs around that direction by this factor, and arcs through it not at
//! all. All directions in which a sphere is seen are within the angle asin(r / |c|) of its centre, along arcs that stay in
//! them, so that the picture of the sphere lies in the disk whose radius is this angle, stretched.
//!
//! The *near* distance of a sphere is a lower bound of `distance + t` of its hits in kernels: the reported point is
//! within r + margin of the centre, and the ray and its distances from the eye are off by less than 64 u (S + T), or 512 u (S + T), where T
//! is the largest distance of the box from the eye. The same again is left for rounding it, and for the sum.

use glam::DVec3;

use crate::geometry::math::unit;

/// Side of a tile in pixels: that of the workgroups of kernels.
pub(crate) const SIDE: u32 = 8;

/// Extra pixels on each side of a sphere's rectangle, for errors in f64: relative to the picture they are less than
/// 2⁻³², because spheres that come as near as [`NEAR_PLANE`] are treated apart.
const PAD: f64 = 1.0 / (1 << 12) as f64;

/// The angle from a fisheye camera's direction of view beyond which spheres are taken to be seen everywhere.
const NEAR_BACK: f64 = 3.0;

/// A sphere is near a plane, an axis or the eye if the square of its distance from there is at most that of its radius times
/// 1 plus this.
const NEAR_PLANE: f64 = 1e-4;

/// The error of camera rays as a fraction of the lengths from which they are computed: 64 u.
const RAY_PART: f64 = 1.0 / (1 << 18) as f64;

/// The error of rays of fisheye cameras, whose sines have larger errors: 512 u.
const FISHEYE_RAY_PART: f64 = 8.0 * RAY_PART;

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
    pub(crate) projection: Projection,
    /// Width and height of the whole film.
    pub(crate) film: [u32; 2],
    /// The first pixel of the part, and its size.
    pub(crate) first: [u32; 2],
    pub(crate) size: [u32; 2],
}

/// How a camera maps directions to its film.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Projection {
    /// Through a view plane.
    Perspective,
    /// All rays have the direction `forward`.
    Parallel,
    /// The location is the angle from `forward` in radians, divided by these numbers along each axis. The camera's vectors
    /// have unit length.
    Fisheye([f64; 2]),
}

/// A camera, prepared for the rectangles of many spheres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileView {
    eye: DVec3,
    /// Unit vector, across which the plane through the eye lies.
    depth: DVec3,
    axes: [Axis; 2],
    projection: Projection,
    /// Number of tiles along each side.
    tiles: [u32; 2],
    /// The length that is added to radii, for rounding on the device.
    widening: f64,
    /// The length by which hits may be nearer than the nearest point of a sphere.
    nearer: f64,
}

/// Lists for tiles. A sphere is in the list of every tile in which it may be seen.
#[derive(Clone, Debug, Default)]
pub struct TileLists {
    /// Number of tiles along a row.
    pub columns: u32,
    /// For each tile, row by row, the place of its first sphere, and at the end the number of places.
    pub starts: Vec<u32>,
    /// For each place, the index of a sphere of the brick. Indices ascend within a list.
    pub places: Vec<u32>,
    /// For each sphere of the brick, a lower bound of the distance of hits from the eye, in ascending order.
    pub nears: Vec<f32>,
}

/// One axis of the picture. Planes through the eye, or along parallel rays, are numbered by y: for a view plane it is the
/// quotient of a point's coordinates along `side` and along the depth, for parallel rays the coordinate along `side`, and
/// for a fisheye camera the angle.
#[derive(Clone, Copy, Debug)]
struct Axis {
    side: DVec3,
    /// The pixel of y = 0 from the first pixel of the part, and pixels for each unit of y.
    pixel_of_zero: f64,
    pixels_per_unit: f64,
    /// The last pixel of the part from the first.
    last: f64,
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
        let TileCamera { origin, advance, right, down, forward, projection, film, first, size } = *camera;
        let eye = origin - advance * forward;
        let depth = unit(right.cross(down))?;
        let depth = if depth.dot(forward) < 0.0 { -depth } else { depth };
        let axis = |along: DVec3, across: DVec3, index: usize| {
            let (side, location_of_zero, locations_per_unit) = match projection {
                Projection::Fisheye(angles) => (along, 0.0, 1.0 / angles[index]),
                // A plane along the rays is at the location x if all its points p have p · b = x along · b.
                Projection::Parallel => {
                    let b = forward.cross(across);
                    (unit(b)?, 0.0, b.length() / along.dot(b))
                }
                // A plane through the eye at the location x has the normal x a + b, and a is along the depth.
                Projection::Perspective => {
                    let a = along.cross(across);
                    let sign = a.dot(depth).signum();
                    let (a, b) = (a.length(), sign * forward.cross(across));
                    let aside = depth * depth.dot(b) - b;
                    (unit(aside)?, -depth.dot(b) / a, aside.length() / a)
                }
            };
            let half = f64::from(film[index]) / 2.0;
            Some(Axis {
                side,
                pixel_of_zero: (location_of_zero + 1.0) * half - 0.5 - f64::from(first[index]),
                pixels_per_unit: locations_per_unit * half,
                last: f64::from(size[index] - 1),
            })
        };
        let farthest = |from: DVec3| corners.iter().map(|corner| (*corner - from).length()).fold(0.0, f64::max);
        let aside = (right.length() + down.length())
            * match projection {
                Projection::Parallel => 1.0,
                Projection::Perspective | Projection::Fisheye(_) => advance,
            };
        let lengths = origin.length() + 2.0 * aside + farthest(origin);
        let ray_part = if matches!(projection, Projection::Fisheye(_)) { FISHEYE_RAY_PART } else { RAY_PART };
        Some(Self {
            eye,
            depth,
            axes: [axis(right, down, 0)?, axis(down, right, 1)?],
            projection,
            tiles: size.map(|side| side.div_ceil(SIDE)),
            widening: margin + ray_part * lengths,
            nearer: margin + 2.0 * ray_part * (farthest(eye) + lengths),
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
        let distance = match self.projection {
            Projection::Parallel => self.depth.dot(center),
            Projection::Perspective | Projection::Fisheye(_) => center.length(),
        };
        ((distance - f64::from(radius) - self.nearer) as f32).next_down()
    }

    /// The tiles in which a sphere may be seen. `None` if no ray of a pixel can hit it.
    #[inline]
    pub(crate) fn range(&self, [x, y, z, radius]: [f32; 4]) -> Option<TileRange> {
        let center = DVec3::new(x.into(), y.into(), z.into()) - self.eye;
        let wide = f64::from(radius) + self.widening;
        let [x, y] = self.axes.each_ref().map(|axis| axis.side.dot(center));
        let depth = self.depth.dot(center);
        let seen = match self.projection {
            Projection::Fisheye(_) => seen_by_fisheye([x, y, depth], wide),
            _ if depth <= -wide => return None,
            Projection::Parallel => [x, y].map(|side| [side - wide, side + wide]),
            Projection::Perspective => seen_in_perspective([x, y, depth], wide),
        };
        let [x, y] = [self.axes[0].tiles(seen[0])?, self.axes[1].tiles(seen[1])?];
        Some(TileRange { first: [x[0], y[0]], last: [x[1], y[1]] })
    }
}

impl Axis {
    /// The first and the last tile with a pixel whose centre lies between two planes. Infinite and undefined numbers
    /// exclude nothing.
    #[inline]
    fn tiles(&self, ends: [f64; 2]) -> Option<[u16; 2]> {
        let [one, other] = ends.map(|y| self.pixel_of_zero + self.pixels_per_unit * y);
        let [low, high] = if self.pixels_per_unit < 0.0 { [other, one] } else { [one, other] };
        let low = (low - PAD).max(0.0).min(self.last + 1.0);
        let high = (high + PAD).min(self.last).max(-1.0);
        // Casts round down, and take less time than functions that round. A part has at most 2^16 tiles along a side.
        let (whole, end) = (low as u32, (high + 1.0) as u32);
        let first = whole + u32::from(f64::from(whole) < low);
        (first < end).then(|| [first, end - 1].map(|pixel| (pixel / SIDE) as u16))
    }
}

const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// The planes through the eye, along each axis, between which the part of a sphere is seen that is in front of the eye's
/// plane.
#[inline]
fn seen_in_perspective([x, y, depth]: [f64; 3], radius: f64) -> [[f64; 2]; 2] {
    let squared = radius * radius;
    let a = depth * depth - squared;
    if depth > 0.0 && a > NEAR_PLANE * squared {
        let quotient = 1.0 / a;
        return [x, y].map(|side| {
            let half = radius * (a + side * side).sqrt();
            [(depth * side - half) * quotient, (depth * side + half) * quotient]
        });
    }
    [x, y].map(|side| {
        if depth * depth + side * side <= squared * (1.0 + NEAR_PLANE) {
            return EVERYWHERE;
        }
        // The sphere goes through the eye's plane or nearly so, on one side of the axis.
        let (mirror, b) = (side < 0.0, depth * side.abs());
        let q = b + (radius * (a + side * side).sqrt()).copysign(b);
        let (one, other) = (q / a, (side * side - squared) / q);
        let end = if a < 0.0 { one.max(other) } else { other };
        if mirror { [f64::NEG_INFINITY, -end] } else { [end, f64::INFINITY] }
    })
}

/// The angles along each axis between which a sphere is seen by a fisheye camera.
#[inline]
fn seen_by_fisheye([x, y, depth]: [f64; 3], radius: f64) -> [[f64; 2]; 2] {
    let aside = x.hypot(y);
    let distance = aside.hypot(depth);
    if distance <= radius * (1.0 + NEAR_PLANE) {
        return [EVERYWHERE; 2];
    }
    let (angle, half) = (aside.atan2(depth), (radius / distance).asin());
    if angle + half > NEAR_BACK {
        return [EVERYWHERE; 2];
    }
    let stretched = half * ((angle + half) / (angle + half).sin());
    [x, y].map(|side| {
        let middle = if aside > 0.0 { side / aside * angle } else { 0.0 };
        [middle - stretched, middle + stretched]
    })
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;
    use glam::DVec2;

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
        let camera = TileCamera {
            origin: vector(rng, 3.0),
            advance: if rng.bool() { 0.0 } else { rng.f64() },
            right: right * 10_f64.powf(rng.f64() - 0.5),
            down: across * 10_f64.powf(rng.f64() - 0.5) + 0.1 * down,
            forward,
            projection: if rng.bool() { Projection::Parallel } else { Projection::Perspective },
            film,
            first,
            size,
        };
        if rng.u32(0..3) > 0 {
            return camera;
        }
        // The corners of the film are seen at most at the angle 3.1.
        let projection = Projection::Fisheye([(); 2].map(|()| 0.05 + 2.15 * rng.f64()));
        let [right, forward] = [forward.cross(across), forward].map(|v| unit(v).unwrap());
        TileCamera { right, down: across, forward, projection, ..camera }
    }

    /// The start and the direction of the ray of a pixel, from the eye.
    fn ray(camera: &TileCamera, pixel: [u32; 2]) -> [DVec3; 2] {
        let location = |axis: usize| (2.0 * f64::from(pixel[axis]) + 1.0) / f64::from(camera.film[axis]) - 1.0;
        let aside = location(0) * camera.right + location(1) * camera.down;
        let eye = camera.origin - camera.advance * camera.forward;
        match camera.projection {
            Projection::Parallel => [eye + aside, camera.forward],
            Projection::Perspective => [eye, aside + camera.forward],
            Projection::Fisheye(angles) => {
                let spot = DVec2::new(location(0) * angles[0], location(1) * angles[1]);
                let (sin, cos) = spot.length().sin_cos();
                let side = spot.normalize_or_zero();
                [eye, sin * (side.x * camera.right + side.y * camera.down) + cos * camera.forward]
            }
        }
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
            projection: Projection::Perspective,
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
