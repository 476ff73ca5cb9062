//! Rays that remember the surface on which they start, so that they need no offset and no smallest distance.

use glam::DVec3;

use super::context::{LightingContext, Surface};
use crate::cpu::search::NearestHit;
use crate::cpu::sphere::intersect;
use crate::geometry::cone_crossing::crossings;
use crate::geometry::math::wide;
use crate::geometry::ray::Ray;
use crate::scene::Shape;

/// A ray in the scene's frame, and the surface that it leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceRay {
    pub(super) ray: Ray,
    pub(super) start: Start,
}

/// The start of a ray: the surface that it leaves, and the side. A ray leaves all equal shapes
/// together, because only the first of them can be hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// At the camera.
    Free,
    /// On a shape, outwards. The ray cannot hit this shape.
    Outside(u32),
    /// On a shape, inwards. The ray hits the far side of this shape, unless something is nearer.
    Inside(u32),
    /// On the ground, upwards. The ray cannot hit the ground.
    Ground,
}

/// The interaction of a ray with a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interaction {
    pub(super) surface: Surface,
    /// Distance along the ray from its origin.
    pub(super) distance: f64,
    /// The hit point, which is on the surface up to rounding.
    pub(super) point: DVec3,
    /// Unit normal on the side from which the ray arrives.
    pub(super) normal: DVec3,
    /// True if the ray arrives from outside the shape, or from above the ground.
    pub(super) is_outside: bool,
}

impl Interaction {
    /// The start of rays that stay on the side from which the ray arrived.
    pub(super) fn this_side(&self) -> Start {
        match self.surface {
            Surface::Ground => Start::Ground,
            Surface::Shape(id) if self.is_outside => Start::Outside(id),
            Surface::Shape(id) => Start::Inside(id),
        }
    }

    /// The start of rays that cross the surface.
    pub(super) fn other_side(&self) -> Start {
        match self.surface {
            Surface::Ground => Start::Ground,
            Surface::Shape(id) if self.is_outside => Start::Inside(id),
            Surface::Shape(id) => Start::Outside(id),
        }
    }
}

/// The shapes that occlude light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Occluders {
    /// All shapes.
    All,
    /// Shapes whose opacity is 1.
    Opaque,
}

/// The nearest interaction. At equal distances, shapes win over the ground, and smaller ids over larger ones.
pub(super) fn nearest(context: &LightingContext<'_>, surface_ray: &SurfaceRay) -> Option<Interaction> {
    let ray = &surface_ray.ray;
    let (start, own) = (surface_ray.start, start_shape(context, surface_ray.start));
    let distance = |shape| hit_of(ray, start, own, shape).map(|hit| hit.distance);
    let nearest = context.search.nearest(ray, distance);
    let is_nearest = |t: &f64| nearest.is_none_or(|nearest| *t < nearest.t);
    if let Some(distance) = ground(context, surface_ray).filter(is_nearest) {
        let plane = context.ground.as_ref()?;
        let beside = ray.at(distance) - plane.point;
        return Some(Interaction {
            surface: Surface::Ground,
            distance,
            point: plane.point + beside - beside.dot(plane.normal) * plane.normal,
            normal: plane.normal,
            is_outside: true,
        });
    }
    let NearestHit { id, shape, .. } = nearest?;
    let ShapeHit { distance, outward, is_outside } = hit_of(ray, start, own, shape)?;
    Some(Interaction {
        surface: Surface::Shape(id),
        distance,
        point: match shape {
            Shape::Sphere([x, y, z, radius]) => wide([x, y, z]) + f64::from(radius) * outward,
            Shape::Cone(_) => ray.at(distance),
        },
        normal: if is_outside { outward } else { -outward },
        is_outside,
    })
}

/// Returns true if any surface is nearer than `t_max`, except the shape `exempt` and shapes equal to it.
pub(super) fn is_occluded(
    context: &LightingContext<'_>,
    surface_ray: &SurfaceRay,
    t_max: f64,
    occluders: Occluders,
    exempt: Option<u32>,
) -> bool {
    let ray = &surface_ray.ray;
    let (start, own) = (surface_ray.start, start_shape(context, surface_ray.start));
    let hides = |id: u32| match occluders {
        Occluders::All => true,
        Occluders::Opaque => context.scene.surface(id).opacity >= 1.0,
    };
    // If several shapes equal the one on which the ray starts, only that one counts.
    let is_there = |id: u32, shape| match start {
        Start::Inside(first) => id == first || own != Some(shape),
        Start::Free | Start::Outside(_) | Start::Ground => true,
    };
    let exempt = exempt.map(|id| context.scene.shared_shapes().shape(id));
    ground(context, surface_ray).is_some_and(|t| t < t_max)
        || context.search.any(ray, t_max, |id, shape| {
            hit_of(ray, start, own, shape).is_some_and(|hit| hit.distance < t_max)
                && exempt != Some(shape)
                && is_there(id, shape)
                && hides(id)
        })
}

/// The shape on which a ray starts.
fn start_shape(context: &LightingContext<'_>, start: Start) -> Option<Shape> {
    match start {
        Start::Free | Start::Ground => None,
        Start::Outside(id) | Start::Inside(id) => Some(context.scene.shared_shapes().shape(id)),
    }
}

/// The intersection of a ray and a shape.
#[derive(Clone, Copy)]
struct ShapeHit {
    distance: f64,
    /// Unit normal, pointing out of the shape.
    outward: DVec3,
    /// Whether the ray arrives from outside. The normal cannot tell: for grazing rays, rounding may change its side, so
    /// that light would leak through.
    is_outside: bool,
}

/// The hit of a ray that starts on the shape `own`. Inlined, so that callers that need only the distance do not compute
/// the rest.
#[inline(always)]
fn hit_of(ray: &Ray, start: Start, own: Option<Shape>, shape: Shape) -> Option<ShapeHit> {
    let is_own = own == Some(shape);
    let [x, y, z, radius] = match shape {
        Shape::Sphere(sphere) => sphere.map(f64::from),
        Shape::Cone(cone) => {
            let hits = crossings(ray, &cone)?.into_iter().zip([true, false]);
            let mut hits = hits.filter(|(hit, _)| hit.normal.is_some());
            let (hit, is_outside) = match start {
                Start::Outside(_) if is_own => None,
                Start::Inside(_) if is_own => hits.find(|(_, is_outside)| !is_outside),
                _ => hits.find(|(hit, _)| hit.t > 0.0),
            }?;
            return Some(ShapeHit { distance: hit.t.max(0.0), outward: hit.normal?, is_outside });
        }
    };
    let center = DVec3::new(x, y, z);
    let from_center = ray.origin - center;
    match start {
        Start::Outside(_) if is_own => None,
        Start::Inside(_) if is_own => {
            let distance = (-2.0 * from_center.dot(ray.direction)).max(0.0);
            let outward = (from_center + distance * ray.direction).normalize_or(DVec3::Z);
            Some(ShapeHit { distance, outward, is_outside: false })
        }
        _ => {
            let (distance, outward) = intersect(ray, center, radius)?;
            let is_outside = from_center.length_squared() - radius * radius > 0.0;
            Some(ShapeHit { distance, outward: outward.normalize_or(DVec3::Z), is_outside })
        }
    }
}

/// The distance to the ground along a ray. `None` for a miss.
fn ground(context: &LightingContext<'_>, surface_ray: &SurfaceRay) -> Option<f64> {
    let plane = context.ground.as_ref()?;
    let descent = surface_ray.ray.direction.dot(plane.normal);
    if descent >= 0.0 || surface_ray.start == Start::Ground {
        return None;
    }
    let t = (plane.point - surface_ray.ray.origin).dot(plane.normal) / descent;
    (t > 0.0).then_some(t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{PinholeCamera, Pose};
    use crate::cpu::search::Search;
    use crate::image::color::LinearRgb;
    use crate::render::RenderSettings;
    use crate::scene::Scene;
    use crate::scene::sphere::Sphere;

    fn with_spheres(spheres: &[Sphere], test: impl FnOnce(&LightingContext<'_>)) {
        let scene = Scene::new(spheres).unwrap();
        let pose = Pose::looking_at([0.0, 0.0, 9.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::new(pose, 1.0, [1.0, 1.0]).unwrap();
        test(&LightingContext::new(Search::from(&scene), &camera, &RenderSettings::studio()));
    }

    fn direction(random: &mut fastrand::Rng) -> DVec3 {
        DVec3::from([0; 3].map(|_| random.f64() - 0.5)).normalize_or(DVec3::X)
    }

    /// A ray that starts inwards on a sphere stays inside until it is let out, and a ray that leaves the sphere does
    /// not come back, however flat the ray is and whatever side rounding gives.
    #[test]
    fn no_sphere_leaks() {
        let mut random = fastrand::Rng::with_seed(21);
        for radius in [1e-4, 1.0, 1e6] {
            with_spheres(&[Sphere::new([0.0; 3], radius, LinearRgb::WHITE)], |context| {
                let (_, radius) = context.sphere(0);
                for _ in 0..20_000 {
                    let outward = direction(&mut random);
                    let along = outward.any_orthonormal_vector();
                    let tilt = (random.f64() - 0.5) * 10_f64.powf(-16.0 * random.f64());
                    let direction = (along + tilt * outward).normalize_or(along);
                    let ray = Ray { origin: radius * outward, direction };
                    let outside = SurfaceRay { ray, start: Start::Outside(0) };
                    assert!(nearest(context, &outside).is_none());
                    let inside = SurfaceRay { ray, start: Start::Inside(0) };
                    let hit = nearest(context, &inside).unwrap();
                    assert!(!hit.is_outside, "{outward}, {tilt}");
                    assert_eq!(hit.this_side(), Start::Inside(0));
                    assert!((hit.point.length() / radius - 1.0).abs() < 1e-14);
                    let wanted = -2.0 * radius * tilt.min(0.0) / (1.0 + tilt * tilt).sqrt();
                    assert!((hit.distance - wanted).abs() < 1e-14 * radius);
                }
            });
        }
    }

    /// A sphere that is hit from outside is hit on its outer side, even if the ray is almost a tangent.
    #[test]
    fn from_outside_the_outer_side_is_hit() {
        let mut random = fastrand::Rng::with_seed(22);
        let mut hits = 0;
        with_spheres(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE)], |context| {
            for _ in 0..20_000 {
                let outward = direction(&mut random);
                let along = outward.any_orthonormal_vector();
                let miss = 1.0 + (random.f64() - 0.6) * 10_f64.powf(-16.0 * random.f64());
                let origin = miss * outward - (1.0 + 9.0 * random.f64()) * along;
                let ray = Ray { origin, direction: along };
                if let Some(hit) = nearest(context, &SurfaceRay { ray, start: Start::Free }) {
                    assert!(hit.is_outside, "{outward}, {miss}");
                    hits += 1;
                }
            }
        });
        assert!(hits > 5000, "{hits}");
    }

    #[test]
    fn at_equal_distances_the_smaller_id_is_hit() {
        with_spheres(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE); 3], |context| {
            let ray = Ray { origin: DVec3::new(0.0, 0.0, 3.0), direction: -DVec3::Z };
            let hit = nearest(context, &SurfaceRay { ray, start: Start::Free }).unwrap();
            assert_eq!((hit.surface, hit.distance), (Surface::Shape(0), 2.0));
            let ray = Ray { origin: hit.point, ..ray };
            let hit = nearest(context, &SurfaceRay { ray, start: hit.other_side() }).unwrap();
            assert_eq!((hit.surface, hit.distance), (Surface::Shape(0), 2.0));
        });
    }

    /// Several equal spheres behave like one.
    #[test]
    fn equal_spheres_do_not_hide_each_other() {
        let mut random = fastrand::Rng::with_seed(23);
        with_spheres(&[Sphere::new([0.1, 0.2, 0.3], 0.7, LinearRgb::WHITE); 3], |context| {
            let (center, radius) = context.sphere(0);
            for _ in 0..2000 {
                let outward = direction(&mut random);
                let along = direction(&mut random);
                let is_outward = along.dot(outward) >= 0.0;
                let start = if is_outward { Start::Outside(1) } else { Start::Inside(1) };
                let ray = Ray { origin: center + radius * outward, direction: along };
                let surface_ray = SurfaceRay { ray, start };
                let hides = |exempt| is_occluded(context, &surface_ray, 9.0, Occluders::All, exempt);
                if is_outward {
                    assert!(nearest(context, &surface_ray).is_none() && !hides(None));
                } else {
                    let hit = nearest(context, &surface_ray).unwrap();
                    assert_eq!((hit.surface, hit.is_outside), (Surface::Shape(0), false));
                    assert!(hides(None) && !hides(Some(2)));
                }
            }
        });
    }

    /// Shadow rays end at the light. Every surface in between hides it, except those on which they start and end.
    #[test]
    fn what_is_between_hides() {
        let at = |z: f64, opacity: f32| Sphere::new([0.0, 0.0, z], 0.5, LinearRgb::WHITE).with_opacity(opacity);
        with_spheres(&[at(0.0, 1.0), at(2.0, 0.9), at(4.0, 1.0)], |context| {
            let up = Ray { origin: DVec3::new(0.0, 0.0, 0.5), direction: DVec3::Z };
            let from = |start| SurfaceRay { ray: up, start };
            let hidden = |start, t_max, occluders, exempt| is_occluded(context, &from(start), t_max, occluders, exempt);
            let outside = Start::Outside(0);
            assert!(hidden(outside, 9.0, Occluders::All, None));
            assert!(!hidden(outside, 1.0, Occluders::All, None), "the near hit of the next");
            assert!(hidden(outside, 1.1, Occluders::All, None));
            assert!(!hidden(outside, 1.1, Occluders::Opaque, None));
            assert!(!hidden(outside, 3.0, Occluders::Opaque, None));
            assert!(hidden(outside, 3.1, Occluders::Opaque, None));
            assert!(!hidden(outside, 9.0, Occluders::Opaque, Some(2)));
            let down = Ray { direction: -DVec3::Z, ..up };
            let inside = SurfaceRay { ray: down, start: Start::Inside(0) };
            assert!(is_occluded(context, &inside, 1.1, Occluders::Opaque, None), "its own far hit");
            assert!(!is_occluded(context, &inside, 1.0, Occluders::Opaque, None));
        });
    }
}
