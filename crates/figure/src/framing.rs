//! Scenes that stand for what a camera should frame in several pictures: all frames of a trajectory, or a scene that turns.

use std::f64::consts::{PI, TAU};

use pinhole::LinearRgb;
use pinhole::glam::{DQuat, DVec3};
use pinhole::internals::parallel;
use pinhole::scene::{Scene, SceneError};

/// The most spheres that are kept. If there are more, only spheres that extend farthest in some direction stay, and a
/// few others for the mean radius.
const MOST: usize = 1 << 20;

/// Number of directions for which the farthest sphere is kept. The extent in a direction between them is wrong by at
/// most 1% of the distance from the middle.
const DIRECTIONS: usize = 256;

/// The most spheres that are kept for the mean radius.
const SAMPLE: usize = 1 << 14;

/// The spheres of several scenes together, each x, y, z, radius.
#[derive(Clone, Debug, Default)]
pub struct Union {
    spheres: Vec<[f64; 4]>,
    /// Spheres that were added to those of the data, and those at the ends of cones.
    added: Vec<[f64; 4]>,
}

impl Union {
    /// Adds the spheres of a scene, and those around the ends of its cones.
    pub fn add(&mut self, scene: &Scene) {
        if let Some(focus) = scene.focus() {
            return gather(&mut self.spheres, scene.origin(), focus.iter().copied());
        }
        let (of_data, added) = scene.spheres().split_at(scene.len() - scene.added());
        gather(&mut self.spheres, scene.origin(), of_data.iter().copied());
        gather(&mut self.added, scene.origin(), added.iter().copied().chain(ends(scene)));
    }

    /// Returns the kept spheres, and the number of those, at the end, that were added to the data.
    #[must_use]
    pub fn into_spheres(mut self) -> (Vec<[f64; 4]>, usize) {
        let added = self.added.len();
        self.spheres.append(&mut self.added);
        (self.spheres, added)
    }

    /// Makes a scene of the kept spheres.
    ///
    /// # Errors
    /// Returns an error if there are too many spheres for a scene, or they are too far apart.
    pub fn scene(self) -> Result<Scene, SceneError> {
        let (spheres, added) = self.into_spheres();
        scene_of(&spheres, added)
    }
}

fn gather(all: &mut Vec<[f64; 4]>, origin: DVec3, new: impl Iterator<Item = [f32; 4]>) {
    for sphere in new {
        if all.len() == MOST {
            reduce(all);
        }
        all.push(in_world(origin, sphere));
    }
}

/// Spheres around the ends of a scene's cones. They reach a little farther than flat cones.
fn ends(scene: &Scene) -> impl Iterator<Item = [f32; 4]> {
    scene.cones().iter().flat_map(|cone| {
        let [first, second] = [cone.first_radius, cone.second_radius].map(f32::abs);
        // A tip is a small sphere.
        let least = 1e-4 * first.max(second);
        [(cone.start, first), (cone.end, second)].map(|([x, y, z], radius)| [x, y, z, radius.max(least)])
    })
}

/// All spheres of a scene and those around the ends of its cones, or else those of its focus, in world space. Those of the
/// data come first, whose number is returned as well.
fn all_of(scene: &Scene) -> (Vec<[f64; 4]>, usize) {
    if let Some(focus) = scene.focus() {
        return (focus.iter().map(|sphere| in_world(scene.origin(), *sphere)).collect(), focus.len());
    }
    let all = scene.spheres().iter().copied().chain(ends(scene)).map(|sphere| in_world(scene.origin(), sphere));
    (all.collect(), scene.len() - scene.added())
}

/// Makes a scene of spheres, the last `added` of which were added to the data.
///
/// # Errors
/// Returns an error if a scene cannot have these spheres.
pub fn scene_of(spheres: &[[f64; 4]], added: usize) -> Result<Scene, SceneError> {
    Ok(Scene::from_f64(spheres, LinearRgb::WHITE)?.with_added(added))
}

/// Keeps only the spheres that extend farthest in some direction, and a sample of all.
fn reduce(spheres: &mut Vec<[f64; 4]>) {
    let all = &*spheres;
    let farthest = |index: usize| {
        let direction = of_spiral(index, DIRECTIONS);
        let reach = |&[x, y, z, radius]: &[f64; 4]| direction.dot(DVec3::new(x, y, z)) + radius;
        all.iter().max_by(|a, b| reach(a).total_cmp(&reach(b))).copied()
    };
    let kept = parallel::map(DIRECTIONS, farthest);
    *spheres = kept.into_iter().flatten().chain(sample(all)).collect();
}

/// A sample of the spheres, at equal steps.
fn sample(spheres: &[[f64; 4]]) -> impl Iterator<Item = [f64; 4]> {
    spheres.iter().step_by(spheres.len().div_ceil(SAMPLE).max(1)).copied()
}

fn in_world(origin: DVec3, sphere: [f32; 4]) -> [f64; 4] {
    let [x, y, z, radius] = sphere.map(f64::from);
    let center = origin + DVec3::new(x, y, z);
    [center.x, center.y, center.z, radius]
}

/// The body that a scene sweeps as it turns about an axis through a point, as a scene of spheres on its surface.
///
/// # Errors
/// Returns an error if the body is too large for a scene.
pub fn swept(scene: &Scene, axis: DVec3, center: DVec3) -> Result<Scene, SceneError> {
    /// Number of directions in a half plane beside the axis.
    const PROFILE: usize = 64;
    /// Number of steps of a full turn.
    const STEPS: usize = 72;
    let (spheres, of_data) = all_of(scene);
    let farthest = |index: usize| {
        let (sine, cosine) = (PI * (index as f64 / (PROFILE - 1) as f64 - 0.5)).sin_cos();
        let reach = |&[x, y, z, radius]: &[f64; 4]| {
            let offset = DVec3::new(x, y, z) - center;
            let height = axis.dot(offset);
            let beside = (offset - height * axis).length();
            sine * height + cosine * beside + radius
        };
        spheres.iter().max_by(|a, b| reach(a).total_cmp(&reach(b))).copied()
    };
    let profile: Vec<_> = parallel::map(PROFILE, farthest).into_iter().flatten().collect();
    let on_surface = (0..STEPS).flat_map(|step| {
        let turn = DQuat::from_axis_angle(axis, TAU * step as f64 / STEPS as f64);
        profile.iter().map(move |&[x, y, z, radius]| {
            let at = center + turn * (DVec3::new(x, y, z) - center);
            [at.x, at.y, at.z, radius]
        })
    });
    body(&spheres[..of_data], on_surface)
}

/// A scene of spheres on a surface, with some of the data's own for the mean radius.
fn body(of_data: &[[f64; 4]], on_surface: impl Iterator<Item = [f64; 4]>) -> Result<Scene, SceneError> {
    let mut all: Vec<[f64; 4]> = sample(of_data).collect();
    let before = all.len();
    all.extend(on_surface);
    let added = all.len() - before;
    Ok(Scene::from_f64(&all, LinearRgb::WHITE)?.with_added(added))
}

/// The ball around a scene, as a scene: spheres on the ball's surface, and some of the scene's own for the mean radius.
///
/// # Errors
/// Returns an error if the ball is too large for a scene.
pub fn around(scene: &Scene) -> Result<Scene, SceneError> {
    let center = scene.subject().bounds().center();
    let (spheres, of_data) = all_of(scene);
    let reach = |&[x, y, z, radius]: &[f64; 4]| DVec3::new(x, y, z).distance(center) + radius;
    let Some(farthest) = spheres.iter().max_by(|a, b| reach(a).total_cmp(&reach(b))) else {
        return Scene::from_f64(&[], LinearRgb::WHITE);
    };
    let radius = farthest[3];
    let beside = reach(farthest) - radius;
    let on_surface = (0..4 * DIRECTIONS).map(|index| {
        let at = center + beside * of_spiral(index, 4 * DIRECTIONS);
        [at.x, at.y, at.z, radius]
    });
    body(&spheres[..of_data], on_surface)
}

/// One of the directions of a spiral, which are about equally spaced.
fn of_spiral(index: usize, count: usize) -> DVec3 {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let z = 1.0 - (2 * index + 1) as f64 / count as f64;
    let (sine, cosine) = (golden * index as f64).sin_cos();
    let rho = (1.0 - z * z).sqrt();
    DVec3::new(rho * cosine, rho * sine, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn supports(scene: &Scene) -> [f64; 6] {
        let axes = DVec3::AXES;
        let middle = scene.bounds_to_frame().center();
        let reach = scene.subject().supports([axes[0], axes[1], axes[2], -axes[0], -axes[1], -axes[2]]);
        let middle = [middle.x, middle.y, middle.z, -middle.x, -middle.y, -middle.z];
        std::array::from_fn(|i| reach[i] + middle[i])
    }

    #[test]
    fn a_union_reaches_as_far_as_its_scenes() {
        let at = |x: f64| Scene::from_f64(&[[x, 0.0, 0.0, 1.0]], LinearRgb::WHITE).unwrap();
        let mut union = Union::default();
        union.add(&at(-3.0));
        union.add(&at(5.0));
        let reach = supports(&union.scene().unwrap()).into_iter().zip([6.0, 1.0, 1.0, 4.0, 1.0, 1.0]);
        for (found, expected) in reach {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn what_is_left_out_lies_within_the_rest() {
        let spheres: Vec<[f64; 4]> = (0..20_000)
            .map(|i| {
                let part = f64::from(i) / 20_000.0;
                let (sine, cosine) = (f64::from(i) * 2.4).sin_cos();
                let rho = part.sqrt();
                [rho * cosine, rho * sine, 0.5 * part, 0.01]
            })
            .collect();
        let whole = Scene::from_f64(&spheres, LinearRgb::WHITE).unwrap();
        let mut union = Union { spheres, ..Union::default() };
        reduce(&mut union.spheres);
        let reduced = union.scene().unwrap();
        assert!(reduced.len() < whole.len());
        for (whole, reduced) in supports(&whole).into_iter().zip(supports(&reduced)) {
            assert!((0.0..0.01).contains(&(whole - reduced)), "{whole} {reduced}");
        }
    }

    #[test]
    fn a_turning_rod_sweeps_a_disk() {
        let rod = [[0.0, 0.0, 0.0, 0.5], [4.0, 1.0, 0.0, 0.5]];
        let rod = Scene::from_f64(&rod, LinearRgb::WHITE).unwrap();
        let swept = swept(&rod, DVec3::Y, DVec3::ZERO).unwrap();
        let [x, y, z, left, down, back] = supports(&swept);
        for side in [x, z, left, back] {
            assert!((side - 4.5).abs() < 1e-6, "{side}");
        }
        assert!((y - 1.5).abs() < 1e-6 && (down - 0.5).abs() < 1e-6, "{y} {down}");
    }

    /// The ball has the same width from all sides: twice the reach of the farthest sphere.
    #[test]
    fn a_ball_is_as_wide_from_all_sides() {
        let rod = [[0.0, 0.0, 0.0, 0.5], [4.0, 0.0, 0.0, 0.5]];
        let rod = Scene::from_f64(&rod, LinearRgb::WHITE).unwrap();
        let ball = around(&rod).unwrap();
        let expected = [4.5, 2.5, 2.5, 0.5, 2.5, 2.5];
        for (found, expected) in supports(&ball).into_iter().zip(expected) {
            assert!((0.0..0.02).contains(&(expected - found)), "{found} {expected}");
        }
        assert!(around(&Scene::from_f64(&[], LinearRgb::WHITE).unwrap()).unwrap().is_empty());
    }
}
