//! Light that adds up: every sphere shines through all others, as stars do, with the light of its disk.
//!
//! Lights are integers in the sums, which therefore do not depend on the order, and so not on structures, devices and
//! threads.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3};

use crate::camera::View;
use crate::camera::film::{Film, YAxis};
use crate::geometry::math::wide;
use crate::parallel;
use crate::scene::SceneAppearance;

/// The number of spheres whose light is added between two looks at whether to go on.
const PIECE: usize = 1 << 18;

/// The part of the pixels with light that are darker than one with [`MIDDLE`].
const BRIGHT: f64 = 0.9;

/// The light of the brightest channel of such a pixel, before it is compressed: 1/2 becomes 1/3.
const MIDDLE: f64 = 0.5;

/// The number of bits of a sum.
const BITS: i32 = 62;

/// The spheres of a scene as a camera sees them, through each other.
pub(super) struct Stars<'a> {
    pub(super) spheres: &'a [[f32; 4]],
    /// Origin of the spheres' frame, in world space.
    pub(super) origin: DVec3,
    pub(super) appearance: &'a SceneAppearance,
    pub(super) view: View<'a>,
}

/// The disk of a sphere on the whole film, in pixels.
struct Disk {
    center: DVec2,
    radius: f64,
    /// The light of each of its points.
    color: DVec3,
}

/// The light of all pixels of a whole film.
pub(super) struct AddedLight {
    width: u32,
    /// Three sums for each pixel, row by row.
    sums: Vec<[u64; 3]>,
    /// The factor of sums.
    exposure: f64,
}

impl Stars<'_> {
    /// Adds the light of all spheres. `go_on` is asked several times; false stops the work.
    pub(super) fn light(&self, mut go_on: impl FnMut() -> bool) -> Option<AddedLight> {
        let film = self.view.film.whole();
        let most = parallel::map_chunks(self.spheres, |first, spheres| {
            let lights = (first..first + spheres.len()).filter_map(|id| self.disk(id, &film));
            lights.map(|disk| disk.most()).fold(0.0, f64::max)
        });
        let scale = scale(self.spheres.len() as f64 * most.into_iter().fold(0.0, f64::max));
        let sums: Vec<[AtomicU64; 3]> = parallel::map(film.pixel_count() as usize, |_| Default::default());
        for ids in parallel::ranges(self.spheres.len(), PIECE) {
            if !go_on() {
                return None;
            }
            parallel::for_each(parallel::ranges(ids.len(), PIECE / 64), |part| {
                for disk in part.filter_map(|at| self.disk(ids.start + at, &film)) {
                    disk.add(&film, scale, &sums);
                }
            });
        }
        let sums: Vec<[u64; 3]> = sums.into_iter().map(|sums| sums.map(AtomicU64::into_inner)).collect();
        let brightest = sums.iter().map(|[r, g, b]| *r.max(g).max(b));
        let mut lit: Vec<u64> = brightest.filter(|sum| *sum > 0).collect();
        let place = (BRIGHT * lit.len().saturating_sub(1) as f64) as usize;
        let bright = (place < lit.len()).then(|| *lit.select_nth_unstable(place).1);
        let exposure = bright.map_or(0.0, |bright| MIDDLE / bright as f64);
        Some(AddedLight { width: film.width(), sums, exposure })
    }

    /// The disk of a sphere; `None` if the camera does not see it.
    fn disk(&self, id: usize, film: &Film) -> Option<Disk> {
        let [x, y, z, radius] = self.spheres[id].map(f64::from);
        let point = self.origin + DVec3::new(x, y, z);
        let camera = self.view.camera;
        let up = camera.vectors().up.normalize_or_zero();
        let half = 0.5 * DVec2::new(film.width().into(), film.height().into());
        let at = camera.location_of(point)?;
        let radius = ((camera.location_of(point + radius * up)? - at) * half).length();
        let down = match film.y_axis() {
            YAxis::Up => DVec2::new(1.0, -1.0),
            YAxis::Down => DVec2::ONE,
        };
        let center = (at * down + 1.0) * half;
        let id = id as u32;
        let opacity = f64::from(self.appearance.surface_of(id).opacity * self.appearance.alpha(id));
        let color = opacity * wide(self.appearance.color_of(id).to_array());
        (center.is_finite() && radius.is_finite()).then_some(Disk { center, radius, color })
    }
}

impl Disk {
    /// At least the light that it adds to any pixel.
    fn most(&self) -> f64 {
        self.color.max_element() * self.area().min(2.0 * std::f64::consts::PI)
    }

    fn area(&self) -> f64 {
        std::f64::consts::PI * self.radius * self.radius
    }

    /// Adds its light to the pixels of a film.
    fn add(&self, film: &Film, scale: f64, sums: &[[AtomicU64; 3]]) {
        let reach = self.radius.max(1.0);
        let range = |center: f64, side: u32| {
            let end = |at: f64| at.clamp(0.0, f64::from(side)) as usize;
            end((center - reach - 0.5).ceil())..end((center + reach + 0.5).floor())
        };
        let columns = range(self.center.x, film.width());
        for row in range(self.center.y, film.height()) {
            for column in columns.clone() {
                let share = self.share(DVec2::new(column as f64 + 0.5, row as f64 + 0.5) - self.center);
                let light = (scale * share * self.color).round();
                let sum = &sums[row * film.width() as usize + column];
                for (sum, light) in sum.iter().zip(light.to_array()) {
                    sum.fetch_add(light as u64, Ordering::Relaxed);
                }
            }
        }
    }

    /// The part of a pixel with light. A disk that is smaller than a pixel lights the four around its centre, together by
    /// its area. A larger one fades towards its rim, so that the light of all pixels is about its area.
    fn share(&self, offset: DVec2) -> f64 {
        if self.radius <= 1.0 {
            let near = (1.0 - offset.abs()).max(DVec2::ZERO);
            return self.area() * near.x * near.y;
        }
        2.0 * (1.0 - offset.length_squared() / (self.radius * self.radius)).max(0.0)
    }
}

/// A power of two by which sums up to `most` become integers that fit.
fn scale(most: f64) -> f64 {
    let exponent = ((most.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    let exponent = (BITS - 1 - exponent).clamp(-1022, 1023);
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

impl AddedLight {
    /// The bytes of memory for it.
    #[cfg(feature = "gpu")]
    pub(super) fn bytes(film: &Film) -> u64 {
        // The sums, and those of the brightest channels.
        film.whole().pixel_count() * 4 * size_of::<u64>() as u64
    }

    /// The light of a pixel of the whole film, from 0 to 1: so that faint and bright places are seen, x becomes x / (1 + x).
    pub(super) fn of(&self, [column, row]: [u32; 2]) -> DVec3 {
        let sums = self.sums[row as usize * self.width as usize + column as usize];
        let light = self.exposure * DVec3::from(sums.map(|sum| sum as f64));
        light / (1.0 + light.max_element())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::camera::{PinholeCamera, Pose};
    use crate::image::color::LinearRgb;
    use crate::scene::Scene;
    use crate::scene::sphere::Sphere;
    use fastrand::Rng;

    fn light_of(spheres: &[Sphere], view: &View<'_>) -> AddedLight {
        let scene = Scene::new(spheres).unwrap();
        let stars = Stars {
            spheres: &scene.shared_shapes().spheres,
            origin: scene.origin(),
            appearance: scene.checked_appearance(),
            view: *view,
        };
        stars.light(|| true).unwrap()
    }

    fn sphere(random: &mut Rng) -> Sphere {
        let center = [0; 3].map(|_| 40.0 * random.f64() - 20.0);
        let color = LinearRgb::new([0; 3].map(|_| random.f32())).unwrap();
        Sphere::new(center, 10f64.powf(3.0 * random.f64() - 3.0), color)
    }

    /// Spheres may lie behind the camera and around it.
    #[test]
    fn the_order_of_spheres_and_parts_of_a_film_change_nothing() {
        let mut random = Rng::with_seed(3);
        let pose = Pose::looking_at([0.0, 0.0, 12.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 1.2, 1.5).unwrap();
        let film = Film::new(60, 40).unwrap();
        let view = View::new(&camera, film);
        let mut spheres: Vec<Sphere> = (0..5000).map(|_| sphere(&mut random)).collect();
        let light = light_of(&spheres, &view);
        assert!(light.exposure > 0.0 && light.sums.iter().flatten().all(|sum| *sum < 1 << BITS));
        random.shuffle(&mut spheres);
        assert_eq!(light_of(&spheres, &view).sums, light.sums);
        let part = View::new(&camera, film.part([20, 10], [7, 5]).unwrap());
        assert_eq!(light_of(&spheres, &part).sums, light.sums);
        for pixel in (0..60 * 40).map(|at| [at % 60, at / 60]) {
            assert!(light.of(pixel).cmpge(DVec3::ZERO).all() && light.of(pixel).cmple(DVec3::ONE).all());
        }
    }

    #[test]
    fn a_disk_gives_the_light_of_its_area() {
        let film = Film::new(100, 100).unwrap();
        for (radius, slack) in [(1e-2, 1e-9), (0.3, 1e-9), (1.0, 1e-9), (1.5, 0.1), (7.3, 0.01), (20.0, 1e-3)] {
            let disk = Disk { center: DVec2::new(51.23, 45.44), radius, color: DVec3::ONE };
            let sums: Vec<[AtomicU64; 3]> = (0..100 * 100).map(|_| Default::default()).collect();
            let scale = scale(disk.most());
            disk.add(&film, scale, &sums);
            let sum = sums.iter().map(|[red, ..]| red.load(Ordering::Relaxed) as f64).sum::<f64>() / scale;
            assert!((sum / disk.area() - 1.0).abs() < slack, "{radius}: {sum} and not {}", disk.area());
        }
    }

    #[test]
    fn sums_fit() {
        for most in [f64::MIN_POSITIVE, 1e-30, 0.7, 1.0, 3e9, 1e200] {
            let sum = most * scale(most);
            assert!(sum < 2f64.powi(BITS) && (sum > 2f64.powi(BITS - 2) || most < 1e-280), "{most}: {sum}");
        }
        assert!(scale(0.0).is_finite());
    }
}
