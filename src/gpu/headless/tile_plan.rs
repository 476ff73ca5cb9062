//! Planning pictures by lists of the spheres that may be seen in each tile: whether one is rendered so, and what it takes.

use std::f64::consts::PI;

use crate::accel::tile_lists::{mean_tiles, most_places};
use crate::accel::tiles::{Projection, SIDE, TileCamera, TileView};
use crate::accel::{AccelPlan, PlannedBuffer};
use crate::camera::film::YAxis;
use crate::camera::{CameraKind, View};
use crate::geometry::cone::ConeInFrame;
use crate::gpu::device_shape::DeviceLimits;
use crate::gpu::passes::bands::rows_per_band;
use crate::gpu::passes::tiles::{Tile, tile_size};
use crate::gpu::shader::records::{self, SceneSpace};
use crate::recording::RequestedCamera;
use crate::scene::Scene;

/// Up to this many spheres, a list of all of them is better.
const FEW: usize = 32;

/// The most places in lists for each sphere, on average. Where spheres cover more tiles, grids are better.
const PLACES_PER_SPHERE: f64 = 12.0;

/// However many tiles spheres cover, so many places in lists take no time.
const FEW_PLACES: f64 = (1 << 20) as f64;

/// The camera of a tile of a picture, with the numbers that its kernels have.
pub(crate) fn tile_view(view: &View<'_>, space: &SceneSpace, margin: f32, tile: Tile) -> Option<TileView> {
    let wide = |v: [f32; 3]| glam::Vec3::from(v).as_dvec3();
    let records::Camera { origin, advance, right, up, forward, first, second, third } =
        records::Camera::new(&RequestedCamera::of(view.camera), space);
    let film = view.film;
    let down = match film.y_axis() {
        YAxis::Up => -wide(up),
        YAxis::Down => wide(up),
    };
    let camera = TileCamera {
        origin: wide(origin),
        advance: advance.into(),
        right: wide(right),
        down,
        forward: wide(forward),
        projection: match view.camera.kind() {
            CameraKind::Orthographic => Projection::Parallel,
            CameraKind::Fisheye => {
                Projection::Fisheye([first, second].map(|side| PI * f64::from(third) * f64::from(side)))
            }
            _ => Projection::Perspective,
        },
        film: [film.whole().width(), film.whole().height()],
        first: film.in_whole(tile.origin),
        size: tile.size,
    };
    TileView::new(&camera, margin.into(), &space.corners())
}

fn space_of(scene_origin: glam::DVec3, plan: &AccelPlan) -> SceneSpace {
    let (min, max) = plan.statistics.inflated_bounds();
    SceneSpace { origin: scene_origin, min, max }
}

/// Decides if a picture is rendered by tiles, rather than by a structure.
///
/// Only software devices were measured: there, one picture takes less time than building the structure for it.
pub(crate) fn suits(scene: &Scene, view: &View<'_>, plan: &AccelPlan, device: &DeviceLimits) -> bool {
    let count = scene.shape_count();
    if device.device_type != wgpu::DeviceType::Cpu || count <= FEW {
        return false;
    }
    let most = PLACES_PER_SPHERE.max(FEW_PLACES / count as f64);
    let balls: Vec<[f32; 4]> = scene.cones().iter().map(ConeInFrame::ball).collect();
    let are_few = |tiles| [scene.spheres(), &balls].iter().all(|all| mean_tiles(&tiles, all) <= most);
    of_picture(scene, view, plan).is_some_and(are_few)
}

/// The tiles of a whole picture; `None` if it cannot have any.
pub(crate) fn of_picture(scene: &Scene, view: &View<'_>, plan: &AccelPlan) -> Option<TileView> {
    let kinds = [CameraKind::Pinhole, CameraKind::Orthographic, CameraKind::ThinLens, CameraKind::Fisheye];
    let size = [view.film.width(), view.film.height()];
    // Tiles are numbered in 16 bits along each axis.
    let are_few = size.iter().all(|side| side.div_ceil(SIDE) <= u32::from(u16::MAX));
    if !kinds.contains(&view.camera.kind()) || scene.is_empty() || !are_few {
        return None;
    }
    let tile = Tile { origin: [0, 0], size, in_target: [0, 0] };
    tile_view(view, &space_of(scene.origin(), plan), plan.statistics.margin(), tile)
}

/// The size of the parts of a picture that are rendered one after the other. The hits of each are in one buffer.
pub(crate) fn part_size(view: &View<'_>, device: &DeviceLimits) -> [u32; 2] {
    let (limits, film) = (&device.limits, &view.film);
    let [width, height] = tile_size(film, device.shape().max_tile_pixels, limits.max_texture_dimension_2d);
    let rows = rows_per_band(limits, [width, height], false);
    [width, if rows < height { (rows / SIDE).max(1) * SIDE } else { height }]
}

/// The most places in one brick of lists for a part of a picture.
fn places(spheres: usize, part: [u32; 2]) -> u64 {
    // The last sphere of a brick may be in all tiles.
    most_places(spheres) as u64 + tile_count(part)
}

/// The most spheres in one brick of lists for a part of a picture, and in bricks that are shaded together.
pub(crate) fn listed(spheres: usize, part: [u32; 2]) -> u64 {
    places(spheres, part).min(spheres as u64)
}

fn tile_count(part: [u32; 2]) -> u64 {
    part.iter().map(|side| u64::from(side.div_ceil(SIDE))).product()
}

/// The buffers of one brick of lists for a part of a picture.
pub(crate) fn buffers(scene: &Scene, part: [u32; 2]) -> Vec<PlannedBuffer> {
    let count = scene.shape_count();
    let (listed, tiles) = (listed(count, part), tile_count(part));
    let bytes = if scene.cones().is_empty() { size_of::<[f32; 4]>() } else { size_of::<ConeInFrame>() };
    vec![
        PlannedBuffer::one("spheres", bytes as u64 * listed),
        PlannedBuffer::one("ids", 4 * (2 * listed + places(count, part) + tiles + 1)),
        PlannedBuffer::one("tiles", 4 * tiles),
    ]
}

/// The most host memory that making a brick takes, in addition to it.
pub(crate) fn building_bytes(spheres: usize, part: [u32; 2]) -> u64 {
    // The ids of all spheres, and those that are seen in a slab twice while they are sorted; the spheres that are shaded
    // together; and the places that threads fill.
    36 * spheres as u64 + 20 * listed(spheres, part) + 4 * places(spheres, part)
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::camera::film::Film;
    use crate::camera::{Camera, FisheyeCamera, OrthographicCamera, PinholeCamera, Pose, ThinLensCamera};
    use crate::gpu::headless::recording::requested_view;
    use crate::verify::LegalCameraRay;

    const U: f64 = 1.0 / (1 << 24) as f64;

    /// Every ray that a device may make is as near to the exact ray as `accel/tiles.rs` says, anywhere in the scene's box.
    #[test]
    fn rays_are_within_the_widening() {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut vector = |size: f64| DVec3::from([(); 3].map(|()| size * (2.0 * rng.f64() - 1.0)));
        let mut worst = [0.0_f64; 2];
        for number in 0..600 {
            let size = 10_f64.powi(number % 7 - 3);
            let (min, max) = (vector(size).as_vec3(), vector(size).as_vec3());
            let space = SceneSpace { origin: vector(100.0), min: min.min(max), max: min.max(max) };
            let eye = space.origin + vector(size * [0.5, 3.0, 1000.0][number as usize % 3]);
            let pose = Pose::looking_at(eye, space.origin + vector(0.2 * size), vector(1.0)).unwrap();
            let half = [0.01, 0.3, 3.0][number as usize / 7 % 3];
            let pinhole = PinholeCamera::new(pose, 1.0, [half, 0.7 * half]).unwrap();
            let lens = ThinLensCamera::new(pinhole, 0.01 * size, 2.0 * size).unwrap();
            let parallel = OrthographicCamera::new(pose, [half * size, half * size]).unwrap();
            let fisheye = FisheyeCamera::new(pose, [0.1, 3.0, 6.0][number as usize / 7 % 3], 1.0).unwrap();
            for camera in [&pinhole as &dyn Camera, &lens, &parallel, &fisheye] {
                let (requested, uploaded) = requested_view(&space, camera);
                let film = Film::new(64, 64).unwrap();
                let tile = Tile { origin: [0, 0], size: [64, 64], in_target: [0, 0] };
                let view = View::new(camera, film);
                let widening = tile_view(&view, &space, 0.0, tile).unwrap().widening();
                let farthest =
                    |from: DVec3| space.corners().iter().map(|corner| (*corner - from).length()).fold(0.0, f64::max);
                let reach: f32 = if camera.kind() == CameraKind::Fisheye { 0.7 } else { 1.0 };
                for location in [[0.0_f32, 0.0], [1.0, 1.0], [-1.0, 0.9], [0.3, -1.0]].map(|at| at.map(|x| reach * x)) {
                    let ray = LegalCameraRay::new(requested.kind, &uploaded, location, [0.5; 2]);
                    let half_width = |of: [crate::verify::Interval; 3]| {
                        DVec3::from(of.map(|interval| 0.5 * (interval.high - interval.low))).length()
                    };
                    let start = DVec3::from(ray.origin.map(|interval| 0.5 * (interval.high + interval.low)));
                    let t = farthest(start);
                    // The location is a quotient, whose error moves the point in the view plane.
                    let wide = |v: [f32; 3]| glam::Vec3::from(v).as_dvec3();
                    let location = DVec2::new(location[0].into(), location[1].into());
                    let [right, up] = [location.x * wide(uploaded.right), location.y * wide(uploaded.up)];
                    let moved = 5.0 * U * (right.length() + up.length());
                    let moved = match requested.kind {
                        CameraKind::Orthographic => moved,
                        // The vectors are rounded, so that they are not quite of unit length and at right angles.
                        CameraKind::Fisheye => {
                            t * (6.0 * U + 5.0 * U * location.length() * PI * f64::from(uploaded.numbers[2]))
                        }
                        _ => {
                            let toward = right + up + wide(uploaded.forward);
                            moved * (f64::from(uploaded.advance) + t / toward.length())
                        }
                    };
                    // The origin is moved to the box, which rounds its coordinates.
                    let entered = 3.0 * U * (start.length() + t);
                    let off = half_width(ray.origin) + half_width(ray.direction) * t + moved + entered;
                    let worst = &mut worst[usize::from(camera.kind() == CameraKind::Fisheye)];
                    *worst = worst.max(off / widening);
                }
            }
        }
        // 60 u of 64 u, and 300 u of 512 u.
        assert!(worst[0] < 0.9375 && worst[0] > 0.1 && worst[1] < 0.586 && worst[1] > 0.1, "{worst:?}");
    }
}
