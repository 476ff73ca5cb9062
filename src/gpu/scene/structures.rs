//! The structures of a scene for a device, and retries with another structure if rays need too many steps.

use crate::accel::{Accel, AccelChoice, Structure};
use crate::gpu::error::GpuError;
use crate::gpu::headless::plan::RenderPlan;
use crate::gpu::scene::scene_upload::bricks_of;
use crate::scene::Scene;

/// The acceleration structures of a scene, built on the host. [`RenderPlan::build`] returns them. They can also be made
/// from a single structure.
#[derive(Debug)]
pub struct Structures {
    /// The structure of all shapes.
    pub accel: Accel,
    /// The structure of the shapes that cast shadows in a studio, if some do not.
    pub occluders: Option<Accel>,
}

impl From<Accel> for Structures {
    /// Returns the structures for pictures of primary rays and of paths, and for studios in which every sphere is
    /// opaque.
    fn from(accel: Accel) -> Self {
        Self { accel, occluders: None }
    }
}

impl RenderPlan {
    /// Builds the planned structures of the scene that the plan was made for.
    #[must_use]
    pub fn build(&self, scene: &Scene) -> Structures {
        let accel = bricks_of(&self.accel, scene).build();
        let occluders = self.occluders.as_ref().zip(self.occluders.as_ref().and(scene.opaque()));
        let occluders = occluders.map(|(plan, opaque)| bricks_of(plan, &opaque).build());
        Structures { accel, occluders }
    }

    /// Returns the choice to try next if rays need too many steps in the planned structures: a tree instead of a grid,
    /// or a list instead of a tree; the planned structure instead of tiles. It is `None` for lists, which always stay
    /// within the limit.
    #[must_use]
    pub fn instead(&self) -> Option<AccelChoice> {
        if self.by_tiles {
            return Some(self.accel.structure.choice());
        }
        let plans = self.occluders.iter().chain([&self.accel]);
        let planned =
            plans.flat_map(|plan| [plan.structure].into_iter().chain(plan.cones.map(|cones| cones.structure)));
        let others: Vec<AccelChoice> = planned.filter_map(Structure::instead).collect();
        // A tree may suffice for both structures, so it is tried before a list.
        [AccelChoice::Tree, AccelChoice::List].into_iter().find(|other| others.contains(other))
    }
}

/// A retry with another structure after rays needed too many steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Retry {
    /// The structure in which rays needed too many steps.
    pub failed: Structure,
    /// The choice that is tried next.
    pub next: AccelChoice,
}

/// Plans structures for a choice and calls `work` with the plan. If the choice is
/// [`AccelChoice::Auto`] and rays need too many steps in the planned structures ([`GpuError::Steps`]),
/// calls `retrying` and repeats this with another choice.
///
/// `plan` makes a plan for a choice, as [`Headless::plan`](crate::gpu::Headless::plan) does; `work` builds, uploads and
/// renders.
///
/// # Errors
/// The outer error is the caller's own and ends the function at once. The inner error is the device's.
pub async fn with_retries<T, E>(
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> RenderPlan,
    mut retrying: impl FnMut(Retry),
    mut work: impl AsyncFnMut(&RenderPlan) -> Result<Result<T, GpuError>, E>,
) -> Result<Result<T, GpuError>, E> {
    let mut tried = choice;
    loop {
        let plan = plan(tried);
        match (work(&plan).await?, plan.instead()) {
            (Err(GpuError::Steps), Some(next)) if choice == AccelChoice::Auto => {
                retrying(Retry { failed: plan.structure(), next });
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
    use crate::gpu::device_shape::DeviceLimits;
    use crate::gpu::headless::plan::{PictureRequest, StructurePlans};
    use crate::gpu::headless::waiting::Wait;
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
            is_only: false,
            is_shaded: true,
        };
        let [accel, occluders] = choices.map(|choice| AccelPlan::new(scene.spheres(), choice, 1 << 27));
        let structures = StructurePlans { accel, occluders: Some(occluders) };
        let device = DeviceLimits { limits: wgpu::Limits::default(), device_type: wgpu::DeviceType::Cpu };
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
    fn only_an_automatic_choice_is_retried_and_retries_end() {
        let attempts = |choice| {
            let (mut tried, mut told) = (Vec::new(), Vec::new());
            let planned = |choice| plan([choice; 2]);
            let done: Result<Result<(), GpuError>, ()> = with_retries(
                choice,
                planned,
                |retry| told.push(retry.next),
                async |plan: &RenderPlan| {
                    tried.push(plan.accel.structure.name());
                    Ok(Err(GpuError::Steps))
                },
            )
            .wait();
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
            with_retries(AccelChoice::Auto, planned, |_| {}, async |_: &_| Err("enough")).wait();
        assert_eq!(done, Err("enough"));
    }
}
