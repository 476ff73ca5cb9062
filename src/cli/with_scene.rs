//! A scene on a device, in the structure that suits it, and work with it.

use super::failure::Failure;
use super::input::Input;
use super::speak::tell;
use super::{interrupt, memory, progress};
use crate::accel::{Accel, AccelChoice, AccelPlan, Structure};
use crate::gpu::{GpuError, Headless, Progress, RenderPlan, SceneBuffers, Watch};
use crate::scene::Scene;

/// Does some work, of which `plan` says what it takes, and says by which structure it was done. Where rays take
/// too many steps in the structure, and the choice was free, it is done once more with another. The errors within
/// are the device's.
pub(super) fn with_scene<T>(
    headless: &Headless,
    input: &Input,
    choice: AccelChoice,
    plan: impl Fn(AccelPlan) -> RenderPlan,
    work: impl Fn(&SceneBuffers, &mut Watch<'_>) -> Result<T, GpuError>,
) -> Result<Result<(T, Structure), GpuError>, Failure> {
    let scene = &input.scene;
    let plan = |choice| plan(headless.plan_once(scene, choice, &input.film));
    with_accel(headless, scene, choice, plan, |accel| {
        interrupt::on_device(|| {
            let buffers = headless.upload(scene, &accel)?;
            drop(accel);
            progress::stage("preparing");
            let mut watch = |Progress { done, total }| {
                progress::tracing(done, total);
                interrupt::decide()
            };
            work(&buffers, &mut watch)
        })
    })
}

/// As [`with_scene`], for work that copies the scene itself.
pub(super) fn with_accel<T>(
    headless: &Headless,
    scene: &Scene,
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> RenderPlan,
    work: impl Fn(Accel) -> Result<Result<T, GpuError>, Failure>,
) -> Result<Result<(T, Structure), GpuError>, Failure> {
    let mut tried = choice;
    loop {
        progress::stage("planning");
        let plan = plan(tried);
        let structure = plan.accel.structure;
        match (with_plan(headless, scene, &plan, &work)?, structure.instead()) {
            (Err(GpuError::Steps), Some(other)) if choice == AccelChoice::Auto => {
                tell(format_args!(
                    "note: rays take more steps in the {} than this device may loop for; \
                     trying the structure `{other}`, which takes longer",
                    structure.name()
                ));
                tried = other;
            }
            (done, _) => return Ok(done.map(|done| (done, structure))),
        }
    }
}

fn with_plan<T>(
    headless: &Headless,
    scene: &Scene,
    plan: &RenderPlan,
    work: impl Fn(Accel) -> Result<Result<T, GpuError>, Failure>,
) -> Result<Result<T, GpuError>, Failure> {
    if let Err(error) = plan.check(&headless.device().limits(), memory::available()) {
        return Ok(Err(error));
    }
    progress::stage(format!("building: {}", plan.accel.structure.name()));
    let accel = plan.accel.build(scene.spheres());
    progress::stage("copying to the device");
    work(accel)
}
