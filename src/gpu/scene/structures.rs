//! Structures of a scene for a device, and trying another where rays take too many steps.

use crate::accel::{Accel, AccelChoice, Structure};
use crate::gpu::error::GpuError;
use crate::gpu::headless::plan::RenderPlan;
use crate::scene::Scene;

/// What finds the spheres of rays, built on the host: from [`RenderPlan::build`], or from a structure alone.
#[derive(Debug)]
pub struct Structures {
    /// Of all spheres.
    pub accel: Accel,
    /// Of the spheres that cast shadows in a studio, where some do not.
    pub occluders: Option<Accel>,
}

impl From<Accel> for Structures {
    /// For pictures of primary rays and of paths, and for studios in which every sphere is opaque.
    fn from(accel: Accel) -> Self {
        Self { accel, occluders: None }
    }
}

impl RenderPlan {
    /// Builds what was planned, of the scene that it was planned for.
    #[must_use]
    pub fn build(&self, scene: &Scene) -> Structures {
        let accel = self.accel.build(scene.spheres());
        let occluders = self.occluders.as_ref().zip(self.occluders.as_ref().and(scene.opaque()));
        let occluders = occluders.map(|(plan, opaque)| plan.build(opaque.spheres()));
        Structures { accel, occluders }
    }

    /// What to choose where rays take too many steps in what is planned: a tree instead of a grid, a list instead of a
    /// tree. `None` for lists, which always end.
    #[must_use]
    pub fn instead(&self) -> Option<AccelChoice> {
        let planned = self.occluders.iter().chain([&self.accel]).map(|plan| plan.structure);
        let others: Vec<AccelChoice> = planned.filter_map(Structure::instead).collect();
        // A tree may do for both; only then is a list tried.
        [AccelChoice::Tree, AccelChoice::List].into_iter().find(|other| others.contains(other))
    }
}

/// Rays took too many steps in a structure, and another is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Retry {
    /// In which they did.
    pub failed: Structure,
    /// What is tried.
    pub next: AccelChoice,
}

/// Does some work in the structures that a choice stands for. Where the choice is [`AccelChoice::Auto`] and rays take
/// too many steps in what suits the data ([`GpuError::Steps`]), it is done once more with another, and `retrying` is
/// told before.
///
/// `plan` plans for a choice, as [`Headless::plan`](crate::gpu::Headless::plan) does; `work` builds, uploads and renders.
///
/// # Errors
/// The outer one is the caller's own, and ends the work at once; the inner one is the device's.
pub fn with_retries<T, E>(
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> RenderPlan,
    mut retrying: impl FnMut(Retry),
    mut work: impl FnMut(&RenderPlan) -> Result<Result<T, GpuError>, E>,
) -> Result<Result<T, GpuError>, E> {
    let mut tried = choice;
    loop {
        let plan = plan(tried);
        match (work(&plan)?, plan.instead()) {
            (Err(GpuError::Steps), Some(next)) if choice == AccelChoice::Auto => {
                retrying(Retry { failed: plan.accel.structure, next });
                tried = next;
            }
            (done, _) => return Ok(done),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::AccelPlan;
    use crate::camera::film::Film;
    use crate::camera::{PinholeCamera, Pose, View};
    use crate::gpu::headless::plan::{DeviceLimits, PictureRequest, StructurePlans};
    use crate::image::LayerSet;
    use crate::image::color::LinearRgb;
    use crate::render::RenderSettings;

    fn plan(choices: [AccelChoice; 2]) -> RenderPlan {
        let spheres: Vec<[f32; 4]> = (0..100).map(|i| [i as f32, 0.0, 0.0, 0.4]).collect();
        let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
        let pose = Pose::looking_at([0.0, 0.0, 9.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.5, 1.0).unwrap();
        let settings = RenderSettings::studio();
        let request = PictureRequest {
            scene: &scene,
            view: View::new(&camera, Film::new(8, 8).unwrap()),
            settings: &settings,
            layers: LayerSet::COLOR,
            host_bytes_per_pixel: 0,
        };
        let [accel, occluders] =
            choices.map(|choice| AccelPlan::new(scene.spheres(), choice, 1 << 27));
        let structures = StructurePlans { accel, occluders: Some(occluders) };
        let device =
            DeviceLimits { limits: wgpu::Limits::default(), device_type: wgpu::DeviceType::Cpu };
        RenderPlan::new(&request, structures, &device)
    }

    #[test]
    fn a_tree_is_tried_before_a_list() {
        use AccelChoice::{Grid, List, Tree};
        for (choices, instead) in [
            ([Grid, Grid], Some(Tree)),
            ([Grid, Tree], Some(Tree)),
            ([Tree, Grid], Some(Tree)),
            ([Tree, Tree], Some(List)),
            ([List, Tree], Some(List)),
            ([List, List], None),
        ] {
            assert_eq!(plan(choices).instead(), instead, "{choices:?}");
        }
    }

    #[test]
    fn only_a_free_choice_is_changed_and_it_ends() {
        let attempts = |choice| {
            let (mut tried, mut told) = (Vec::new(), Vec::new());
            let planned = |choice| plan([choice; 2]);
            let done: Result<Result<(), GpuError>, ()> = with_retries(
                choice,
                planned,
                |retry| told.push(retry.next),
                |plan| {
                    tried.push(plan.accel.structure.name());
                    Ok(Err(GpuError::Steps))
                },
            );
            assert_eq!(done, Ok(Err(GpuError::Steps)));
            (tried.len(), told)
        };
        assert_eq!(attempts(AccelChoice::Auto), (3, vec![AccelChoice::Tree, AccelChoice::List]));
        assert_eq!(attempts(AccelChoice::Grid), (1, Vec::new()));
    }

    #[test]
    fn a_callers_own_error_ends_it() {
        let planned = |choice| plan([choice; 2]);
        let done: Result<Result<(), GpuError>, &str> =
            with_retries(AccelChoice::Auto, planned, |_| {}, |_| Err("enough"));
        assert_eq!(done, Err("enough"));
    }
}
